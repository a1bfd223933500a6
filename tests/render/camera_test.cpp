#include "render/camera.h"

#include <gtest/gtest.h>

#include <array>

#include "support/projection.h"

namespace aspic {
namespace {

// Matrices are single precision: a pixel of a thousand is a few units in the last place of its coordinate,
// times the handful of products of a projection.
constexpr double pixel_tolerance = 1000.0 * 64 * 0x1p-24;

TEST(Camera, TargetIsInTheMiddle) {
  const Camera camera(CameraSettings{}, 640, 360);
  const auto p = test::project(camera, {0.0, 2.0, 0.0});
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->x, 320.0, pixel_tolerance);
  EXPECT_NEAR(p->y, 180.0, pixel_tolerance);
  EXPECT_NEAR(p->distance, std::sqrt(10.0 * 10 + 4 * 4 + 14 * 14), 1e-4);
}

TEST(Camera, FieldOfViewIsVertical) {
  CameraSettings settings;
  settings.position = {0.0, 0.0, 5.0};
  settings.target = {0.0, 0.0, 0.0};
  settings.fov = 90.0;
  const Camera camera(settings, 800, 400);
  const auto top = test::project(camera, {0.0, 5.0, 0.0});
  ASSERT_TRUE(top);
  EXPECT_NEAR(top->x, 400.0, pixel_tolerance);
  EXPECT_NEAR(top->y, 0.0, pixel_tolerance);
  EXPECT_NEAR(test::pixels_per_meter(camera, 5.0), 40.0, 1e-4);
}

TEST(Camera, SightLineThroughAProjectedPointHitsIt) {
  CameraSettings settings;
  settings.position = {3.0, -2.0, 7.0};
  settings.target = {-1.0, 4.0, 0.5};
  const Camera camera(settings, 641, 359);
  const Vec3 point = {0.3, 2.5, -1.7};
  const auto p = test::project(camera, point);
  ASSERT_TRUE(p);
  const Ray ray = camera.ray_through(p->x, p->y);
  EXPECT_NEAR(length(ray.direction), 1.0, 1e-12);
  const Vec3 to_point = point - ray.origin;
  const double off = length(to_point - dot(to_point, ray.direction) * ray.direction);
  EXPECT_LT(off, length(to_point) * 64 * 0x1p-24);
}

TEST(Camera, NothingBehindTheEye) {
  EXPECT_FALSE(test::project(Camera(CameraSettings{}, 640, 360), {20.0, 10.0, 28.0}));
}

TEST(Camera, LooksStraightDown) {
  CameraSettings settings;
  settings.position = {0.0, 9.0, 0.0};
  settings.target = {0.0, 0.0, 0.0};
  const auto ahead = test::project(Camera(settings, 200, 200), {0.0, 0.0, -1.0});
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->x, 100.0, pixel_tolerance);
  EXPECT_LT(ahead->y, 100.0);
}

CameraSettings orthographic(const Vec3& position, const Vec3& target) {
  CameraSettings settings;
  settings.position = position;
  settings.target = target;
  settings.projection = Projection::orthographic;
  return settings;
}

TEST(Camera, OrthographicKeepsParallelsAndSizes) {
  const CameraSettings settings = orthographic({3.0, -2.0, 7.0}, {-1.0, 4.0, 0.5});
  const Camera camera(settings, 641, 359);
  const Vec3 edge = {0.7, -0.4, 1.1};
  const auto way = [&](const Vec3& from) {
    const auto a = test::project(camera, from), b = test::project(camera, from + edge);
    return std::array{b->x - a->x, b->y - a->y};
  };
  const auto first = way({0.0, 0.0, 0.0});
  // Also of what lies behind the position.
  for (const Vec3& from : {Vec3{-5.0, 9.0, 3.0}, {2.0, 0.0, -14.0}, {8.0, -6.0, 16.0}}) {
    const auto other = way(from);
    EXPECT_NEAR(other[0], first[0], 4.0 * pixel_tolerance);
    EXPECT_NEAR(other[1], first[1], 4.0 * pixel_tolerance);
  }
  // What is at the target is as large as in perspective.
  CameraSettings perspective = settings;
  perspective.projection = Projection::perspective;
  EXPECT_NEAR(
      test::pixels_per_meter(camera, 1.0),
      test::pixels_per_meter(Camera(perspective, 641, 359), length(settings.position - settings.target)),
      1e-3);
}

TEST(Camera, OrthographicSightLinesAreParallelAndHit) {
  const CameraSettings settings = orthographic({3.0, -2.0, 7.0}, {-1.0, 4.0, 0.5});
  const Camera camera(settings, 641, 359);
  const Vec3 point = {0.3, 2.5, -1.7}, axis = settings.target - settings.position;
  const auto p = test::project(camera, point);
  const Ray ray = camera.ray_through(p->x, p->y);
  EXPECT_LT(length(ray.direction - (1.0 / length(axis)) * axis), 64 * 0x1p-24);
  // The eye stands 40 distances off: so much do single precision's roundings grow.
  const Vec3 to_point = point - ray.origin;
  EXPECT_LT(length(to_point - dot(to_point, ray.direction) * ray.direction),
            40 * length(axis) * 64 * 0x1p-24);
  EXPECT_NEAR(dot(ray.origin - settings.position, ray.direction), 0.0, 40 * length(axis) * 64 * 0x1p-24);
}

}  // namespace
}  // namespace aspic
