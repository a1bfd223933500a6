// Bodies of any size: lengths times L, Young's modulus times L and times multiplied by the root of L give the
// same motion, where contact.distance goes with the lengths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cpu_reference/reference_solver.h"
#include "support/model_building.h"

namespace aspic {
namespace {

/// Lowest particle [L] at ten times of the fall of a cube of 5³, its edge L, from 1.5 L above the ground.
std::vector<double> heights(double L) {
  ModelSettings settings = test::cube_on_plane(5, 2.0 * L);
  CubeSettings& cube = settings.cubes[0];
  cube.edge_length = L;
  cube.material = MaterialSettings{1000.0, 1e7 * L, 0.1, {}};
  settings.terrain[0].geometry["point"] = Vec3{};
  settings.contact.distance = settings.contact.resting_speed = 0.02 * L / 4.0;
  settings.simulation.integrator = Integrator::symplectic_euler;
  settings.simulation.timestep = 3e-4 * std::sqrt(L);
  const Model model = test::build(settings);
  // Bounces magnify the rounding of single precision beyond the bound.
  const auto solver = std::move(*make_reference_solver(model, Precision::double_));
  std::vector<double> all;
  for (int n = 0; n < 10; ++n) {
    EXPECT_FALSE((*solver->advance(1000)).divergence.has_value());
    const State state = *solver->state();
    all.push_back(std::ranges::min(state.position, {}, &Vec3::y).y / L);
  }
  return all;
}

TEST(Scale, MovesAlikeInEverySize) {
  const std::vector<double> meter = heights(1.0);
  EXPECT_GT(meter[0], 0.0);
  for (const double L : {0.1, 0.01, 0.001}) {
    const std::vector<double> small = heights(L);
    for (std::size_t n = 0; n < meter.size(); ++n) EXPECT_NEAR(small[n], meter[n], 1e-4) << L << ' ' << n;
    EXPECT_NEAR(small.back(), 0.0, 0.02 / 4.0) << "it hovers";
  }
}

}  // namespace
}  // namespace aspic
