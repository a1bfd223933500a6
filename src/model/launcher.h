#pragma once
// The launcher: balls at random, the same ones for the same seed on every machine and backend.
//
// Nothing is carried from ball to ball: ball n's start and target follow from (seed, n) alone, so a launcher
// has no state. Its numbers are those of SplitMix64 (Steele, Lea, Flood, Fast Splittable Pseudorandom Number
// Generators, OOPSLA 2014), started at mix(seed): number i is mix(mix(seed) + (i + 1)·γ) with γ =
// 0x9e3779b97f4a7c15, and its upper 53 bits are a fraction in [0, 1). Ball n takes numbers 6n … 6n + 5: x, y,
// z of its start in `from`, then x, y, z of its target in `towards`.
#include <cstdint>

#include "model/model.h"

namespace aspic {

/// Number `index` of the sequence of `seed`, in [0, 1).
double launcher_number(std::int64_t seed, std::uint64_t index);

/// Ball n of a launcher, n from 0: it starts at step round(n·interval/h), never where that exceeds all step
/// numbers, with velocity factor·(target − start), not spinning.
Ball launched_ball(const LauncherSettings& launcher, std::uint64_t n, double timestep);

}  // namespace aspic
