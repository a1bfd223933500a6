// Words that an option takes, from the tables which the program checks them against.
#include <algorithm>
#include <string_view>

#include "command_line/window_layouts.h"
#include "gpu_solver/force_paths.h"
#include "io/film_format.h"
#include "manual/manual.h"
#include "model/integrator.h"
#include "report/outline.h"
#include "report/report.h"
#include "run/backends.h"
#include "scene/parameters.h"
#include "scene/short_keys.h"
#include "verify/check.h"

namespace aspic::manual {
namespace {

using Words = std::vector<std::string>;

template <class Range, class Name>
Words names_of(const Range& range, const Name& name) {
  Words words;
  for (const auto& row : range) words.emplace_back(name(row));
  return words;
}

Words both(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Words integrators() {
  return names_of(all_integrators, [](Integrator i) { return name_of(i); });
}

Words force_path_names() {
  return both({"auto"}, names_of(force_paths(), [](const ForcePathRow& row) { return row.name; }));
}

/// Keys of a scene with the first element of each list, or those of its view without the table's name.
Words keys(bool view) {
  Words words;
  for (const Parameter& p : parameters()) {
    const std::string path = path_text(p.path, 0);
    const bool of_view = path.starts_with("view.");
    if (view && of_view) words.push_back(path.substr(5) + "=");
    if (!view) words.push_back(path + "=");
  }
  return words;
}

Words short_names() {
  return names_of(short_keys(), [](const ShortKey& key) { return std::string(key.name) + "="; });
}

/// "order" for order/midpoint, each group once.
Words groups_of_checks() {
  Words words;
  for (const verify::Check& check : verify::battery()) {
    const std::string group = check.name.substr(0, check.name.find('/'));
    if (std::ranges::find(words, group) == words.end()) words.push_back(group);
  }
  return words;
}

Words on_either_side_of_bar(std::string_view value) {
  const std::size_t bar = value.find('|');
  if (bar == std::string_view::npos) return {};
  return {std::string(value.substr(0, bar)), std::string(value.substr(bar + 1))};
}

}  // namespace

std::vector<std::string> known_values(const CommandFacts& command, const OptionFacts& option) {
  const std::string& name = option.names.back();
  const std::string verb = last_word(command);
  if (name == "--backend" || name == "--backends")
    return both({"auto"}, names_of(backends(), [](const BackendRow& row) { return row.name; }));
  if (name == "--precision")
    return {std::string(name_of(Precision::single)), std::string(name_of(Precision::double_))};
  if (name == "--arithmetic")
    return {std::string(name_of(Arithmetic::exact)), std::string(name_of(Arithmetic::fast))};
  if (name == "--force-path") return force_path_names();
  if (name == "--integrator") return both({"all"}, integrators());
  if (name == "--timestep") return {"scene", "largest"};
  if (name == "--layout") return names_of(window_layouts, [](std::string_view layout) { return layout; });
  if (name == "--outline")
    return names_of(report::outlines(), [](const report::OutlineRow& row) { return row.name; });
  if (name == "--only" && verb == "report")
    return names_of(report::sections(), [](const report::SectionRow& row) { return row.name; });
  if (name == "--only" && verb == "verify") return groups_of_checks();
  if (name == "--frames-format") {
    Words words;
    for (const FilmFormat& format : film_formats())
      if (format.is_directory()) words.emplace_back(format.ending.substr(1));
    return words;
  }
  if (name == "--set") return keys(false);
  if (name == "--view") return keys(true);
  if (name == "--beside" || name == "--vary") return both(short_names(), keys(false));
  return on_either_side_of_bar(option.value);
}

std::vector<std::string> scene_names() {
  return names_of(list_builtin_scenes(), [](const BuiltinScene& scene) { return scene.name; });
}

}  // namespace aspic::manual
