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
  const auto write = [&](std::string_view kind, std::size_t index, std::initializer_list<Vec3> vectors) {
    line.clear();
    fmt::format_to(std::back_inserter(line), "{},{}", kind, index);
    for (const Vec3& v : vectors) {
      for (const double x : {v.x, v.y, v.z}) {
        if (state.precision == Precision::single)
          fmt::format_to(std::back_inserter(line), ",{}", static_cast<float>(x));
        else
          fmt::format_to(std::back_inserter(line), ",{}", x);
      }
    }
    line.push_back('\n');
    return file.write({line.data(), line.size()});
  };
  for (std::size_t i = 0; i < state.position.size(); ++i)
    ASPIC_CHECK(write("particle", i, {state.position[i], state.velocity[i], Vec3{}}));
  for (std::size_t b = 0; b < state.ball_position.size(); ++b)
    ASPIC_CHECK(
        write("ball", b, {state.ball_position[b], state.ball_velocity[b], state.ball_angular_velocity[b]}));
  return {};
}

}  // namespace aspic
