#include "scene/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "base/printable.h"
#include "model/material.h"
#include "model/voxels.h"
#include "scene/parameters.h"

namespace aspic {
namespace {

/// act(what it is called, the material) of every body but those with a palette, where it may be none.
template <class Settings, class Act>
void for_each_material(Settings& settings, const Act& act) {
  const auto optional = [&](const char* key, auto& list) {
    for (std::size_t i = 0; i < list.size(); ++i)
      if (list[i].material) act(fmt::format("{}[{}]", key, i), *list[i].material);
  };
  optional("cube", settings.cubes);
  for (std::size_t i = 0; i < settings.voxels.size(); ++i)
    if (settings.voxels[i].palette.empty()) act(fmt::format("voxels[{}]", i), settings.voxels[i].material);
  optional("goal-net", settings.goal_nets);
  optional("cloth", settings.cloths);
}

/// act(key, index, names) of whatever names materials to select cells, but for bodies.
template <class Act>
void for_each_selection(const Scene& scene, const Act& act) {
  for (const Parameter& p : parameters()) {
    if (!p.path.ends_with("].select.material")) continue;
    for (std::size_t i = 0; i < index_count(p, scene); ++i)
      if (const auto names = p.get(scene, i)) act(p, i, std::get<std::vector<std::string>>(*names));
  }
}

std::string free_name(const ModelSettings& settings, const std::string& wish) {
  std::string name = wish;
  for (int i = 2; find_material(settings, name); ++i) name = fmt::format("{}-{}", wish, i);
  return name;
}

/// Where the list was in the order of names it is so again.
void sort_again(ModelSettings& settings, bool sorted) {
  if (sorted) std::ranges::stable_sort(settings.materials, {}, &MaterialSettings::name);
}

bool in_order(const ModelSettings& settings) {
  return std::ranges::is_sorted(settings.materials, {}, &MaterialSettings::name);
}

}  // namespace

std::vector<std::string> users_of_material(const Scene& scene, std::string_view name) {
  const ModelSettings& settings = scene.model;
  std::vector<std::string> users;
  if (name.empty()) return users;
  for_each_material(settings, [&](const std::string& body, const MaterialSettings& material) {
    if (material.name == name) users.push_back(body);
  });
  for (std::size_t i = 0; i < settings.voxels.size(); ++i) {
    const auto names = [&](const auto& entry) { return entry.second == name; };
    if (std::ranges::any_of(settings.voxels[i].palette, names)) users.push_back(fmt::format("voxels[{}]", i));
  }
  for_each_selection(scene, [&](const Parameter& p, std::size_t i, const std::vector<std::string>& names) {
    if (std::ranges::find(names, name) != names.end()) users.push_back(path_text(p.section(), i));
  });
  return users;
}

std::string add_material(ModelSettings& settings, const MaterialSettings& numbers, const std::string& wish) {
  const bool sorted = in_order(settings);
  MaterialSettings added = numbers;
  added.name = free_name(settings, wish);
  settings.materials.push_back(added);
  sort_again(settings, sorted);
  return added.name;
}

Status rename_material(Scene& scene, std::size_t index, const std::string& name) {
  ModelSettings& settings = scene.model;
  const std::string before = settings.materials[index].name;
  if (name == before) return {};
  if (name.empty())
    return fail(ErrorCode::scene_rejected, "A material needs a name for use in bodies; {} keeps its own.",
                excerpt(before, 40));
  if (find_material(settings, name))
    return fail(ErrorCode::scene_rejected,
                "Another material is called \"{}\"; names are unique, and \"{}\" keeps its own.",
                excerpt(name, 40), excerpt(before, 40));
  const bool sorted = in_order(settings);
  settings.materials[index].name = name;
  for_each_material(settings, [&](const std::string&, MaterialSettings& material) {
    if (!before.empty() && material.name == before) material.name = name;
  });
  for (VoxelsSettings& voxels : settings.voxels)
    for (auto& [cell, material] : voxels.palette)
      if (material == before) material = name;
  for_each_selection(scene, [&](const Parameter& p, std::size_t i, std::vector<std::string> names) {
    std::ranges::replace(names, before, name);
    p.set(scene, i, Value(std::move(names)));
  });
  sort_again(settings, sorted);
  return {};
}

Result<std::string> remove_material(Scene& scene, std::size_t index) {
  ModelSettings& settings = scene.model;
  const MaterialSettings removed = settings.materials[index];
  const bool named = !removed.name.empty();
  for (std::size_t i = 0; named && i < settings.voxels.size(); ++i)
    for (const auto& [cell, material] : settings.voxels[i].palette)
      if (material == removed.name && has_cell(settings.voxels[i], cell.front()))
        return fail(ErrorCode::scene_rejected,
                    "Cannot remove the material \"{}\": cells '{}' of voxels[{}] use it. Choose another one "
                    "for them in the palette, or erase them first.",
                    excerpt(removed.name, 40), cell, i);
  std::string selector;
  for_each_selection(scene, [&](const Parameter& p, std::size_t i, const std::vector<std::string>& names) {
    if (std::ranges::find(names, removed.name) != names.end()) selector = path_text(p.section(), i);
  });
  if (named && !selector.empty())
    return fail(ErrorCode::scene_rejected,
                "Cannot remove the material \"{}\": {} selects cells by it. Change that first.",
                excerpt(removed.name, 40), selector);
  std::string mended;
  if (named) {
    std::vector<std::string> bodies;
    for_each_material(settings, [&](const std::string& body, MaterialSettings& material) {
      if (material.name != removed.name) return;
      material = removed;
      material.name.clear();
      bodies.push_back(body);
    });
    for (VoxelsSettings& voxels : settings.voxels)
      std::erase_if(voxels.palette, [&](const auto& entry) { return entry.second == removed.name; });
    if (!bodies.empty())
      mended = fmt::format("{} {} its density, Young's modulus and damping ratio as {} own.",
                           fmt::join(bodies, ", "), bodies.size() == 1 ? "keeps" : "keep",
                           bodies.size() == 1 ? "its" : "their");
  }
  settings.materials.erase(settings.materials.begin() + static_cast<std::ptrdiff_t>(index));
  return mended;
}

void make_palette(ModelSettings& settings, VoxelsSettings& voxels) {
  if (!voxels.palette.empty()) return;
  const std::string name = voxels.material.name.empty() ? add_material(settings, voxels.material, "material")
                                                        : voxels.material.name;
  for (const auto& layer : voxels.layers)
    for (const std::string& row : layer)
      for (const char c : row)
        if (is_full_cell(c)) voxels.palette[std::string(1, c)] = name;
  voxels.material = {};
}

bool has_cell(const VoxelsSettings& voxels, char cell) {
  for (const auto& layer : voxels.layers)
    for (const std::string& row : layer)
      if (row.find(cell) != std::string::npos) return true;
  return false;
}

char free_cell(const VoxelsSettings& voxels) {
  for (const char c : std::string_view("123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"))
    if (!voxels.palette.contains(std::string_view(&c, 1)) && !has_cell(voxels, c)) return c;
  return '\0';
}

}  // namespace aspic
