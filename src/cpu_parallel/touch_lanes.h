#pragma once
// Contact between bodies as files see it that are compiled for a particular instruction set: without Eigen.
#include <cstddef>
#include <cstdint>

#include "cpu_reference/touch_batch.h"

namespace aspic::parallel {

/// reference::SightBatch
struct SightLanes {
  const reference::Row<std::uint32_t>* faces;
  const reference::Row<float>* x;
  std::size_t count;
  float P[3];
  const std::int32_t* triangle;
  float *e[3], *N[3], *b, *c, *L, *z;
  std::int32_t *face, *real;
};

/// Reads and writes up to fifteen lanes behind the last.
void look_in_lanes(const SightLanes& batch);

/// What points touch first, in the lanes of vectors: the bits of reference::BodyContact.
void touch_in_lanes(const reference::TouchTables<float>& from, reference::TouchBatch<float>& batch);

}  // namespace aspic::parallel
