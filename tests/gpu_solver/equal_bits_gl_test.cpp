// The product's first claim: the gpu backend ends with the same bits as the reference in single precision.
// EqualBits has a covering set of all that a run depends on, and what no set has; EqualBitsInFull the
// products of integrators, terrains and paths, and more particles.
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "aspic/scene.h"
#include "cpu_reference/reference_solver.h"
#include "gpu_solver/gpu_solver.h"
#include "model/springs.h"
#include "model/terrain.h"
#include "support/equality_cases.h"
#include "support/gl_fixture.h"
#include "support/golden_runs.h"
#include "support/integrator_names.h"
#include "support/lattice_bodies.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

using Paths = std::span<const ForcePath>;
constexpr ForcePath every_path[] = {ForcePath::lattice, ForcePath::gather, ForcePath::per_spring};

class EqualBits : public aspic::testing::GlTest {
 protected:
  void expect_equal(const ModelSettings& settings, std::uint64_t steps,
                    std::initializer_list<std::uint32_t> group_sizes, Paths paths = every_path) {
    expect_equal(test::build(settings), steps, group_sizes, paths);
  }
  void expect_equal(const Model& model, std::uint64_t steps, std::initializer_list<std::uint32_t> group_sizes,
                    Paths paths = every_path) {
    const State expected = test::after(model, steps, Precision::single);
    // The run means nothing unless every terrain acts in it.
    double contact = 0.0;
    for (std::size_t k = 0; k < model.terrain.size(); ++k) {
      Model fewer = model;
      fewer.terrain.erase(fewer.terrain.begin() + static_cast<std::ptrdiff_t>(k));
      const State otherwise = test::after(fewer, steps, Precision::single);
      ASSERT_FALSE(otherwise == expected) << "terrain " << k;
      for (std::size_t i = 0; i < expected.velocity.size(); ++i)
        contact = std::max(contact, length(expected.velocity[i] - otherwise.velocity[i]));
    }
    ASSERT_GT(contact, 0.5);
    for (const ForcePath path : paths) {
      if (!works_with(path, model.simulation.integrator)) continue;  // refused by name
      for (const std::uint32_t group_size : group_sizes) {
        GpuOptions options;
        options.force_path = path;
        options.group_size = group_size;
        options.split_stages = split_;
        // The form for hardware takes its turn with the one for software.
        options.lattice_run = group_size != group_sizes.begin()[0] ? 1 : 0;
        auto solver = make_gpu_solver(context(), model, options);
        ASSERT_TRUE(solver.ok()) << solver.error().message();
        ASSERT_FALSE((*(*solver)->advance(steps)).divergence.has_value());
        const State state = *(*solver)->state();
        EXPECT_EQ(state_hash_text(state), state_hash_text(expected))
            << name_of(model.simulation.integrator) << ", " << name_of(model.contact.model) << ", path "
            << name_of(path) << ", work group " << group_size;
        EXPECT_EQ(state, expected);
      }
    }
  }
  /// What costs time is compiling: in core, scenes share the kernels of forces. Full, and built-in scenes in
  /// core, have each stage in one pass where bodies do not touch.
  bool split_ = true;
};

class EqualBitsInFull : public EqualBits {
 protected:
  EqualBitsInFull() { split_ = false; }
};

void expect_golden_end(gl::Context& context, const test::GoldenRun& run, bool split = false) {
  SCOPED_TRACE(run.scene);
  const Model model = run.model();
  GpuOptions options;
  options.split_stages = split;
  auto solver = make_gpu_solver(context, model, options);
  ASSERT_TRUE(solver.ok()) << solver.error().message();
  ASSERT_TRUE((*solver)->advance(run.steps).ok());
  test::expect_golden(run, *(*solver)->state());
}

