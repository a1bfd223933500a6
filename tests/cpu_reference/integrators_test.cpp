#include "cpu_reference/integrators.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "cpu_reference/all_forces.h"
#include "cpu_reference/phase.h"
#include "model/integrator.h"
#include "support/integrator_names.h"
#include "support/model_building.h"

namespace aspic::reference {
namespace {

class EveryMethod : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Explicit, EveryMethod, testing::ValuesIn(explicit_integrators), test::by_integrator);

// Free fall: v_n = v_0 + n·h·g for all; the position sums depend on which velocity a method moves with.
TEST_P(EveryMethod, FreeFallFollowsItsOwnRecurrence) {
  const Model model = test::particles({{1, 2, 3}}, {{0.5, 4, -1}});
  const Dynamics<double> constants(model);
  const test::AllForces dynamics(constants);
  const double h = 0.001, g = -9.8;
  Phase<double> s = start_of(model);
  const int n = 1000;
  for (int step = 0; step < n; ++step) s = explicit_step(GetParam(), dynamics, s, h);
  // A step adds h·v + h²·g·(what the velocities that move it are ahead of v, in steps) to y.
  const double lead = free_fall_lead(GetParam());
  const double g_terms = n * (n - 1) / 2.0 + n * lead;  // y_n = y_0 + n·h·v_0 + h²·g·(this)
  const double eps = n * 2.3e-16 * 10.0;                // a rounding per step of numbers up to 10
  EXPECT_NEAR(s.x(1, 0), 2.0 + n * h * 4.0 + h * h * g * g_terms, eps);
  EXPECT_NEAR(s.v(1, 0), 4.0 + n * h * g, eps);
  EXPECT_NEAR(s.x(0, 0), 1.0 + n * h * 0.5, eps);
}

// Textbook functions and the stage table (which the kernels execute) are two statements of the same methods.
TEST_P(EveryMethod, EqualsTheStageTableToTheBit) {
  ModelSettings settings = test::cube_on_plane(4);
  settings.cubes[0].velocity = {1.0, -2.0, 0.3};
  const Model model = test::build(settings);
  const Dynamics<double> constants(model);
  const test::AllForces dynamics(constants);
  const Staged& method = *row_of(GetParam()).staged();
  const double h = 0.002;
  Phase<double> by_name = start_of(model), by_table = by_name;
  by_name.v(0, 5) = by_table.v(0, 5) = 3.0;
  for (int step = 0; step < 20; ++step) {
    by_name = explicit_step(GetParam(), dynamics, by_name, h);
    Phase<double> at = by_table, sum;
    for (const Stage& stage : method.stages) {
      const Field<double> a = dynamics.acceleration(at.x, at.v), slope_x = at.v;
      if (stage.weight != 0.0) {
        const bool first = sum.x.size() == 0;
        sum.x = first ? Field<double>(stage.weight * slope_x) : Field<double>(sum.x + stage.weight * slope_x);
        sum.v = first ? Field<double>(stage.weight * a) : Field<double>(sum.v + stage.weight * a);
      }
      const Field<double> next_v = by_table.v + (h * stage.advance) * a;
      const bool mean = method.drift == Drift::mean_velocity;
      const Field<double> moves = mean ? Field<double>(0.5 * (slope_x + next_v)) : slope_x;
      at = {by_table.x + (h * stage.advance) * moves, next_v};
    }
    const double scale = h / method.divisor;
    const Field<double> v = by_table.v + scale * sum.v;
    const Field<double> x = by_table.x + scale * (method.drift == Drift::new_velocity ? v : sum.x);
    by_table = {x, v};
    EXPECT_TRUE((by_name.x.array() == by_table.x.array()).all());
    EXPECT_TRUE((by_name.v.array() == by_table.v.array()).all());
  }
}

// Order of convergence by halving h on a smooth free spring system: 2³ cube, edge 1, k = 20, c = 0.2, T = 0.4
// s, against a fine runge-kutta-4 solution. Last halving whose finer error is above 1e-12.
TEST_P(EveryMethod, ConvergesWithItsOrder) {
  ModelSettings settings;
  CubeSettings cube;
  cube.particles_per_edge = 2;
  cube.edge_length = 1.0;
  cube.structural = cube.shear = {20.0, 0.2};
  settings.cubes.push_back(cube);
  const Model model = test::build(settings);
  const Dynamics<double> constants(model);
  const test::AllForces dynamics(constants);
  const auto solve = [&](Integrator method, double h) {
    Phase<double> s = start_of(model);
    for (Eigen::Index i = 0; i < 8; ++i)
      s.v.col(i) = Vector<double>(0.3 * static_cast<double>(i % 3), -0.2 * static_cast<double>(i % 2),
                                  0.1 * static_cast<double>(i));
    const auto steps = std::lround(0.4 / h);
    for (long n = 0; n < steps; ++n) s = explicit_step(method, dynamics, s, h);
    return s;
  };
  const Phase<double> exact = solve(Integrator::runge_kutta_4, 0.4 / 20000);
  double order = 0.0, coarse = 0.0;
  for (int halvings = 0; halvings < 8; ++halvings) {
    const double h = std::ldexp(0.004, -halvings);
    const Phase<double> s = solve(GetParam(), h);
    const double error =
        std::max((s.x - exact.x).cwiseAbs().maxCoeff(), (s.v - exact.v).cwiseAbs().maxCoeff());
    if (error <= 1e-12) break;
    if (coarse > 0.0) order = std::log2(coarse / error);
    coarse = error;
  }
  EXPECT_NEAR(order, row_of(GetParam()).order, 0.05);
}

}  // namespace
}  // namespace aspic::reference
