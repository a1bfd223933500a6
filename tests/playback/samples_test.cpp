// Points of the plots: in the order of time, whatever the order in which they come.
#include "playback/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "aspic/scene.h"
#include "aspic/solver.h"
#include "support/epsilon.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

TEST(Samples, NextStepIsLaterWithTinyTimeSteps) {
  for (const double h : {1e-19, 1e-21, 1e-38, 1e-300})
    for (const std::uint64_t step : {std::uint64_t{0}, std::uint64_t{7}, std::uint64_t{1} << 53})
      for (const std::uint64_t stride : {1u, 1000u}) EXPECT_GT(next_sample_step(step, h, stride), step) << h;
}

TEST(Samples, AddUpTheWorkOfActuatorsInAnyOrder) {
  const Model model = test::build(load_scene("worm")->model);
  const auto solver = test::solver_for(model);
  ActuatorWork in_order;
  std::vector<EnergySample> samples;
  std::vector<double> expected;
  double largest = 0.0;
  for (std::uint64_t step = 0; step <= 600; step += 20) {
    const State state = step == 0 ? *solver->state() : test::advanced(*solver, 20);
    EnergySample sample = {static_cast<double>(step), measure(model, state), step};
    EXPECT_TRUE(sample.actuators.add(model, state).has_value());
    samples.push_back(sample);
    expected.push_back(*in_order.add(model, state));
    largest = std::max(largest, std::abs(expected.back()));
  }
  EXPECT_GT(largest, 1.0);
  // As they come where jobs overtake one another, some of them twice.
  for (const std::size_t stride : {1u, 7u, 30u}) {
    Samples plot;
    for (std::size_t n = 0; n < samples.size(); ++n) {
      plot.add(samples[(n * stride) % samples.size()]);
      if (n % 3 == 0) plot.add(samples[(n * stride) % samples.size()]);
    }
    ASSERT_EQ(plot.energies().size(), samples.size());
    for (std::size_t n = 0; n < samples.size(); ++n) {
      ASSERT_TRUE(plot.energies()[n].work.has_value());
      EXPECT_NEAR(*plot.energies()[n].work, expected[n], 100 * test::eps * largest) << stride << ", " << n;
    }
  }
}

// What is left out of a long plot takes no work with it.
TEST(Samples, KeepWorkWhereTheyBecomeLessDense) {
  const Model model = test::build(load_scene("worm")->model);
  const auto solver = test::solver_for(model);
  ActuatorWork in_order;
  Samples plot;
  double end = 0.0;
  for (std::uint64_t step = 0; step <= Samples::most_energies; ++step) {
    const State state = step % 100 == 0 ? test::advanced(*solver, 1) : *solver->state();
    EnergySample sample = {static_cast<double>(step), {}, step};
    sample.actuators.add(model, state);
    plot.add(sample);
    end = *in_order.add(model, state);
  }
  EXPECT_LT(plot.energies().size(), Samples::most_energies);
  EXPECT_NEAR(*plot.energies().back().work, end, 1e-9 * std::abs(end));
}

// An hour of a body that hits the ground after 1.28 s, with another peak and a dip late in the run.
TEST(Samples, KeepPeaksAndAllPartsOfALongRun) {
  constexpr std::uint64_t count = 180'000, impact = 64, peak = 100'003, dip = 150'001;
  Samples plot;
  for (std::uint64_t n = 0; n <= count; ++n) {
    EnergySample sample = {0.02 * static_cast<double>(n), {}, n};
    sample.measures.kinetic = n == impact ? 1000.0
                              : n == peak ? 500.0
                                          : 1.0 + 1e-6 * static_cast<double>(n % 7);
    sample.measures.momentum.y = n == dip ? -3.0 : 0.0;
    plot.add(sample);
  }
  const auto& kept = plot.energies();
  EXPECT_LE(kept.size(), Samples::most_energies);
  const auto value = [&](std::uint64_t n) { return plot.nearest(0.02 * static_cast<double>(n))->measures; };
  EXPECT_EQ(value(impact).kinetic, 1000.0);
  EXPECT_EQ(value(peak).kinetic, 500.0);
  EXPECT_EQ(value(dip).momentum.y, -3.0);
  EXPECT_EQ(kept.front().step, 0u);
  EXPECT_EQ(kept.back().step, count);
  double longest = 0.0;
  for (std::size_t n = 1; n < kept.size(); ++n) {
    ASSERT_GT(kept[n].time, kept[n - 1].time);
    longest = std::max(longest, kept[n].time - kept[n - 1].time);
  }
  EXPECT_LE(longest, 20.0) << "parts of the run are missing";
}

TEST(Samples, HaveNoWorkWithoutActuators) {
  const Model model = test::build(load_scene("cube-plane")->model);
  Samples plot;
  for (std::uint64_t step = 0; step < 3; ++step) {
    EnergySample sample = {static_cast<double>(step), {}, step};
    EXPECT_FALSE(sample.actuators.add(model, initial_state(model, Precision::double_)).has_value());
    plot.add(sample);
    EXPECT_FALSE(plot.energies().back().work.has_value());
  }
}

}  // namespace
}  // namespace aspic
