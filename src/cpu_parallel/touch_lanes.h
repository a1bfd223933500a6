#pragma once
// reference::SightBatch as files see it that are compiled for a particular instruction set: without Eigen.
#include <cstddef>
#include <cstdint>

namespace aspic::parallel {

struct TouchLanes {
  const float* x[3];  ///< positions of all particles [m]
  std::size_t count;
  const float *P[3], *N_P[3], *opposing;
  const std::int32_t* corner[3];
  float *e[3], *N[3], *b, *c, *L, *z;
  std::int32_t *face, *counts;
};

/// Reads and writes up to fifteen lanes behind the last.
void look_in_lanes(const TouchLanes& batch);

}  // namespace aspic::parallel