TEST_F(EqualBits, CoveringSet) {
  for (const test::EqualityCase& row : test::covering_cases()) {
    SCOPED_TRACE(test::text_of(row));
    GpuOptions options;
    options.force_path = row.path;
    options.lattice_run = row.lattice_run;
    options.split_stages = split_;
    options.group_size = 256;  // as on hardware; built-in scenes below have the size for software
    const Model model = test::model_of(row);
    auto solver = make_gpu_solver(context(), model, options);
    ASSERT_TRUE(solver.ok()) << solver.error().message();
    const test::GoldenRun run = test::golden_run(row);
    ASSERT_TRUE((*solver)->advance(run.steps).ok());
    test::expect_golden(run, *(*solver)->state());
  }
}

// On the path that scenes take.
TEST_F(EqualBits, BuiltInScenes) {
  const auto split = [](Integrator method) { return method == Integrator::runge_kutta_4; };
  for (const test::GoldenRun& run : test::core_scene_runs())
    expect_golden_end(context(), run, split(run.method));
}

// In nets numbers become denormal, which the H200 flushes and this driver flushes under the guard alone.
TEST_F(EqualBits, EndsRunsOfNetsWithTheStatesOfAnH200) {
  int count = 0;
  for (const test::HardwareRun& run : test::hardware_runs()) {
    const Model model = run.model();
    if (!(run.scene.find("net") != std::string::npos || run.scene == "penalty" || run.scene == "course-2018"))
      continue;
    ++count;
    auto solver = make_gpu_solver(context(), model);
    ASSERT_TRUE(solver.ok()) << solver.error().message();
    ASSERT_TRUE((*solver)->advance(run.steps).ok());
    EXPECT_EQ(state_hash_text(*(*solver)->state()), run.hash) << run.text();
  }
  EXPECT_EQ(count, 13);
}

// Browsers end all of these runs with the same states (tests/page/live_browser_test.cpp).
class EqualBitsOfScenesInFull : public EqualBits, public ::testing::WithParamInterface<Integrator> {};

TEST_P(EqualBitsOfScenesInFull, UnderThisMethod) {
  for (const test::GoldenRun& run : test::scene_runs())
    if (run.method == GetParam()) expect_golden_end(context(), run);
}

INSTANTIATE_TEST_SUITE_P(Every, EqualBitsOfScenesInFull, ::testing::ValuesIn(all_integrators),
                         test::by_integrator);

constexpr Integrator both_integrators[] = {Integrator::explicit_euler, Integrator::runge_kutta_4};
constexpr ContactModel both_models[] = {ContactModel::coulomb, ContactModel::course};

TEST_F(EqualBitsInFull, Five) {
  for (const Integrator integrator : both_integrators) {
    for (const ContactModel contact : both_models)
      expect_equal(test::low_cube(5, integrator, contact), 2000, {32, 128});
  }
}

TEST_F(EqualBitsInFull, FiveOverEveryIntegratorAndTerrain) {
  for (const Integrator integrator : explicit_integrators) {
    for (const TerrainShapeRow& shape : terrain_shapes) {
      for (const ContactModel contact : both_models) {
        ModelSettings settings = test::low_cube(5, integrator, contact);
        settings.terrain[0].shape = shape.value;
        settings.cubes[0].position = shape.drop;
        expect_equal(settings, 1000, {64});
      }
    }
  }
}

TEST_F(EqualBits, FiveWithSeveralTerrainsMaterialAndPinnedCorner) {
  for (const ContactModel contact : both_models) {
    ModelSettings settings = test::low_cube(5, Integrator::symplectic_euler, contact);
    settings.cubes.push_back(settings.cubes[0]);
    settings.cubes[1].position = {9.0, 2.0, 0.0};
    settings.cubes[1].material = MaterialSettings{};
    settings.cubes[1].pinned.names = {"left-top-front"};
    TerrainSettings sphere;
    sphere.shape = TerrainShape::sphere;
    sphere.mass = 10.0;
    sphere.restitution = 1.0;
    settings.terrain.push_back(sphere);
    settings.terrain.push_back(TerrainSettings{});
    settings.terrain[2].geometry["point"] = Vec3{-1.0, -1.0, 0.0};
    settings.terrain[2].geometry["normal"] = Vec3{1.0, 0.2, 0.0};
    settings.terrain[2].friction = 0.9;
    expect_equal(settings, 400, {64});
  }
}

