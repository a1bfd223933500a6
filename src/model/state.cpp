#include "aspic/state.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/fnv.h"

namespace aspic {

std::string_view name_of(Precision precision) {
  return precision == Precision::single ? "single" : "double";
}

void resize(State& state, std::size_t particles, std::size_t balls) {
  for (const StateField& field : state_fields)
    (state.*field.vectors).resize(field.carrier == StateCarrier::particle ? particles : balls);
}

std::optional<std::string> first_not_finite(const State& state) {
  for (const StateCarrier carrier : {StateCarrier::particle, StateCarrier::ball}) {
    std::size_t first = count_of(state, carrier);
    for (const StateField& field : state_fields) {
      if (field.carrier != carrier) continue;
      const auto& vectors = state.*field.vectors;
      const auto bad = std::ranges::find_if_not(vectors, [](const Vec3& v) { return is_finite(v); });
      first = std::min(first, static_cast<std::size_t>(bad - vectors.begin()));
    }
    if (first < count_of(state, carrier))
      return fmt::format("{} {}", carrier == StateCarrier::particle ? "particle" : "ball", first);
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
