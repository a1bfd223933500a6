#pragma once
// What points see of triangles, in the lanes of vectors: the bits of reference::look_one_by_one().
#include <algorithm>

#include "cpu_parallel/touch_lanes.h"
#include "cpu_reference/touch_sights.h"

namespace aspic::parallel {

/// Of particles whose components lie one after the other.
inline void look_side_by_side(const reference::ParticleView<const float>& particles,
                              reference::SightBatch<float>& batch) {
  // Lanes behind the last look at a triangle that is there.
  for (std::size_t n = batch.count; n < (batch.count + 15) / 16 * 16; ++n)
    for (auto& corner : batch.corner) corner[n] = 0;
  const auto three = [](auto& of) { return std::array{of[0].data(), of[1].data(), of[2].data()}; };
  const auto P = three(batch.P), N_P = three(batch.N_P), e = three(batch.e), N = three(batch.N);
  const auto corner = three(batch.corner);
  look_in_lanes({{particles.x[0], particles.x[1], particles.x[2]},
                 batch.count,
                 {P[0], P[1], P[2]},
                 {N_P[0], N_P[1], N_P[2]},
                 batch.opposing.data(),
                 {corner[0], corner[1], corner[2]},
                 {e[0], e[1], e[2]},
                 {N[0], N[1], N[2]},
                 batch.b.data(),
                 batch.c.data(),
                 batch.L.data(),
                 batch.z.data(),
                 batch.face.data(),
                 batch.counts.data()});
}

}  // namespace aspic::parallel
