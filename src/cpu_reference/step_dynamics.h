#pragma once
// The forces of one step of an explicit method, with all that depends on where the step began.
#include <utility>
#include <vector>

#include "cpu_reference/body_contact.h"
#include "cpu_reference/terms.h"

namespace aspic::reference {

/// The forces of one step from (x0, v0): the terms, contact between bodies, then terrain: the course model's
/// force or, in the Coulomb model, the reaction on the particles that rest on it. An explicit method
/// evaluates these.
template <class T>
class StepDynamics {
 public:
  /// `bodies` may be nullptr. All must outlive it.
  StepDynamics(const Dynamics<T>& dynamics, const Terms<T>& terms, const Field<T>& x0, const Field<T>& v0,
               BodyContact<T>* bodies = nullptr)
      : dynamics_(dynamics), terms_(terms), start_(view(x0, v0)) {
    for (Eigen::Index i = 0; i < x0.cols(); ++i) dynamics.find_resting(i, x0.col(i), v0.col(i), resting_);
    if (bodies && bodies->begin_step(dynamics.step(), start_)) bodies_ = bodies;
  }

  /// a(x, v) [m/s²] at the stage that is this share of the step from its start.
  Field<T> acceleration(const Field<T>& x, const Field<T>& v, double share) const {
    Field<T> f = terms_.force(x, v, share);
    if (bodies_ && !dynamics_.interrupted() && bodies_->find(view(x, v))) add_body_contact(f);
    dynamics_.add_contact_force(x, v, f);
    for (const RestingContact<T>& at : resting_)
      f.col(at.particle) = with_reaction<T>(at, f.col(at.particle));
    return dynamics_.weighed(std::move(f));
  }

 private:
  using View = typename BodyContact<T>::Particles;
  static View view(const Field<T>& x, const Field<T>& v) {
    return {components(x.data()), components(v.data()), 3};
  }

  void add_body_contact(Field<T>& f) const {
    std::vector<Vector<T>> forces;
    for (const std::uint32_t p : bodies_->particles()) forces.push_back(f.col(p));
    bodies_->add_forces(
        start_, [&](std::uint32_t p) { return dynamics_.inverse_mass(p); }, forces);
    for (std::size_t n = 0; n < forces.size(); ++n) f.col(bodies_->particles()[n]) = forces[n];
  }

  const Dynamics<T>& dynamics_;
  const Terms<T>& terms_;
  View start_;
  BodyContact<T>* bodies_ = nullptr;  // none where nothing may touch in this step
  std::vector<RestingContact<T>> resting_;
};

}  // namespace aspic::reference
