#pragma once
// Reads back the tables of states that runs write (io/state_csv.h).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "base/files.h"
#include "io/state_csv.h"

namespace aspic::test {

inline constexpr std::size_t field_count = 11;

template <class T>
std::optional<double> parse_as(std::string_view text) {
  T value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return static_cast<double>(value);
}

/// Walks through lines; tolerates a missing last line end and carriage returns.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    ++number_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }
  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// The fields of a line; nothing if there are not exactly field_count.
inline std::optional<std::array<std::string_view, field_count>> split(std::string_view line) {
  std::array<std::string_view, field_count> fields;
  for (std::size_t i = 0; i < field_count; ++i) {
    const std::size_t comma = line.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == field_count)) return std::nullopt;
    fields[i] = line.substr(0, comma);
    line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
  }
  return fields;
}

/// Reads what write_state_csv wrote, as `precision`. `name` is for messages. The step number is not in the
/// table: it is 0. Error (io) with the line number: wrong header, wrong number of fields, an index out of
/// order, no number, a number that is not finite or not representable in `precision`.
inline Result<State> parse_state_csv(std::string_view text, const std::string& name, Precision precision) {
  Lines lines(text);
  const auto error = [&](const std::string& what) {
    return fail(ErrorCode::io, "{}:{}: {}", name, lines.number(), what);
  };
  const auto header = lines.next();
  if (!header) return fail(ErrorCode::io, "{}: empty; a state starts with {}", name, state_csv_header);
  if (*header != state_csv_header) return error(fmt::format("the header must be {}", state_csv_header));

  State state;
  state.precision = precision;
  while (const auto line = lines.next()) {
    const auto fields = split(*line);
    if (!fields) return error(fmt::format("expected {} fields separated by commas", field_count));
    const bool ball = (*fields)[0] == "ball";
    if (!ball && (*fields)[0] != "particle")
      return error(fmt::format("unknown kind \"{}\"; allowed: particle, ball", (*fields)[0]));
    if (!ball && !state.ball_position.empty()) return error("particles come before balls");
    const std::size_t expected = ball ? state.ball_position.size() : state.position.size();
    if ((*fields)[1] != std::to_string(expected)) {
      return error(fmt::format("expected index {}, found \"{}\"", expected, (*fields)[1]));
    }
    std::array<double, 9> values = {};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string_view field = (*fields)[i + 2];
      const auto value = precision == Precision::single ? parse_as<float>(field) : parse_as<double>(field);
      if (!value)
        return error(fmt::format("\"{}\" is not a finite number of {} precision", field, name_of(precision)));
      values[i] = *value;
    }
    (ball ? state.ball_position : state.position).push_back({values[0], values[1], values[2]});
    (ball ? state.ball_velocity : state.velocity).push_back({values[3], values[4], values[5]});
    if (ball) state.ball_angular_velocity.push_back({values[6], values[7], values[8]});
  }
  return state;
}

/// The same from a file.
inline Result<State> read_state_csv(const std::string& path, Precision precision) {
  ASPIC_TRY(const auto text, read_file(path));
  return parse_state_csv(text, path, precision);
}

}  // namespace aspic::test
