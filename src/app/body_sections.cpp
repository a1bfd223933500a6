// The sections of bodies, springs and contact.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "app/panels.h"
#include "app/parameter_widget.h"
#include "base/memory.h"
#include "base/printable.h"
#include "model/bodies.h"
#include "model/springs.h"
#include "scene/new_body.h"

namespace aspic::app {
namespace {

constexpr std::string_view spring_types[] = {"structural", "shear", "bending"};

/// What the scene takes, and what a cube of another size would have to fit into.
std::string memory_note(const Solver& solver) {
  const Model& model = solver.model();
  std::string note = fmt::format(
      "This scene: {} particles and {} springs. The model takes {}, its state {} and the {} backend {}.",
      model.particle_count(), spring_count(model), human_bytes(model_bytes(model)),
      human_bytes(state_bytes(count(model))), solver.backend(), human_bytes(solver.bytes()));
  if (const auto free = available_memory())
    note += fmt::format(" {} of memory are free; Aspic rejects scenes that need more.", human_bytes(*free));
  return note + " Particles grow with the third power of the particles per edge.";
}

std::size_t body_count(const ModelSettings& settings) {
  std::size_t count = 0;
  for (const BodyRow& row : body_rows()) count += row.list.size(settings);
  return count;
}

/// The line of one body, with a button that removes it. True if it was removed.
bool body_line(Gui& gui, SceneControl& scene, const SettingsList& list, std::size_t i) {
  const bool last_body = body_count(scene.scene().model) == 1;
  const std::string name = noun_of(list.key);
  const std::string help =
      last_body
          ? "Keeps the last body: a scene needs at least one."
          : fmt::format("Removes this {}. Restarts the simulation.\n\nScene key: [[{}]]", name, list.key);
  if (!element_line(gui, fmt::format("{} {}", name, i), fmt::format("{}/{}/remove", list.key, i), help,
                    !last_body))
    return false;
  scene.change("remove " + name, [&](Scene& s) { remove_body(s, list, i); });
  return true;
}

/// A button below a list that adds an element to it. True if it was pressed.
bool add_button(Gui& gui, std::string_view key, std::string_view help) {
  return button(gui, fmt::format("{}/add", key).c_str(), fmt::format("Add a {}", noun_of(key)).c_str(),
                fmt::format("{}\n\nScene key: [[{}]]", help, key), true, -1.0f);
}

/// One of the kinds of bodies to add.
struct Kind {
  const char* name;  ///< of the button: NAME/add
  const char* label;
  std::string_view key;  ///< of the list
};
constexpr Kind kinds[] = {{"cube", "Cube", "cube"},
                          {"box", "Box", "cube"},
                          {"voxels", "Cells", "voxels"},
                          {"cloth", "Cloth", "cloth"},
                          {"goal-net", "Net", "goal-net"},
                          {"ball", "Ball", "ball"},
                          {"launcher", "Launcher", "launcher"}};

/// As many buttons as a line has room for their words, four at most.
int buttons_of_a_line() {
  float widest = 0.0f;
  for (const Kind& kind : kinds) widest = std::max(widest, ImGui::CalcTextSize(kind.label).x);
  const ImGuiStyle& style = ImGui::GetStyle();
  const float each = widest + 2.0f * style.FramePadding.x + style.ItemSpacing.x;
  return std::clamp(static_cast<int>((ImGui::GetContentRegionAvail().x + style.ItemSpacing.x) / each), 1, 4);
}

/// A button for each kind of body, and for a mesh.
void add_buttons(Gui& gui, SceneControl& scene, CellEditor& cells) {
  group_heading("Add a body");
  // Rows of a body that was added above would move the buttons away under the mouse.
  const float y = ImGui::GetCursorScreenPos().y;
  if (gui.held_y) ImGui::SetScrollY(ImGui::GetScrollY() + y - *gui.held_y);
  gui.held_y.reset();
  const int columns = buttons_of_a_line();
  const float width = share_of_line(columns);
  int column = 0;
  for (const Kind& kind : kinds) {
    if (column++ % columns != 0) ImGui::SameLine();
    const SettingsList& list = *list_of_bodies(kind.key);
    const bool box = std::string_view(kind.name) == "box";
    const std::string noun = box ? "box" : noun_of(list.key);
    const std::string help =
        fmt::format("Adds a {}{} in free space. Restarts the simulation.\n\nScene key: [[{}]]", noun,
                    list.size(scene.scene().model) > 0 && !box ? ", like the last one," : "", list.key);
    if (!button(gui, fmt::format("{}/add", kind.name).c_str(), kind.label, help, true, width)) continue;
    gui.held_y = y;
    if (box)
      scene.change("add box", [](Scene& s) { add_box(s); });
    else
      add_body(scene, list);
    if (kind.key != "voxels") continue;
    cells.choose_body(list.size(scene.scene().model) - 1);
  }
  if (column % columns != 0) ImGui::SameLine();
  command_button(gui, "mesh/add", "Mesh…",
                 "Fills a mesh (.obj, .stl, .ply) with cells, in free space.\n\nScene key: [[voxels]]",
                 "add a mesh", true, width);
}

/// Opens the section in which the cells of a body are edited.
void cells_button(Gui& gui, CellEditor& cells, Layouts& layout, std::size_t i) {
  if (!button(gui, fmt::format("voxels/{}/cells", i).c_str(), "Edit its cells",
              "Shows the body's layers under Cells for painting.", true, -1.0f))
    return;
  cells.choose_body(i);
  show_section(layout, "Cells");
}

/// Every body of one list with all its keys, straight from the table.
void bodies_of(Gui& gui, SceneControl& scene, CellEditor& cells, Layouts& layout, const SettingsList& list) {
  const std::string section = fmt::format("{}[]", list.key), prefix = section + ".";
  for (std::size_t i = 0; i < list.size(scene.scene().model); ++i) {
    if (body_line(gui, scene, list, i)) return;
    if (list.key == "voxels") cells_button(gui, cells, layout, i);
    const bool made = find_parameter(prefix + "material.name") != nullptr;
    if (made) made_of_row(gui, scene, section, i);
    if (made) add_actuator_button(gui, scene, list.key, i);
    for (const Parameter& p : parameters()) {
      if (!p.path.starts_with(prefix) || !applies(p, scene.scene(), i)) continue;
      if (p.path == prefix + "material.name") continue;  // chosen above
      edit(gui, scene, p.path, i, {capitalized(spaced(p.path.substr(prefix.size())))});
    }
  }
}

/// Which springs the image shows: the words of view.draw, next to the springs' own values.
void shown_springs(Gui& gui, SceneControl& scene) {
  const Parameter& p = *find_parameter("view.draw");
  auto words = std::get<std::vector<std::string>>(*p.get(scene.scene(), 0));
  group_heading("Shown");
  tooltip("Selects the types of springs to show.\n\nScene key: view.draw");
  float end = ImGui::GetWindowContentRegionMax().x;
  for (const std::string_view type : spring_types) {
    const float width = ImGui::CalcTextSize(type.data()).x + ImGui::GetFrameHeight() +
                        ImGui::GetStyle().ItemInnerSpacing.x + ImGui::GetStyle().ItemSpacing.x;
    // Large text needs more lines.
    if (end + width < ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
    end = ImGui::GetCursorPosX() + width;
    const std::string help =
        fmt::format("Shows {} springs in the image. View sets their colors.\n\nScene key: view.draw", type);
    if (check_box(gui, type, fmt::format("springs/show/{}", type), words, help))
      scene.set_value(p, 0, Value(words));
  }
}

/// Springs as they are described: by type, or as a material.
void kind_of_springs(Gui& gui, SceneControl& scene, std::size_t cube) {
  const CubeSettings& settings = scene.scene().model.cubes[cube];
  static constexpr std::string_view kinds[] = {"stiffness, damping", "material"};
  std::size_t kind = settings.material ? 1 : 0;
  label_column("Given by");
  if (!choice(gui, fmt::format("springs/{}/kind", cube), kinds, kinds, kind,
              "Selects stiffness, damping and mass, or a material for every resolution.\n\nScene key: "
              "cube[].material"))
    return;
  scene.change("material", [&](Scene& s) {
    auto& material = s.model.cubes[cube].material;
    material = kind == 1 ? std::optional(MaterialSettings()) : std::nullopt;
  });
}

/// As many particles along every edge, or three numbers of them.
void kind_of_edges(Gui& gui, SceneControl& scene, std::size_t cube) {
  static constexpr std::string_view kinds[] = {"cube", "box"};
  std::size_t kind = scene.scene().model.cubes[cube].particles ? 1 : 0;
  label_column("Shape");
  if (!choice(gui, fmt::format("bodies/{}/shape", cube), kinds, kinds, kind,
              "Sets a cube with equal edges, or a box. Restarts the simulation.\n\nScene keys: "
              "cube[].particles-per-edge, cube[].particles"))
    return;
  scene.change("shape", [&](Scene& s) {
    CubeSettings& changed = s.model.cubes[cube];
    if (kind == 1) {
      changed.particles = changed.lattice();
    } else {
      changed.particles_per_edge = std::min(512, std::ranges::max(changed.lattice()));
      changed.particles.reset();
    }
  });
}

void same_for_all(Gui& gui, SceneControl& scene, std::size_t cube, std::string_view what) {
  const Parameter& first = *find_parameter(fmt::format("cube[].structural.{}", what));
  const std::string label = fmt::format("{} (all)", capitalized(std::string(what))),
                    help = fmt::format(
                        "Sets one {0} for all springs. Shows that of structural springs.\n\nScene keys: "
                        "cube[{1}].structural.{0}, cube[{1}].shear.{0}, cube[{1}].bending.{0}\nDrag to "
                        "change, Ctrl+click to type.",
                        what, cube);
  // Not the row of the structural springs, which has the same key.
  ImGui::PushID("all");
  const auto change = parameter_widget(gui, first, scene.scene(), cube, {label, {}, help});
  gui.mark("springs/all/{}", what);
  ImGui::PopID();
  if (!change || !change->value) return;
  const auto set = [&](Scene& s) {
    for (const std::string_view type : spring_types)
      find_parameter(fmt::format("cube[].{}.{}", type, what))->set(s, cube, *change->value);
  };
  scene.change("springs", set, fmt::format("all {}", change->gesture));
}

void terrain(Gui& gui, SceneControl& scene, std::size_t index) {
  const TerrainShape shape = scene.scene().model.terrain[index].shape;
  if (element_line(gui, fmt::format("terrain {}, {}", index, name_of(shape)),
                   fmt::format("terrain/{}/remove", index),
                   "Removes this terrain. The motion continues.\n\nScene key: [[terrain]]", true))
    return scene.change("remove terrain", [&](Scene& s) {
      s.model.terrain.erase(s.model.terrain.begin() + static_cast<std::ptrdiff_t>(index));
    });
  for (const Parameter& p : parameters()) {
    if (p.path.starts_with("terrain[].") && applies(p, scene.scene(), index)) edit(gui, scene, p.path, index);
  }
}

}  // namespace

bool element_line(Gui& gui, const std::string& title, const std::string& name, std::string_view help,
                  bool enabled) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(ImGui::GetStyleColorVec4(ImGuiCol_CheckMark), "%s", title.c_str());
  const char* const label = "Remove";
  const float width = ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().FramePadding.x;
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - width);
  return button(gui, name.c_str(), label, help, enabled);
}

