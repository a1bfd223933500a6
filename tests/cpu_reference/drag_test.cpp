// Linear drag on particles and balls: the terminal velocity, its energy and its stable steps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>

#include "aspic/analysis.h"
#include "cpu_reference/reference_solver.h"
#include "model/integrator.h"
#include "support/model_building.h"

namespace aspic {
namespace {

/// A cube and a ball in free fall with drag γ [1/s].
ModelSettings falling(double drag, Integrator integrator) {
  ModelSettings settings = test::cube_on_plane(3, 0.0);
  settings.terrain.clear();
  settings.balls.push_back({0.3, 2.0, {9.0, 0.0, 0.0}, {1.0, 4.0, 0.0}, {}});
  settings.simulation.drag = drag;
  settings.simulation.integrator = integrator;
  settings.simulation.implicit.tolerance = 1e-12;
  return settings;
}

TEST(Drag, LeadsToTheTerminalVelocityUnderEveryMethod) {
  for (const Integrator integrator : all_integrators) {
    const Model model = test::build(falling(20.0, integrator));
    const auto solver = std::move(*make_reference_solver(model, Precision::double_));
    ASSERT_TRUE(solver->advance(2000).ok());
    const State end = *solver->state();
    for (const Vec3& v : end.velocity) EXPECT_NEAR(v.y, -9.8 / 20.0, 1e-8) << name_of(integrator);
    EXPECT_NEAR(end.ball_velocity[0].y, -9.8 / 20.0, 1e-8) << name_of(integrator);
    EXPECT_NEAR(end.ball_velocity[0].x, 0.0, 1e-8) << name_of(integrator);
  }
}

TEST(Drag, DissipatesTheEnergyThatIsLost) {
  ModelSettings settings = falling(0.0, Integrator::runge_kutta_4);
  test::resist(settings, 0.5);
  const Model model = test::build(settings);
  const auto solver = std::move(*make_reference_solver(model, Precision::double_));
  const Measures start = measure(model, *solver->state());
  double dissipated = 0.0, before = *start.drag_power;
  for (int step = 0; step < 1000; ++step) {
    ASSERT_TRUE(solver->advance(1).ok());
    const double now = *measure(model, *solver->state()).drag_power;
    dissipated += 0.5 * model.simulation.timestep * (before + now);
    before = now;
  }
  const double lost = start.total() - measure(model, *solver->state()).total();
  EXPECT_GT(lost, 100.0);
  // Pulls and drag on balls are those of a step's start, so that theirs is an error of first order.
  EXPECT_NEAR(dissipated, lost, 1e-3 * lost);
  EXPECT_FALSE(measure(test::build(falling(0.0, Integrator::midpoint)), *solver->state()).drag_power);
}

TEST(Drag, IsFiniteAndNotNegative) {
  for (const auto& row : resistance_constants)
    for (const double bad : {-1.0, 1e39, std::numeric_limits<double>::quiet_NaN()}) {
      ModelSettings settings = falling(0.0, Integrator::midpoint);
      settings.simulation.*row.value = bad;
      const auto model = build_model(settings);
      ASSERT_FALSE(model.ok()) << row.name << ' ' << bad;
      EXPECT_NE(model.error().what.find(fmt::format("simulation.{} ", row.name)), std::string::npos);
    }
}

TEST(Drag, LimitsTheStableStep) {
  ModelSettings settings = falling(0.0, Integrator::explicit_euler);
  settings.cubes[0].structural = settings.cubes[0].shear = settings.cubes[0].bending = {0.0, 0.0};
  settings.simulation.drag = 500.0;
  const Integrator methods[] = {Integrator::explicit_euler, Integrator::symplectic_euler};
  for (const StabilityLimit& limit :
       stability_limits(test::build(settings), methods, StabilityEffort::thorough))
    EXPECT_NEAR(*limit.step, 2.0 / 500.0, 1e-9);
  ModelSettings jelly = falling(0.0, Integrator::explicit_euler);
  const auto limit = [&] {
    return *stability_limits(test::build(jelly), methods, StabilityEffort::thorough)[1].step;
  };
  const double without = limit();
  jelly.simulation.drag = 100.0;
  EXPECT_LT(limit(), without);
  EXPECT_GT(limit(), 0.8 * without);
}

}  // namespace
}  // namespace aspic
