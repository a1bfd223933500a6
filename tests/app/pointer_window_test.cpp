// What the mouse points at: told, marked, centered.
#include <cmath>
#include <fstream>

#include "analysis/particle_force.h"
#include "app/stage.h"
#include "model/terrain.h"
#include "render/camera.h"
#include "scene/follow.h"
#include "support/projection.h"

namespace aspic::test {
namespace {

class Pointer : public Stage {
 protected:
  bool full_quality() const override { return true; }  // images are compared, whatever time they take
  Camera camera() { return app().view.lens(); }
  /// Where a point is seen in the window.
  test::Projected place(const Vec3& point) {
    auto seen = test::project(camera(), point);
    EXPECT_TRUE(seen.has_value());
    seen->x += app().view.box.left;
    seen->y += app().view.box.top;
    return *seen;
  }
  void point_at(const Vec3& point) {
    const test::Projected p = place(point);
    app().cursor(p.x, p.y);
    frames(3);
  }
  /// Differences of the pixels within `radius` of a place of a roomy window, summed.
  static int change(const std::vector<unsigned char>& a, const std::vector<unsigned char>& b, double x,
                    double y, double radius, double without = 0.0) {
    constexpr auto width = roomy[0], height = roomy[1];
    int sum = 0;
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        const double off = std::hypot(column + 0.5 - x, height - row - 0.5 - y);
        if (off > radius || off < without) continue;
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t at = 3 * static_cast<std::size_t>(row * width + column) + c;
          sum += std::abs(static_cast<int>(a[at]) - static_cast<int>(b[at]));
        }
      }
    }
    return sum;
  }
  void click(double x, double y, double at_time) {
    time_ = at_time;
    app().cursor(x, y);
    app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, 0);
    app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0);
  }
  void double_click(double x, double y, double pause = 0.2) {
    app().image.full_quality = false;  // nobody looks
    app().pointer.clock = [this] { return time_; };
    const double start = time_ + 10.0;
    click(x, y, start);
    frames(1);
    click(x, y, start + pause);
    frames(3);
    frames_to_rest();
  }
  using Stage::click;

 private:
  double time_ = 0.0;
};

/// What the mouse finds, on every backend; no images are compared.
class PointerOn : public Pointer, public ::testing::WithParamInterface<const char*> {
 protected:
  /// Coarsely on the way.
  void run_to(std::uint64_t step) {
    app().image.full_quality = false;
    frames_to_step(step);
  }
};

TEST_P(PointerOn, TellsForceMassAndPins) {
  open("cube-plane",
       {"cube[0].pinned=[\"top\"]", "cube[0].position=[0,3,0]", "view.draw=[\"solid\", \"particles\"]"},
       GetParam());
  for (int i = 0; i < 40; ++i) type(U'.');
  frames(2);
  const Model& model = simulation().model();
  const State& state = simulation().snapshot();
  const SpringFinder incident(model);
  for (const std::uint32_t particle : {999u, 909u}) {  // two corners of the face towards the eye
    point_at(state.position[particle]);
    const auto& h = app().pointer.hovered();
    ASSERT_TRUE(h.has_value());
    EXPECT_EQ(h->particle, particle);
    EXPECT_EQ(h->position, state.position[particle]);
    EXPECT_EQ(h->velocity, state.velocity[particle]);
    EXPECT_EQ(h->force.net, particle_force(model, incident, state, particle).net);
    EXPECT_NE(h->force.net, h->force.gravity) << "springs have something to say after 40 steps";
    EXPECT_EQ(h->mass, 1.0);
    EXPECT_EQ(h->pinned, model.inverse_mass[particle] == 0.0);
  }
  EXPECT_NE(model.inverse_mass[999], model.inverse_mass[909]) << "one of each";
}
INSTANTIATE_TEST_SUITE_P(Pointer, PointerOn, ::testing::Values("reference", "cpu", "gpu"));