void placed_cube(Gui& gui, SceneControl& scene, std::size_t cube) {
  const std::string note = memory_note(scene.solver());
  edit(gui, scene, "cube[].particles-per-edge", cube, {{}, note});
  edit(gui, scene, "cube[].particles", cube, {{}, note});
  edit(gui, scene, "cube[].position", cube, {"Position"});
  edit(gui, scene, "cube[].rotation.axis", cube, {"Rotation axis"});
  edit(gui, scene, "cube[].rotation.angle", cube, {"Rotation angle"});
}

void bodies_section(Gui& gui, SceneControl& scene, PlaybackSession& simulation, CellEditor& cells,
                    Layouts& layout) {
  add_buttons(gui, scene, cells);
  const SettingsList& cubes = body_rows().front().list;
  const std::size_t count = cubes.size(scene.scene().model);
  for (std::size_t i = 0; i < count; ++i) {
    if (body_line(gui, scene, cubes, i)) return;
    kind_of_edges(gui, scene, i);
    placed_cube(gui, scene, i);
    edit(gui, scene, "cube[].edge-length", i,
         {scene.scene().model.cubes[i].particles ? "Longest edge" : "Edge"});
    edit(gui, scene, "cube[].velocity", i);
    made_of_row(gui, scene, "cube[]", i);
    edit(gui, scene, "cube[].particle-mass", i);
    edit(gui, scene, "cube[].friction", i);
    edit(gui, scene, "cube[].pinned", i);
    add_actuator_button(gui, scene, "cube", i);
  }
  for (const BodyRow& row : body_rows().subspan(1)) bodies_of(gui, scene, cells, layout, row.list);
  actuators_of_bodies(gui, scene, simulation);
  if (body_count(scene.scene().model) > 1 && !scene.scene().model.contact.bodies)
    ImGui::TextDisabled("Bodies pass through each other: enable body contact under Contact.");
}

