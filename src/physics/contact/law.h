#pragma once
// Contact between bodies: the push and the friction of one contact, and how they are added to the forces of
// particles (docs/contact.md, "The push", "Friction", "Order of sums").
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/vectors.h"

namespace aspic::physics {

/// A point that touches a triangle.
template <class T>
struct Touch {
  std::uint32_t point = 0, triangle = 0;  ///< numbers in TouchSurfaces
  std::uint32_t carriers = 1;             ///< 1 or 2: particles that carry the point
  /// Of the carriers, from [2] on of the triangle's corners: places in the list of all particles that
  /// contacts may name.
  std::array<std::uint32_t, 5> place = {};
  std::array<T, 5> weight = {};       ///< of each, ≥ 0
  Vector<T> n = Vector<T>::Zero();    ///< unit normal towards the point
  T d = T(0);                         ///< distance [m]
  T reach = T(0);                     ///< where pushes begin [m]: ρ, or less while bodies are eased apart
  T k = T(0), c = T(0), mu = T(0);    ///< of the pair [N/m], [N·s/m], 1
  T rest = T(0);                      ///< the push, were there no motion [N]; it may pull
  T push = T(0);                      ///< f [N], ≥ 0
  Vector<T> rub = Vector<T>::Zero();  ///< friction on the point [N]
};

/// Σ weight·value over the carriers, or over the corners; `value(place)`.
template <class T, class Value>
auto over_carriers(const Touch<T>& touch, const Value& value) {
  using Sum = decltype(value(0u));
  if (touch.carriers == 1) return value(touch.place[0]);
  return Sum(touch.weight[0] * value(touch.place[0]) + touch.weight[1] * value(touch.place[1]));
}
template <class T, class Value>
auto over_corners(const Touch<T>& touch, const Value& value) {
  using Sum = decltype(value(0u));
  return Sum((touch.weight[2] * value(touch.place[2]) + touch.weight[3] * value(touch.place[3])) +
             touch.weight[4] * value(touch.place[4]));
}

/// f = max(0, rest − c·u) with the normal speed u of the point relative to the face.
template <class T>
T push_of(const Touch<T>& touch, T u) {
  const T f = touch.rest - touch.c * u;
  return f > T(0) ? f : T(0);
}

/// Sets the normal force of a contact with normal speed u: that at the end of a step from the speed u there,
/// or the one where the contact is.
template <class T>
void set_normal_force(Touch<T>& touch, T u, bool at_end) {
  touch.rest = touch.k * (touch.reach - touch.d);
  if (at_end) touch.rest = touch.rest + touch.c * u;
  touch.push = push_of(touch, u);
}

/// Calls add(place, weight) for the particles of every contact, in the order in which each particle adds: as
/// a carrier first, then as a corner, contacts ascending.
template <class T, class Carrier, class Corner>
void for_sums(std::span<const Touch<T>> touches, const Carrier& carrier, const Corner& corner) {
  for (const Touch<T>& touch : touches)
    for (std::size_t n = 0; n < touch.carriers; ++n) carrier(touch, touch.place[n], touch.weight[n]);
  for (const Touch<T>& touch : touches)
    for (std::size_t n = 2; n < 5; ++n) corner(touch, touch.place[n], touch.weight[n]);
}

/// Adds weight·force(touch) to what carries a point, and takes it from the corners of the triangle.
template <class T, class Force>
void spread(std::span<const Touch<T>> touches, std::vector<Vector<T>>& f, const Force& force) {
  for_sums<T>(
      touches,
      [&](const Touch<T>& touch, std::uint32_t place, T weight) {
        if (touch.push > T(0)) f[place] = f[place] + weight * force(touch);
      },
      [&](const Touch<T>& touch, std::uint32_t place, T weight) {
        if (touch.push > T(0)) f[place] = f[place] - weight * force(touch);
      });
}

/// The same with the pushes, and S: how much of them [N] falls to each particle, whose mass is divided among
/// its contacts in this proportion.
template <class T>
void spread_pushes(std::span<const Touch<T>> touches, std::vector<Vector<T>>& f, std::vector<T>& S) {
  for_sums<T>(
      touches,
      [&](const Touch<T>& touch, std::uint32_t place, T weight) {
        if (!(touch.push > T(0))) return;
        f[place] = f[place] + weight * Vector<T>(touch.push * touch.n);
        S[place] = S[place] + weight * touch.push;
      },
      [&](const Touch<T>& touch, std::uint32_t place, T weight) {
        if (!(touch.push > T(0))) return;
        f[place] = f[place] - weight * Vector<T>(touch.push * touch.n);
        S[place] = S[place] + weight * touch.push;
      });
}

/// Friction [N] on the point of a contact that pushes: the impulse that ends the slip of the velocities v₁ in
/// a step of h, or as much of it as the cone μ·f allows. W: inverse mass of the two parts that meet [1/kg].
template <class T>
Vector<T> friction_of(const Touch<T>& touch, T W, const Vector<T>& point_v1, const Vector<T>& face_v1, T h) {
  if (!(W > T(0))) return Vector<T>::Zero();
  const Vector<T> r = point_v1 - face_v1;
  const Vector<T> slip = r - dot3<T>(touch.n, r) * touch.n;
  Vector<T> J = (T(1) / W) * slip;
  const T size = norm3<T>(J), cone = touch.mu * (h * touch.push);
  if (size > cone) J = (cone / size) * J;
  return (T(1) / h) * -J;
}

}  // namespace aspic::physics
