#include "render/overlay_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/printable.h"
#include "model/actuators.h"
#include "model/cube.h"
#include "model/integrator.h"
#include "model/material.h"
#include "model/model.h"
#include "model/terrain.h"

namespace aspic {
namespace {

std::string triple(const Vec3& v) {
  return fmt::format("({}, {}, {})", short_number(v.x), short_number(v.y), short_number(v.z));
}

std::string terrain_names(const std::vector<TerrainSettings>& terrain) {
  std::string names;
  for (const TerrainSettings& t : terrain) {
    names += names.empty() ? "" : ", ";
    names += terrain_row(t.shape).title;
  }
  return names;
}

/// The springs of one type, of the kinds that a body may have.
struct SpringsOfType {
  std::string_view label;
  double stiffness, damping;  ///< k [N/m], c [N·s/m]
};

template <class Springs>
SpringsOfType of_type(std::string_view label, const Springs& s) {
  return {label, s.stiffness, s.damping};
}

/// The numbers of a body's material; nothing: it has none, or names one that the scene does not have.
std::optional<MaterialSettings> numbers_of(const ModelSettings& settings,
                                           const std::optional<MaterialSettings>& of_body) {
  if (!of_body) return std::nullopt;
  const auto found = material_of(settings, *of_body);
  return found ? std::optional(*found) : std::nullopt;
}

/// What the first body is of, if that is a net or a cloth of a material: its springs differ by direction.
std::optional<MaterialSettings> first_material(const ModelSettings& settings) {
  if (!settings.cubes.empty()) return std::nullopt;
  if (!settings.goal_nets.empty()) return numbers_of(settings, settings.goal_nets.front().material);
  return settings.cloths.empty() ? std::nullopt : numbers_of(settings, settings.cloths.front().material);
}

/// Those of the first body, kinds in the order of scene files.
std::vector<SpringsOfType> first_springs(const ModelSettings& settings) {
  if (!settings.cubes.empty()) {
    CubeSettings cube = settings.cubes.front();
    cube.material = numbers_of(settings, cube.material);
    if (cube.material) return {of_type("structural", material_springs(cube))};
    return {of_type("structural", cube.structural), of_type("shear", cube.shear),
            of_type("bending", cube.bending)};
  }
  if (!settings.goal_nets.empty()) {
    const GoalNetSettings& net = settings.goal_nets.front();
    std::vector<SpringsOfType> springs = {of_type("structural", net.structural)};
    if (net.shear.stiffness > 0.0) springs.push_back(of_type("shear", net.shear));
    if (net.bending.stiffness > 0.0) springs.push_back(of_type("bending", net.bending));
    return springs;
  }
  if (settings.cloths.empty()) return {};
  const ClothSettings& cloth = settings.cloths.front();
  return {of_type("structural", cloth.structural), of_type("shear", cloth.shear),
          of_type("bending", cloth.bending)};
}

std::string values_of(const MaterialSettings& m) {
  return fmt::format("E {} Pa   ρ {} kg/m³   ζ {}", short_number(m.youngs_modulus), short_number(m.density),
                     short_number(m.damping_ratio));
}

/// A name may be as long as it likes; the panel must not cover the image.
constexpr std::size_t most_of_author = 40, most_of_name = 16, most_of_a_kind = 2;

void add_springs(const ModelSettings& settings, std::vector<OverlayLine>& lines) {
  if (const auto material = first_material(settings)) {
    lines.push_back(
        {material->name.empty() ? "material" : excerpt(material->name, most_of_name), values_of(*material)});
    return;
  }
  const std::vector<SpringsOfType> springs = first_springs(settings);
  const auto value = [](const SpringsOfType& s) {
    return fmt::format("k {} N/m   c {} N·s/m", short_number(s.stiffness), short_number(s.damping));
  };
  const auto alike = [&](const SpringsOfType& s) { return value(s) == value(springs.front()); };
  if (!springs.empty() && std::ranges::all_of(springs, alike))
    lines.push_back({"springs", value(springs.front())});
  else
    for (const SpringsOfType& s : springs) lines.push_back({std::string(s.label), value(s)});
}

/// Materials that cells of bodies are of, in file order.
std::vector<const MaterialSettings*> materials_of_cells(const ModelSettings& settings) {
  std::vector<const MaterialSettings*> used;
  for (const MaterialSettings& material : settings.materials) {
    const auto holds = [&](const VoxelsSettings& voxels) {
      if (voxels.palette.empty()) return voxels.material.name == material.name;
      return std::ranges::any_of(voxels.palette,
                                 [&](const auto& entry) { return entry.second == material.name; });
    };
    if (std::ranges::any_of(settings.voxels, holds)) used.push_back(&material);
  }
  // One that has no name.
  if (used.empty() && !settings.voxels.empty()) used.push_back(&settings.voxels.front().material);
  return used;
}

/// A line for those that have a value in common, named by the first: "muscle + 2"; not for all where many
/// differ.
void add_alike(const std::vector<OverlayLine>& named, std::vector<OverlayLine>& lines) {
  std::vector<std::pair<OverlayLine, int>> kinds;
  for (const OverlayLine& each : named) {
    const auto same = [&](const auto& kind) { return kind.first.value == each.value; };
    if (const auto found = std::ranges::find_if(kinds, same); found != kinds.end())
      ++found->second;
    else
      kinds.emplace_back(each, 0);
  }
  if (kinds.size() > most_of_a_kind) kinds.resize(most_of_a_kind);
  for (auto& [line, more] : kinds) {
    line.label = excerpt(line.label, most_of_name);
    if (more > 0) line.label += fmt::format(" + {}", more);
    lines.push_back(std::move(line));
  }
}

void add_cells(const ModelSettings& settings, std::vector<OverlayLine>& lines) {
  std::vector<OverlayLine> named;
  for (const MaterialSettings* const m : materials_of_cells(settings))
    named.push_back({m->name.empty() ? "cells" : m->name, values_of(*m)});
  add_alike(named, lines);
}

void add_actuators(const ModelSettings& settings, std::vector<OverlayLine>& lines) {
  std::vector<OverlayLine> named;
  for (std::size_t i = 0; i < settings.actuators.size(); ++i) {
    const ActuatorSettings& a = settings.actuators[i];
    std::string value = fmt::format("a {}   {}", short_number(amplitude_of(a)), name_of(a.signal));
    if (a.signal != Signal::input) value += fmt::format("   f {} Hz", short_number(a.frequency));
    named.push_back({actuator_name(settings, i), value});
  }
  add_alike(named, lines);
}

/// What terrains have in common, or from the least to the largest.
template <class Value>
std::string over_terrain(const std::vector<TerrainSettings>& terrain, Value value) {
  double least = value(terrain.front()), most = least;
  for (const TerrainSettings& t : terrain) {
    least = std::min(least, value(t));
    most = std::max(most, value(t));
  }
  const std::string from = short_number(least), to = short_number(most);
  return from == to ? from : fmt::format("{}–{}", from, to);
}

void add_terrain(const ModelSettings& settings, std::vector<OverlayLine>& lines) {
  const std::vector<TerrainSettings>& terrain = settings.terrain;
  const ContactSettings& contact = settings.contact;
  if (terrain.empty()) return;
  lines.push_back({"terrain", terrain_names(terrain)});
  std::string value =
      fmt::format("e {}   μ {}",
                  over_terrain(terrain, [&](auto& t) { return t.restitution.value_or(contact.restitution); }),
                  over_terrain(terrain, [&](auto& t) { return t.friction.value_or(contact.friction); }));
  if (std::ranges::all_of(terrain, [](const TerrainSettings& t) { return t.mass.has_value(); }))
    value += fmt::format("   M {} kg", over_terrain(terrain, [](auto& t) { return *t.mass; }));
  const std::string_view model = contact.model == ContactModel::coulomb ? "Coulomb" : "course";
  lines.push_back({"contact", fmt::format("{}   {}", value, model)});
}

void add_balls(const ModelSettings& settings, std::vector<OverlayLine>& lines) {
  std::uint64_t balls = settings.balls.size();
  for (const LauncherSettings& launcher : settings.launchers)
    balls += static_cast<std::uint64_t>(launcher.count);
  if (balls == 0) return;
  const ContactSettings& contact = settings.contact;
  // Without spin nothing acts across the line of centers.
  lines.push_back({"balls", fmt::format("{}   e {}   μ {}", balls, short_number(contact.ball_restitution),
                                        short_number(contact.spin ? contact.ball_friction : 0.0))});
}

}  // namespace

std::string short_number(double value) {
  if (value == 0.0) return "0";
  std::string text = fmt::format("{:.4g}", value);
  const double size = std::abs(value);
  if (size >= 1e4 && size < 1e6) text = fmt::format("{:.0f}", value);
  if (text.starts_with('-')) text = "−" + text.substr(1);
  return text;
}

std::vector<OverlayLine> author_lines(const Scene& scene) {
  if (!scene.author || scene.author->empty()) return {};
  return {{"author", excerpt(*scene.author, most_of_author)}};
}

std::vector<OverlayLine> overlay_lines(const Scene& scene, double time) {
  const ModelSettings& settings = scene.model;
  std::vector<OverlayLine> lines = author_lines(scene);
  add_terrain(settings, lines);
  lines.push_back({"integrator", std::string(row_of(settings.simulation.integrator).title)});
  lines.push_back({"time step h", short_number(1000.0 * settings.simulation.timestep) + " ms"});
  add_springs(settings, lines);
  add_cells(settings, lines);
  add_actuators(settings, lines);
  if (!settings.cubes.empty()) {
    const CubeSettings& cube = settings.cubes.front();
    const std::string more =
        settings.cubes.size() > 1 ? fmt::format("   (first of {} cubes)", settings.cubes.size()) : "";
    lines.push_back({"offset", triple(cube.position) + " m" + more});
    const double angle = cube.rotation.angle;
    lines.push_back({"rotation", short_number(angle) + "°" +
                                     (angle != 0.0 ? " about " + triple(cube.rotation.axis) : "")});
  }
  add_balls(settings, lines);
  lines.push_back({"time", fmt::format("{:.3f} s", time)});
  return lines;
}

}  // namespace aspic
