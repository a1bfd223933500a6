// The scale of colors, set in the section View.
#include <GLFW/glfw3.h>

#include "app/stage.h"

namespace aspic::test {
namespace {

class ScaleRows : public Stage {
 protected:
  std::array<int, 2> window_size() const override { return {1280, 480}; }
  const ViewSettings& view() { return app().scene.scene().view; }
};

TEST_F(ScaleRows, AppearWithAColorThatHasAScale) {
  open("cube-plane", {}, "reference");
  EXPECT_FALSE(has("view.scale.range"));
  click("view.color");
  click("view.color/signed-strain");
  EXPECT_TRUE(has("view.scale.from"));
  EXPECT_TRUE(has("legend"));
  click("view.scale.map");
  click("view.scale.map/heat");
  EXPECT_EQ(view().scale.map, ScaleMap::heat);
  EXPECT_EQ(app().image.legend().map, ScaleMap::heat);
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  EXPECT_EQ(view().scale.map, ScaleMap::automatic);
  EXPECT_EQ(app().image.legend().map, ScaleMap::blue_red);
}

TEST_F(ScaleRows, AnEndStartsAsWhatTheImageHas) {
  open("cube-plane", {"view.color=strain"}, "reference");
  frames(1);
  click("view.scale.to/set");
  EXPECT_EQ(view().scale.to, 0.2);
  click("view.scale.to/set");
  EXPECT_FALSE(view().scale.to.has_value());
}

TEST_F(ScaleRows, ARangeThatFollowsTheImageCanBeKept) {
  // Strained by its own weight from the first step on.
  open("cube-plane", {"view.color=strain", "cube[0].position=[0,1.05,0]"}, "reference");
  click("view.scale.range");
  click("view.scale.range/automatic");
  EXPECT_FALSE(has("view.scale.from"));
  press(GLFW_KEY_SPACE);
  frames_to_step(200);
  press(GLFW_KEY_SPACE);
  frames(2);
  const QuantityRange shown = app().image.range();
  EXPECT_LT(shown[1], 0.2) << "the ends do not follow the image";
  EXPECT_GT(shown[1], shown[0]);
  const Legend legend = app().image.legend();
  click("scale/keep");
  EXPECT_EQ(view().scale.range, ScaleRange::fixed);
  EXPECT_EQ(view().scale.from, shown[0]);
  EXPECT_EQ(view().scale.to, shown[1]);
  frames(1);
  EXPECT_EQ(app().image.range(), shown);
  EXPECT_EQ(app().image.legend().marks[1], legend.marks[1]);
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  EXPECT_EQ(view().scale.range, ScaleRange::automatic);
  EXPECT_FALSE(view().scale.from.has_value());
}

}  // namespace
}  // namespace aspic::test
