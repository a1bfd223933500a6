#pragma once
// Contact between bodies inside the equation of implicit Euler (docs/contact.md, "Implicit Euler"). Contacts
// are found where a step begins, and again where its first solve ends; their normal forces and friction are
// functions of the velocities v' at its end, and linear but for where a normal force begins and a cone ends.
// Every expression has one order of operations, which the kernels follow
// (shaders/compute/implicit_contact_react.comp).
#include <cstdint>
#include <span>
#include <vector>

#include "model/model.h"
#include "physics/contact/forces.h"
#include "physics/diagonal_block.h"

namespace aspic::physics {

/// What a contact does at a trial v', and the part of the matrix, −h·∂F/∂v', that it is.
template <class T>
struct ContactResponse {
  T cone = T(0);                        ///< most friction [N]: μ·f where it was found
  Vector<T> force = Vector<T>::Zero();  ///< on the point [N]
  T along = T(0), across = T(0);        ///< along n and across it [kg]
  Vector<T> t = Vector<T>::Zero();      ///< unit vector of a friction that slides; it may turn, and not grow
  Vector<T> product = Vector<T>::Zero();  ///< the matrix times a direction [kg·m/s]
  bool acts() const { return along > T(0) || across > T(0); }
};

/// Where the step would end with relative velocity r of the point: with a normal force f = max(0, k·(ρ − d) −
/// k·h·u) and friction p, which begins with that of the explicit methods and gives way like a spring of the
/// normal force's stiffness.
template <class T>
void answer(const ContactPoint<T>& contact, const Vector<T>& r, T h, ContactResponse<T>& out) {
  const T stiffness = h * contact.c;
  const T u = dot3<T>(contact.n, r), normal_force = normal_force_of<T>(contact, u);
  const Vector<T> slip = r - u * contact.n;
  Vector<T> p = contact.friction - contact.c * slip;
  const T size = norm3<T>(p);
  out.along = normal_force > T(0) ? stiffness : T(0);
  out.across = stiffness;
  out.t.setZero();
  if (!(out.cone > T(0))) {
    p.setZero();
    out.across = T(0);
  } else if (size > out.cone) {
    const T share = out.cone / size;
    out.t = (T(1) / size) * p;
    p = share * p;
    out.across = share * stiffness;
  }
  out.force = p + normal_force * contact.n;
}

/// The matrix of a contact times the relative velocity c of its point.
template <class T>
Vector<T> product_of(const ContactPoint<T>& contact, const ContactResponse<T>& answer, const Vector<T>& c) {
  const T along = dot3<T>(contact.n, c), turned = dot3<T>(answer.t, c);
  const Vector<T> rest = (c - along * contact.n) - turned * answer.t;
  return (answer.along * along) * contact.n + answer.across * rest;
}

/// `Search`: finds the contacts, as reference::BodyContact does. What follows `inverse_mass` is passed on to
/// it.
template <class T, class Search>
class ImplicitContact {
 public:
  using Particles = typename ContactForces<T>::Particles;

  /// Of a model whose has_body_contact().
  explicit ImplicitContact(const Model& model)
      : contact_(model, model.simulation.timestep), h_(static_cast<T>(model.simulation.timestep)) {}

  Search& search() { return contact_; }

  /// A step from the state of this number begins. Returns whether any bodies may be in contact in it.
  /// `force(p)`: gravity, springs and pulls where the step begins [N], inverse_mass(p) [1/kg], of a particle.
  template <class Force, class InverseMass, class... Run>
  bool start(std::uint64_t step, const Particles& start, const Force& force, const InverseMass& inverse_mass,
             const Run&... run) {
    contact_.set_at_end(false);
    answers_.clear();
    return contact_.begin_step(step, start, run...) && find(start, start, force, inverse_mass, run...);
  }
  /// The same where the step may end, from which its second solve goes on.
  template <class Force, class InverseMass, class... Run>
  bool search_again(const Particles& start, const Particles& end, const Force& force,
                    const InverseMass& inverse_mass, const Run&... run) {
    contact_.set_at_end(true);
    return find(start, end, force, inverse_mass, run...);
  }

  /// The particles that contacts may name, ascending; force(), block() and product() are by place in this
  /// list.
  std::span<const std::uint32_t> particles() const { return contact_.particles(); }

