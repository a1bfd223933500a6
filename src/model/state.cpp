#include "aspic/state.h"

#include <fmt/format.h>

#include "base/fnv.h"

namespace aspic {

std::string_view name_of(Precision precision) {
  return precision == Precision::single ? "single" : "double";
}

std::optional<std::string> first_not_finite(const State& s) {
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    if (!is_finite(s.position[i]) || !is_finite(s.velocity[i])) return fmt::format("particle {}", i);
  }
  for (std::size_t b = 0; b < s.ball_position.size(); ++b) {
    if (!is_finite(s.ball_position[b]) || !is_finite(s.ball_velocity[b]) ||
        !is_finite(s.ball_angular_velocity[b]))
      return fmt::format("ball {}", b);
  }
  return std::nullopt;
}

std::uint64_t state_hash(const State& state) {
  Fnv1a hash;
  for_each_vector(state, [&](const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) {
      if (state.precision == Precision::single) {
        hash.add(static_cast<float>(v[axis]));
      } else {
        hash.add(v[axis]);
      }
    }
  });
  return hash.value();
}

std::string state_hash_text(const State& state) {
  return fmt::format("{:016x}", state_hash(state));
}

}  // namespace aspic
