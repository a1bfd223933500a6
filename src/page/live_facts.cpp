#include "page/live_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "base/embedded_file.h"
#include "model/actuators.h"
#include "scene/parameters.h"
#include "scene/write.h"

namespace aspic {
std::span<const EmbeddedFile> wasm_files();  // cmake/EmbedFiles.cmake; none where scripts/wasm.sh made none
}

namespace aspic::page {
namespace {

using Json = nlohmann::ordered_json;

/// Whether a page lets its reader change a key.
bool is_control(const Parameter& p) {
  constexpr std::string_view of_programs[] = {"simulation.duration", "simulation.steps-per-frame"};
  return p.live && !p.only_shown() && p.belonging != Belonging::geometry &&
         p.belonging != Belonging::motion &&
         std::ranges::find(of_programs, p.path) == std::end(of_programs) &&
         (p.type == ParameterType::boolean || p.type == ParameterType::integer ||
          p.type == ParameterType::number || p.type == ParameterType::word ||
          (p.type == ParameterType::vector && !p.direction));
}

struct AsJson {
  Json operator()(const Vec3& v) const { return {v.x, v.y, v.z}; }
  Json operator()(const PinnedSettings&) const { return {}; }
  template <class T>
  Json operator()(const T& value) const {
    return value;
  }
};

/// "structural stiffness" of `cube[].structural.stiffness`.
std::string label_of(const Parameter& p) {
  const std::string_view key = p.key();
  std::string text(key.substr(key.starts_with("implicit.") ? 9 : 0));
  for (char& c : text)
    if (c == '.' || c == '-') c = ' ';
  return text;
}

Json row_facts(const Parameter& p, std::size_t index, const Value& value) {
  Json row = {{"path", path_text(p.path, index)},     {"label", label_of(p)}, {"unit", p.unit},
              {"value", std::visit(AsJson(), value)}, {"meaning", p.meaning}, {"allowed", allowed_text(p)}};
  if (p.type == ParameterType::word) {
    row["words"] = p.words;
  } else if (p.type != ParameterType::boolean) {
    row["min"] = p.range.min;
    row["max"] = p.range.max;
    if (p.range.min_excluded) row["above"] = true;
    if (p.type == ParameterType::integer) row["integer"] = true;
  }
  return row;
}

/// "cube 2" of `cube[]` and 1, where there are several; "voxels worm" where it has a name.
std::string title_of(std::string_view section, const Scene& scene, std::size_t index, std::size_t count) {
  const std::string kind(section.substr(0, section.find('[')));
  if (const Parameter* const name = find_parameter(fmt::format("{}.name", section)); name && count > 0)
    if (const auto own = name->get(scene, index); own && !std::get<std::string>(*own).empty())
      return fmt::format("{} {}", kind, std::get<std::string>(*own));
  return count > 1 ? fmt::format("{} {}", kind, index + 1) : kind;
}

/// Numbers that actuators take from the inputs; `channel` is the place among them.
Json input_rows(const ModelSettings& settings) {
  Json rows = Json::array();
  for (const std::string& name : channel_names(settings))
    rows.push_back({{"path", fmt::format("input {}", name)},
                    {"label", name},
                    {"unit", ""},
                    {"value", 0.0},
                    {"meaning", "Sets the signal w of this actuator; initially 0."},
                    {"allowed", "a number from -1 to 1"},
                    {"min", -1.0},
                    {"max", 1.0},
                    {"channel", rows.size()}});
  return rows;
}

}  // namespace

Result<std::string_view> live_module() {
  if (!wasm_files().empty()) return wasm_files().front().text;
  return advised(fail(ErrorCode::io, "this build has no WebAssembly, which a live page needs."),
                 {advice("run scripts/wasm.sh in its source tree and build again")});
}

Status check_live(Precision precision, Arithmetic arithmetic, bool inputs) {
  if (const auto module = live_module(); !module) return module.error();
  if (precision != Precision::single || arithmetic != Arithmetic::exact)
    return fail(ErrorCode::usage,
                "a live page needs single precision and exact arithmetic, since it compares bits.");
  if (inputs) return fail(ErrorCode::usage, "a live page cannot repeat mouse pulls and pins.");
  return {};
}

Json live_facts(const Scene& scene) {
  Json groups = Json::array(), solve = Json::array();
  if (Json rows = input_rows(scene.model); !rows.empty())
    groups.push_back({{"title", "inputs"}, {"open", true}, {"rows", rows}});
  std::vector<std::string_view> done;
  bool bodies = false;  // those of the first one are seen at once
  for (const Parameter& first : parameters()) {
    const std::string_view section = first.section();
    if (section.empty() || std::ranges::find(done, section) != done.end()) continue;
    done.push_back(section);
    const std::size_t count = index_count(first, scene);
    for (std::size_t i = 0; i < count; ++i) {
      Json rows = Json::array();
      for (const Parameter& p : parameters())
        if (p.section() == section && is_control(p))
          if (const auto value = p.get(scene, i))
            (p.key().starts_with("implicit.") ? solve : rows).push_back(row_facts(p, i, *value));
      if (rows.empty()) continue;
      const bool list = section.ends_with("[]"), body = list && !section.starts_with("terrain");
      groups.push_back({{"title", title_of(section, scene, i, count)},
                        {"open", section == "simulation" || (body && !std::exchange(bodies, true))},
                        {"rows", rows}});
    }
  }
  // For one method alone.
  groups.push_back({{"title", "implicit Euler"}, {"open", false}, {"rows", solve}});
  // Denormal numbers, which browsers keep, come up where a body lies in a plane.
  const bool sheets = !scene.model.cloths.empty() || !scene.model.goal_nets.empty();
  return {{"scene", to_toml(scene)}, {"controls", groups}, {"sheets", sheets}};
}

}  // namespace aspic::page
