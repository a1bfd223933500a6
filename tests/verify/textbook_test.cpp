#include "verify/textbook.h"

#include <gtest/gtest.h>

#include <cmath>

#include "verify/experiments.h"

namespace aspic::verify {
namespace {

/// Two masses of 1 kg on a spring along x, 10 % stretched.
Model stretched_pair(double damping) {
  Model model = loose_particles({{0.55, 0, 0}, {-0.55, 0, 0}}, {{0, 0, 0}, {0, 0, 0}});
  model.simulation.gravity = {0, 0, 0};
  model.spring_classes.push_back({SpringType::structural, 50.0, damping, 1.0, false});
  model.listed_springs.push_back({0, 1, 0});
  return model;
}

TEST(Textbook, ForceAndEnergyOfOneSpring) {
  const Model model = stretched_pair(3.0);
  State state = initial_state(model, Precision::double_);
  state.velocity[0].x = 2.0;
  const auto f = force(model, motion_of<double>(state));
  EXPECT_NEAR(f[0], -(50.0 * 0.1 + 3.0 * 2.0), 1e-13);
  EXPECT_EQ(f[3], -f[0]);
  EXPECT_NEAR(elastic_energy(model, state), 0.25, 1e-15);
  EXPECT_EQ(elastic_energy(model, state, 1), elastic_energy(model, state));
}

TEST(Textbook, ExactMotionIsTheCosine) {
  const Model model = stretched_pair(0.0);
  const double duration = 0.3;
  const auto end = exact_motion(model, initial_state(model, Precision::double_), duration, 2000);
  EXPECT_NEAR(static_cast<double>(end.x[0] - end.x[3]) - 1.0, 0.1 * std::cos(10.0 * duration), 1e-13);
}

TEST(Textbook, DenseBackwardEulerIsTheResolventOnOneAxis) {
  Model model = stretched_pair(3.0);
  model.simulation.timestep = 0.05;
  const auto v = dense_backward_euler(model, initial_state(model, Precision::double_));
  const double h = 0.05, kappa = 100.0, gamma = 6.0;
  EXPECT_NEAR(v[0] - v[3], -h * kappa * 0.1 / (1 + h * gamma + h * h * kappa), 1e-13);
}

TEST(Textbook, PowerIterationFindsTheOnlyMode) {
  EXPECT_NEAR(power_iteration(stretched_pair(0.0), 3).kappa, 100.0, 1e-12);
}

TEST(Textbook, NoiseIsTheSameEverywhereAndBounded) {
  Noise noise(1);
  double sum = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double x = noise();
    ASSERT_TRUE(x >= -1.0 && x < 1.0);
    sum += x;
  }
  // The mean of 1,000 draws has a standard deviation of 1/√3000: five of those.
  EXPECT_LT(std::abs(sum / 1000), 5 / std::sqrt(3000.0));
}

}  // namespace
}  // namespace aspic::verify
