// Balls on faces of bodies on the device: the reference's bits for every method, with many balls on one face,
// on open and closed surfaces, and from a state in mid-contact on.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cpu_reference/reference_solver.h"
#include "gpu_solver/gpu_solver.h"
#include "support/gl_fixture.h"
#include "support/integrator_names.h"
#include "support/model_building.h"
#include "support/reference_runs.h"
#include "support/value_of.h"

namespace aspic {
namespace {

/// Balls fall on a coarse cube, of which so many rows along an edge fit, and on a coarse cloth beside it.
ModelSettings shower(Integrator integrator, int rows) {
  ModelSettings settings;
  settings.simulation.integrator = integrator;
  settings.simulation.timestep = row_of(integrator).traits.stable_at_any_step ? 0.005 : 0.001;
  settings.contact.ball_restitution = 0.4;
  settings.terrain.push_back({.geometry = {{"point", Vec3{}}}});
  CubeSettings& cube = settings.cubes.emplace_back();
  cube.particles_per_edge = 3;
  cube.edge_length = 2.0;
  cube.position = {0.0, 1.0, 0.0};
  cube.rotation = {{0.0, 1.0, 0.0}, 12.0};
  ClothSettings& cloth = settings.cloths.emplace_back();
  cloth.particles = {4, 3};
  cloth.size = {2.0, 2.0};
  cloth.position = {2.4, 1.7, 0.0};
  cloth.rotation = {{1.0, 0.0, 0.0}, 90.0};
  cloth.pinned.names = {"top", "bottom"};
  const double radius = 0.9 / rows;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < rows; ++j)
      settings.balls.push_back({radius,
                                0.2,
                                {-0.9 + 3.9 * (i + 0.5) / rows, 2.0 + radius + 0.02 * ((i + 2 * j) % 5),
                                 -0.9 + 1.8 * (j + 0.5) / rows},
                                {0.3, -1.0, 0.1 * j},
                                {1.0, 0.0, -3.0}});
  return settings;
}

class BallFacesOnTheDevice : public testing::GlTest {
 protected:
  static void expect_same(const Model& model, std::uint64_t steps, const GpuOptions& options = {}) {
    const auto reference = std::move(*make_reference_solver(model, Precision::single));
    auto made = make_gpu_solver(context(), model, options);
    ASSERT_TRUE(made.ok()) << made.error().message();
    for (const std::uint64_t part : {steps / 3, steps - steps / 3}) {
      ASSERT_FALSE((*reference->advance(part)).divergence.has_value());
      const auto advanced = (*made)->advance(part);
      ASSERT_TRUE(advanced.ok()) << advanced.error().message();
      ASSERT_FALSE(advanced->divergence.has_value());
      ASSERT_EQ(*(*made)->state(), *reference->state());
    }
  }
};

TEST_F(BallFacesOnTheDevice, HaveTheReferencesBitsUnderEveryMethod) {
  for (const Integrator integrator : all_integrators) {
    SCOPED_TRACE(name_of(integrator));
    ModelSettings settings = shower(integrator, 4);
    const std::uint64_t steps = row_of(integrator).traits.long_steps ? 24 : 90;
    expect_same(test::build(settings), steps);
    const State with = test::after(test::build(settings), steps);
    settings.contact.bodies = false;
    EXPECT_FALSE(test::after(test::build(settings), steps) == with) << "no ball meets a face";
  }
}

// More than a particle sorts by itself, by either search.
TEST_F(BallFacesOnTheDevice, HaveThemWithManyBallsOnAFace) {
  for (const BallSearch search : {BallSearch::all_pairs, BallSearch::grid}) {
    GpuOptions options;
    options.ball_search = search;
    expect_same(test::build(shower(Integrator::symplectic_euler, 18)), 60, options);
  }
}

TEST_F(BallFacesOnTheDevice, TakeTheBytesThatWereSaid) {
  const Model model = test::build(shower(Integrator::midpoint, 3));
  const auto solver = test::value_of(make_gpu_solver(context(), model, {}));
  EXPECT_GT(gpu_bytes(model, ForcePath::automatic), 0u);
  EXPECT_GE(solver->bytes(), gpu_bytes(model, ForcePath::automatic));
}

}  // namespace
}  // namespace aspic
