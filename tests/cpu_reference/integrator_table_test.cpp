// What every row of the integrator table claims, against the solver and against its own step matrix. A new
// row fails here where its order, step matrix, stages or limit are wrong.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <string_view>

#include "analysis/amplification.h"
#include "aspic/state.h"
#include "cpu_reference/reference_solver.h"
#include "model/integrator.h"
#include "support/epsilon.h"
#include "support/integrator_names.h"
#include "support/model_building.h"

namespace aspic {
namespace {

using test::eps;

class IntegratorTable : public testing::TestWithParam<Integrator> {
 protected:
  static const IntegratorRow& row() { return row_of(GetParam()); }

  static std::unique_ptr<Solver> solver_for(const Model& model) {
    auto solver = make_reference_solver(model, Precision::double_);
    EXPECT_TRUE(solver.ok());
    return std::move(solver).value();
  }
};
INSTANTIATE_TEST_SUITE_P(Every, IntegratorTable, testing::ValuesIn(all_integrators), test::by_integrator);

TEST(IntegratorNames, AreUnique) {
  std::set<std::string_view> names, titles;
  for (const IntegratorRow& row : integrator_table) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_TRUE(titles.insert(row.title).second) << row.title;
  }
}

TEST_P(IntegratorTable, RowIsComplete) {
  EXPECT_EQ(row().integrator, GetParam());
  EXPECT_EQ(row().name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string_view::npos);
  EXPECT_FALSE(row().name.empty() || row().title.empty() || row().source.empty() || row().formula.empty());
  EXPECT_GE(row().order, 1);
  ASSERT_NE(row().step_matrix, nullptr);
  EXPECT_GT(row().traits.nominal_step, 0.0);
  const Staged* const staged = row().staged();
  if (!staged) return;
  double weights = 0.0;
  for (const Stage& stage : staged->stages) {
    weights += stage.weight;
    EXPECT_EQ(stage.weight, std::round(stage.weight)) << "not exact in every precision";
  }
  EXPECT_EQ(weights, staged->divisor);
  EXPECT_NE(staged->stages.back().weight, 0.0) << "the last stage is evaluated for nothing";
  EXPECT_TRUE(staged->mode_limit || staged->drift == Drift::stage_velocity)
      << "only Runge-Kutta methods have a polynomial from which their limit follows";
}

// A particle on a spring of rest length 0, held to a line: q̈ = −κq − γq̇ but for rounding.
TEST_P(IntegratorTable, StepMatrixIsOneStepOfTheSolver) {
  constexpr double kappa = 30.0;
  for (const double gamma : {0.0, 4.0, 20.0}) {
    for (const double h : {0.002, 0.02, 0.05}) {
      for (const auto& [q, rate] : {std::pair{1.0, 0.0}, std::pair{0.5, 1.5}, std::pair{-1.0, 2.0}}) {
        Model model = test::particles({{q, 0, 0}}, {{rate, 0, 0}});
        model.simulation.gravity = {};
        model.simulation.timestep = h;
        model.simulation.integrator = GetParam();
        model.simulation.implicit.tolerance = 1e-15;
        auto solver = solver_for(model);
        ASSERT_TRUE(solver->set_inputs({{Pull{0, {}, kappa, gamma}}}).ok());
        ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
        const State end = *solver->state();
        const StepMatrix m = row().step_matrix(h, kappa, gamma);
        // Numbers up to κ·h and γ·h·q̇, a few roundings each.
        const double bound = 64 * eps * 4.0;
        EXPECT_NEAR(end.position[0].x, static_cast<double>(m[0] * q + m[1] * rate), bound)
            << gamma << ' ' << h;
        EXPECT_NEAR(end.velocity[0].x, static_cast<double>(m[2] * q + m[3] * rate), bound)
            << gamma << ' ' << h;
      }
    }
  }
}

/// exp(h·A) by its series, for q̈ = −κq − γq̇.
StepMatrix exact_flow(long double h, long double kappa, long double gamma) {
  StepMatrix sum = {1, 0, 0, 1}, term = sum;
  for (int n = 1; n < 30; ++n) {
    // term·Z/n with Z = (0, h; −hκ, −hγ)
    term = {term[1] * -h * kappa / n, (term[0] * h - term[1] * h * gamma) / n, term[3] * -h * kappa / n,
            (term[2] * h - term[3] * h * gamma) / n};
    for (std::size_t i = 0; i < 4; ++i) sum[i] += term[i];
  }
  return sum;
}

TEST_P(IntegratorTable, StepMatrixIsExactToTheRowsOrder) {
  constexpr long double kappa = 1, gamma = 0.5L;
  const auto error = [&](long double h) {
    const StepMatrix made = row().step_matrix(h, kappa, gamma), exact = exact_flow(h, kappa, gamma);
    long double largest = 0;
    for (std::size_t i = 0; i < 4; ++i) largest = std::max(largest, std::abs(made[i] - exact[i]));
    return largest;
  };
  // A step of order p errs by h^(p+1), and by terms of the next order: h = 1/128 of them.
  EXPECT_NEAR(static_cast<double>(std::log2(error(1 / 128.0L) / error(1 / 256.0L))), row().order + 1, 0.05);
}

double spectral_radius(const StepMatrix& m) {
  const long double half_trace = (m[0] + m[3]) / 2, determinant = m[0] * m[3] - m[1] * m[2];
  const long double square = half_trace * half_trace - determinant;
  return static_cast<double>(square > 0 ? std::abs(half_trace) + std::sqrt(square) : std::sqrt(determinant));
}

TEST_P(IntegratorTable, SpectralRadiusPassesOneAtTheLimit) {
  // Where the two eigenvalues meet, a rounding moves them by its square root.
  const double rounding = 4 * std::sqrt(static_cast<double>(std::numeric_limits<long double>::epsilon()));
  for (const double kappa : {0.0, 1.0, 1e4}) {
    for (const double ratio : {0.0, 0.1, 0.5, 0.6, 1.0, 1.1, 1.2, 1.5, 1.9, 2.1, 5.0, 40.0}) {
      const double scale = kappa > 0.0 ? std::sqrt(kappa) : 1.0, gamma = ratio * scale;
      const auto radius = [&](double h) { return spectral_radius(row().step_matrix(h, kappa, gamma)); };
      const auto limit = mode_limit(GetParam(), kappa, gamma);
      const testing::ScopedTrace at(__FILE__, __LINE__,
                                    "kappa " + std::to_string(kappa) + ", gamma " + std::to_string(gamma));
      if (!limit) {
        EXPECT_GT(radius(0.1 / scale), 1.0 + rounding);
      } else if (kappa + gamma > 0.0) {
        const double last = std::isinf(*limit) ? 1e3 / scale : *limit * (1 - 1e-9);
        for (int i = 1; i <= 1000; ++i) ASSERT_LE(radius(last * i / 1000), 1.0 + rounding) << last * i / 1000;
        if (std::isfinite(*limit)) {
          EXPECT_GT(radius(1.001 * *limit), 1.0 + rounding) << *limit;
        }
      }
    }
  }
}

TEST_P(IntegratorTable, ReportsSolvesWhereItsRowSaysSo) {
  Model model = test::particles({{0, 0, 0}}, {{0, 1, 0}});
  model.simulation.integrator = GetParam();
  const auto solver = solver_for(model);
  ASSERT_FALSE((*solver->advance(2)).divergence.has_value());
  const auto solves = solver->solve_statistics();
  ASSERT_EQ(solves.has_value(), row().traits.reports_solves);
  EXPECT_EQ(solves ? solves->steps : 2, 2u);
}

// Two particles on a damped spring that turns: both forces lie on the line between them.
TEST_P(IntegratorTable, KeepsAngularMomentumExactlyWhereItsRowSaysSo) {
  Model model = test::particles({{0.55, 0, 0}, {-0.55, 0, 0}}, {{0, 1, 0}, {0, -1, 0}});
  model.simulation.gravity = {};
  model.simulation.timestep = 0.02;  // a fifth of 1/ω, ω² = 2k/m
  model.simulation.integrator = GetParam();
  model.simulation.implicit.tolerance = 1e-15;
  model.spring_classes.push_back({SpringType::structural, 50.0, 0.5, 1.0, false});
  model.listed_springs.push_back({0, 1, 0});
  auto solver = solver_for(model);
  ASSERT_FALSE((*solver->advance(200)).divergence.has_value());
  const State end = *solver->state();
  const double change =
      cross(end.position[0], end.velocity[0]).z + cross(end.position[1], end.velocity[1]).z - 1.1;
  if (row().traits.keeps_angular_momentum) {
    EXPECT_LE(std::abs(change), 200 * 16 * eps);
  } else {
    EXPECT_GE(std::abs(change), 1e-9);
  }
}

}  // namespace
}  // namespace aspic
