#include "scene/aim.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/model.h"
#include "scene/scene_support.h"
#include "scene/write.h"

namespace aspic {
namespace {

Scene parsed(const std::string& text, const std::vector<std::string>& overrides = {}) {
  auto scene = parse_scene(text, "scene.toml", overrides, test::unlimited);
  EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message());
  return std::move(scene).value();
}

/// A cube of this edge, its lowest point `drop` edges above a plane.
std::string cube_text(double edge, double drop, const std::string& more = "") {
  return fmt::format(
      "schema = 1\n[[terrain]]\nshape = \"plane\"\npoint = [0, 0, 0]\n[[cube]]\nparticles-per-edge = 3\n"
      "edge-length = {}\nposition = [{}, {}, 0]\n{}",
      edge, edge, (drop + 0.5) * edge, more);
}

/// Where places are in the image: 1 is the upper, −1 the lower edge.
struct Shown {
  double low = 1e9, high = -1e9;
  void add(const CameraSettings& camera, const Vec3& x) {
    const Vec3 ahead = (1.0 / length(camera.target - camera.position)) * (camera.target - camera.position);
    const Vec3 aside = cross(ahead, Vec3{0.0, 1.0, 0.0}), up = cross((1.0 / length(aside)) * aside, ahead);
    const Vec3 from_eye = x - camera.position;
    const double y =
        dot(from_eye, up) / (dot(from_eye, ahead) * std::tan(0.5 * camera.fov * std::numbers::pi / 180.0));
    low = std::min(low, y);
    high = std::max(high, y);
  }
};

Shown bodies_in(const Scene& scene) {
  auto model = build_model(scene.model);
  EXPECT_TRUE(model.ok());
  Shown shown;
  for (const Vec3& x : initial_state(*model, Precision::double_).position) shown.add(scene.view.camera, x);
  return shown;
}

TEST(Aim, BodiesOfAnySizeFillHalfOfTheImage) {
  for (const double edge : {0.02, 0.25, 4.0, 50.0}) {
    const Scene scene = parsed(cube_text(edge, 0.1));
    const Shown shown = bodies_in(scene);
    EXPECT_NEAR(shown.high - shown.low, 0.95, 0.1) << edge;  // of 2
    EXPECT_GT(scene.view.camera.position.y, 0.0) << edge;
  }
}

TEST(Aim, ShowsTheGroundThatBodiesFallOn) {
  for (const double drop : {1.0, 2.5}) {
    const Scene scene = parsed(cube_text(0.25, drop));
    Shown shown = bodies_in(scene);
    EXPECT_LT(shown.high, 0.85) << drop;
    shown.add(scene.view.camera, {0.25, 0.0, 0.0});  // below the cube
    EXPECT_GT(shown.low, -0.85) << drop;
  }
  // From far above it shows the body.
  const Shown high = bodies_in(parsed(cube_text(0.25, 40.0)));
  EXPECT_NEAR(high.high - high.low, 0.95, 0.1);
}

TEST(Aim, EyeIsOutsideOfTerrain) {
  // A slope of 45° that rises towards the eye.
  const Scene scene = parsed(
      "schema = 1\n[[terrain]]\nshape = \"plane\"\npoint = [0, 0, 0]\nnormal = [-0.6, 1, -0.8]\n[[cube]]\n"
      "particles-per-edge = 3\nedge-length = 1.0\nposition = [0, 1.0, 0]\n");
  const Vec3& eye = scene.view.camera.position;
  EXPECT_GT(eye.y, 0.6 * eye.x + 0.8 * eye.z);
}

TEST(Aim, FollowsChangesUntilAFileOrAnArgumentPlacesTheCamera) {
  const Scene small = parsed(cube_text(0.25, 0.1));
  EXPECT_TRUE(small.view.aimed);
  const auto large =
      with_overrides(small, std::vector<std::string>{"cube[0].edge-length=2.5"}, test::unlimited);
  ASSERT_TRUE(large.ok());
  const Shown shown = bodies_in(*large);
  EXPECT_NEAR(shown.high - shown.low, 0.95, 0.3);

  const std::string camera = "[view]\ncamera = { position = [10.0, 6.0, 14.0], target = [0.0, 2.0, 0.0] }\n";
  for (const Scene& given :
       {parsed(cube_text(0.25, 0.1, camera)), parsed(cube_text(0.25, 0.1), {"view.camera.target=[0,2,0]"})}) {
    EXPECT_FALSE(given.view.aimed);
    const auto moved =
        with_overrides(given, std::vector<std::string>{"cube[0].edge-length=2.5"}, test::unlimited);
    ASSERT_TRUE(moved.ok());
    EXPECT_EQ(moved->view.camera, given.view.camera);
  }
  EXPECT_EQ(parsed(cube_text(0.25, 0.1, camera)).view.camera, CameraSettings());
}

TEST(Aim, IsLeftOutOfShortFilesAndACameraIsNot) {
  const Scene aimed = parsed(cube_text(0.25, 0.1));
  EXPECT_EQ(to_short_toml(aimed).find("camera"), std::string::npos);
  EXPECT_EQ(parsed(to_short_toml(aimed)).view, aimed.view);
  Scene usual = aimed;
  usual.view.camera = {};
  usual.view.aimed = false;
  EXPECT_EQ(parsed(to_short_toml(usual)).view, usual.view);
}

TEST(Aim, LooksAtBallsAndAtLaunchersWhereNothingElseIs) {
  const Scene balls = parsed("schema = 1\n[[ball]]\nposition = [100, 3, 0]\nradius = 0.1\n");
  EXPECT_EQ(balls.view.camera.target, (Vec3{100.0, 3.0, 0.0}));
  EXPECT_LT(length(balls.view.camera.position - balls.view.camera.target), 1.0);
  const Scene launcher = parsed(
      "schema = 1\n[[launcher]]\nfrom = { min = [90, 1, 0], max = [92, 3, 0] }\n"
      "towards = { min = [100, 1, 0], max = [102, 3, 0] }\n");
  EXPECT_EQ(launcher.view.camera.target, (Vec3{96.0, 2.0, 0.0}));
}

}  // namespace
}  // namespace aspic
