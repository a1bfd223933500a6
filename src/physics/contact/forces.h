#pragma once
// The forces of all contacts of one force evaluation: normal forces, then friction (docs/contact.md).
#include <cstdint>
#include <span>
#include <vector>

#include "physics/contact/law.h"
#include "physics/particle_view.h"

namespace aspic::physics {

/// A search derives from it and fills in contacts and particles.
template <class T>
class ContactForces {
 public:
  using Particles = ParticleView<const T>;

  explicit ContactForces(double h) : h_(static_cast<T>(h)) {}

  /// Ascending by point, body of the triangle, and first contact before other sides.
  std::span<const ContactPoint<T>> contacts() const { return contacts_; }
  /// The particles that contacts of this step may name, ascending; forces are by place in this list.
  std::span<const std::uint32_t> particles() const { return particles_; }

  /// Adds normal forces and friction to the forces f [N] of gravity, springs and pulls. `start`: of the step;
  /// inverse_mass(particle) [1/kg].
  template <class InverseMass>
  void add_forces(const Particles& start, const InverseMass& inverse_mass, std::vector<Vector<T>>& f) {
    add_normal_forces(start, inverse_mass, f);
    add_friction(f);
  }
  /// Adds normal forces alone; friction is found for every contact.
  template <class InverseMass>
  void add_normal_forces(const Particles& start, const InverseMass& inverse_mass, std::vector<Vector<T>>& f) {
    begin_friction(start, inverse_mass, f);
    for (ContactPoint<T>& contact : contacts_) find_friction(contact);
  }

  /// Σ ½k·max(0, ρ − d)² [J].
  T energy() const {
    T sum = T(0);
    for (const ContactPoint<T>& contact : contacts_) {
      const T near = contact.reach - contact.d;
      if (near > T(0)) sum += T(0.5) * contact.k * near * near;
    }
    return sum;
  }

 protected:
  template <class InverseMass>
  void begin_friction(const Particles& start, const InverseMass& inverse_mass, std::vector<Vector<T>>& f) {
    share_.assign(particles_.size(), T(0));
    spread_normal_forces<T>(contacts_, f, share_);
    if (!friction_) return;
    v1_.resize(particles_.size());
    for (std::size_t n = 0; n < particles_.size(); ++n) {
      const T w = inverse_mass(particles_[n]);
      v1_[n] = start.velocity(particles_[n]) + (h_ * w) * f[n];
      share_[n] = w * share_[n];
    }
  }
  void find_friction(ContactPoint<T>& contact) const {
    if (!friction_ || !(contact.normal_force > T(0))) return;
    const auto part = [&](std::uint32_t place) { return share_[place]; };
    const auto v1 = [&](std::uint32_t place) { return v1_[place]; };
    const T W = (over_carriers<T>(contact, part) + over_corners<T>(contact, part)) / contact.normal_force;
    contact.friction =
        friction_of<T>(contact, W, over_carriers<T>(contact, v1), over_corners<T>(contact, v1), h_);
  }
  void add_friction(std::vector<Vector<T>>& f) const {
    if (friction_)
      spread<T>(contacts_, f,
                [](const ContactPoint<T>& contact) -> const Vector<T>& { return contact.friction; });
  }

  std::vector<ContactPoint<T>> contacts_;
  std::vector<std::uint32_t> particles_;
  T h_;                        // time step [s]
  bool friction_ = false;      // any pair of bodies has friction
  std::vector<T> share_;       // by place: the sum of normal forces [N], then times the inverse mass
  std::vector<Vector<T>> v1_;  // by place: velocity at the step's end without friction [m/s]
};

}  // namespace aspic::physics
