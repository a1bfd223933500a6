// Terrain that moves, on the device: the reference's bits, however a run is cut into pieces.
#include <gtest/gtest.h>

#include "cpu_reference/reference_solver.h"
#include "gpu_solver/gpu_solver.h"
#include "model/integrator.h"
#include "model/terrain.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/value_of.h"

namespace aspic {
namespace {

class MovingTerrain : public aspic::testing::GlTest {
 protected:
  std::unique_ptr<GpuSolver> solver(const Model& model, ForcePath path = ForcePath::automatic) {
    GpuOptions options;
    options.force_path = path;
    return test::value_of(make_gpu_solver(context(), model, options));
  }
  static State reference_after(const Model& model, std::uint64_t steps) {
    auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    EXPECT_FALSE((*reference->advance(steps)).divergence.has_value());
    return *reference->state();
  }

  /// A tilted cube and a ball between a floor that rises and falls, a wall that shakes and still ground.
  static ModelSettings shaken(Integrator integrator, ContactModel contact) {
    ModelSettings settings = test::cube_on_plane(4, 2.2);
    settings.cubes[0].rotation = {{1.0, 0.3, 0.7}, 25.0};
    settings.cubes[0].velocity = {-1.0, -1.0, 0.5};
    settings.simulation.integrator = integrator;
    settings.contact.model = contact;
    if (integrator == Integrator::implicit_euler) settings.simulation.timestep = 0.01;
    settings.terrain[0].motion = TerrainMotion{{0.1, 1.0, 0.0}, 0.3, 0.9, 0.1};
    settings.terrain.push_back({.geometry = {{"point", Vec3{-2.6, 0, 0}}, {"normal", Vec3{1, 0.1, 0}}},
                                .motion = TerrainMotion{{1.0, 0.0, 0.3}, 0.2, 1.3, 0.6}});
    settings.terrain.push_back({.geometry = {{"point", Vec3{0, 0, -2.5}}, {"normal", Vec3{0, 0.1, 1}}}});
    settings.balls.push_back({0.3, 2.0, {3.0, -0.4, 0.2}, {-1.0, -2.0, 0.5}, {3.0, 1.0, -2.0}});
    return settings;
  }
};

// More steps than the table of poses has, which two terrains share.
TEST_F(MovingTerrain, HasTheReferencesBitsUnderEveryIntegrator) {
  for (const Integrator integrator : all_integrators) {
    const bool solved = integrator == Integrator::implicit_euler;
    for (const ContactModel contact : {ContactModel::coulomb, ContactModel::course}) {
      const Model model = test::build(shaken(integrator, contact));
      const std::uint64_t steps = solved ? 60 : 700;
      const State expected = reference_after(model, steps);
      for (const ForcePath path : {ForcePath::lattice, ForcePath::gather, ForcePath::per_spring}) {
        if (!works_with(path, integrator)) continue;  // refused by name
        const auto gpu = solver(model, path);
        ASSERT_FALSE((*gpu->advance(steps)).divergence.has_value());
        EXPECT_EQ(*gpu->state(), expected)
            << name_of(integrator) << ", " << name_of(contact) << ", " << name_of(path);
      }
    }
  }
}

// Poses belong to the absolute step: pieces, a loaded state and the other backend in between change nothing.
TEST_F(MovingTerrain, RunsInPiecesAndOverToTheOtherBackend) {
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::implicit_euler}) {
    const Model model = test::build(shaken(integrator, ContactModel::coulomb));
    const State expected = reference_after(model, 90);
    const auto gpu = solver(model);
    for (const std::uint64_t steps : {1u, 16u, 13u})
      ASSERT_FALSE((*gpu->advance(steps)).divergence.has_value());
    auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    ASSERT_TRUE(reference->load(*gpu->state()).ok());
    ASSERT_FALSE((*reference->advance(25)).divergence.has_value());
    const auto again = solver(model);
    ASSERT_TRUE(again->load(*reference->state()).ok());
    ASSERT_FALSE((*again->advance(35)).divergence.has_value());
    EXPECT_EQ(*again->state(), expected) << name_of(integrator);
  }
}

// As many as there may be: the table has room for the two ends of a few steps.
TEST_F(MovingTerrain, ManyTerrainsMayMove) {
  for (const Integrator integrator : {Integrator::explicit_euler, Integrator::implicit_euler}) {
    ModelSettings settings = shaken(integrator, ContactModel::coulomb);
    while (settings.terrain.size() < 64) {
      const auto n = static_cast<double>(settings.terrain.size());
      settings.terrain.push_back(
          {.shape = TerrainShape::sphere,
           .geometry = {{"center", Vec3{0.1 * n - 3.0, -3.0, 0.2 * n}}, {"radius", 1.8}},
           .motion = TerrainMotion{{0.0, 1.0, 0.1 * n}, 0.1, 0.1 * n, 0.01 * n}});
    }
    const Model model = test::build(settings);
    const auto gpu = solver(model);
    ASSERT_FALSE((*gpu->advance(20)).divergence.has_value());
    EXPECT_EQ(*gpu->state(), reference_after(model, 20)) << name_of(integrator);
  }
}

}  // namespace
}  // namespace aspic
