#include "scene/scene_checks.h"

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "model/cube.h"
#include "model/goal_net.h"
#include "model/model.h"
#include "scene/diagnostics.h"
#include "scene/parameters.h"

namespace aspic::reader {
namespace {

using document::find;
using document::Kind;
using document::Member;
using document::Node;
using document::Position;
using document::Problem;

/// The tables of a list; none if it is missing or of another kind.
const std::vector<Node>& tables_of(const Node& root, std::string_view list) {
  static const std::vector<Node> none;
  const Member* member = find(root, list);
  return member && member->value.kind == Kind::array ? member->value.elements : none;
}

void check_schema(const Node& root, std::vector<Problem>& problems) {
  if (find(root, "schema")) return;
  problems.push_back(
      {{}, fmt::format("'schema' is missing; start the file with the line schema = {}", scene_schema)});
}

void check_terrain(const Node& root, const Scene& scene, std::vector<Problem>& problems) {
  const std::vector<Node>& elements = tables_of(root, "terrain");
  for (std::size_t t = 0; t < elements.size(); ++t) {
    const TerrainShape shape = scene.model.terrain[t].shape;
    // A shape that was not understood says nothing about which keys belong to it.
    const Member* written = find(elements[t], "shape");
    if (written && (written->value.kind != Kind::string || written->value.text != name_of(shape))) continue;
    for (const Member& member : elements[t].members) {
      const Parameter* p = find_parameter("terrain[]." + member.key);
      if (!p || belongs_to_shape(*p, shape)) continue;
      std::vector<std::string_view> geometry;
      for (const Parameter& other : parameters()) {
        if (other.path.starts_with("terrain[].") && other.belonging != Belonging::always &&
            belongs_to_shape(other, shape)) {
          geometry.push_back(other.path.substr(other.path.find('.') + 1));
        }
      }
      problems.push_back({member.position, fmt::format("a {} has no '{}'; its geometry is {}", name_of(shape),
                                                       member.key, diagnostics::list_text(geometry, false))});
    }
  }
}

void check_material(const Node& cube, std::vector<Problem>& problems) {
  const Member* material = find(cube, "material");
  if (!material) return;
  std::vector<std::string_view> others;
  for (const std::string_view key : child_keys("cube[]")) {
    const Member* member = find(cube, key);
    if (!member) continue;
    for (const Parameter& p : parameters()) {
      const std::string path = fmt::format("cube[].{}", key);
      if (p.belonging == Belonging::explicit_springs && (p.path == path || p.path.starts_with(path + "."))) {
        others.push_back(key);
        break;
      }
    }
  }
  if (others.empty()) return;
  problems.push_back(
      {material->position, fmt::format("a cube has either 'material' or the masses and springs it decides, "
                                       "not both; leave out 'material' or {}",
                                       diagnostics::list_text(others, false))});
}

void check_pinned(const Node& cube, const CubeSettings& settings, std::vector<Problem>& problems) {
  const Member* pinned = find(cube, "pinned");
  if (!pinned || pinned->value.kind != Kind::array) return;
  // n itself may be wrong in the file: then there is no last particle to compare with.
  const Member* written = find(cube, "particles-per-edge");
  const std::int64_t n = settings.particles_per_edge;
  if (written && (written->value.kind != Kind::integer || written->value.integer != n)) return;
  for (const Node& element : pinned->value.elements) {
    if (element.kind != Kind::integer || (element.integer >= 0 && element.integer < n * n * n)) continue;
    problems.push_back(
        {element.position, fmt::format("'cube.pinned' index {} is not in the cube; allowed: 0 … {}",
                                       element.integer, n * n * n - 1)});
  }
}

void check_camera(const Node& root, const Scene& scene, std::vector<Problem>& problems) {
  const CameraSettings& camera = scene.view.camera;
  if (length(camera.position - camera.target) > 0.0) return;
  const Member* view = find(root, "view");
  const Member* written = view ? find(view->value, "camera") : nullptr;
  if (!written) return;
  const Member* target = find(written->value, "target");
  if (!target) target = find(written->value, "position");
  problems.push_back({target ? target->value.position : written->position,
                      "the camera's position and target are the same point: it looks nowhere"});
}

void check_box(const Node& launcher, std::string_view key, const BoxSettings& box,
               std::vector<Problem>& problems) {
  const Member* written = find(launcher, key);
  if (!written) return;
  for (int axis = 0; axis < 3; ++axis) {
    if (box.min[axis] <= box.max[axis]) continue;
    problems.push_back(
        {written->value.position,
         fmt::format("'launcher.{}' is no box: its min has the {} {} and its max {}; min must not "
                     "exceed max",
                     key, "xyz"[axis], box.min[axis], box.max[axis])});
  }
}

/// Whether anything in the document is meant to move.
bool has_bodies(const Node& root) {
  for (const std::string_view list : {"cube", "goal-net", "ball", "launcher"}) {
    const Member* member = find(root, list);
    if (member && (member->value.kind != Kind::array || !member->value.elements.empty())) return true;
  }
  return false;
}

/// Where the scene's size is decided: the counts of its largest net or launcher, or the particles per edge of
/// its largest cube.
Position largest_body(const Node& root, const Scene& scene) {
  Position position;
  std::uint64_t most_of_all = 0;
  const auto consider = [&](std::uint64_t size, const Node& element, std::string_view key) {
    if (size <= most_of_all) return;
    most_of_all = size;
    const Member* written = find(element, key);
    position = written ? written->value.position : element.position;
  };
  const std::vector<Node>& nets = tables_of(root, "goal-net");
  for (std::size_t i = 0; i < nets.size(); ++i) {
    consider(goal_net_counts(scene.model.goal_nets[i]).particles, nets[i], "particles");
  }
  const std::vector<Node>& launchers = tables_of(root, "launcher");
  for (std::size_t i = 0; i < launchers.size(); ++i) {
    consider(static_cast<std::uint64_t>(scene.model.launchers[i].count), launchers[i], "count");
  }
  const std::vector<Node>& cubes = tables_of(root, "cube");
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    consider(cube_counts(scene.model.cubes[i].particles_per_edge).particles, cubes[i], "particles-per-edge");
  }
  return position;
}

std::string bytes_text(std::uint64_t bytes) {
  constexpr double mebi = 1024.0 * 1024.0;
  const double size = static_cast<double>(bytes);
  return size < 1024.0 * mebi ? fmt::format("{:.1f} MiB", size / mebi)
                              : fmt::format("{:.1f} GiB", size / (1024.0 * mebi));
}

void check_size(const Node& root, const Scene& scene, std::optional<std::uint64_t> memory_bytes,
                std::vector<Problem>& problems) {
  const ModelCounts counts = predict_counts(scene.model);
  const std::uint64_t bytes = run_bytes(counts);
  const std::string size =
      counts.balls == 0
          ? fmt::format("the scene has {} particles and {} springs", counts.particles, counts.springs())
          : fmt::format("the scene has {} particles, {} springs and {} balls", counts.particles,
                        counts.springs(), counts.balls);
  // Both ends of every spring are counted by 32 bits (build_model).
  if (2 * counts.springs() > 0xffffffffull || counts.particles + counts.balls > 0x7fffffffull) {
    problems.push_back({largest_body(root, scene),
                        size + ": more than 32-bit indices can name; use fewer particles or balls"});
  } else if (memory_bytes && bytes > *memory_bytes) {
    problems.push_back(
        {largest_body(root, scene),
         fmt::format("{}: they need {} of memory and {} are available; use fewer particles or balls", size,
                     bytes_text(bytes), bytes_text(*memory_bytes))});
  }
}

}  // namespace

void check_whole_scene(const Node& root, const Scene& scene, std::optional<std::uint64_t> memory_bytes,
                       std::vector<Problem>& problems) {
  check_schema(root, problems);
  check_terrain(root, scene, problems);
  const std::vector<Node>& cubes = tables_of(root, "cube");
  for (std::size_t c = 0; c < cubes.size(); ++c) {
    check_material(cubes[c], problems);
    check_pinned(cubes[c], scene.model.cubes[c], problems);
  }
  const std::vector<Node>& launchers = tables_of(root, "launcher");
  for (std::size_t i = 0; i < launchers.size(); ++i) {
    check_box(launchers[i], "from", scene.model.launchers[i].from, problems);
    check_box(launchers[i], "towards", scene.model.launchers[i].towards, problems);
  }
  check_camera(root, scene, problems);
  if (!has_bodies(root)) {
    problems.push_back(
        {{},
         "the scene is empty: nothing in it moves; add a [[cube]], [[goal-net]], [[ball]] or [[launcher]]"});
  }
  check_size(root, scene, memory_bytes, problems);
}

}  // namespace aspic::reader
