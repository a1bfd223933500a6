#pragma once
// A pull: a damped spring of rest length 0 from a particle or a ball to a fixed anchor (aspic/inputs.h).
#include "aspic/inputs.h"
#include "physics/springs/law.h"

namespace aspic::physics {

/// A pull in the solver's precision.
template <class T>
struct PullConstants {
  Eigen::Index particle;
  Vector<T> anchor;  ///< [m]
  SpringConstants<T> spring;

  explicit PullConstants(const Pull& pull)
      : particle(static_cast<Eigen::Index>(pull.particle)),
        anchor(rounded<T>(pull.anchor)),
        spring(SpringClass{SpringType::structural, pull.stiffness, pull.damping, 0.0, false}) {}
};

/// Force [N] on a particle or ball at (x, v).
template <class T>
Vector<T> pull_force(const PullConstants<T>& pull, const Vector<T>& x, const Vector<T>& v) {
  return spring_force<T>(pull.spring, x - pull.anchor, v);
}

/// The same at the end of a step h from x with the velocity v, and the Jacobian.
template <class T>
std::pair<Vector<T>, SpringJacobian<T>> linearized(const PullConstants<T>& pull, T h, const Vector<T>& x,
                                                   const Vector<T>& v) {
  return linearized<T>(pull.spring, h, (x - pull.anchor) + h * v, v);
}

}  // namespace aspic::physics
