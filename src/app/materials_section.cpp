// The section of materials that have names, and the choice of what a body is made of.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "app/panels.h"
#include "app/parameter_widget.h"
#include "base/printable.h"
#include "model/material.h"
#include "scene/materials.h"

namespace aspic::app {
namespace {

/// The name, which takes effect once the field is left.
void name_field(Gui& gui, SceneControl& scene, Messages& messages, std::size_t i, float width) {
  static std::string typed;  // in the field that has the keyboard
  static std::size_t typed_in = 0;
  static bool typing = false;
  const std::string& name = scene.scene().model.materials[i].name;
  const bool own = typing && typed_in == i;
  std::string text = own ? typed : name;
  ImGui::SetNextItemWidth(width);
  ImGui::InputText("##name", &text, ImGuiInputTextFlags_AutoSelectAll);
  named(gui, fmt::format("material/{}/name", i),
        "Renames the material, also in the bodies that use it.\n\nScene key: material[].name");
  const bool active = ImGui::IsItemActive(), done = ImGui::IsItemDeactivatedAfterEdit();
  if (active) {
    typed = text;
    typed_in = i;
    typing = true;
  } else if (own) {
    typing = false;
  }
  if (!done || text == name) return;
  Scene changed = scene.scene();
  if (const Status renamed = rename_material(changed, i, text); !renamed)
    return messages.refuse(renamed.error());
  scene.apply(std::move(changed), "rename material");
}

void remove(SceneControl& scene, Messages& messages, std::size_t i) {
  Scene changed = scene.scene();
  const std::string name = changed.model.materials[i].name;
  const auto removed = remove_material(changed, i);
  if (!removed) return messages.refuse(removed.error());
  scene.apply(std::move(changed), "remove material");
  if (!removed->empty()) scene.tell(fmt::format("Removed {}. {}", printable_line(name), *removed));
}

/// A sample of the color in which cells of it are shown.
void color_sample(ImU32 color) {
  const float side = ImGui::GetFrameHeight(), inset = 0.2f * side;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddRectFilled({at.x + inset, at.y + inset},
                                            {at.x + side - inset, at.y + side - inset}, color, 0.15f * side);
  ImGui::Dummy({side, side});
  ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
}

/// True if the list changed.
bool material_rows(Gui& gui, SceneControl& scene, Messages& messages, std::size_t i) {
  const ModelSettings& settings = scene.scene().model;
  const std::string name = settings.materials[i].name;
  const std::size_t count = settings.materials.size();
  const char* const label = "Remove";
  const float width = ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().FramePadding.x;
  color_sample(material_color(settings, name));
  name_field(gui, scene, messages, i,
             std::max(ImGui::GetContentRegionAvail().x - width - ImGui::GetStyle().ItemSpacing.x, 1.0f));
  ImGui::SameLine();
  if (button(gui, fmt::format("material/{}/remove", i).c_str(), label,
             "Removes this material. Its bodies keep the values. Limit: none of palettes.\n\nScene key: "
             "[[material]]"))
    remove(scene, messages, i);
  if (scene.scene().model.materials.size() != count) return true;
  edit(gui, scene, "material[].density", i);
  edit(gui, scene, "material[].youngs-modulus", i, {"Young's modulus"});
  edit(gui, scene, "material[].damping-ratio", i);
  const std::vector<std::string> users = users_of_material(scene.scene(), name);
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  wrapped_text(users.empty() ? std::string("Not used by any body.")
                             : fmt::format("Used by: {}", fmt::join(users, ", ")),
               ImGui::GetContentRegionAvail().x);
  ImGui::PopStyleColor();
  return false;
}

/// The numbers of what a body is made of; defaults for springs by type.
MaterialSettings numbers_of(const ModelSettings& settings, const MaterialSettings* material) {
  if (!material) return {};
  const MaterialSettings* const named = find_material(settings, material->name);
  MaterialSettings numbers = named ? *named : *material;
  numbers.name.clear();
  return numbers;
}

/// What a body may be made of, in the order of the list.
enum class Made { springs, numbers, palette, named, new_one };
struct MadeOf {
  Made kind;
  std::string name;  ///< of a material that has one; for the list else
};

std::vector<MadeOf> choices(const ModelSettings& settings, bool cells) {
  std::vector<MadeOf> list;
  if (!cells) list.push_back({Made::springs, "springs by type"});
  list.push_back({Made::numbers, "a material of its own"});
  if (cells) list.push_back({Made::palette, "cell by cell (palette)"});
  for (const MaterialSettings& m : settings.materials)
    if (!m.name.empty()) list.push_back({Made::named, m.name});
  list.push_back({Made::new_one, "a new material"});
  return list;
}

std::size_t chosen_of(const std::vector<MadeOf>& list, const MaterialSettings* material, bool cells) {
  const auto is = [&](const MadeOf& m) {
    if (!material) return m.kind == (cells ? Made::palette : Made::springs);
    return material->name.empty() ? m.kind == Made::numbers
                                  : m.kind == Made::named && m.name == material->name;
  };
  return static_cast<std::size_t>(std::ranges::find_if(list, is) - list.begin()) % list.size();
}

/// Makes the body of what was chosen.
void make_of(ModelSettings& settings, std::string_view section, std::size_t i, const MadeOf& chosen) {
  MaterialSettings material = numbers_of(settings, made_of(settings, section, i));
  if (chosen.kind == Made::named) material = {};
  if (chosen.kind == Made::new_one) material.name = add_material(settings, material, "material");
  if (chosen.kind == Made::named) material.name = chosen.name;
  if (section == "voxels[]") {
    VoxelsSettings& voxels = settings.voxels[i];
    if (chosen.kind == Made::palette) return make_palette(settings, voxels);
    voxels.palette.clear();
    voxels.material = material;
    return;
  }
  auto& place = *material_place(settings, section, i);
  if (chosen.kind == Made::springs)
    place.reset();
  else
    place = material;
}

}  // namespace

void made_of_row(Gui& gui, SceneControl& scene, std::string_view section, std::size_t i) {
  const ModelSettings& settings = scene.scene().model;
  const bool cells = section == "voxels[]";
  const std::vector<MadeOf> list = choices(settings, cells);
  std::vector<std::string> names;
  for (const MadeOf& m : list) names.push_back(printable_line(m.name));
  const std::vector<std::string_view> views(names.begin(), names.end());
  std::size_t index = chosen_of(list, made_of(settings, section, i), cells);
  const std::string_view key = section.substr(0, section.find('['));
  label_column("Made of");
  const std::string help = fmt::format(
      "{} A new material starts with the body's values, under Materials.\n\nScene keys: {}[].material{}",
      cells ? "Selects one material for all cells, or one for each palette character."
            : "Selects spring values by type, own material values, or a named material.",
      key, cells ? ", voxels[].palette" : "");
  if (!choice(gui, fmt::format("{}/{}/made-of", key, i), views, views, index, help)) return;
  scene.change("material", [&](Scene& s) { make_of(s.model, section, i, list[index]); });
}

void materials_section(Gui& gui, SceneControl& scene, Messages& messages) {
  if (scene.scene().model.materials.empty())
    wrapped_text(
        "No material has a name yet. Name one to use it in bodies (Made of, under Bodies) and cells.",
        ImGui::GetContentRegionAvail().x);
  for (std::size_t i = 0; i < scene.scene().model.materials.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const bool changed = material_rows(gui, scene, messages, i);
    ImGui::PopID();
    if (changed) break;
  }
  if (button(gui, "material/add", "Add a material",
             "Adds a material for bodies and cells. The motion continues.\n\nScene key: [[material]]", true,
             -1.0f))
    scene.change("add material", [](Scene& s) {
      const auto& all = s.model.materials;
      add_material(s.model, all.empty() ? MaterialSettings() : all.back(), "material");
    });
}

}  // namespace aspic::app
