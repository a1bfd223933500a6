#pragma once
// What points see of triangles, in the lanes of vectors: the bits of collision::closest_points_one_by_one().
#include <algorithm>

#include "collision/closest_points.h"
#include "cpu_parallel/contact_lanes.h"

namespace aspic::parallel {

inline void closest_points_in_lanes(const collision::FacesInSpace<float>& faces,
                                    collision::ClosestPointBatch<float>& batch) {
  // Lanes behind the last look at a triangle that is there.
  for (std::size_t n = batch.count; n < (batch.count + 15) / 16 * 16; ++n) batch.triangle[n] = 0;
  const auto three = [](auto& of) { return std::array{of[0].data(), of[1].data(), of[2].data()}; };
  const auto e = three(batch.e), N = three(batch.N);
  look_in_lanes({faces.faces.data(),
                 faces.x.data(),
                 batch.count,
                 {batch.P.x(), batch.P.y(), batch.P.z()},
                 batch.triangle.data(),
                 {e[0], e[1], e[2]},
                 {N[0], N[1], N[2]},
                 batch.b.data(),
                 batch.c.data(),
                 batch.L.data(),
                 batch.z.data(),
                 batch.face.data(),
                 batch.real.data()});
}

}  // namespace aspic::parallel
