#include "model/state.h"

#include <fmt/format.h>

#include "base/fnv.h"

namespace aspic {

std::string_view name_of(Precision precision) {
  return precision == Precision::single ? "single" : "double";
}

std::uint64_t state_hash(const State& state) {
  Fnv1a hash;
  const auto add = [&](const Vec3& value) {
    for (int axis = 0; axis < 3; ++axis) {
      if (state.precision == Precision::single) {
        hash.add(static_cast<float>(value[axis]));
      } else {
        hash.add(value[axis]);
      }
    }
  };
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    add(state.position[i]);
    add(state.velocity[i]);
  }
  for (std::size_t b = 0; b < state.ball_position.size(); ++b) {
    add(state.ball_position[b]);
    add(state.ball_velocity[b]);
    add(state.ball_angular_velocity[b]);
  }
  return hash.value();
}

std::string state_hash_text(const State& state) {
  return fmt::format("{:016x}", state_hash(state));
}

}  // namespace aspic
