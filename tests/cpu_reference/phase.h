#pragma once
// A model's start as the reference's integrators take it.
#include "cpu_reference/integrators.h"

namespace aspic::reference {

/// Initial positions and velocities in double precision, one column per particle.
inline Phase<double> start_of(const Model& model) {
  Phase<double> s;
  const auto n = static_cast<Eigen::Index>(model.particle_count());
  s.x.resize(3, n);
  s.v.resize(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    s.x.col(i) = rounded<double>(model.initial_position[static_cast<std::size_t>(i)]);
    s.v.col(i) = rounded<double>(model.initial_velocity[static_cast<std::size_t>(i)]);
  }
  return s;
}

}  // namespace aspic::reference
