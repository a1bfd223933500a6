#pragma once
// Contact between bodies: the normal force and the friction of one contact, and how they are added to the
// forces of particles (docs/contact.md, "Normal force", "Friction", "Order of sums").
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/vectors.h"

namespace aspic::physics {

/// A point in contact with a triangle.
template <class T>
struct ContactPoint {
  std::uint32_t point = 0, triangle = 0;  ///< numbers in ContactSurfaces
  std::uint32_t carriers = 1;             ///< 1 or 2: particles that carry the point
  /// Of the carriers, from [2] on of the triangle's corners: places in the list of all particles that
  /// contacts may name.
  std::array<std::uint32_t, 5> place = {};
  std::array<T, 5> weight = {};     ///< of each, ≥ 0
  Vector<T> n = Vector<T>::Zero();  ///< unit normal towards the point
  T d = T(0);                       ///< distance [m]
  T reach = T(0);                   ///< where forces begin [m]: ρ, or less while an initial overlap parts
  T k = T(0), c = T(0), mu = T(0);  ///< of the pair [N/m], [N·s/m], 1
  T static_force = T(0);            ///< normal force without motion [N]; may be negative
  T normal_force = T(0);            ///< f [N], ≥ 0
  Vector<T> friction = Vector<T>::Zero();  ///< on the point [N]
};

/// Σ weight·value over the carriers, or over the corners; `value(place)`.
template <class T, class Value>
auto over_carriers(const ContactPoint<T>& contact, const Value& value) {
  using Sum = decltype(value(0u));
  if (contact.carriers == 1) return value(contact.place[0]);
  return Sum(contact.weight[0] * value(contact.place[0]) + contact.weight[1] * value(contact.place[1]));
}
template <class T, class Value>
auto over_corners(const ContactPoint<T>& contact, const Value& value) {
  using Sum = decltype(value(0u));
  return Sum((contact.weight[2] * value(contact.place[2]) + contact.weight[3] * value(contact.place[3])) +
             contact.weight[4] * value(contact.place[4]));
}

/// f = max(0, rest − c·u) with the normal speed u of the point relative to the face.
template <class T>
T normal_force_of(const ContactPoint<T>& contact, T u) {
  const T f = contact.static_force - contact.c * u;
  return f > T(0) ? f : T(0);
}

/// Sets the normal force of a contact with normal speed u: that at the end of a step from the speed u there,
/// or the one where the contact is.
template <class T>
void set_normal_force(ContactPoint<T>& contact, T u, bool at_end) {
  contact.static_force = contact.k * (contact.reach - contact.d);
  if (at_end) contact.static_force = contact.static_force + contact.c * u;
  contact.normal_force = normal_force_of(contact, u);
}

/// Calls add(place, weight) for the particles of every contact, in the order in which each particle adds: as
/// a carrier first, then as a corner, contacts ascending.
template <class T, class Carrier, class Corner>
void for_sums(std::span<const ContactPoint<T>> contacts, const Carrier& carrier, const Corner& corner) {
  for (const ContactPoint<T>& contact : contacts)
    for (std::size_t n = 0; n < contact.carriers; ++n) carrier(contact, contact.place[n], contact.weight[n]);
  for (const ContactPoint<T>& contact : contacts)
    for (std::size_t n = 2; n < 5; ++n) corner(contact, contact.place[n], contact.weight[n]);
}

/// Adds weight·force(contact) to what carries a point, and takes it from the corners of the triangle.
template <class T, class Force>
void spread(std::span<const ContactPoint<T>> contacts, std::vector<Vector<T>>& f, const Force& force) {
  for_sums<T>(
      contacts,
      [&](const ContactPoint<T>& contact, std::uint32_t place, T weight) {
        if (contact.normal_force > T(0)) f[place] = f[place] + weight * force(contact);
      },
      [&](const ContactPoint<T>& contact, std::uint32_t place, T weight) {
        if (contact.normal_force > T(0)) f[place] = f[place] - weight * force(contact);
      });
}

/// The same with the normal forces, and S: how much of them [N] falls to each particle, whose mass is divided
/// among its contacts in this proportion.
template <class T>
void spread_normal_forces(std::span<const ContactPoint<T>> contacts, std::vector<Vector<T>>& f,
                          std::vector<T>& S) {
  for_sums<T>(
      contacts,
      [&](const ContactPoint<T>& contact, std::uint32_t place, T weight) {
        if (!(contact.normal_force > T(0))) return;
        f[place] = f[place] + weight * Vector<T>(contact.normal_force * contact.n);
        S[place] = S[place] + weight * contact.normal_force;
      },
      [&](const ContactPoint<T>& contact, std::uint32_t place, T weight) {
        if (!(contact.normal_force > T(0))) return;
        f[place] = f[place] - weight * Vector<T>(contact.normal_force * contact.n);
        S[place] = S[place] + weight * contact.normal_force;
      });
}

/// Friction [N] on the point of a contact with a normal force: the impulse that ends the slip of the
/// velocities v₁ in a step of h, or as much of it as the cone μ·f allows. W: inverse mass of the two parts
/// that meet [1/kg].
template <class T>
Vector<T> friction_of(const ContactPoint<T>& contact, T W, const Vector<T>& point_v1,
                      const Vector<T>& face_v1, T h) {
  if (!(W > T(0))) return Vector<T>::Zero();
  const Vector<T> r = point_v1 - face_v1;
  const Vector<T> slip = r - dot3<T>(contact.n, r) * contact.n;
  Vector<T> J = (T(1) / W) * slip;
  const T size = norm3<T>(J), cone = contact.mu * (h * contact.normal_force);
  if (size > cone) J = (cone / size) * J;
  return (T(1) / h) * -J;
}

}  // namespace aspic::physics
