#pragma once
// What serves software rasterizers alone; a GPU would do without.
#include <cstdint>

namespace aspic::software {

/// Quads along an edge of a coarse skin at most (ImageOptions::coarse_skin): triangles cost time there.
inline constexpr std::uint32_t coarse_quads = 16;

/// Invocations that find the particles' bounds; more particles are shared out among them: atomics cost time
/// there.
inline constexpr std::uint32_t most_bounding_invocations = 4096;

}  // namespace aspic::software
