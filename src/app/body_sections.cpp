// The sections of bodies, springs and contact.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "app/app.h"
#include "app/panels.h"
#include "app/parameter_widget.h"
#include "base/printable.h"
#include "gpu/device_info.h"
#include "model/bodies.h"
#include "run/backends.h"
#include "scene/load.h"

namespace aspic::app {
namespace {

constexpr std::string_view spring_types[] = {"structural", "shear", "bending"};

/// What the scene takes, and what a cube of another size would have to fit into.
std::string memory_note(const App& app) {
  const ModelSettings& settings = app.editor().scene().model;
  const ModelCounts counts = predict_counts(settings);
  std::string note = fmt::format(
      "This scene: {} particles and {} springs. The model takes {}, and a backend more:", counts.particles,
      counts.springs(), human_bytes(model_bytes(counts)));
  for (const BackendRow& row : backends()) {
    note += fmt::format(" {} {}{}", row.title,
                        human_bytes(row.bytes(counts, settings.simulation.integrator, {&row})),
                        &row == &backends().back() ? "." : ",");
  }
  if (const auto free = available_memory())
    note += fmt::format(" {} of memory are free; a scene that does not fit is refused.", human_bytes(*free));
  return note + " Springs grow with the third power of the particles per edge.";
}

/// A line that names an element of a list, with a button that takes it away. True if it was pressed.
bool element_line(Gui& gui, const std::string& title, const std::string& name, std::string_view help,
                  bool enabled) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", title.c_str());
  const char* const label = "Remove";
  const float width = ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().FramePadding.x;
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - width);
  return button(gui, name.c_str(), label, help, "", enabled);
}

std::size_t body_count(const ModelSettings& settings) {
  std::size_t count = 0;
  for (const BodyRow& row : body_rows()) count += row.list.size(settings);
  return count;
}

/// Every key of one list of bodies, straight from the table.
void all_keys_of(App& app, const SettingsList& list) {
  const std::string prefix = fmt::format("{}[].", list.key);
  for (std::size_t i = 0; i < list.size(app.editor().scene().model); ++i) {
    ImGui::TextDisabled("%.*s %zu", static_cast<int>(list.key.size()), list.key.data(), i);
    for (const Parameter& p : parameters()) {
      if (!p.path.starts_with(prefix) || !applies(p, app.editor().scene(), i)) continue;
      std::string label(p.path.substr(prefix.size()));
      std::ranges::replace(label, '.', ' ');
      std::ranges::replace(label, '-', ' ');
      edit(app, p.path, i, {label});
    }
  }
}

void add_cube(App& app) {
  const bool any = !app.editor().scene().model.cubes.empty();
  if (!button(
          app.gui(), "cube/add", "Add a cube",
          any ? "One more cube like the last, above it. The simulation starts anew.\n\nScene key: [[cube]]"
              : "A cube with default values. The simulation starts anew.\n\nScene key: [[cube]]",
          "", true, -1.0f))
    return;
  Scene scene = app.editor().scene();
  CubeSettings cube = any ? scene.model.cubes.back() : CubeSettings();
  if (any) cube.position.y += 1.5 * cube.edge_length;
  scene.model.cubes.push_back(cube);
  app.apply(std::move(scene), "a cube more", "");
}

}  // namespace

void placed_cube(App& app, std::size_t cube) {
  const std::string note = memory_note(app);
  edit(app, "cube[].particles-per-edge", cube, {{}, note});
  edit(app, "cube[].position", cube, {"Offset"});
  edit(app, "cube[].rotation.axis", cube, {"Turn axis"});
  edit(app, "cube[].rotation.angle", cube, {"Turn angle"});
}

void bodies_section(App& app) {
  const std::size_t count = app.editor().scene().model.cubes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool last_body = body_count(app.editor().scene().model) == 1;
    if (element_line(app.gui(), fmt::format("cube {}", i), fmt::format("cube/{}/remove", i),
                     last_body ? "The scene's last body stays: without one, nothing would move."
                               : "Takes this cube away. The simulation starts anew.\n\nScene key: [[cube]]",
                     !last_body)) {
      Scene scene = app.editor().scene();
      scene.model.cubes.erase(scene.model.cubes.begin() + static_cast<std::ptrdiff_t>(i));
      app.apply(std::move(scene), "a cube less", "");
      return;
    }
    if (i > 0) placed_cube(app, i);
    edit(app, "cube[].edge-length", i, {"Edge"});
    edit(app, "cube[].velocity", i);
    edit(app, "cube[].particle-mass", i);
    edit(app, "cube[].pinned", i);
  }
  add_cube(app);
  for (const BodyRow& row : body_rows()) {
    if (row.list.key != "cube") all_keys_of(app, row.list);
  }
}

