#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <set>

#include "app/stage.h"
#include "aspic/scene.h"
#include "io/atomic_file.h"
#include "render/camera.h"
#include "support/projection.h"

namespace aspic::test {
namespace {

class AppWindow : public Stage {};

/// How many different colors the scene's part of the image has, at most `most`.
std::size_t colors(const std::vector<unsigned char>& rgb, std::size_t most) {
  std::set<std::array<unsigned char, 3>> seen;
  for (std::size_t i = 0; i + 2 < rgb.size() && seen.size() < most; i += 3)
    seen.insert({rgb[i], rgb[i + 1], rgb[i + 2]});
  return seen.size();
}

TEST_F(AppWindow, EveryBuiltInSceneOpensAndDraws) {
  open("cube-plane");
  std::vector<unsigned char> before;
  for (const BuiltinScene& scene : list_builtin_scenes()) {
    EXPECT_EQ(app().scene.editor().source(), scene.name);
    EXPECT_FALSE(app().messages.notice() && app().messages.notice()->is_error)
        << app().messages.notice()->text;
    frames(2);
    const auto now = pixels();
    // Panels alone have a few dozen; sky, ground and jelly have thousands.
    EXPECT_GE(colors(now, 2000), 2000u) << scene.name;
    EXPECT_NE(now, before) << scene.name;
    before = now;
    type(U']');
  }
  EXPECT_EQ(app().scene.editor().source(), "cube-plane") << "the list of scenes goes round";
  type(U'[');
  EXPECT_EQ(app().scene.editor().source(), list_builtin_scenes().back().name);
}

TEST_F(AppWindow, SpaceRunsAndPausesAndTheReferencesBitsCome) {
  open("cube-plane", {}, "reference");
  press(GLFW_KEY_SPACE);
  EXPECT_TRUE(simulation().running());
  frames_to_step(100);
  press(GLFW_KEY_SPACE);
  EXPECT_FALSE(simulation().running());
  ASSERT_TRUE(simulation().settle().ok());
  const std::uint64_t paused_at = simulation().step();
  frames(5);
  EXPECT_EQ(simulation().step(), paused_at);
  type(U'.');
  EXPECT_EQ(simulation().step(), paused_at + 1);
  EXPECT_EQ(state_hash_text(simulation().snapshot()),
            reference_hash(app().scene.editor().scene(), paused_at + 1));
  press(GLFW_KEY_R);
  EXPECT_EQ(simulation().step(), 0u);
  EXPECT_EQ(state_hash_text(simulation().snapshot()), reference_hash(app().scene.editor().scene(), 0));
}

TEST_F(AppWindow, TwentyChangesOfBackendLeaveTheBitsAsTheyWere) {
  open("cube-plane", {"cube[0].position=[0,2,0]", "simulation.steps-per-frame=3"}, "reference");
  type(U'.');
  press(GLFW_KEY_SPACE);
  for (int i = 0; i < 20; ++i) {
    const std::uint64_t before = simulation().step();
    const BackendRow& next = next_backend(simulation().present().backend());
    press(GLFW_KEY_G);
    EXPECT_TRUE(simulation().running()) << "a change of backend does not pause";
    EXPECT_EQ(simulation().present().backend().name, next.name);
    frames_to_step(before + 10);
  }
  press(GLFW_KEY_SPACE);
  ASSERT_TRUE(simulation().settle().ok());
  EXPECT_GE(simulation().step(), 200u);
  EXPECT_EQ(state_hash_text(simulation().snapshot()),
            reference_hash(app().scene.editor().scene(), simulation().step()));
}

TEST_F(AppWindow, GpuDrawsItsOwnParticlesAndStepsSingly) {
  open("cube-plane", {}, "gpu");
  EXPECT_TRUE(simulation().present().device_state().has_value()) << "drawn without a copy";
  for (int i = 0; i < 7; ++i) type(U'.');
  EXPECT_EQ(simulation().step(), 7u);
  EXPECT_EQ(state_hash_text(simulation().snapshot()), reference_hash(app().scene.editor().scene(), 7));
  press(GLFW_KEY_SPACE);
  frames_to_step(50);
  const auto moving = pixels();
  frames(3);
  EXPECT_NE(pixels(), moving);
}

TEST_F(AppWindow, MouseTurnsMovesAndZoomsAndHomeComesBack) {
  open("cube-plane");
  const CameraSettings home = app().view.camera.goal();
  EXPECT_EQ(home, app().scene.editor().scene().view.camera);
  drag(GLFW_MOUSE_BUTTON_LEFT, middle_x(), middle_y(), 120, 40);
  frames_to_rest();
  const CameraSettings turned = app().view.camera.shown();
  EXPECT_EQ(turned.target, home.target);
  EXPECT_NEAR(length(turned.position - turned.target), length(home.position - home.target), 1e-9);
  EXPECT_GT(length(turned.position - home.position), 1.0);
  drag(GLFW_MOUSE_BUTTON_RIGHT, middle_x(), middle_y(), 50, 0);
  frames_to_rest();
  const CameraSettings moved = app().view.camera.shown();
  EXPECT_GT(length(moved.target - turned.target), 0.1);
  EXPECT_NEAR(length((moved.position - moved.target) - (turned.position - turned.target)), 0.0, 1e-9);
  drag(GLFW_MOUSE_BUTTON_LEFT, middle_x(), middle_y(), -50, 0, GLFW_MOD_SHIFT);
  frames_to_rest();
  EXPECT_NEAR(length(app().view.camera.shown().target - turned.target), 0.0, 1e-9) << "Shift drag moves too";
  app().scroll(0, 3);
  frames_to_rest();
  const CameraSettings near = app().view.camera.shown();
  EXPECT_NEAR(length(near.position - near.target), std::pow(0.9, 3) * length(moved.position - moved.target),
              1e-9);
  press(GLFW_KEY_HOME);
  frames_to_rest();
  EXPECT_EQ(app().view.camera.shown(), home) << "to the bit";
}

TEST_F(AppWindow, DraggingAPanelDoesNotTurnTheCamera) {
  open("cube-plane");
  const CameraSettings before = app().view.camera.goal();
  drag(GLFW_MOUSE_BUTTON_LEFT, 150, 300, 60, 40);
  app().scroll(0, 2);
  frames(5);
  EXPECT_EQ(app().view.camera.goal(), before);
}

TEST_F(AppWindow, TheHelpPageOfASmallWindowCloses) {
  open("cube-plane");
  press(GLFW_KEY_F1);
  frames(3);
  ASSERT_TRUE(app().help_visible);
  const app::Box close = widgets().at("help/close");
  EXPECT_GE(close.top, 0.0);
  EXPECT_LE(close.bottom, 400.0) << "in sight without scrolling";
  click("help/close");
  EXPECT_FALSE(app().help_visible);
}

TEST_F(AppWindow, KeysOfTheView) {
  open("cube-plane");
  resize(roomy[0], roomy[1]);
  press(GLFW_KEY_TAB);
  frames(1);
  EXPECT_FALSE(app().layout.panels);
  EXPECT_EQ(app().view.box.left, 0.0);
  EXPECT_FALSE(has("simulation/run"));
  press(GLFW_KEY_TAB);
  frames(1);
  EXPECT_TRUE(has("simulation/run"));
  press(GLFW_KEY_F1);
  frames(2);
  EXPECT_TRUE(app().help_visible);
  frames(2);
  for (const auto& [name, box] : widgets()) {
    if (!name.starts_with("help/")) continue;
    EXPECT_LE(box.right, roomy[0]) << name;
  }
  click("help/close");
  EXPECT_FALSE(app().help_visible);
  press(GLFW_KEY_F11);
  EXPECT_EQ(full_screen_toggles, 1);
  type(U'+');
  type(U'+');
  EXPECT_EQ(simulation().pacer().speed(), 4.0);
  type(U'-');
  EXPECT_EQ(simulation().pacer().speed(), 2.0);
  drag(GLFW_MOUSE_BUTTON_RIGHT, middle_x(), middle_y(), 400, 0);
  press(GLFW_KEY_F);
  frames_to_rest();
  const Vec3 target = app().view.camera.shown().target;
  EXPECT_NEAR(length(target - app().scene.editor().scene().model.cubes[0].position), 0.0, 1e-5)
      << "the middle of a cube at rest";
}

TEST_F(AppWindow, ScreenshotsAreNeverOverwritten) {
  open("cube-plane");
  press(GLFW_KEY_F12);
  frames(1);
  press(GLFW_KEY_F12);
  frames(1);
  const auto first = read_file((directory() / "aspic-cube-plane-0001.png").string());
  const auto second = read_file((directory() / "aspic-cube-plane-0002.png").string());
  ASSERT_TRUE(first.ok() && second.ok());
  EXPECT_EQ(first->substr(1, 3), "PNG");
  EXPECT_GT(first->size(), 50000u) << "an image with content does not compress to nothing";
}

TEST_F(AppWindow, CameraTravelsAsText) {
  open("cube-plane");
  drag(GLFW_MOUSE_BUTTON_LEFT, middle_x(), middle_y(), 90, -30);
  frames_to_rest();
  const CameraSettings copied = app().view.camera.goal();
  press(GLFW_KEY_C, GLFW_MOD_CONTROL);
  EXPECT_THAT(clipboard, testing::StartsWith("camera = { position = ["));
  press(GLFW_KEY_HOME);
  frames_to_rest();
  press(GLFW_KEY_V, GLFW_MOD_CONTROL);
  EXPECT_EQ(app().view.camera.shown(), copied);
  clipboard = "a shopping list";
  press(GLFW_KEY_V, GLFW_MOD_CONTROL);
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_TRUE(app().messages.notice()->is_error);
  EXPECT_EQ(app().view.camera.shown(), copied);
}

TEST_F(AppWindow, MouseOverAParticleTellsOfIt) {
  open("cube-plane", {"view.draw=[\"particles\"]"});
  const app::Box view = app().view.box;
  const Camera camera = app().view.lens();
  // The corner nearest to the eye has nothing before it.
  const std::uint32_t corner = 999;
  const auto seen = test::project(camera, simulation().snapshot().position[corner]);
  ASSERT_TRUE(seen.has_value());
  app().cursor(view.left + seen->x, view.top + seen->y);
  frames(2);
  ASSERT_TRUE(app().pointer.hovered().has_value());
  EXPECT_EQ(app().pointer.hovered()->particle, corner);
  EXPECT_EQ(app().pointer.hovered()->position, simulation().snapshot().position[corner]);
}

}  // namespace
}  // namespace aspic::test
