#pragma once
// Ground as the reference's contact rules take it.
#include <limits>

#include "physics/terrain/ground.h"

namespace aspic::physics {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// The plane y = 0.
inline Ground<double> plane(double e = 0.5, double mu = 0.25, double mass = infinite) {
  Terrain t;
  t.restitution = e;
  t.friction = mu;
  t.mass = mass;
  return Ground<double>(t);
}

}  // namespace aspic::physics
