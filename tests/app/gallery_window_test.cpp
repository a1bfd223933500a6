// The window as docs/gallery.md shows it. With the environment variable ASPIC_WINDOW_IMAGES the images go
// to that directory; scripts/gallery.sh does so.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "app/stage.h"
#include "io/video_format.h"
#include "render/camera.h"
#include "support/projection.h"

namespace aspic::test {
namespace {

class Gallery : public Stage {
 protected:
  std::array<int, 2> window_size() const override { return {1600, 1000}; }
  bool full_quality() const override { return true; }

  /// Coarsely on the way, so that the figures shown are those of a window that keeps up.
  void run_to(std::uint64_t step) {
    app().image.full_quality = false;
    press(GLFW_KEY_SPACE);
    frames_to_step(step);
    app().image.full_quality = true;
  }
  void point_at(const Vec3& point) {
    const app::Box& view = app().view.box;
    const Camera camera = app().view.lens();
    const auto seen = test::project(camera, point);
    ASSERT_TRUE(seen.has_value());
    app().cursor(view.left + seen->x, view.top + seen->y);
  }
  /// Writes what the window shows. A window with nothing in it compresses to less than this.
  void take(const std::string& name) {
    EXPECT_FALSE(app().messages.notice() && app().messages.notice()->is_error)
        << app().messages.notice()->text;
    const Image window = image();
    const auto file = encode_jpeg({window.width, window.height}, window.rgb);
    ASSERT_TRUE(file.ok()) << file.error().message();
    EXPECT_GT(file->size(), 60000u);
    const char* const wanted = std::getenv("ASPIC_WINDOW_IMAGES");
    const std::filesystem::path path =
        (wanted ? std::filesystem::path(wanted) : directory()) / (name + ".jpg");
    auto out = AtomicFile::create(path.string(), Overwrite::allow);
    ASSERT_TRUE(out.ok()) << out.error().message();
    ASSERT_TRUE(out->write(*file).ok());
    ASSERT_TRUE(out->commit().ok());
  }
};

TEST_F(Gallery, CubeInABowlRuns) {
  open("cube-bowl", {"simulation.steps-per-frame=32"}, "reference");
  run_to(1450);
  frames(1);
  EXPECT_TRUE(simulation().running());
  EXPECT_GT(simulation().samples().energies().size(), 2u) << "the plot has curves";
  EXPECT_TRUE(has("simulation/run"));
  take("window-cube-bowl");
}

/// What somebody sees who starts the window for the first time.
TEST_F(Gallery, TheFirstScreen) {
  open("cube-plane", {}, "", app::KeptState());
  for (const auto& [width, height] : {std::pair(1280, 720), std::pair(1920, 1080)}) {
    app().layout.reset();
    resize(width, height);
    // Where the mouse points at nothing.
    app().cursor(app().view.box.left + 20.0, app().view.box.top + 20.0);
    frames(30);
    for (const char* widget : {"actions/start", "actions/compare", "energy/plot", "springs/all/stiffness"})
      EXPECT_LT(widgets().at(widget).bottom, height) << widget;
    take(fmt::format("window-first-{}", width));
  }
}

TEST_F(Gallery, FourRunsSideBySide) {
  open("cube-plane", {"simulation.steps-per-frame=20", "cube[0].position=[0,6,0]"}, "reference");
  for (int i = 0; i < 3; ++i) press(GLFW_KEY_B, GLFW_MOD_CONTROL);
  frames_until([&] { return app().comparison.count() == 4 && app().comparison.settled(); });
  app().layout.reset();
  run_to(1010);
  press(GLFW_KEY_SPACE);
  frames_until([&] { return app().comparison.settled(); });
  app().messages.dismiss();
  app().cursor(middle_x(), app().view.box.top + 100.0);
  frames(30);
  EXPECT_EQ(app().comparison.count(), 4u);
  take("window-beside-four");
}

TEST_F(Gallery, TwoIntegratorsSideBySide) {
  open("cube-plane",
       {"cube[0].structural.damping=1", "cube[0].shear.damping=1", "cube[0].bending.damping=1",
        "simulation.steps-per-frame=20", "view.camera={position=[10,5,14], target=[0,2.4,0], fov=45}"},
       "reference");
  press(GLFW_KEY_B, GLFW_MOD_CONTROL);
  app().layout.reset();
  run_to(1700);
  press(GLFW_KEY_SPACE);
  frames_until([&] { return app().comparison.settled(); });
  app().messages.dismiss();
  // Into the sky, where the mouse points at nothing.
  app().cursor(middle_x(), app().view.box.top + 150.0);
  frames(3);
  EXPECT_EQ(app().comparison.count(), 2u);
  take("window-beside");
}

TEST_F(Gallery, GoalNetCatchesAShot) {
  open("goal-net", {}, "reference");
  run_to(320);
  press(GLFW_KEY_SPACE);
  frames(30);
  take("window-goal-net");
}

TEST_F(Gallery, StrainOfACubeThatAHandPulls) {
  open("cube-plane",
       {"cube[0].position=[0,1.05,0]", "view.color=strain", "simulation.steps-per-frame=20",
        "view.camera={position=[8,5,13], target=[0.4,2.0,0], fov=45}"},
       "reference");
  const Vec3 corner = simulation().snapshot().position[999];
  point_at(corner);
  frames(4);
  ASSERT_TRUE(app().pointer.hovered().has_value());
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, GLFW_MOD_CONTROL);
  point_at(corner + Vec3{0.8, 2.4, 0.0});
  run_to(180);
  press(GLFW_KEY_SPACE);
  frames(30);
  ASSERT_TRUE(app().pointer.hovered().has_value());
  EXPECT_NE(app().pointer.hovered()->force.pull, Vec3{});
  take("window-strain");
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, GLFW_MOD_CONTROL);
}

