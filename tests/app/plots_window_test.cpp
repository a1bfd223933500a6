// The plots of energy and momentum in the real window.
#include <cmath>
#include <map>

#include "app/stage.h"

namespace aspic::test {
namespace {

class Plots : public Stage {};

TEST_F(Plots, AClickInThePlotGoesToThatMoment) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, "reference");
  simulation().set_running(true);
  frames_to_step(400);
  simulation().set_running(false);
  ASSERT_TRUE(simulation().settle().ok());
  frames(4);
  click("section/Scene");
  const app::Box plot = widgets().at("energy/plot");
  const auto& energies = simulation().samples().energies();
  const double span = energies.back().time - energies.front().time;
  click("energy/plot");
  ASSERT_TRUE(simulation().settle().ok());
  EXPECT_NEAR(simulation().time(), energies.front().time + 0.5 * span, 0.02 * span);
  EXPECT_LT(plot.top, plot.bottom);
  EXPECT_FALSE(simulation().running());
}

TEST_F(Plots, ActuatorsHaveACurveOfTheirWork) {
  open("worm", {}, "reference");
  simulation().set_running(true);
  frames_to_step(300);
  simulation().set_running(false);
  ASSERT_TRUE(simulation().settle().ok());
  frames(2);
  EXPECT_TRUE(has("energy/plot/total"));
  EXPECT_TRUE(has("energy/plot/actuator work"));
  const auto& energies = simulation().samples().energies();
  EXPECT_EQ(energies.front().work, 0.0);
  EXPECT_GT(std::abs(energies.back().work.value_or(0.0)), 1.0);
  close();
  open("cube-plane", {}, "reference");
  frames(2);
  EXPECT_TRUE(has("energy/plot/total"));
  EXPECT_FALSE(has("energy/plot/actuator work"));
}

TEST_F(Plots, PlotsOfTwoRunsHaveTheSamePoints) {
  const auto times = [&](const char* backend) {
    open("cube-plane", {"cube[0].position=[0,1.2,0]", "cube[0].particles-per-edge=5"}, backend);
    simulation().set_running(true);
    frames_to_step(205);
    std::vector<std::pair<std::uint64_t, double>> points;
    for (const auto& sample : simulation().samples().energies())
      if (sample.step <= 200) points.emplace_back(sample.step, sample.measures.total());
    close();
    return points;
  };
  const auto first = times("reference");
  EXPECT_EQ(first.size(), 11u) << "one for every twenty steps of a millisecond";
  EXPECT_EQ(first, times("reference"));
}

// Where reading states back takes long some points are left out, never moved.
TEST_F(Plots, PlotsOfTheDeviceHaveNoOtherPoints) {
  std::map<std::uint64_t, double> known;
  for (int run = 0; run < 2; ++run) {
    open("cube-plane", {"cube[0].position=[0,1.2,0]", "cube[0].particles-per-edge=5"}, "gpu");
    simulation().set_running(true);
    frames_to_step(403);
    std::size_t points = 0;
    for (const auto& sample : simulation().samples().energies()) {
      if (sample.step > 400) continue;
      ++points;
      EXPECT_EQ(sample.step % 20, 0u);
      const auto [before, is_new] = known.try_emplace(sample.step, sample.measures.total());
      EXPECT_EQ(before->second, sample.measures.total()) << "step " << sample.step;
    }
    EXPECT_GE(points, 3u);
    close();
  }
}

}  // namespace
}  // namespace aspic::test
