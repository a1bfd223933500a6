#include "app/camera_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/camera.h"

namespace aspic::app {
namespace {

const CameraSettings home = {{10.0, 6.0, 14.0}, {0.0, 2.0, 0.0}, 45.0};

void settle(CameraControl& camera) {
  for (int i = 0; i < 1000 && camera.update(1.0 / 60.0); ++i) {
  }
}

TEST(CameraControl, StartsAtHomeToTheBit) {
  CameraControl camera(home);
  EXPECT_FALSE(camera.update(0.1));
  EXPECT_EQ(camera.shown(), home);
}

TEST(CameraControl, OrbitsByHalfATurnForTheViewsHeight) {
  CameraControl camera(home);
  camera.orbit(1.0, 0.0);
  settle(camera);
  const CameraSettings shown = camera.shown();
  // Half a turn about the vertical axis through the target.
  EXPECT_NEAR(shown.position.x, -home.position.x, 1e-12);
  EXPECT_NEAR(shown.position.y, home.position.y, 1e-12);
  EXPECT_NEAR(shown.position.z, -home.position.z, 1e-12);
}

TEST(CameraControl, NeverTurnsOverThePole) {
  CameraControl camera(home);
  camera.orbit(0.0, 10.0);
  settle(camera);
  const Vec3 d = camera.shown().position - camera.shown().target;
  EXPECT_NEAR(std::asin(d.y / length(d)) * 180.0 / std::numbers::pi, 89.0, 1e-9);
}

TEST(CameraControl, PanningByTheViewsHeightMovesWhatIsSeenAtTheTargetByIt) {
  CameraControl camera(home);
  camera.pan(0.0, 1.0);
  settle(camera);
  const double height = 2.0 * length(home.position - home.target) * std::tan(22.5 * std::numbers::pi / 180.0);
  const Vec3 moved = camera.shown().target - home.target;
  EXPECT_NEAR(length(moved), height, 1e-9);
  EXPECT_NEAR(dot(moved, home.position - home.target), 0.0, 1e-9) << "square to the line of sight";
  EXPECT_GT(moved.y, 0.0) << "the scene follows the mouse down";
}

TEST(CameraControl, FramesASphereWhollyInsideTheView) {
  CameraControl camera(home);
  for (const double aspect : {0.5, 1.0, 2.0}) {
    camera.frame({1.0, 2.0, 3.0}, 4.0, aspect);
    settle(camera);
    const CameraSettings shown = camera.shown();
    const double half = 22.5 * std::numbers::pi / 180.0;
    const double narrow = std::min(half, std::atan(aspect * std::tan(half)));
    EXPECT_EQ(shown.target, (Vec3{1.0, 2.0, 3.0}));
    const double seen_under = std::asin(4.0 / length(shown.position - shown.target));
    EXPECT_LT(seen_under, narrow);
    EXPECT_GT(seen_under, 0.8 * narrow);
  }
}

TEST(CameraControl, EasesMonotonicallyWhateverTheFrameRate) {
  CameraControl often(home), seldom(home);
  often.zoom(5.0);
  seldom.zoom(5.0);
  for (int i = 0; i < 8; ++i) often.update(0.01);
  seldom.update(0.08);
  // The exponential of a sum is the product of exponentials.
  EXPECT_NEAR(length(often.shown().position - home.target), length(seldom.shown().position - home.target),
              1e-9);
  EXPECT_LT(length(often.shown().position - home.target), length(home.position - home.target));
}

TEST(CameraControl, ComesHomeToTheBitAfterManyTurns) {
  CameraControl camera(home);
  camera.orbit(7.3, -0.2);
  settle(camera);
  camera.reset();
  double longest = 0.0;
  Vec3 last = camera.shown().position;
  while (camera.update(1.0 / 60.0)) {
    longest += length(camera.shown().position - last);
    last = camera.shown().position;
  }
  EXPECT_EQ(camera.shown(), home);
  EXPECT_LT(longest, 2.0 * std::numbers::pi * length(home.position - home.target)) << "the short way round";
}

TEST(CameraControl, LooksFromADirectionTheShortWayRound) {
  CameraControl camera(home);
  camera.orbit(3.9, 0.0);  // nearly two turns
  settle(camera);
  const double distance = length(home.position - home.target);
  const std::pair<Vec3, Vec3> cases[] = {
      {{0, 0, 5}, {0, 0, 1}}, {{3, 0, 0}, {1, 0, 0}}, {{1, 1, 1}, (1.0 / std::sqrt(3.0)) * Vec3{1, 1, 1}}};
  for (const auto& [direction, seen_from] : cases) {
    camera.look_from(direction);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 before = camera.shown().position;
      if (!camera.update(1.0 / 60.0)) break;
      // Half a turn at most, so an easing's first image goes less than this part of the circle.
      EXPECT_LT(length(camera.shown().position - before), distance);
    }
    const CameraSettings shown = camera.shown();
    EXPECT_EQ(shown.target, home.target);
    EXPECT_NEAR(length(shown.position - (home.target + distance * seen_from)), 0.0, 1e-9 * distance);
  }
  camera.look_from({0, 1, 0});
  settle(camera);
  const Vec3 d = camera.shown().position - camera.shown().target;
  EXPECT_NEAR(std::asin(d.y / length(d)) * 180.0 / std::numbers::pi, 89.0, 1e-9);
}

TEST(CameraControl, ZoomKeepsThePointUnderTheMouse) {
  const CameraSettings start = {{3.0, 4.0, 12.0}, {0.0, 1.0, 0.0}, 40.0};
  const double dx = 0.4, dy = -0.3;
  // Where the sight line through (dx, dy) meets the plane through the target that is square to the view.
  const auto seen = [&](const CameraSettings& c) {
    const int height = 1000;
    const Camera camera(c, 2 * height, height);
    const Ray ray = camera.ray_through(height + dx * height, 0.5 * height + dy * height);
    const Ray axis = camera.ray_through(height, 0.5 * height);
    return ray.origin +
           (dot(start.target - ray.origin, axis.direction) / dot(ray.direction, axis.direction)) *
               ray.direction;
  };
  CameraControl camera(start);
  const Vec3 point = seen(start);
  for (const double notches : {3.0, -5.0, 1.5}) {
    const double distance = length(camera.goal().position - camera.goal().target);
    camera.zoom(notches, dx, dy);
    const CameraSettings goal = camera.goal();
    EXPECT_NEAR(length(goal.position - goal.target), distance * std::pow(0.9, notches), 1e-12 * distance);
    // The camera's matrices are of single precision.
    EXPECT_LT(length(seen(goal) - point), 100.0 * 0x1p-23 * 12.0) << notches;
  }
}

}  // namespace
}  // namespace aspic::app