TEST_F(Gallery, ABallThatAHandPulls) {
  open("cube-and-balls", {"simulation.steps-per-frame=16"}, "reference");
  run_to(600);
  press(GLFW_KEY_SPACE);
  frames(4);
  const State& state = simulation().snapshot();
  // Of the balls the one nearest to the eye, which nothing hides.
  std::size_t nearest = 0;
  const Vec3 eye = app().view.seen().position;
  for (std::size_t b = 0; b < state.ball_position.size(); ++b)
    if (length(state.ball_position[b] - eye) < length(state.ball_position[nearest] - eye)) nearest = b;
  const Vec3 ball = state.ball_position[nearest];
  point_at(ball);
  frames(4);
  ASSERT_TRUE(app().pointer.hovered() && app().pointer.hovered()->ball);
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, GLFW_MOD_CONTROL);
  point_at(ball + Vec3{-1.5, 3.0, 0.0});
  run_to(1000);
  press(GLFW_KEY_SPACE);
  frames(30);
  EXPECT_NE(app().pointer.hovered()->force.pull, Vec3{});
  take("window-ball");
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, GLFW_MOD_CONTROL);
}

TEST_F(Gallery, CellsArePainted) {
  app::KeptState kept;
  kept.greeted = true;
  for (const char* name : {"Scene", "Simulation", "Springs"}) kept.layout.sections[name] = false;
  kept.layout.sections["Cells"] = kept.layout.sections["Materials"] = true;
  open("bridge", {"view.camera={position=[2.6,3.6,5.2],target=[0,0.7,0],fov=44}"}, "reference", kept);
  app().cells.choose_layer(4);
  app().cells.choose_brush('o');
  for (int row = 0; row < 5; ++row) {
    app().cells.begin_stroke({row, 9 + row % 2}, 'o');
    app().cells.stroke({row, 14 - row % 2});
  }
  frames(3);
  const app::Box grid = widgets().at("cells/grid");
  app().cursor(grid.left + 0.65 * (grid.right - grid.left), grid.center_y());
  frames(3);
  EXPECT_TRUE(app().cells.refusal().empty()) << app().cells.refusal();
  take("window-cells");
}

TEST_F(Gallery, LectureLayout) {
  open("cube-tilted-plane", {"simulation.steps-per-frame=20"}, "reference");
  press(GLFW_KEY_L);
  app().cursor(middle_x(), 900);
  ASSERT_EQ(app().layout.row().name, "lecture");
  run_to(1180);
  press(GLFW_KEY_SPACE);
  frames(30);
  EXPECT_TRUE(has("clock"));
  take("window-lecture");
}

TEST_F(Gallery, StabilityMapOfACube) {
  open("cube-plane", {"simulation.steps-per-frame=32"}, "reference");
  for (const char* section : {"Scene", "View", "Energy", "Stability"})
    click(std::string("section/") + section);
  app().cursor(middle_x(), middle_y());
  frames_until([&] { return has("stability/map") && !has("stability/measuring"); });
  run_to(1420);
  press(GLFW_KEY_SPACE);
  frames(30);
  take("window-stability");
}

}  // namespace
}  // namespace aspic::test
