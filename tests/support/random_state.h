#pragma once
// States full of awkward numbers: every bit pattern of a finite number is as likely as any other.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "aspic/state.h"

namespace aspic::test {

inline State random_bits_state(std::size_t particles, Precision precision, std::uint64_t seed = 1,
                               std::size_t balls = 7) {
  std::mt19937_64 random(seed);
  const auto number = [&] {
    for (;;) {
      const std::uint64_t bits = random();
      const double value = precision == Precision::single
                               ? double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))}
                               : std::bit_cast<double>(bits);
      if (std::isfinite(value)) return value;
    }
  };
  State state;
  state.precision = precision;
  for (std::size_t i = 0; i < particles; ++i) {
    state.position.push_back({number(), number(), number()});
    state.velocity.push_back({number(), number(), number()});
  }
  for (std::size_t b = 0; b < balls; ++b) {
    state.ball_position.push_back({number(), number(), number()});
    state.ball_velocity.push_back({number(), number(), number()});
    state.ball_angular_velocity.push_back({number(), number(), number()});
  }
  if (particles > 0) {
    state.velocity[0] = {-0.0, 0.0,
                         precision == Precision::single ? double{std::numeric_limits<float>::denorm_min()}
                                                        : std::numeric_limits<double>::denorm_min()};
  }
  return state;
}

}  // namespace aspic::test
