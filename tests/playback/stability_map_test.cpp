#include "playback/stability_map.h"

#include <gtest/gtest.h>

#include <thread>

#include "aspic/scene.h"

namespace aspic::test {
namespace {

/// The map of a scene once all of it is measured.
void measure(StabilityMap& map, const Scene& scene) {
  map.update(scene);
  while (map.busy()) std::this_thread::yield();
  map.update(scene);
}

TEST(StabilityMap, EdgeIsWhereTheoryHasIt) {
  const Scene scene =
      load_scene("cube-plane", std::vector<std::string>{"cube[0].particles-per-edge=4"}).value();
  StabilityMap map;
  measure(map, scene);
  ASSERT_NE(map.cells(), nullptr);
  const StabilityCells& cells = *map.cells();
  const double cell = cells.steps[1] / cells.steps[0];
  for (std::size_t row = 0; row < cells.stiffness.size(); ++row) {
    const double limit = cells.limit[row];
    for (std::size_t column = 0; column < cells.steps.size(); ++column) {
      const double h = cells.steps[column];
      if (h * cell >= limit && h <= limit * cell) continue;
      EXPECT_EQ(cells.cells[row * cells.steps.size() + column],
                h < limit ? Stability::stable : Stability::unstable)
          << cells.stiffness[row] << " N/m, " << h << " s";
    }
  }
  EXPECT_TRUE(cells.cell_at(map.step(), map.stiffness()).has_value());
}

TEST(StabilityMap, StaysWhileTheSceneMovesOnIt) {
  Scene scene = load_scene("cube-plane", std::vector<std::string>{"cube[0].particles-per-edge=3"}).value();
  StabilityMap map;
  measure(map, scene);
  const std::vector<double> before = map.cells()->steps;
  scene.model.simulation.timestep = 0.0015;
  scene.model.terrain.clear();
  map.update(scene);
  EXPECT_FALSE(map.busy()) << "only the dot moves";
  EXPECT_EQ(map.step(), 0.0015);
  EXPECT_EQ(map.cells()->steps, before);
  scene.model.simulation.integrator = Integrator::implicit_euler;
  measure(map, scene);
  for (std::size_t i = 0; i < map.cells()->cells.size(); ++i)
    EXPECT_EQ(map.cells()->cells[i], Stability::stable)
        << map.cells()->steps[i % map.cells()->steps.size()] << " s, "
        << map.cells()->stiffness[i / map.cells()->steps.size()] << " N/m";
}

TEST(StabilityMap, IsNotThereWithoutSprings) {
  StabilityMap map;
  measure(map, load_scene("ball-pit").value());
  EXPECT_EQ(map.cells(), nullptr);
}

}  // namespace
}  // namespace aspic::test
