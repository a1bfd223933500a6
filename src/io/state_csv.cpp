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
  // Every quantity has its columns, which are 0 where a carrier has no such field.
  const auto write = [&](StateCarrier carrier, std::size_t index) {
    line.clear();
    fmt::format_to(std::back_inserter(line), "{},{}", carrier == StateCarrier::particle ? "particle" : "ball",
                   index);
    for (const StateField& column : state_fields) {
      if (column.carrier != StateCarrier::ball) continue;
      Vec3 v;
      for (const StateField& field : state_fields)
        if (field.carrier == carrier && field.symbol == column.symbol) v = (state.*field.vectors)[index];
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
  for (const StateCarrier carrier : {StateCarrier::particle, StateCarrier::ball})
    for (std::size_t i = 0; i < count_of(state, carrier); ++i) ASPIC_CHECK(write(carrier, i));
  return {};
}

}  // namespace aspic