namespace {

/// Which springs the picture shows: the words of view.draw, where they belong for who thinks of springs.
void shown_springs(App& app) {
  const Parameter& p = *find_parameter("view.draw");
  auto words = std::get<std::vector<std::string>>(*p.get(app.editor().scene(), 0));
  ImGui::TextUnformatted("Shown");
  tooltip("Types of springs in the picture. Their colours are chosen under View.\n\nScene key: view.draw");
  float end = ImGui::GetWindowContentRegionMax().x;
  for (const std::string_view type : spring_types) {
    const float width = ImGui::CalcTextSize(type.data()).x + ImGui::GetFrameHeight() +
                        ImGui::GetStyle().ItemInnerSpacing.x + ImGui::GetStyle().ItemSpacing.x;
    // Large text needs more lines.
    if (end + width < ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
    end = ImGui::GetCursorPosX() + width;
    bool on = std::ranges::find(words, type) != words.end();
    const bool toggled = ImGui::Checkbox(std::string(type).c_str(), &on);
    app.gui().mark(fmt::format("springs/show/{}", type));
    tooltip(fmt::format(
        "Whether {} springs are in the picture. Their colours are chosen under View.\n\nScene key: "
        "view.draw",
        type));
    if (!toggled) continue;
    if (on)
      words.emplace_back(type);
    else
      std::erase(words, type);
    app.set_value(p, 0, Value(words), "");
  }
}

/// Springs as they are described: by type, or as a material.
void kind_of_springs(App& app, std::size_t cube) {
  const CubeSettings& settings = app.editor().scene().model.cubes[cube];
  static constexpr const char* kinds[] = {"stiffness, damping", "material"};
  int kind = settings.material ? 1 : 0;
  label_column("Given by");
  const bool chosen = ImGui::Combo("##kind", &kind, kinds, 2);
  app.gui().mark(fmt::format("springs/{}/kind", cube));
  tooltip(
      "Stiffness and damping of each type of spring and the mass of a particle; or a material, which means "
      "the "
      "same jelly at every resolution.\n\nScene key: cube[].material");
  if (!chosen || (kind == 1) == settings.material.has_value()) return;
  Scene scene = app.editor().scene();
  CubeSettings& c = scene.model.cubes[cube];
  if (kind == 1)
    c.material.emplace();
  else
    c.material.reset();
  app.apply(std::move(scene), "material", "");
}

void same_for_all(App& app, std::size_t cube, std::string_view what) {
  const Parameter& first = *find_parameter(fmt::format("cube[].structural.{}", what));
  const auto change =
      parameter_widget(app.gui(), first, app.editor().scene(), cube, {"All " + std::string(what)});
  if (!change || !change->value) return;
  Scene scene = app.editor().scene();
  for (const std::string_view type : spring_types)
    find_parameter(fmt::format("cube[].{}.{}", type, what))->set(scene, cube, *change->value);
  app.apply(std::move(scene), "springs", fmt::format("all {}", change->gesture));
}

}  // namespace

void springs_section(App& app) {
  static bool together = false;
  const std::size_t count = app.editor().scene().model.cubes.size();
  shown_springs(app);
  if (count == 0) ImGui::TextDisabled("No cube; springs of nets stand under Bodies.");
  for (std::size_t i = 0; i < count; ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (count > 1) ImGui::TextDisabled("cube %zu", i);
    kind_of_springs(app, i);
    if (app.editor().scene().model.cubes[i].material) {
      edit(app, "cube[].material.density", i);
      edit(app, "cube[].material.youngs-modulus", i, {"Young's modulus"});
      edit(app, "cube[].material.damping-ratio", i);
    } else {
      ImGui::Checkbox("all types together", &together);
      app.gui().mark("springs/together");
      tooltip("One stiffness and one damping for structural, shear and bending springs.");
      if (together) {
        same_for_all(app, i, "stiffness");
        same_for_all(app, i, "damping");
      } else {
        for (const std::string_view type : spring_types) {
          std::string label(type);
          label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
          edit(app, fmt::format("cube[].{}.stiffness", type), i, {label + " k"});
          edit(app, fmt::format("cube[].{}.damping", type), i, {label + " c"});
        }
      }
    }
    ImGui::PopID();
  }
}

namespace {

void terrain(App& app, std::size_t index) {
  const TerrainShape shape = app.editor().scene().model.terrain[index].shape;
  if (element_line(app.gui(), fmt::format("terrain {}, {}", index, name_of(shape)),
                   fmt::format("terrain/{}/remove", index),
                   "Takes this terrain away. The motion goes on.\n\nScene key: [[terrain]]", true)) {
    Scene scene = app.editor().scene();
    scene.model.terrain.erase(scene.model.terrain.begin() + static_cast<std::ptrdiff_t>(index));
    return app.apply(std::move(scene), "a terrain less", "");
  }
  for (const Parameter& p : parameters()) {
    if (p.path.starts_with("terrain[].") && applies(p, app.editor().scene(), index)) edit(app, p.path, index);
  }
}

}  // namespace

void contact_section(App& app) {
  for (const Parameter& p : parameters()) {
    if (p.path.starts_with("contact.")) edit(app, p.path);
  }
  for (std::size_t i = 0; i < app.editor().scene().model.terrain.size(); ++i) terrain(app, i);
  if (!button(app.gui(), "terrain/add", "Add a terrain",
              "One more terrain, a plane at its default place. Several act in the order of the file. The "
              "motion goes "
              "on.\n\nScene key: [[terrain]]",
              "", true, -1.0f))
    return;
  Scene scene = app.editor().scene();
  scene.model.terrain.emplace_back();
  app.apply(std::move(scene), "a terrain more", "");
}

}  // namespace aspic::app
