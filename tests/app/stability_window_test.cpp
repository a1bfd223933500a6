#include <gmock/gmock.h>

#include "app/stage.h"
#include "aspic/scene.h"

namespace aspic::test {
namespace {

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

TEST_F(StabilityWindow, AnotherWindowMeasuresAMapOfItsOwn) {
  open("cube-plane", {"cube[0].particles-per-edge=3"}, "reference", only_the_map());
  frames_until([&] { return app().stability.cells() != nullptr; });
  app::KeptState closed = only_the_map();
  closed.layout.sections["Stability"] = false;
  open("cube-plane", {"cube[0].particles-per-edge=3"}, "reference", closed);
  EXPECT_EQ(app().stability.cells(), nullptr);
}

TEST_F(StabilityWindow, AClickSetsTimeStepAndStiffness) {
  open("cube-plane", {"cube[0].particles-per-edge=3"}, "reference", only_the_map());
  frames_until([&] { return has("stability/map") && !has("stability/measuring"); });
  EXPECT_THAT(explanations().at("stability/map"), testing::HasSubstr("Dot: the scene"));
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