// Long enough to rest: reactions act in every stage, on ground, slope, top of a sphere and bottom of a bowl.
TEST_F(EqualBitsInFull, FourAtRestUnderEveryIntegratorOnEveryTerrain) {
  for (const Integrator integrator : explicit_integrators) {
    for (const TerrainShapeRow& shape : terrain_shapes) {
      ModelSettings settings = test::low_cube(4, integrator, ContactModel::coulomb);
      settings.cubes[0].velocity = {0.0, -1.0, 0.1};
      settings.terrain[0].shape = shape.value;
      settings.terrain[0].restitution = 0.1;
      settings.terrain[0].friction = 1.2;
      settings.cubes[0].position = shape.drop;
      expect_equal(settings, 2500, {64}, every_path);
    }
  }
}

// A groove of slopes, a wall across it, one of them movable, and a pinned corner: each acts on what the one
// before left, in every stage and at the step's end.
TEST_F(EqualBitsInFull, FourInACornerOfThreeTerrains) {
  for (const Integrator integrator : explicit_integrators) {
    for (const bool pinned : {false, true}) {
      ModelSettings settings = test::low_cube(4, integrator, ContactModel::coulomb);
      settings.cubes[0].position = {0.2, 4.2, 2.4};
      settings.cubes[0].velocity = {0.2, -1.0, -1.5};
      if (pinned) settings.cubes[0].pinned.names = {"left-top-front"};
      settings.terrain.clear();
      for (const Vec3& normal : {Vec3{0.6, 0.8, 0.0}, Vec3{-0.5, 0.7, -0.1}, Vec3{0.0, 0.1, 1.0}}) {
        TerrainSettings side;
        side.geometry["point"] = Vec3{};
        side.geometry["normal"] = normal;
        side.restitution = 0.2;
        settings.terrain.push_back(side);
      }
      settings.terrain[1].mass = 30.0;
      test::set_down(settings, 0.01);
      expect_equal(settings, 2500, {64}, every_path);
    }
  }
}

/// A cube, one whose springs are listed, another cube, and cloth: every body on a path of its own, in one
/// run.
Model mixed(Integrator integrator, double timestep) {
  ModelSettings settings = test::low_cube(2, integrator, ContactModel::coulomb);
  settings.cubes[0].particles = {5, 5, 5};
  settings.simulation.timestep = timestep;
  for (const int edge : {2, 3}) {
    settings.cubes.push_back(settings.cubes[0]);
    settings.cubes.back().particles.reset();
    settings.cubes.back().particles_per_edge = edge;
    settings.cubes.back().position.x += 9.0 * (2.5 - edge);
  }
  settings.cubes[2].pinned.names = {"left-top-front"};
  settings.cloths.emplace_back();
  settings.cloths[0].position = {0.0, 0.5, 9.0};
  test::set_down(settings, 0.01);
  Model model = test::build(settings);
  Body& body = model.bodies[1];
  std::vector<Spring> listed;
  for (const Spring& spring : springs_of(model, body.first_particle, body.particle_count))
    listed.push_back(spring);
  model.listed_springs.insert(model.listed_springs.begin(), listed.begin(), listed.end());
  body.lattice.reset();
  return model;
}

TEST_F(EqualBitsInFull, MixedBodies) {
  for (const Integrator integrator : {Integrator::explicit_euler, Integrator::midpoint})
    expect_equal(mixed(integrator, 0.001), 1000, {64, 32});
}

/// Boxes whose edges differ, several at once.
Model boxes(Integrator integrator) {
  ModelSettings settings = test::low_cube(2, integrator, ContactModel::coulomb);
  if (row_of(integrator).traits.long_steps) settings.simulation.timestep = 1.0 / 60.0;
  settings = test::with_odd_boxes(settings);
  test::set_down(settings, 0.01);
  return test::build(settings);
}