TEST_P(PointerOn, ReadsAndPullsABallAndTheRunComesBack) {
  open("cube-plane", {"cube[0].position=[0,3,0]", "view.camera={position=[14,7,20], target=[0,4,0], fov=45}"},
       GetParam());
  app().scene.change("a ball", [](Scene& s) {
    s.model.balls.push_back({0.5, 2.0, {1.0, -0.5, 5.0}, {}, {0.0, 1.0, 0.0}});
  });
  frames(3);
  const Vec3 start = simulation().snapshot().ball_position[0];
  point_at(start);
  ASSERT_TRUE(app().pointer.hovered().has_value());
  const app::Hovered h = *app().pointer.hovered();
  EXPECT_TRUE(h.ball);
  EXPECT_EQ(h.position, start);
  EXPECT_EQ(h.mass, 2.0);
  EXPECT_EQ(h.radius, 0.5);
  EXPECT_EQ(h.angular_velocity, (Vec3{0.0, 1.0, 0.0}));
  EXPECT_EQ(h.contact, "touches plane");
  EXPECT_TRUE(has("particle")) << "the readout";
  app().mouse_button(GLFW_MOUSE_BUTTON_RIGHT, GLFW_PRESS, GLFW_MOD_CONTROL);
  EXPECT_TRUE(simulation().present().setup().pinned.empty());
  app().mouse_button(GLFW_MOUSE_BUTTON_RIGHT, GLFW_RELEASE, GLFW_MOD_CONTROL);
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, GLFW_MOD_CONTROL);
  ASSERT_TRUE(simulation().hand() && simulation().hand()->ball);
  const test::Projected there = place(start + Vec3{1.0, 2.0, 0.0});
  app().cursor(there.x, there.y);
  press(GLFW_KEY_SPACE);
  run_to(300);
  ASSERT_TRUE(app().pointer.hovered().has_value());
  EXPECT_NE(app().pointer.hovered()->force.pull, Vec3{});
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, GLFW_MOD_CONTROL);
  EXPECT_FALSE(simulation().hand().has_value());
  frames_to_step(350);
  press(GLFW_KEY_SPACE);
  ASSERT_TRUE(simulation().settle().ok());
  EXPECT_GT(simulation().snapshot().ball_position[0].y, 0.3) << "it hung in the air";
  const std::string last = state_hash_text(simulation().snapshot());
  const double end = simulation().time();
  app().run.go_to(0.0);
  ASSERT_TRUE(simulation().settle().ok());
  EXPECT_EQ(simulation().snapshot().ball_position[0], start);
  app().run.go_to(end);
  ASSERT_TRUE(simulation().settle().ok());
  EXPECT_EQ(state_hash_text(simulation().snapshot()), last) << "the same hand did the same";
}

TEST_P(PointerOn, TheCameraFollowsWhatIsUnderTheMouse) {
  open("cube-tilted-plane", {"cube[0].position=[0,3,0]"}, GetParam());
  const auto center = [&] { return place_of(simulation().model(), simulation().snapshot(), {false, 0}); };
  const Vec3 start = center();
  const test::Projected before = place(start);
  point_at(start);
  ASSERT_TRUE(app().pointer.hovered().has_value());
  press(GLFW_KEY_C);
  EXPECT_EQ(app().scene.scene().view.follow, "cube[0]");
  frames(1);  // from this image on
  app().cursor(5.0, 300.0);
  press(GLFW_KEY_SPACE);
  run_to(250);
  press(GLFW_KEY_SPACE);
  ASSERT_TRUE(simulation().settle().ok());
  frames(2);
  EXPECT_GT(length(center() - start), 0.2);
  // Camera matrices are of single precision.
  const test::Projected after = place(center());
  EXPECT_NEAR(after.x, before.x, 0.1);
  EXPECT_NEAR(after.y, before.y, 0.1);
  press(GLFW_KEY_C);
  frames(2);
  EXPECT_FALSE(app().scene.scene().view.follow.has_value());
  const test::Projected left = place(center());
  EXPECT_NEAR(left.x, after.x, 0.1) << "the image stays where it is";
  EXPECT_NEAR(left.y, after.y, 0.1);
  for (int i = 0; i < 2; ++i) press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(1);
  EXPECT_FALSE(app().scene.editor().changed());
}

TEST_F(Pointer, FollowingEndsWithWhatIsFollowed) {
  open("cube-plane", {"view.follow=cube"}, "reference");
  const auto& follow = [&]() -> const auto& {
    return app().scene.scene().view.follow;
  };
  app().scene.change("another", [](Scene& s) {
    s.model.cubes.push_back(s.model.cubes[0]);
    s.model.cubes[1].position.x += 4.0;
    s.view.follow = "cube[1]";
  });
  frames(2);
  app().scene.change("one less", [](Scene& s) { s.model.cubes.pop_back(); });
  EXPECT_FALSE(follow().has_value());
  frames_until([&] { return !simulation().rebuild().changing() && simulation().model().bodies.size() == 1; });
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_NE(app().messages.notice()->text.find("no longer has cube[1]"), std::string::npos);
  app().scene.undo();
  EXPECT_EQ(follow(), "cube[1]");
  frames(2);
  app().cursor(5.0, 300.0);
  frames(2);
  press(GLFW_KEY_C);
  EXPECT_FALSE(follow().has_value()) << "nothing is under the mouse";
}

