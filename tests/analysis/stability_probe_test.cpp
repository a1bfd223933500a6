#include "analysis/stability_probe.h"

#include <gtest/gtest.h>

#include "analysis/stability.h"
#include "cpu_reference/reference_solver.h"
#include "support/integrator_names.h"

namespace aspic {
namespace {

Model small_cube(Integrator integrator) {
  ModelSettings settings;
  settings.cubes.emplace_back().particles_per_edge = 4;
  settings.simulation.integrator = integrator;
  return alone_in_space(build_model(settings).value());
}

Result<std::unique_ptr<Solver>> reference(const Model& model) {
  ASPIC_TRY(auto solver, make_reference_solver(model, Precision::single));
  return std::unique_ptr<Solver>(std::move(solver));
}

class Probe : public testing::TestWithParam<Integrator> {};

// Bisection to 1 %; 480 steps tell growth of 1e-4 a step, which is that of a step less than 1 % too large.
TEST_P(Probe, FindsTheLimitOfTheory) {
  const Model model = small_cube(GetParam());
  const auto limit = stability_limit(model, GetParam());
  ASSERT_TRUE(limit.step && limit.exact);
  const auto found =
      measured_limit(model, probe_start(model), reference, *limit.step / 8, *limit.step * 8, 0.01, 480);
  ASSERT_TRUE(found.ok()) << found.error().message();
  EXPECT_NEAR(*found / *limit.step, 1.0, 0.02);
}

TEST_P(Probe, LightlyDampedToo) {
  const Model model = with_constants(small_cube(GetParam()), 1.0, 0.1, 1e-3);
  const auto limit = stability_limit(model, GetParam());
  ASSERT_TRUE(limit.step);
  for (const auto& [factor, expected] : {std::pair{0.9, false}, std::pair{1.15, true}}) {
    Model probed = model;
    probed.simulation.timestep = factor * *limit.step;
    auto solver = reference(probed);
    ASSERT_TRUE(solver.ok());
    const auto grew = grows(**solver, probe_start(model), 480);
    ASSERT_TRUE(grew.ok());
    EXPECT_EQ(*grew, expected) << factor;
  }
}

INSTANTIATE_TEST_SUITE_P(Explicit, Probe, testing::ValuesIn(explicit_integrators), test::by_integrator);

TEST(ProbeOfImplicitEuler, NeverGrows) {
  Model model = small_cube(Integrator::implicit_euler);
  const ProbeStart start = probe_start(model);
  for (const double h : {1e-3, 1e-2, 0.1, 1.0}) {
    model.simulation.timestep = h;
    auto solver = reference(model);
    ASSERT_TRUE(solver.ok());
    const auto grew = grows(**solver, start, 30);
    ASSERT_TRUE(grew.ok());
    EXPECT_FALSE(*grew) << h;
  }
}

}  // namespace
}  // namespace aspic
