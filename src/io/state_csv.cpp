#include "io/state_csv.h"

#include <fmt/format.h>

#include <iterator>

namespace aspic {

Status check_finite(const State& state, const std::string& path) {
  if (const auto bad = first_not_finite(state))
    return fail(ErrorCode::diverged, "{} was not written: {} is not a finite number.", path, *bad);
  return {};
}

Status write_state_csv(AtomicFile& file, const State& state) {
  ASPIC_CHECK(check_finite(state, file.path()));
  ASPIC_CHECK(file.write(fmt::format("{}\n", state_csv_header)));
  fmt::memory_buffer line;
  const auto append = [&](const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) {
      if (state.precision == Precision::single) {
        fmt::format_to(std::back_inserter(line), ",{}", static_cast<float>(v[axis]));
      } else {
        fmt::format_to(std::back_inserter(line), ",{}", v[axis]);
      }
    }
  };
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    line.clear();
    fmt::format_to(std::back_inserter(line), "particle,{}", i);
    append(state.position[i]);
    append(state.velocity[i]);
    line.append(std::string_view(",0,0,0\n"));
    ASPIC_CHECK(file.write({line.data(), line.size()}));
  }
  for (std::size_t b = 0; b < state.ball_position.size(); ++b) {
    line.clear();
    fmt::format_to(std::back_inserter(line), "ball,{}", b);
    append(state.ball_position[b]);
    append(state.ball_velocity[b]);
    append(state.ball_angular_velocity[b]);
    line.push_back('\n');
    ASPIC_CHECK(file.write({line.data(), line.size()}));
  }
  return {};
}

}  // namespace aspic
