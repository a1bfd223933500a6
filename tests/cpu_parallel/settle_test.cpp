// Bodies that have come to rest.
#include <gtest/gtest.h>

#include <algorithm>

#include "aspic/analysis.h"
#include "cpu_parallel/cpu_solver.h"
#include "support/model_building.h"

namespace aspic {
namespace {

/// Cubes of 4³ particles above each other, alternately turned.
ModelSettings stack(int cubes, double height) {
  ModelSettings settings;
  settings.simulation.integrator = Integrator::symplectic_euler;
  settings.contact.restitution = 0.0;
  settings.terrain.emplace_back().geometry["point"] = Vec3{};
  for (int n = 0; n < cubes; ++n) {
    CubeSettings& cube = settings.cubes.emplace_back();
    cube.particles_per_edge = 4;
    cube.edge_length = 1.2;
    cube.position = {0.0, height + 1.5 * n, 0.0};
    cube.rotation = {{0.0, 1.0, 0.0}, n % 2 == 0 ? 0.0 : 12.0};
  }
  return settings;
}

Measures measures_of(const Solver& solver, const State& state) {
  return measure(solver.model(), state);
}

TEST(Settled, StayAtRestWhenTheTimeStepChanges) {
  ModelSettings settings = stack(3, 0.65);
  const auto solver = std::move(*make_cpu_solver(test::build(settings)));
  ASSERT_FALSE(solver->advance(12000)->divergence.has_value());
  double most = measures_of(*solver, *solver->state()).total();
  for (const double h : {5e-4, 2.5e-4, 1e-3}) {
    settings.simulation.timestep = h;
    ASSERT_TRUE(solver->set_constants(shared(test::build(settings))).ok());
    for (int n = 0; n < 10; ++n) {
      ASSERT_FALSE(solver->advance(20)->divergence.has_value());
      const Measures now = measures_of(*solver, *solver->state());
      EXPECT_LT(now.max_speed, 1e-3) << h;
      EXPECT_LT(now.total(), most + 1e-6 * most) << h;
    }
  }
}

TEST(Settled, KeepTheSameEnergyWhateverTheDrop) {
  double elastic = 0.0;
  for (const double height : {0.7, 3.0, 10.0, 30.0}) {
    const auto solver = std::move(*make_cpu_solver(test::build(stack(1, height))));
    ASSERT_FALSE(solver->advance(20000)->divergence.has_value());
    const Measures now = measures_of(*solver, *solver->state());
    if (elastic == 0.0) elastic = now.elastic;
    EXPECT_NEAR(now.elastic, elastic, 0.003 * elastic) << height;
    EXPECT_LT(now.max_speed, 1e-3) << height;
  }
}

}  // namespace
}  // namespace aspic