TEST_F(Pointer, SolidBodiesHideTheirInside) {
  open("cube-plane", {"cube[0].position=[0,3,0]"});
  // The very middle of the body lies behind its skin.
  point_at({0.0, 3.0, 0.0});
  ASSERT_TRUE(app().pointer.hovered().has_value());
  const std::uint32_t i = app().pointer.hovered()->particle / 100,
                      j = app().pointer.hovered()->particle / 10 % 10,
                      k = app().pointer.hovered()->particle % 10;
  EXPECT_TRUE(i == 9 || j == 9 || k == 9)
      << "on a face towards the eye, not " << app().pointer.hovered()->particle;
  point_at({0.0, -1.0, 6.0});
  EXPECT_FALSE(app().pointer.hovered().has_value()) << "the ground";
  app().cursor(5.0, 300.0);
  frames(3);
  EXPECT_FALSE(app().pointer.hovered().has_value()) << "a panel";
}

TEST_F(Pointer, RingFollowsTheMouseWithoutANewImage) {
  open("cube-plane", {"cube[0].position=[0,3,0]"});
  resize(roomy[0], roomy[1]);
  frames_to_rest();
  frames(60);
  const auto before = pixels();
  const Vec3 corner = simulation().snapshot().position[999];
  const test::Projected p = place(corner);
  point_at(corner);
  const auto with = pixels();
  ASSERT_TRUE(app().pointer.hovered().has_value());
  const double x = p.x > middle_x() ? 1.0 : -1.0, y = p.y > middle_y() ? 1.0 : -1.0;
  EXPECT_GT(change(before, with, p.x + 7.2 * x, p.y, 2.0), 200);
  EXPECT_GT(change(before, with, p.x, p.y + 7.2 * y, 2.0), 200);
  EXPECT_EQ(change(before, with, p.x + 30.0 * x, p.y + 30.0 * y, 20.0), 0) << "nothing else changes";
  EXPECT_EQ(change(before, with, p.x - 30.0 * x, p.y - 30.0 * y, 20.0), 0) << "nothing is in the way";
  const app::Box readout = widgets().at("particle");
  EXPECT_GT(change(before, with, readout.center_x(), readout.center_y(), 20.0), 5000) << "what is told of it";
  app().cursor(5.0, 300.0);
  frames(3);
  EXPECT_EQ(change(before, pixels(), p.x, p.y, 40.0), 0) << "gone with the mouse";
}

TEST_F(Pointer, PullsAndPinsAreMarked) {
  open("cube-plane", {"simulation.gravity=[0,0,0]", "cube[0].position=[0,3,0]"}, "reference");
  resize(roomy[0], roomy[1]);
  const Vec3 corner = simulation().snapshot().position[999];
  const test::Projected p = place(corner);
  point_at(corner);
  ASSERT_TRUE(app().pointer.hovered().has_value());
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, GLFW_MOD_CONTROL);
  frames(12);
  const auto before = pixels();
  app().cursor(p.x - 60.0, p.y - 90.0);
  frames(12);
  ASSERT_TRUE(simulation().hand().has_value());
  ASSERT_TRUE(app().pointer.hovered().has_value());
  EXPECT_EQ(app().pointer.hovered()->particle, 999u) << "who is pulled is told of, wherever the mouse is";
  EXPECT_NE(app().pointer.hovered()->force.pull, Vec3{});
  EXPECT_GT(change(before, pixels(), p.x - 30.0, p.y - 45.0, 4.0), 500) << "the band";
  EXPECT_GT(change(before, pixels(), p.x - 60.0, p.y - 90.0, 8.0), 5000) << "the anchor";
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, GLFW_MOD_CONTROL);
  app().cursor(5.0, 300.0);
  frames(12);
  const auto after = pixels();
  EXPECT_EQ(change(after, before, p.x - 60.0, p.y - 90.0, 8.0), 0);
  point_at(corner);
  app().mouse_button(GLFW_MOUSE_BUTTON_RIGHT, GLFW_PRESS, GLFW_MOD_CONTROL);
  app().mouse_button(GLFW_MOUSE_BUTTON_RIGHT, GLFW_RELEASE, GLFW_MOD_CONTROL);
  app().cursor(5.0, 300.0);
  frames(12);
  EXPECT_GT(change(after, pixels(), p.x, p.y, 5.0), 2000) << "a diamond";
}

