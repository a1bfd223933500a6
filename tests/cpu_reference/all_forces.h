#pragma once
// The forces of the reference at any state, without what depends on where a step began: contact between
// bodies and resting contacts.
#include "cpu_reference/terms.h"

namespace aspic::test {

class AllForces {
 public:
  explicit AllForces(const reference::Dynamics<double>& dynamics) : dynamics_(dynamics), terms_(dynamics) {}

  using Field = physics::Field<double>;
  Field force(const Field& x, const Field& v, double share = 0.0) const {
    Field f = terms_.force(x, v, share);
    dynamics_.add_contact_force(x, v, f);
    return f;
  }
  /// The course model's contact force alone.
  Field contact_force(const Field& x, const Field& v) const { return force(x, v) - terms_.force(x, v); }
  Field acceleration(const Field& x, const Field& v, double share = 0.0) const {
    return dynamics_.weighed(force(x, v, share));
  }

 private:
  const reference::Dynamics<double>& dynamics_;
  reference::Terms<double> terms_;
};

}  // namespace aspic::test
