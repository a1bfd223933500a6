#include "report/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "aspic/scene.h"
#include "aspic/version.h"
#include "base/fnv.h"
#include "base/printable.h"
#include "scene/short_keys.h"

namespace aspic::report {
namespace {

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Splits at a character outside brackets and quotation marks.
std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = '\0';
  for (const char c : text) {
    if (quote == '\0') {
      if (c == '"' || c == '\'') quote = c;
      if (c == '[' || c == '{') ++depth;
      if (c == ']' || c == '}') --depth;
      if (c == separator && depth == 0) {
        parts.emplace_back();
        continue;
      }
    } else if (c == quote) {
      quote = '\0';
    }
    parts.back() += c;
  }
  return parts;
}

Error bad_axis(const std::string& text, std::string_view what) {
  return fail(ErrorCode::usage,
              "--vary {}: {}; an axis is KEY=from:to:count, KEY=from:to:count:log or KEY=a,b,c.",
              printable_line(text), what);
}

}  // namespace

std::vector<double> spaced(double from, double to, std::size_t count, bool log) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.0;
    const double value = log ? from * std::pow(to / from, share) : std::lerp(from, to, share);
    values.push_back(i > 0 && i + 1 == count ? to : value);
  }
  return values;
}

Result<Axis> parse_axis(const std::string& text, const Scene& scene) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return bad_axis(text, "the key or its = is missing");
  Axis axis = {text.substr(0, equals), {}};
  const std::string values = text.substr(equals + 1);
  const std::vector<std::string> range = split(values, ':');
  if (range.size() == 1 || !number(range.front())) {
    axis.values = split(values, ',');
    if (std::ranges::count(axis.values, "") > 0) return bad_axis(text, "a value is missing");
    return axis;
  }
  const std::optional<double> from = number(range[0]), to = number(range[1]);
  const bool log = range.size() == 4 && range[3] == "log";
  std::size_t count = 0;
  if (range.size() > 2) {
    const auto [end, error] = std::from_chars(range[2].data(), range[2].data() + range[2].size(), count);
    if (error != std::errc() || end != range[2].data() + range[2].size()) count = 0;
  }
  if (!to) return bad_axis(text, "from and to are numbers");
  if (range.size() == 2) return bad_axis(text, "the count is missing");
  if (range.size() > 4 || (range.size() == 4 && !log))
    return bad_axis(text, "after the count comes log or nothing");
  if (count < 1 || count > most_runs)
    return bad_axis(text, fmt::format("the count is from 1 to {}", most_runs));
  if (log && !(*from > 0.0 && *to > 0.0)) return bad_axis(text, "log needs numbers above 0");
  const bool whole = takes_whole_numbers(scene, axis.key);
  for (const double value : spaced(*from, *to, count, log)) {
    std::string word = whole ? fmt::format("{:.0f}", value) : fmt::format("{:.12g}", value);
    if (axis.values.empty() || axis.values.back() != word) axis.values.push_back(std::move(word));
  }
  return axis;
}

std::size_t Grid::size() const {
  std::size_t runs = 1;
  for (const Axis& axis : axes) runs *= axis.values.size();
  return runs;
}

std::vector<std::string> Grid::values(std::size_t index) const {
  std::vector<std::string> result(axes.size());
  for (std::size_t a = axes.size(); a-- > 0;) {
    result[a] = axes[a].values[index % axes[a].values.size()];
    index /= axes[a].values.size();
  }
  return result;
}

std::string Grid::identity() const {
  Fnv1a hash;
  const auto add = [&](std::string_view text) {
    hash.add(static_cast<std::uint64_t>(text.size()));
    hash.add_bytes(std::as_bytes(std::span(text)));
  };
  add(ASPIC_VERSION);
  add(to_toml(scene));
  for (const Axis& axis : axes) {
    add(axis.key);
    for (const std::string& value : axis.values) add(value);
  }
  add(fmt::format("{} {} {} {} {}", backend.row ? backend.row->name : "auto",
                  static_cast<int>(backend.precision), static_cast<int>(backend.force_path),
                  static_cast<int>(backend.arithmetic),
                  length.steps ? fmt::format("steps {}", *length.steps)
                               : fmt::format("duration {}", length.duration.value_or(-1.0))));
  return fmt::format("{:016x}", hash.value());
}

Result<Grid> make_grid(Scene scene, const BackendChoice& backend, const RunLength& length,
                       const std::vector<std::string>& vary) {
  Grid grid = {std::move(scene), backend, length, {}};
  std::size_t runs = 1;
  for (const std::string& text : vary) {
    ASPIC_TRY(auto axis, parse_axis(text, grid.scene));
    if (std::ranges::find(grid.axes, axis.key, &Axis::key) != grid.axes.end())
      return fail(ErrorCode::usage, "--vary {} is given twice; give all its values in one list.", axis.key);
    runs *= axis.values.size();
    if (runs > most_runs)
      return fail(ErrorCode::usage, "the grid has more than {} runs; vary fewer keys or values.", most_runs);
    grid.axes.push_back(std::move(axis));
  }
  // A key that is wrong, rather than some of its values, would make every run a rejected row.
  for (const Axis& axis : grid.axes) {
    std::optional<Error> first;
    for (const std::string& value : axis.values) {
      const Grid alone = {grid.scene, grid.backend, grid.length, {{axis.key, {value}}}};
      const SweepRun run = grid_run(alone, 0);
      if (!run.error) {
        first.reset();
        break;
      }
      if (!first) first = run.error;
    }
    if (first) {
      return fail(*first, "--vary {}: none of the values makes a run; the first ends with\n{}", axis.key,
                  first->what);
    }
  }
  return grid;
}

SweepRun grid_run(const Grid& grid, std::size_t index) {
  const std::vector<std::string> values = grid.values(index);
  std::vector<Difference> differences;
  for (std::size_t a = 0; a < values.size(); ++a) differences.push_back({grid.axes[a].key, values[a]});
  return sweep_run(grid.scene, grid.backend, grid.length, differences);
}

}  // namespace aspic::report
