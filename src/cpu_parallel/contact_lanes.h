#pragma once
// Contact between bodies as files see it that are compiled for a particular instruction set: without Eigen.
#include <cstddef>
#include <cstdint>

#include "collision/contact_batch.h"

namespace aspic::parallel {

/// collision::ClosestPointBatch
struct SightLanes {
  const collision::Row<std::uint32_t>* faces;
  const collision::Row<float>* x;
  std::size_t count;
  float P[3];
  const std::int32_t* triangle;
  float *e[3], *N[3], *b, *c, *L, *z;
  std::int32_t *face, *real;
};

/// Reads and writes up to fifteen lanes behind the last.
void look_in_lanes(const SightLanes& batch);

/// What points touch first, in the lanes of vectors: the bits of collision::ContactSearch.
void contacts_in_lanes(const collision::ContactTables<float>& from, collision::ContactBatch<float>& batch);

}  // namespace aspic::parallel