  /// Answers at the trial velocities v'(particle) [m/s]. Returns whether any contact acts.
  template <class Velocity>
  bool react(const Velocity& velocity) {
    gather(velocity);
    bool any = false;
    for (std::size_t n = 0; n < answers_.size(); ++n) {
      const ContactPoint<T>& contact = contact_.contacts()[n];
      const Vector<T> r = relative(contact);
      answer<T>(contact, r, h_, answers_[n]);
      any = any || answers_[n].acts();
    }
    force_.assign(particles().size(), Vector<T>::Zero());
    block_.assign(particles().size(), DiagonalBlock<T>(T(0)));
    const auto add = [&](std::uint32_t place, T weight, T sign, const ContactPoint<T>& contact,
                         const ContactResponse<T>& at) {
      force_[place] = force_[place] + (sign * weight) * at.force;
      const T square = weight * weight;
      block_[place].add({square * at.along, square * at.across, contact.n});
      block_[place].add({-(square * at.across), T(0), at.t});
    };
    for_each_acting(add);
    return any;
  }
  const Vector<T>& force(std::size_t place) const { return force_[place]; }         ///< [N]
  const DiagonalBlock<T>& block(std::size_t place) const { return block_[place]; }  ///< [kg]

  /// The matrix of all contacts times p(particle).
  template <class Direction>
  void multiply(const Direction& p) {
    gather(p);
    product_.assign(particles().size(), Vector<T>::Zero());
    for (std::size_t n = 0; n < answers_.size(); ++n) {
      const ContactPoint<T>& contact = contact_.contacts()[n];
      if (answers_[n].acts()) answers_[n].product = product_of<T>(contact, answers_[n], relative(contact));
    }
    for_each_acting(
        [&](std::uint32_t place, T weight, T sign, const ContactPoint<T>&, const ContactResponse<T>& at) {
          product_[place] = product_[place] + (sign * weight) * at.product;
        });
  }
  const Vector<T>& product(std::size_t place) const { return product_[place]; }

  std::uint64_t bytes() const { return contact_.bytes(); }

 private:
  template <class Force, class InverseMass, class... Run>
  bool find(const Particles& start, const Particles& at, const Force& force, const InverseMass& inverse_mass,
            const Run&... run) {
    const bool near = contact_.find(at, run...);
    answers_.assign(contact_.contacts().size(), {});
    if (!near) return false;
    std::vector<Vector<T>> f;
    for (const std::uint32_t p : contact_.particles()) f.push_back(force(p));
    contact_.add_normal_forces(start, inverse_mass, f, run...);
    for (std::size_t n = 0; n < answers_.size(); ++n)
      answers_[n].cone = contact_.contacts()[n].mu * contact_.contacts()[n].normal_force;
    return true;
  }

  template <class Value>
  void gather(const Value& value) {
    value_.clear();
    for (const std::uint32_t p : particles()) value_.push_back(value(p));
  }
  Vector<T> relative(const ContactPoint<T>& contact) const {
    const auto value = [&](std::uint32_t place) { return value_[place]; };
    return over_carriers<T>(contact, value) - over_corners<T>(contact, value);
  }
  /// As for_sums(), of contacts that act.
  template <class Add>
  void for_each_acting(const Add& add) const {
    const auto each = [&](std::size_t first, auto last, T sign) {
      for (std::size_t n = 0; n < answers_.size(); ++n) {
        const ContactPoint<T>& contact = contact_.contacts()[n];
        if (!answers_[n].acts()) continue;
        for (std::size_t k = first; k < last(contact); ++k)
          add(contact.place[k], contact.weight[k], sign, contact, answers_[n]);
      }
    };
    each(
        0, [](const ContactPoint<T>& contact) { return std::size_t{contact.carriers}; }, T(1));
    each(
        2, [](const ContactPoint<T>&) { return std::size_t{5}; }, T(-1));
  }

  Search contact_;
  T h_;
  std::vector<ContactResponse<T>> answers_;  // of the contacts
  std::vector<Vector<T>> value_, force_, product_;
  std::vector<DiagonalBlock<T>> block_;
};

}  // namespace aspic::physics
