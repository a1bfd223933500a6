// Actuators: which bodies they act on, and their keys as the parameter table has them.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/panels.h"
#include "app/parameter_widget.h"
#include "aspic/model.h"
#include "base/printable.h"
#include "model/actuators.h"
#include "model/bodies.h"
#include "scene/follow.h"

namespace aspic::app {
namespace {

using Names = std::vector<std::string>;

/// Null where scenes have no actuators.
const SettingsList* actuators() {
  const auto lists = settings_lists();
  const auto found = std::ranges::find(lists, "actuator", &SettingsList::key);
  return found == lists.end() ? nullptr : &*found;
}

/// A key whose value is a list of names; none where the key is absent.
Names names_of(const Scene& scene, std::string_view path, std::size_t i) {
  const auto value = find_parameter(path)->get(scene, i);
  return value ? std::get<Names>(*value) : Names();
}

/// What actuators call a body.
std::string body_name(const Scene& scene, std::string_view key, std::size_t i) {
  const Parameter* const name = find_parameter(fmt::format("{}[].name", key));
  const auto own = name ? name->get(scene, i) : std::nullopt;
  return own ? std::get<std::string>(*own) : fmt::format("{}[{}]", key, i);
}

/// Bodies of particles, by the names that actuators have for them.
Names body_names(const Scene& scene) {
  Names names;
  for (const BodyRow& row : body_rows())
    for (std::size_t i = 0; i < row.list.size(scene.model); ++i)
      if (row.counts(scene.model, i).particles > 0) names.push_back(body_name(scene, row.list.key, i));
  return names;
}

/// A box for each of several names; none ticked means all.
void name_boxes(Gui& gui, SceneControl& scene, const char* path, std::size_t i, const char* heading,
                const Names& all) {
  const Parameter& p = *find_parameter(path);
  if (all.empty()) return;
  group_heading(heading);
  const std::string key = path_text(path, i),
                    help = fmt::format("{} Tick none for the default: {}.\n\nScene key: {}", p.meaning,
                                       p.when_absent, key);
  Names ticked = names_of(scene.scene(), path, i);
  bool changed = false;
  ImGui::PushID(key.c_str());
  for (const std::string& name : all)
    changed = check_box(gui, printable_line(name), fmt::format("{}/{}", key, name), ticked, help) || changed;
  ImGui::PopID();
  if (changed) scene.set_value(p, i, Value(ticked));
}

/// The number that an actuator takes from the inputs, from the next step on.
void input_now(Gui& gui, PlaybackSession& simulation, const std::string& name, std::size_t i) {
  const Inputs inputs = simulation.inputs();
  const std::vector<std::string> names = input_names(simulation.model());
  const auto channel = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  double w = channel < inputs.channels.size() ? inputs.channels[channel] : 0.0;
  const double before = w;
  slider(gui, "Input now", fmt::format("actuator/{}/input", i), w, -1.0, 1.0, "%.2f",
         "Sets the signal w of this actuator from the next step on. Reset restores it.", false);
  if (w != before) simulation.stepper().acts().channels[name] = w;
}

/// True if it was removed.
bool actuator(Gui& gui, SceneControl& scene, PlaybackSession& simulation, const SettingsList& list,
              std::size_t i) {
  if (element_line(gui, fmt::format("actuator {}", i), fmt::format("actuator/{}/remove", i),
                   "Removes this actuator and keeps its bodies.\n\nScene key: [[actuator]]", true)) {
    scene.change("remove actuator", [&](Scene& s) { list.remove(s.model, i); });
    return true;
  }
  Names materials;
  for (const MaterialSettings& m : scene.scene().model.materials)
    if (!m.name.empty()) materials.push_back(m.name);
  const Names types = {"structural", "shear", "bending"};
  name_boxes(gui, scene, "actuator[].body", i, "Acts on", body_names(scene.scene()));
  name_boxes(gui, scene, "actuator[].select.material", i, "Cells of", materials);
  name_boxes(gui, scene, "actuator[].select.springs", i, "Springs", types);
  for (const Parameter& p : parameters()) {
    if (p.section() != "actuator[]" || !applies(p, scene.scene(), i)) continue;
    if (p.key() == "body" || p.key() == "select.material" || p.key() == "select.springs") continue;
    edit(gui, scene, p.path, i, {capitalized(spaced(p.key()))});
  }
  if (scene.scene().model.actuators[i].signal == Signal::input)
    input_now(gui, simulation, actuator_name(scene.scene().model, i), i);
  return false;
}

}  // namespace

void add_actuator_button(Gui& gui, SceneControl& scene, std::string_view key, std::size_t i) {
  const SettingsList* const list = actuators();
  if (!list) return;
  const std::string name = body_name(scene.scene(), key, i);
  if (!button(
          gui, fmt::format("{}/{}/actuator", key, i).c_str(), "Add an actuator",
          fmt::format("Adds an actuator to {}: its signal changes rest lengths.\n\nScene key: [[actuator]]",
                      printable_line(name)),
          true, -1.0f))
    return;
  scene.change("add actuator", [&](Scene& s) {
    list->append(s.model);
    find_parameter("actuator[].body")->set(s, list->size(s.model) - 1, Value(Names{name}));
  });
}

void actuators_of_bodies(Gui& gui, SceneControl& scene, PlaybackSession& simulation) {
  const SettingsList* const list = actuators();
  if (!list) return;
  for (std::size_t i = 0; i < list->size(scene.scene().model); ++i)
    if (actuator(gui, scene, simulation, *list, i)) return;
}

void remove_body(Scene& scene, const SettingsList& bodies, std::size_t index) {
  const std::string own = body_name(scene, bodies.key, index);
  bodies.remove(scene.model, index);
  if (scene.view.follow == own)
    scene.view.follow.reset();
  else if (scene.view.follow)
    scene.view.follow = followed_without(*scene.view.follow, bodies.key, index);
  const SettingsList* const list = actuators();
  for (std::size_t a = list ? list->size(scene.model) : 0; a-- > 0;) {
    const Names before = names_of(scene, "actuator[].body", a);
    Names after;
    for (const std::string& name : before)
      if (const auto left = followed_without(name, bodies.key, index); left && name != own)
        after.push_back(*left);
    // One that names no body acts on all.
    if (!before.empty() && after.empty())
      list->remove(scene.model, a);
    else if (after != before)
      find_parameter("actuator[].body")->set(scene, a, Value(after));
  }
}

}  // namespace aspic::app