void springs_section(Gui& gui, SceneControl& scene, Layouts& layout) {
  const std::size_t count = scene.scene().model.cubes.size();
  if (count == 0) ImGui::TextDisabled("No cube. Bodies lists the springs of other bodies.");
  for (std::size_t i = 0; i < count; ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (count > 1) group_heading(fmt::format("cube {}", i));
    const bool material = scene.scene().model.cubes[i].material.has_value();
    if (material) {
      edit(gui, scene, "cube[].material.density", i);
      edit(gui, scene, "cube[].material.youngs-modulus", i, {"Young's modulus"});
      edit(gui, scene, "cube[].material.damping-ratio", i);
    } else {
      same_for_all(gui, scene, i, "stiffness");
      same_for_all(gui, scene, i, "damping");
    }
    const std::string label = count > 1 ? fmt::format("by type, cube {}", i) : std::string("by type");
    if (folded(gui, layout, "Springs", label.c_str(),
               "Shows stiffness and damping by type of spring, or from a material.")) {
      kind_of_springs(gui, scene, i);
      for (const std::string_view type : spring_types) {
        if (material) break;
        const std::string name = capitalized(std::string(type));
        edit(gui, scene, fmt::format("cube[].{}.stiffness", type), i, {name + " k"});
        edit(gui, scene, fmt::format("cube[].{}.damping", type), i, {name + " c"});
      }
    }
    ImGui::PopID();
  }
  for (const auto& [_, key] : resistance_constants) edit(gui, scene, fmt::format("simulation.{}", key));
  shown_springs(gui, scene);
}

void contact_section(Gui& gui, SceneControl& scene) {
  for (const Parameter& p : parameters()) {
    if (p.path.starts_with("contact.")) edit(gui, scene, p.path);
  }
  for (std::size_t i = 0; i < scene.scene().model.terrain.size(); ++i) terrain(gui, scene, i);
  if (add_button(gui, "terrain", "Adds a plane at its default place. The motion continues."))
    scene.change("add terrain", [](Scene& s) { s.model.terrain.emplace_back(); });
}

}  // namespace aspic::app
