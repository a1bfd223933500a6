// What the View section and its keys change of the image: cut, projection, axes, arrows.
#include <gtest/gtest.h>

#include "app/stage.h"

namespace aspic::test {
namespace {

class Look : public Stage {
 protected:
  const ViewSettings& shown() { return app().scene.scene().view; }
};

TEST_F(Look, XCutsAndUndoMakesWhole) {
  open("cube-plane", {"cube[0].position=[0.0, 1.0, 0.0]"}, "cpu");
  frames(2);
  const Image whole = image();
  press(GLFW_KEY_X);
  frames(2);
  EXPECT_EQ(shown().cut.inside, CutInside::section);
  EXPECT_NE(image().rgb, whole.rgb);
  click("cut/x");
  frames(2);
  EXPECT_EQ(shown().cut.normal, (Vec3{1.0, 0.0, 0.0}));
  press(GLFW_KEY_X);
  frames(2);
  EXPECT_EQ(shown().cut.inside, CutInside::springs);
  press(GLFW_KEY_X);
  frames(2);
  EXPECT_EQ(shown().cut.inside, CutInside::off);
  EXPECT_FALSE(has("cut/x"));
  for (int i = 0; i < 4; ++i) press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(2);
  EXPECT_EQ(shown().cut, CutSettings{});
}

TEST_F(Look, OChangesTheProjectionAndFrameFits) {
  open("cube-plane", {"cube[0].position=[0.0, 1.0, 0.0]"}, "cpu");
  press(GLFW_KEY_O);
  frames(2);
  EXPECT_EQ(app().view.camera.shown().projection, Projection::orthographic);
  press(GLFW_KEY_F);
  frames_to_rest();
  const Camera lens = app().view.lens();
  ASSERT_TRUE(lens.orthographic());
  const glm::mat4 through = lens.projection() * lens.view();
  float widest = 0.0f;
  for (const Vec3& x : simulation().snapshot().position) {
    const glm::vec4 p = through * glm::vec4(to_glm(x), 1.0f);
    widest = std::max({widest, std::abs(p.x), std::abs(p.y)});
  }
  EXPECT_LT(widest, 1.0f);
  EXPECT_GT(widest, 0.5f);
  press(GLFW_KEY_O);
  frames(1);
  EXPECT_EQ(app().view.camera.shown().projection, Projection::perspective);
}

TEST_F(Look, AxesAndArrowsAreByChoice) {
  open("cube-plane", {"cube[0].position=[0.0, 1.0, 0.0]"}, "gpu");
  frames(2);
  EXPECT_FALSE(has("legend/arrows"));
  press(GLFW_KEY_A);
  click("view.arrows/contacts");
  frames(3);
  EXPECT_TRUE(shown().axes);
  EXPECT_TRUE(shown().arrows.contacts);
  EXPECT_TRUE(has("legend/arrows"));
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(2);
  EXPECT_FALSE(has("legend/arrows"));
}

}  // namespace
}  // namespace aspic::test
