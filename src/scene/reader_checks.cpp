// What is wrong with a scene as it was written.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "model/bodies.h"
#include "scene/reader.h"

namespace aspic::reader {

bool is_cell_source(std::string_view path) {
  constexpr std::string_view keys[] = {"voxels[].file", "voxels[].mesh", "voxels[].cells", "voxels[].height",
                                       "voxels[].up"};
  return std::ranges::find(keys, path) != std::end(keys);
}

bool is_actuator_source(std::string_view path) {
  return path == "actuator[].phase.file" || path == "actuator[].select.file";
}

std::vector<std::string> Reader::explicit_keys(std::string_view section, std::size_t index) const {
  std::vector<std::string> keys;
  for (const std::string_view key : child_keys(section)) {
    const std::string path = fmt::format("{}.{}", section, key);
    const bool decided_by_material = std::ranges::any_of(parameters(), [&](const Parameter& p) {
      return p.belonging == Belonging::explicit_springs && (p.path == path || p.path.starts_with(path + "."));
    });
    if (decided_by_material && written_.contains(path_text(path, index))) keys.emplace_back(key);
  }
  return keys;
}

/// Bodies that have a material and what it decides, or a material's name and numbers.
void Reader::check_materials(std::vector<Problem>& problems) const {
  for (const SettingsList& list : settings_lists()) {
    const std::string section = fmt::format("{}[]", list.key);
    for (std::size_t i = 0; i < list.size(scene_.model); ++i) {
      const auto material = written_.find(path_text(section + ".material", i));
      const std::vector<std::string> others = explicit_keys(section, i);
      if (material != written_.end() && !others.empty()) {
        const std::vector<std::string_view> names(others.begin(), others.end());
        problems.push_back(
            {material->second.key, fmt::format("a {} has either 'material' or the masses and springs that it "
                                               "sets, not both; remove 'material' or {}",
                                               list.key, diagnostics::list_text(names, false))});
      }
      const MaterialSettings* const made = made_of(scene_.model, section, i);
      for (const Parameter& p : parameters()) {
        const auto key = written_.find(path_text(p.path, i));
        if (p.belonging != Belonging::material || p.section() != section || made || key == written_.end())
          continue;
        problems.push_back(
            {key->second.key, fmt::format("'{}' applies to a {} with a 'material': add one, or remove '{}'",
                                          key_text(p), list.key, p.key())});
      }
      if (!made && material != written_.end() && list.key == "voxels")
        problems.push_back({material->second.key,
                            "a body of cells has either 'material', for all cells, or a 'palette' of "
                            "materials, not both; remove one of them"});
      if (!made || made->name.empty()) continue;
      for (const std::string_view key : child_keys(section + ".material")) {
        const auto number = written_.find(path_text(fmt::format("{}.material.{}", section, key), i));
        if (key == "name" || number == written_.end()) continue;
        problems.push_back({number->second.key, fmt::format("a material has either a 'name' or numbers, not "
                                                            "both; set 'material[{}].{}', or remove the name",
                                                            made->name, key)});
      }
    }
  }
}

std::vector<Problem> Reader::problems(std::optional<std::uint64_t> memory_bytes) const {
  std::vector<Problem> problems = problems_;
  for (const auto& [path, written] : written_) {
    if (written.problem) problems.push_back(*written.problem);
  }
  if (has_text_ && !written_.contains("schema")) {
    problems.push_back(
        {{}, fmt::format("'schema' is missing; start the file with the line schema = {}", scene_schema)});
  }
  for (std::size_t c = 0; c < scene_.model.cubes.size(); ++c) {
    const auto edges = written_.find(path_text("cube[].particles-per-edge", c));
    const auto box = written_.find(path_text("cube[].particles", c));
    if (edges != written_.end() && box != written_.end())
      problems.push_back(
          {std::max(edges->second.key, box->second.key),
           "a cube has either 'particles-per-edge' or, as a box, 'particles', not both; remove one of them"});
  }
  for (std::size_t v = 0; v < scene_.model.voxels.size(); ++v) {
    const auto layers = written_.find(path_text("voxels[].layers", v));
    const auto file = written_.find(path_text("voxels[].file", v));
    if (layers != written_.end() && file != written_.end())
      problems.push_back(
          {std::max(layers->second.key, file->second.key),
           "a body of cells has either 'layers' or a 'file' of them, not both; remove one of them"});
    const auto mesh = written_.find(path_text("voxels[].mesh", v));
    for (const std::string_view other : {"layers", "file", "size", "skin"}) {
      const auto also = written_.find(path_text(fmt::format("voxels[].{}", other), v));
      if (mesh != written_.end() && also != written_.end())
        problems.push_back({std::max(mesh->second.key, also->second.key),
                            fmt::format("'{}' follows from the mesh; remove 'mesh' or '{}'", other, other)});
    }
  }
  for (std::size_t a = 0; a < scene_.model.actuators.size(); ++a) {
    const auto either = [&](std::string_view one, std::string_view other, std::string_view message) {
      const auto first = written_.find(path_text(one, a)), second = written_.find(path_text(other, a));
      if (first != written_.end() && second != written_.end())
        problems.push_back({std::max(first->second.key, second->second.key), std::string(message)});
    };
    either("actuator[].amplitude", "actuator[].volume-change",
           "an actuator has either 'amplitude' or 'volume-change', not both; remove one of them");
    either("actuator[].phase.cells", "actuator[].phase.file",
           "an actuator's phases are either 'cells' or a 'file' of them, not both; remove one of them");
    either("actuator[].select.voxels", "actuator[].select.file",
           "a mask is either 'voxels' or a 'file' of them, not both; remove one of them");
    const auto table = written_.find(path_text("actuator[].table", a)),
               signal = written_.find(path_text("actuator[].signal", a));
    if (table != written_.end() && signal != written_.end() && table->second.key.source == 0 &&
        signal->second.key.source == 0 && !signal->second.problem &&
        scene_.model.actuators[a].signal != Signal::table)
      problems.push_back(
          {table->second.key,
           "'actuator.table' needs the signal \"table\": write signal = \"table\", or remove 'table'"});
  }
  check_materials(problems);
  for (const SceneComplaint& complaint : check_scene(scene_, memory_bytes)) {
    if ((complaint.of_key || !has_problem(complaint.path)) && !has_problem(complaint.other))
      problems.push_back(located(complaint));
  }
  return problems;
}

}  // namespace aspic::reader
