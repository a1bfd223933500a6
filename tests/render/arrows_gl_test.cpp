// Arrows stand where their particles are, as long as the legend says; axes point where the camera sees them.
#include <gtest/gtest.h>

#include <cmath>

#include "render/axes.h"
#include "render/studio.h"
#include "support/projection.h"

namespace aspic {
namespace {

class Arrows : public test::Studio {
 protected:
  static constexpr int width = 320, height = 240;
  static ImageOptions from_front() {
    ImageOptions options;
    options.view.camera.position = {0.0, 0.0, 10.0};
    options.view.camera.target = {0.0, 0.0, 0.0};
    options.view.draw = {.solid = false};
    options.view.arrows.net = true;
    options.background = Color{0.0f, 0.0f, 0.0f};
    options.legend = false;
    return options;
  }
  static bool lit(const test::Image& image, double x, double y) {
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    return image.channel(column, row, 0) + image.channel(column, row, 1) + image.channel(column, row, 2) > 40;
  }
};

TEST_F(Arrows, EndWhereTheForceSays) {
  const Model model = test::particles({{0.0, 0.0, 0.0}}, {{}});
  const State state = initial_state(model, Precision::single);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    for (const Vec3 force : {Vec3{20.0, 0.0, 0.0}, {-10.0, 16.0, 0.0}, {6.0, -12.0, 15.0}}) {
      ImageOptions options = from_front();
      options.view.camera.projection = projection;
      options.view.arrow_scale = 8.0;
      options.arrows = {{{{0.5, -0.5, 0.0}, force, ArrowKind::net}}, 1.0};
      const Camera camera(options.view.camera, width, height);
      const test::Image image = draw(model, state, options, width, height);
      const Vec3 from = {0.5, -0.5, 0.0};
      const auto at = [&](double share) {
        const auto p = test::project(camera, from + (share / 8.0) * force);
        return std::pair(p->x, p->y);
      };
      for (const double share : {0.03, 0.3, 0.6, 0.9, 0.97}) {
        const auto [x, y] = at(share);
        EXPECT_TRUE(lit(image, x, y)) << share;
      }
      for (const double share : {-0.12, 1.12}) {
        const auto [x, y] = at(share);
        EXPECT_FALSE(lit(image, x, y)) << share;
      }
    }
  }
}

TEST_F(Arrows, BeyondACutAreLeftOut) {
  const Model model = test::particles({{0.0, 0.0, 0.0}}, {{}});
  const State state = initial_state(model, Precision::single);
  ImageOptions options = from_front();
  options.arrows = {{{{-1.0, 0.0, 1.0}, {0.0, 9.0, 0.0}, ArrowKind::net},
                     {{1.0, 0.0, -1.0}, {0.0, 9.0, 0.0}, ArrowKind::net}},
                    1.0};
  options.view.cut.inside = CutInside::section;
  const Camera camera(options.view.camera, width, height);
  const test::Image image = draw(model, state, options, width, height);
  const auto gone = test::project(camera, {-1.0, 0.4, 1.0}), there = test::project(camera, {1.0, 0.4, -1.0});
  EXPECT_FALSE(lit(image, gone->x, gone->y));
  EXPECT_TRUE(lit(image, there->x, there->y));
}

TEST_F(Arrows, AxesAreInTheCornerWhereTheViewAsksForThem) {
  const Model model = test::particles({{0.0, 0.0, 0.0}}, {{}});
  const State state = initial_state(model, Precision::single);
  ImageOptions options = from_front();
  options.view.arrows = {};
  const test::Image without = draw(model, state, options, width, height);
  options.view.axes = true;
  const test::Image with = draw(model, state, options, width, height);
  int in_corner = 0, elsewhere = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        if (with.channel(x, y, c) != without.channel(x, y, c))
          ++(x > width * 2 / 3 && y < height / 2 ? in_corner : elsewhere);
  EXPECT_GT(in_corner, 500);
  EXPECT_EQ(elsewhere, 0);
  options.axes = false;
  EXPECT_EQ(draw(model, state, options, width, height).rgb, without.rgb);
}

TEST(Axes, PointAsTheCameraSeesThem) {
  CameraSettings settings;
  settings.position = {0.0, 0.0, 5.0};
  settings.target = {0.0, 0.0, 0.0};
  for (const AxisArm& arm : axes_seen(Camera(settings, 100, 100))) {
    EXPECT_NEAR(arm.right, arm.letter == 'x' ? 1.0 : 0.0, 1e-6);
    EXPECT_NEAR(arm.down, arm.letter == 'y' ? -1.0 : 0.0, 1e-6);
    EXPECT_NEAR(arm.away, arm.letter == 'z' ? -1.0 : 0.0, 1e-6);
  }
  settings.position = {5.0, 0.1, 0.0};
  // Nearest to the eye comes last.
  EXPECT_EQ(axes_seen(Camera(settings, 100, 100)).back().letter, 'x');
}

}  // namespace
}  // namespace aspic