TEST_F(Pointer, DoubleClickCentersWhatIsThere) {
  std::ofstream("scene.toml")
      << "schema = 1\n[[terrain]]\nshape = \"plane\"\n[[cube]]\nposition = [0, 3, 0]\n"
         "[[ball]]\nposition = [-4, 1, 2]\nradius = 0.8\nvelocity = [0, 0, 0]\n"
         "[view]\ncamera = { position = [10, 6, 14], target = [0, 2, 0] }\n";
  open("scene.toml");
  const auto distance = [](const CameraSettings& c) { return length(c.position - c.target); };
  const CameraSettings home = app().view.camera.goal();
  const Vec3 corner = simulation().snapshot().position[999];
  test::Projected p = place(corner);
  double_click(p.x, p.y);
  EXPECT_NEAR(length(app().view.camera.shown().target - corner), 0.0, 1e-12);
  EXPECT_NEAR(distance(app().view.camera.shown()), distance(home), 1e-9) << "as far away as before";
  const test::Projected now = place(corner);
  EXPECT_NEAR(now.x, middle_x(), 1.0);
  EXPECT_NEAR(now.y, middle_y(), 1.0);

  press(GLFW_KEY_HOME);
  frames_to_rest();
  const Vec3 ball = simulation().snapshot().ball_position[0];
  p = place(ball);
  double_click(p.x, p.y);
  EXPECT_NEAR(length(app().view.camera.shown().target - ball), 0.0, 1e-12);

  press(GLFW_KEY_HOME);
  frames_to_rest();
  const Vec3 ground = {3.0, -1.0, 5.0};
  p = place(ground);
  double_click(p.x, p.y);
  const Vec3 target = app().view.camera.shown().target;
  EXPECT_NEAR(signed_distance(simulation().model().terrain[0], target), 0.0, 1e-3);
  // The middle of a pixel of the window, seen from 18 m away at a slant.
  EXPECT_NEAR(length(target - ground), 0.0, 0.1);

  press(GLFW_KEY_HOME);
  frames_to_rest();
  double_click(middle_x(), app().view.box.top + 3.0);
  EXPECT_EQ(app().view.camera.goal(), home) << "the sky is nothing to turn to";
}

TEST_F(Pointer, OnlyTwoQuickPressesOnOnePlaceAreADoubleClick) {
  open("cube-plane", {"cube[0].position=[0,3,0]"});
  const CameraSettings home = app().view.camera.goal();
  const test::Projected p = place(simulation().snapshot().position[999]);
  double_click(p.x, p.y, 0.41);
  EXPECT_EQ(app().view.camera.goal(), home) << "too slow";
  double time = 1000.0;
  app().pointer.clock = [&] { return time; };
  const auto press_at = [&](double x, double y) {
    app().cursor(x, y);
    app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, 0);
    app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0);
    frames(3);
    time += 0.1;
  };
  press_at(p.x, p.y);
  press_at(p.x - 5.0, p.y);
  EXPECT_EQ(app().view.camera.goal(), home) << "too far apart";
  time += 1.0;
  press_at(p.x, p.y);
  press_at(p.x - 3.0, p.y);
  EXPECT_NE(app().view.camera.goal(), home);
  frames_to_rest();
  const CameraSettings there = app().view.camera.goal();
  press_at(p.x - 3.0, p.y);
  EXPECT_EQ(app().view.camera.goal(), there) << "a third press begins anew";
}

TEST_F(Pointer, ShadowsCanBeSwitchedOff) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"});
  resize(roomy[0], roomy[1]);
  frames(60);
  const auto shadowed = pixels();
  const test::Projected beside = place({3.0, -1.0, 0.5});
  const auto far_off = place({-5.0, -1.0, 5.0});
  click("view/shadows");
  EXPECT_FALSE(app().image.shadows);
  app().cursor(5.0, 300.0);
  frames(60);
  const auto bare = pixels();
  EXPECT_GT(change(shadowed, bare, beside.x, beside.y, 4.0), 1000);
  EXPECT_LE(change(shadowed, bare, far_off.x, far_off.y, 4.0), 150) << "a unit for each channel";
  click("view/shadows");
  app().cursor(5.0, 300.0);
  frames(60);
  EXPECT_EQ(change(shadowed, pixels(), beside.x, beside.y, 30.0), 0);
}

}  // namespace
}  // namespace aspic::test
