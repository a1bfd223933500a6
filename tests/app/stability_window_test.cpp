#include <gmock/gmock.h>

#include <thread>

#include "analysis/stability.h"
#include "app/stability_map.h"
#include "app/stage.h"
#include "aspic/scene.h"

namespace aspic::test {
namespace {

/// The map of a scene once all of it is measured.
void measure(app::StabilityMap& map, const Scene& scene) {
  map.update(scene);
  while (map.busy()) std::this_thread::yield();
  map.update(scene);
}

class StabilityWindow : public Stage {
 protected:
  std::array<int, 2> window_size() const override { return roomy; }
  static app::KeptState only_the_map() {
    app::KeptState kept;
    for (const char* name : {"Scene", "Simulation", "View", "Performance", "Energy"})
      kept.layout.sections[name] = false;
    kept.layout.sections["Stability"] = true;
    return kept;
  }
  const ModelSettings& settings() { return app().scene.scene().model; }
};

TEST(StabilityMap, EdgeIsWhereTheoryHasIt) {
  const Scene scene =
      load_scene("cube-plane", std::vector<std::string>{"cube[0].particles-per-edge=4"}).value();
  app::StabilityMap map;
  measure(map, scene);
  ASSERT_NE(map.cells(), nullptr);
  const app::StabilityCells& cells = *map.cells();
  const double cell = cells.steps[1] / cells.steps[0];
  for (std::size_t row = 0; row < cells.stiffness.size(); ++row) {
    const double limit = cells.limit[row];
    for (std::size_t column = 0; column < cells.steps.size(); ++column) {
      const double h = cells.steps[column];
      if (h * cell >= limit && h <= limit * cell) continue;
      EXPECT_EQ(cells.cells[row * cells.steps.size() + column],
                h < limit ? app::Stability::stable : app::Stability::unstable)
          << cells.stiffness[row] << " N/m, " << h << " s";
    }
  }
  EXPECT_TRUE(cells.cell_at(map.step(), map.stiffness()).has_value());
}

TEST(StabilityMap, StaysWhileTheSceneMovesOnIt) {
  Scene scene = load_scene("cube-plane", std::vector<std::string>{"cube[0].particles-per-edge=3"}).value();
  app::StabilityMap map;
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
    EXPECT_EQ(map.cells()->cells[i], app::Stability::stable)
        << map.cells()->steps[i % map.cells()->steps.size()] << " s, "
        << map.cells()->stiffness[i / map.cells()->steps.size()] << " N/m";
}

TEST(StabilityMap, IsNotThereWithoutSprings) {
  app::StabilityMap map;
  measure(map, load_scene("ball-pit").value());
  EXPECT_EQ(map.cells(), nullptr);
}

TEST_F(StabilityWindow, AClickSetsTimeStepAndStiffness) {
  open("cube-plane", {"cube[0].particles-per-edge=3"}, "reference", only_the_map());
  frames_until([&] { return has("stability/map") && !has("stability/measuring"); });
  EXPECT_THAT(explanations().at("stability/map"), testing::HasSubstr("the dot is where the scene is"));
  const auto box = widgets().at("stability/map");
  const auto click_at = [&](double x, double y) {
    drag(GLFW_MOUSE_BUTTON_LEFT, box.left + x * (box.right - box.left),
         box.bottom - y * (box.bottom - box.top), 0, 0);
    frames(2);
  };
  click_at(0.1, 0.9);
  EXPECT_LT(settings().simulation.timestep, 0.001);
  EXPECT_GT(settings().cubes[0].structural.stiffness, 8000.0);
  EXPECT_EQ(settings().cubes[0].shear.stiffness, settings().cubes[0].structural.stiffness);
  EXPECT_EQ(simulation().model().simulation.timestep, settings().simulation.timestep);
  click_at(0.9, 0.1);
  EXPECT_GT(settings().simulation.timestep, 0.003);
  EXPECT_LT(settings().cubes[0].structural.stiffness, 500.0);
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(1);
  EXPECT_GT(settings().cubes[0].structural.stiffness, 8000.0) << "one change for undo";
}

}  // namespace
}  // namespace aspic::test
