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

}  // namespace aspic::physics
