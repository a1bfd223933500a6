#include "scene/scene_checks.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "base/printable.h"
#include "model/actuators.h"
#include "model/bodies.h"
#include "model/cube.h"
#include "model/integrator.h"
#include "model/material.h"
#include "model/voxels.h"
#include "scene/diagnostics.h"
#include "scene/follow.h"

namespace aspic {
namespace {

using Complaints = std::vector<SceneComplaint>;

/// Every value by itself. Returns whether all numbers are legal.
bool check_values(const Scene& scene, Complaints& complaints) {
  bool legal = true;
  for (const Parameter& p : parameters()) {
    const std::size_t count = index_count(p, scene);
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = p.get(scene, i);
      if (!value) continue;
      const auto complaint = check_value(p, *value);
      if (!complaint) continue;
      complaints.push_back({*complaint, path_text(p.path, i)});
      legal = legal && p.type == ParameterType::pinned;
    }
  }
  return legal;
}

/// Geometry that the terrain's shape does not have.
void check_geometry(const Scene& scene, Complaints& complaints) {
  for (std::size_t i = 0; i < scene.model.terrain.size(); ++i) {
    const TerrainShape shape = scene.model.terrain[i].shape;
    for (const Parameter& p : parameters()) {
      if (belongs_to_shape(p, shape) || !p.read(p, scene, i)) continue;
      std::vector<std::string_view> geometry;
      for (const Parameter& other : parameters()) {
        if (other.belonging == Belonging::geometry && belongs_to_shape(other, shape))
          geometry.push_back(other.key());
      }
      complaints.push_back({{fmt::format("a {} has no '{}'; its geometry is {}", name_of(shape), p.key(),
                                         diagnostics::list_text(geometry, false))},
                            path_text(p.path, i),
                            path_text("terrain[].shape", i),
                            true});
    }
  }
}

/// The key that decides the size of a body, if one does.
const Parameter* size_of(const Scene& scene, const BodyRow& row, std::size_t body) {
  for (const std::string_view key : row.size_keys) {
    const Parameter& p = *find_parameter(fmt::format("{}[].{}", row.list.key, key));
    if (applies(p, scene, body)) return &p;
  }
  return nullptr;
}

void check_pinned(const Scene& scene, Complaints& complaints) {
  for (const BodyRow& row : body_rows()) {
    if (!row.pins) continue;
    for (std::size_t b = 0; b < row.list.size(scene.model); ++b) {
      const Parameter& size = *size_of(scene, row, b);
      if (check_value(size, *size.get(scene, b))) continue;  // a body of no size has no last index
      const auto last = static_cast<std::int64_t>(row.counts(scene.model, b).particles) - 1;
      if (last < 0) continue;  // complained about elsewhere
      const PinnedSettings& pinned = *row.pinned(scene.model, b);
      for (std::size_t i = 0; i < pinned.indices.size(); ++i) {
        const std::int64_t index = pinned.indices[i];
        if (index >= 0 && index <= last) continue;
        complaints.push_back({{fmt::format("'{}.pinned' index {} is not in the {}; allowed: 0 … {}",
                                           row.list.key, index, row.pins->body, last),
                               pinned.names.size() + i},
                              fmt::format("{}[{}].pinned", row.list.key, b),
                              path_text(size.path, b)});
      }
    }
  }
}

/// Names that two elements of a list have.
void check_names(const Scene& scene, Complaints& complaints) {
  for (const SettingsList& list : settings_lists()) {
    const Parameter* const p = find_parameter(fmt::format("{}[].name", list.key));
    for (std::size_t i = 0; p && i < list.size(scene.model); ++i) {
      const auto name = p->get(scene, i);
      const auto first = name ? element_named(scene, list.key, std::get<std::string>(*name)) : std::nullopt;
      if (first.value_or(i) == i) continue;
      complaints.push_back({{fmt::format("'{}' \"{}\" is taken: another [[{}]] has it. Choose another name",
                                         key_text(*p), excerpt(std::get<std::string>(*name), 40), list.key)},
                            path_text(p->path, i),
                            path_text(p->path, *first)});
    }
  }
}

/// Materials that the scene does not have, and bodies of cells that cannot be made.
void check_materials(const Scene& scene, Complaints& complaints) {
  for (const BodyRow& row : body_rows()) {
    const std::string section = fmt::format("{}[]", row.list.key);
    for (std::size_t i = 0; i < row.list.size(scene.model); ++i) {
      if (row.list.key == "voxels") continue;
      const MaterialSettings* const made = made_of(scene.model, section, i);
      if (!made || made->name.empty() || find_material(scene.model, made->name)) continue;
      complaints.push_back(
          {{fmt::format("'{}.material' names {}", row.list.key, unknown_material(scene.model, made->name))},
           path_text(section + ".material.name", i)});
    }
  }
  for (std::size_t i = 0; i < scene.model.voxels.size(); ++i) {
    const auto fault = fault_of(scene.model, scene.model.voxels[i]);
    if (!fault) continue;
    const std::string key = fault->key == "material" ? "material.name" : fault->key;
    complaints.push_back({{fmt::format("'voxels.{}': {}", fault->key, fault->message), fault->element},
                          fmt::format("voxels[{}].{}", i, key),
                          path_text("voxels[].file", i)});
  }
}

/// Actuators that cannot act as they say.
void check_actuators(const Scene& scene, Complaints& complaints) {
  for (std::size_t a = 0; a < scene.model.actuators.size(); ++a) {
    const auto fault = fault_of(scene.model, a);
    if (!fault) continue;
    const std::string_view file = fault->key == "phase.cells"     ? "actuator[].phase.file"
                                  : fault->key == "select.voxels" ? "actuator[].select.file"
                                                                  : "";
    complaints.push_back({{fmt::format("'actuator.{}': {}", fault->key, fault->message), fault->element},
                          fmt::format("actuator[{}].{}", a, fault->key),
                          path_text(file, a)});
  }
}

/// Cells of a cloth that is of a material, which must be nearly square.
void check_sheets(const Scene& scene, Complaints& complaints) {
  for (std::size_t i = 0; i < scene.model.cloths.size(); ++i) {
    ClothSettings cloth = scene.model.cloths[i];
    if (!cloth.material) continue;
    const auto springs = sheet_springs(cloth);
    if (!springs)
      complaints.push_back({{fmt::format("'cloth.{}'", springs.error().what)},
                            path_text("cloth[].particles", i),
                            path_text("cloth[].material", i)});
  }
}

/// Corners of a body of cells that no full cell has.
void check_corners(const Scene& scene, Complaints& complaints) {
  const BodyRow& row = *std::ranges::find(body_rows(), "voxels", [](const BodyRow& r) { return r.list.key; });
  for (std::size_t i = 0; i < scene.model.voxels.size(); ++i) {
    const std::vector<std::string>& names = scene.model.voxels[i].pinned.names;
    for (std::size_t n = 0; n < names.size(); ++n) {
      if (names[n].find('-') == std::string::npos) continue;
      const auto found = row.named(*row.pins, scene.model, i, {{names[n]}, {}});
      if (!found || std::ranges::find(*found, true) != found->end()) continue;
      complaints.push_back(
          {{fmt::format("'voxels.pinned' \"{}\" names no particle: there is no cell at this corner",
                        names[n]),
            n},
           path_text("voxels[].pinned", i),
           path_text("voxels[].layers", i)});
    }
  }
}

void check_particles(const Scene& scene, Complaints& complaints) {
  constexpr std::uint64_t most = most_lattice_points;
  for (std::size_t c = 0; c < scene.model.cubes.size(); ++c) {
    const auto& particles = scene.model.cubes[c].particles;
    const std::uint64_t count = box_counts(scene.model.cubes[c].lattice()).particles;
    if (!particles || count <= most) continue;
    complaints.push_back({{fmt::format("'cube.particles' {} × {} × {} makes {} particles; allowed: {}",
                                       (*particles)[0], (*particles)[1], (*particles)[2], count, most)},
                          path_text("cube[].particles", c)});
  }
}

void check_boxes(const Scene& scene, Complaints& complaints) {
  const auto check = [&](std::string_view key, std::size_t i, const BoxSettings& box) {
    for (int axis = 0; axis < 3; ++axis) {
      if (box.min[axis] <= box.max[axis]) continue;
      complaints.push_back(
          {{fmt::format(
               "'launcher.{}' is not a box: its min has the {} {} and its max {}; min must not exceed max",
               key, "xyz"[axis], box.min[axis], box.max[axis])},
           fmt::format("launcher[{}].{}", i, key)});
    }
  };
  for (std::size_t i = 0; i < scene.model.launchers.size(); ++i) {
    check("from", i, scene.model.launchers[i].from);
    check("towards", i, scene.model.launchers[i].towards);
  }
}

void check_camera(const Scene& scene, Complaints& complaints) {
  const CameraSettings& camera = scene.view.camera;
  if (length(camera.position - camera.target) > 0.0) return;
  complaints.push_back({{"the camera's position and target are the same point, so it has no direction"},
                        "view.camera.target",
                        "view.camera.position"});
}

void check_followed(const Scene& scene, Complaints& complaints) {
  if (!scene.view.follow || find_followed(scene.model, *scene.view.follow)) return;
  std::vector<std::string> names = actuated_names(scene.model);
  if (const std::uint64_t balls = predict_counts(scene.model).balls; balls > 0)
    names.push_back(balls == 1 ? "ball[0]" : fmt::format("ball[0] … ball[{}]", balls - 1));
  complaints.push_back({{fmt::format("'view.follow' names {}, which the scene does not have; it has {}",
                                     excerpt(*scene.view.follow, 40), fmt::join(names, ", "))},
                        "view.follow"});
}

/// The key that decides the size of the scene's largest body.
std::string largest_body(const Scene& scene) {
  std::string path;
  std::uint64_t most = 0;
  for (const BodyRow& row : body_rows()) {
    for (std::size_t i = 0; i < row.list.size(scene.model); ++i) {
      const ModelCounts counts = row.counts(scene.model, i);
      if (counts.particles + counts.balls <= most) continue;
      most = counts.particles + counts.balls;
      const Parameter* const size = size_of(scene, row, i);
      path = size ? path_text(size->path, i) : fmt::format("{}[{}]", row.list.key, i);
    }
  }
  return path;
}

void check_size(const Scene& scene, std::optional<std::uint64_t> memory_bytes, Complaints& complaints) {
  const ModelCounts counts = predict_counts(scene.model);
  const std::uint64_t bytes = run_bytes(counts);
  const std::string size =
      counts.balls == 0
          ? fmt::format("the scene has {} particles and {} springs", counts.particles, counts.springs())
          : fmt::format("the scene has {} particles, {} springs and {} balls", counts.particles,
                        counts.springs(), counts.balls);
  std::string problem;
  if (counts.particles + counts.balls > most_indices)
    problem = "more than 32-bit indices can name";
  else if (memory_bytes && bytes > *memory_bytes)
    problem = fmt::format("they need {} of memory and {} are available", human_bytes(bytes),
                          human_bytes(*memory_bytes));
  else
    return;
  complaints.push_back(
      {{fmt::format("{}: {}; use fewer particles or balls", size, problem)}, largest_body(scene)});
}

void check_bodies(const Scene& scene, Complaints& complaints) {
  std::vector<std::string> tables;
  for (const BodyRow& row : body_rows()) {
    if (row.list.size(scene.model) > 0) return;
    tables.push_back(fmt::format("[[{}]]", row.list.key));
  }
  const std::vector<std::string_view> names(tables.begin(), tables.end());
  complaints.push_back({{fmt::format("the scene is empty: nothing in it moves; add a {}",
                                     diagnostics::list_text(names, false))},
                        ""});
}

}  // namespace

std::vector<SceneComplaint> check_scene(const Scene& scene, std::optional<std::uint64_t> memory_bytes) {
  Complaints complaints;
  const bool legal = check_values(scene, complaints);
  check_geometry(scene, complaints);
  check_pinned(scene, complaints);
  check_bodies(scene, complaints);
  check_names(scene, complaints);
  check_materials(scene, complaints);
  if (!legal) return complaints;
  // These compute with the numbers.
  check_actuators(scene, complaints);
  check_particles(scene, complaints);
  check_corners(scene, complaints);
  check_sheets(scene, complaints);
  check_boxes(scene, complaints);
  check_camera(scene, complaints);
  check_followed(scene, complaints);
  check_size(scene, memory_bytes, complaints);
  return complaints;
}

}  // namespace aspic