// Every path takes them, and a body with empty cells.
TEST_F(EqualBits, BoxesOfAnyEdges) {
  for (const Integrator integrator : {Integrator::explicit_euler, Integrator::implicit_euler}) {
    const bool long_steps = row_of(integrator).traits.long_steps;
    ModelSettings settings = test::low_cube(2, integrator, ContactModel::coulomb);
    if (long_steps) settings.simulation.timestep = 1.0 / 60.0;
    expect_equal(test::with_cells(settings, test::lattice_of("xxx,x.x,xxx;xxx,...,x..")),
                 long_steps ? 8 : 100, {64});
    if (long_steps)
      expect_equal(boxes(integrator), 6, {64});
    else
      expect_equal(boxes(integrator), 50, {64, 32});
  }
}

TEST_F(EqualBitsInFull, BoxesOfAnyEdgesImplicit) {
  expect_equal(boxes(Integrator::implicit_euler), 15, {64, 32});
}

TEST_F(EqualBits, MixedBodiesImplicit) {
  expect_equal(mixed(Integrator::implicit_euler, 1.0 / 60.0), 10, {64});
}

/// Implicit Euler with 60 steps a second; what contact does to it shows after a few.
ModelSettings implicit(ModelSettings settings) {
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 1.0 / 60.0;
  settings.cubes[0].position.y -= 0.5;
  return settings;
}

TEST_F(EqualBitsInFull, FiveImplicit) {
  for (const ContactModel contact : both_models) {
    expect_equal(implicit(test::low_cube(5, Integrator::implicit_euler, contact)), 30, {64});
  }
}

// Ground in the equation: flat, inclined, curved both ways; until it rests or nearly so.
TEST_F(EqualBitsInFull, FourImplicitOnEveryTerrain) {
  for (const TerrainShapeRow& shape : terrain_shapes) {
    ModelSettings settings = implicit(test::low_cube(4, Integrator::implicit_euler, ContactModel::coulomb));
    settings.terrain[0].shape = shape.value;
    settings.terrain[0].friction = 0.6;
    settings.terrain[0].mass = 20.0;
    settings.cubes[0].position = shape.drop;
    expect_equal(settings, 150, {64});
  }
}

// A groove and a wall across it: particles held by one, two and three terrains, with and without a pinned
// corner.
TEST_F(EqualBits, FourImplicitInACornerOfThreeTerrains) {
  for (const bool pinned : {false, true}) {
    ModelSettings settings = implicit(test::low_cube(4, Integrator::implicit_euler, ContactModel::coulomb));
    settings.cubes[0].position = {0.2, 4.2, 2.4};
    settings.cubes[0].velocity = {0.2, -1.0, -1.5};
    if (pinned) settings.cubes[0].pinned.names = {"left-top-front"};
    settings.terrain.clear();
    for (const Vec3& normal : {Vec3{0.6, 0.8, 0.0}, Vec3{-0.5, 0.7, 0.1}, Vec3{0.0, 0.1, 1.0}}) {
      TerrainSettings side;
      side.geometry["point"] = Vec3{};
      side.geometry["normal"] = normal;
      side.restitution = 0.2;
      settings.terrain.push_back(side);
    }
    test::set_down(settings, 0.01);
    expect_equal(settings, 65, {64});
  }
}

// 1,000 particles are four blocks of a reduction, 74,088 are 290: their results make two more blocks.
TEST_F(EqualBits, TenPerEdgeImplicit) {
  expect_equal(implicit(test::low_cube(10, Integrator::implicit_euler, ContactModel::coulomb)), 8, {64});
}

TEST_F(EqualBitsInFull, FortyTwoPerEdgeImplicit) {
  ModelSettings settings = implicit(test::low_cube(42, Integrator::implicit_euler, ContactModel::course));
  settings.cubes[0].material = MaterialSettings{};
  settings.cubes[0].velocity = {1.0, -12.0, 0.5};
  expect_equal(settings, 1, {64});
}

TEST_F(EqualBitsInFull, TenPerEdge) {
  expect_equal(test::low_cube(10, Integrator::runge_kutta_4, ContactModel::coulomb), 2000, {64});
}

TEST_F(EqualBitsInFull, TwentyPerEdge) {
  expect_equal(test::low_cube(20, Integrator::explicit_euler, ContactModel::course), 2000, {64});
}

}  // namespace
}  // namespace aspic
