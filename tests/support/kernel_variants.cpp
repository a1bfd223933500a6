#include "support/kernel_variants.h"

#include <fmt/format.h>

#include <utility>

#include "model/terrain.h"
#include "support/actuated.h"
#include "support/equality_cases.h"

namespace aspic::test {
namespace {

constexpr Integrator methods[] = {Integrator::explicit_euler, Integrator::midpoint,
                                  Integrator::implicit_euler};

/// A cube that lands.
ModelSettings cube_on(Integrator integrator, const TerrainShapeRow& shape) {
  ModelSettings settings;
  settings.simulation.integrator = integrator;
  if (row_of(integrator).traits.stable_at_any_step) settings.simulation.timestep = 1.0 / 120.0;
  settings.terrain.emplace_back().shape = shape.value;
  CubeSettings& cube = settings.cubes.emplace_back();
  cube.particles_per_edge = 5;
  cube.position = shape.drop;
  cube.velocity = {0.5, -2.0, 0.3};
  set_down(settings, 0.005);
  return settings;
}

/// Two balls strike the cube and each other within a step or two.
ModelSettings with_balls(ModelSettings settings) {
  const Vec3 top = settings.cubes[0].position + Vec3{0.1, 2.0, 0.1};
  settings.balls.push_back({0.5, 4.0, top + Vec3{0.0, 0.495, 0.0}, {0.0, -6.0, 0.0}, {0.0, 0.0, 9.0}});
  settings.balls.push_back({0.4, 2.0, top + Vec3{0.1, 1.385, 0.0}, {0.0, -9.0, 0.0}, {}});
  return settings;
}

/// Without contact between bodies balls meet particles, else faces.
ModelSettings with_balls_on_particles(ModelSettings settings) {
  settings = with_balls(std::move(settings));
  settings.contact.bodies = false;
  return settings;
}

/// A ball in the middle of a dense cube: more than a block of partners, of which it strikes more than half.
ModelSettings crowded(Integrator integrator) {
  ModelSettings settings = cube_on(integrator, terrain_shapes[0]);
  CubeSettings& cube = settings.cubes[0];
  cube.particles_per_edge = 10;
  cube.edge_length = 0.5;
  settings.balls.push_back({0.45, 400.0, cube.position, {0.5, -9.0, 0.3}, {0.0, 0.0, 9.0}});
  settings.balls.push_back({0.4, 2.0, cube.position + Vec3{0.1, 0.84, 0.0}, {0.0, -12.0, 0.0}, {}});
  return settings;
}

ModelSettings with_net(ModelSettings settings) {
  GoalNetSettings& net = settings.goal_nets.emplace_back();
  net.particles = {4, 5, 6};
  net.position = settings.cubes[0].position + Vec3{0.0, -0.4, 6.0};
  return settings;
}

/// A body of two materials with a hole and a notch, where the cube would be: blocks of one material, of both,
/// and some that have empty places.
ModelSettings with_cells(ModelSettings settings) {
  settings.materials = {{16.0, 33000.0, 0.4, "jelly"}, {30.0, 9000.0, 0.7, "fat"}};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  voxels.size = 0.9;
  voxels.position = settings.cubes[0].position;
  voxels.rotation = {{1.0, 0.3, 0.7}, 25.0};
  voxels.velocity = settings.cubes[0].velocity;
  voxels.palette = {{"1", "jelly"}, {"2", "fat"}};
  voxels.layers.assign(4, {"111222", "111222", "11.222", "112222", "112222", "1122.."});
  settings.cubes.clear();
  set_down(settings, 0.005);
  return settings;
}

/// Another cube strikes the first from above, so far away that at first nothing is near.
ModelSettings struck(ModelSettings settings) {
  settings.contact.bodies = true;
  CubeSettings other = settings.cubes[0];
  other.position = other.position + Vec3{0.3, 6.0, 0.2};
  other.rotation = {{0.0, 1.0, 0.0}, 20.0};
  other.velocity = {5.0, -45.0, 1.0};
  settings.cubes.push_back(other);
  return settings;
}

class Variants {
 public:
  void add(const std::string& scene, const ModelSettings& settings, const GpuOptions& options) {
    made.push_back({fmt::format("kernels: {}", scene), settings, options});
  }
  /// One for each path that the method takes.
  void add_paths(const std::string& scene, const ModelSettings& settings, GpuOptions options) {
    for (const ForcePathRow& path : force_paths()) {
      options.force_path = path.path;
      if (works_with(path.path, settings.simulation.integrator)) add(scene, settings, options);
    }
  }
  std::vector<KernelVariant> made;
};

}  // namespace

std::uint64_t KernelVariant::steps() const {
  return row_of(settings.simulation.integrator).traits.long_steps ? 8 : 60;
}

const std::vector<KernelVariant>& kernel_variants() {
  static const std::vector<KernelVariant> all = [] {
    Variants variants;
    const TerrainShapeRow& plane = terrain_shapes[0];
    GpuOptions exact;
    exact.arithmetic.emplace();  // as the device computes, without a canary for each solver
    GpuOptions gather = exact;
    gather.force_path = ForcePath::gather;
    for (const Integrator method : methods) {
      // Every path, of cubes alone and among others; what follows the sum of forces is one text for all.
      variants.add_paths("plane", cube_on(method, plane), exact);
      variants.add_paths("plane, with a net", with_net(cube_on(method, plane)), exact);
      // Springs whose rest lengths change; and stages in two passes.
      variants.add_paths("actuated", actuated(method, ContactModel::coulomb), exact);
      GpuOptions split = exact;
      split.split_stages = true;
      variants.add_paths("plane, with a net", with_net(cube_on(method, plane)), split);
      for (const TerrainShapeRow& shape : terrain_shapes)
        variants.add(std::string(shape.name), cube_on(method, shape), exact);
      ModelSettings several = cube_on(method, plane);
      several.terrain[0].motion = TerrainMotion{{0.3, 1.0, 0.0}, 0.1, 2.0, 0.1};
      variants.add("plane that moves", several, exact);
      for (const TerrainShapeRow& shape : terrain_shapes) several.terrain.emplace_back().shape = shape.value;
      variants.add("all terrains", several, gather);
      for (const std::uint32_t size : {32u, 256u}) {
        GpuOptions sized = exact;
        sized.group_size = size;
        variants.add("plane", cube_on(method, plane), sized);
      }
      // A device that divides and takes roots inexactly, with and without an fma() that rounds once.
      GpuOptions corrected = exact;
      corrected.arithmetic->defines = {{"ASPIC_CORRECT_DIV", "1"}, {"ASPIC_CORRECT_SQRT", "1"}};
      variants.add("plane", cube_on(method, plane), corrected);
      corrected.arithmetic->defines.push_back({"ASPIC_FUSED_FMA", "1"});
      variants.add("plane, with balls", with_balls(cube_on(method, plane)), corrected);
      corrected.arithmetic->defines.push_back({"ASPIC_QUICK", "2"});
      variants.add("plane", cube_on(method, plane), corrected);
    }
    // Both forms of the kernels of lattices, and fast arithmetic on each path.
    for (const Integrator method : {Integrator::explicit_euler, Integrator::midpoint}) {
      GpuOptions form = exact;
      for (const std::uint32_t run : {1u, 4u}) {
        form.lattice_run = run;
        form.spring_arithmetic = Arithmetic::exact;
        variants.add("plane, with a net", with_net(cube_on(method, plane)), form);
        variants.add("plane, cells", with_cells(cube_on(method, plane)), form);
        variants.add("plane, cells of many classes", cells_of_many_classes(method), form);
        form.spring_arithmetic = Arithmetic::fast;
        variants.add("plane", cube_on(method, plane), form);
        variants.add("plane, cells", with_cells(cube_on(method, plane)), form);
      }
      variants.add_paths("plane, with a net", with_net(cube_on(method, plane)), form);
      GpuOptions split = exact;
      split.split_stages = true;
      variants.add("plane, cells", with_cells(cube_on(method, plane)), split);
    }
    // Few balls, on terrain of every kind; and more bodies than a block of partners, which want a kernel of
    // their own.
    for (const Integrator method : {Integrator::explicit_euler, Integrator::implicit_euler}) {
      variants.add("plane, with balls", with_balls(cube_on(method, plane)), exact);
      variants.add("plane, with balls", with_balls(cube_on(method, plane)), gather);
      variants.add("plane, with balls on particles", with_balls_on_particles(cube_on(method, plane)), exact);
      for (const BallSearch search : {BallSearch::all_pairs, BallSearch::grid}) {
        GpuOptions searching = exact;
        searching.ball_search = search;
        variants.add("plane, a ball in a crowd", crowded(method), searching);
      }
    }
    // Bodies that touch, on every path and with more than one stage.
    variants.add_paths("plane, struck by a cube",
                       struck(with_net(cube_on(Integrator::explicit_euler, plane))), exact);
    for (const Integrator method : {Integrator::midpoint, Integrator::implicit_euler})
      variants.add("plane, struck by a cube", struck(cube_on(method, plane)), exact);
    ModelSettings balls = with_balls_on_particles(cube_on(Integrator::explicit_euler, plane));
    for (const TerrainShapeRow& shape : terrain_shapes) balls.terrain.emplace_back().shape = shape.value;
    variants.add("all terrains, with balls on particles", balls, exact);
    balls.contact.bodies = true;
    variants.add("all terrains, with balls", balls, exact);
    return std::move(variants.made);
  }();
  return all;
}

}  // namespace aspic::test
