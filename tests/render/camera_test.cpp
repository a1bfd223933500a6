#include "render/camera.h"

#include <gtest/gtest.h>

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
  EXPECT_NEAR(test::pixels_per_metre(camera, 5.0), 40.0, 1e-4);
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

}  // namespace
}  // namespace aspic
