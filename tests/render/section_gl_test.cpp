// A cut takes away what lies beyond its plane, and fills what it crosses.
#include <glad/gl.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/color_map.h"
#include "render/studio.h"
#include "support/projection.h"

namespace aspic {
namespace {

class Cut : public test::Studio {
 protected:
  static constexpr int width = 320, height = 240;

  /// A cube 4 m wide around the origin, in empty space.
  static Model lonely_cube(int n) {
    ModelSettings settings = test::cube_on_plane(n, 0.0);
    settings.terrain.clear();
    return test::build(settings);
  }
  /// From the front along −z, on black; cut at z = `offset`.
  static ImageOptions from_front(double offset) {
    ImageOptions options;
    options.view.camera.position = {0.0, 0.0, 16.0};
    options.view.camera.target = {0.0, 0.0, 0.0};
    options.view.cut = {CutInside::section, {0.0, 0.0, 1.0}, offset};
    options.view.color = ViewColor::speed;
    options.view.scale.from = 0.0;
    options.view.scale.to = 4.0;
    options.background = Color{0.0f, 0.0f, 0.0f};
    options.legend = false;
    options.samples = 1;
    return options;
  }
  static Camera camera_of(const ImageOptions& options) { return {options.view.camera, width, height}; }
  static int lit_pixels(const test::Image& image) {
    int lit = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        lit += image.channel(x, y, 0) + image.channel(x, y, 1) + image.channel(x, y, 2) > 0;
    return lit;
  }
  std::optional<Picked> picked_at(const Camera& camera, const Vec3& point) {
    const auto seen = test::project(camera, point);
    const auto number = renderer().request_pick({seen->x, seen->y, width, height});
    EXPECT_TRUE(number.ok());
    glFinish();
    EXPECT_EQ(renderer().picked().request, *number);
    return renderer().picked().what;
  }
};

TEST_F(Cut, SectionIsAsLargeAsTheBodyIsThere) {
  // The last has more cells than are looked at together. Sheared along x by y, a cube's section stays as
  // large; what is kept lies behind it and looks smaller.
  for (const int n : {2, 5, 38}) {
    const Model model = lonely_cube(n);
    for (const double shear : {0.0, 0.25}) {
      State state = initial_state(model, Precision::single);
      for (Vec3& x : state.position) x.x += shear * x.y;
      for (const double offset : {-1.3, 0.0, 0.7}) {
        const ImageOptions options = from_front(offset);
        const test::Image image = draw(model, state, options, width, height);
        const double scale = test::pixels_per_meter(camera_of(options), 16.0 - offset);
        const double side = 4.0 * scale;
        // A pixel counts where its center is inside: along the outline half of them are off by less than one.
        EXPECT_NEAR(lit_pixels(image), side * side, 0.5 * 4.0 * std::hypot(1.0, shear) * side)
            << n << " at " << offset;
      }
    }
  }
}

TEST_F(Cut, SectionOfABoxIsAsLargeAsTheBoxIsThere) {
  ModelSettings settings = test::cube_on_plane(2, 0.0);
  settings.cubes[0].particles = {9, 5, 17};  // 2 m, 1 m and 4 m
  settings.terrain.clear();
  const Model model = test::build(settings);
  const State state = initial_state(model, Precision::single);
  for (const double offset : {-1.3, 0.0, 0.7}) {
    const ImageOptions options = from_front(offset);
    const double scale = test::pixels_per_meter(camera_of(options), 16.0 - offset);
    const double width_seen = 2.0 * scale, height_seen = 1.0 * scale;
    EXPECT_NEAR(lit_pixels(draw(model, state, options, width, height)), width_seen * height_seen,
                0.5 * 2.0 * (width_seen + height_seen))
        << offset;
  }
}

TEST_F(Cut, SectionHasTheLegendsColors) {
  const Model model = lonely_cube(5);
  State state = initial_state(model, Precision::single);
  // Evenly varying speed: between particles the section has what lies between their colors' values.
  for (std::size_t i = 0; i < state.velocity.size(); ++i)
    state.velocity[i] = {0.0, 2.0 + 0.5 * state.position[i].x + 0.25 * state.position[i].z, 0.0};
  const ImageOptions options = from_front(0.3);
  const test::Image image = draw(model, state, options, width, height);
  const std::vector<std::byte> texels = color_map_texels(chosen_map(options.view));
  for (const double x : {-1.5, -0.5, 0.5, 1.5}) {
    for (const double y : {-1.5, 0.5}) {
      const auto at = test::project(camera_of(options), {x, y, 0.3});
      const double value = (2.0 + 0.5 * x + 0.25 * 0.3) / 4.0;
      const auto texel = 4 * static_cast<std::size_t>(std::lround(255.0 * value));
      for (int c = 0; c < 3; ++c)
        // A pixel is a sixtieth of the cube wide, so four of the scale's 256 colors.
        EXPECT_NEAR(image.channel(static_cast<int>(at->x), static_cast<int>(at->y), c),
                    std::to_integer<int>(texels[texel + static_cast<std::size_t>(c)]), 6)
            << x << ' ' << y << ' ' << c;
    }
  }
}

TEST_F(Cut, BesideTheBodyItTakesAllOrNothing) {
  const Model model = lonely_cube(4);
  const State state = initial_state(model, Precision::single);
  for (const bool springs : {false, true}) {
    ImageOptions options = from_front(0.0);
    options.view.color = ViewColor::material;
    if (springs) options.view.draw = {.solid = true, .particles = true, .structural = true, .bending = true};
    options.view.cut.inside = CutInside::off;
    const test::Image whole = draw(model, state, options, width, height);
    options.view.cut.inside = CutInside::section;
    options.view.cut.offset = 2.5;
    EXPECT_EQ(draw(model, state, options, width, height).rgb, whole.rgb);
    options.view.cut.offset = -2.5;
    EXPECT_EQ(lit_pixels(draw(model, state, options, width, height)), 0);
    // From the other side.
    options.view.cut.normal = {0.0, 0.0, -3.0};
    options.view.cut.offset = 2.5;
    EXPECT_EQ(draw(model, state, options, width, height).rgb, whole.rgb);
  }
}

TEST_F(Cut, SpringsStandOneSpacingDeepBeforeTheSection) {
  const Model model = lonely_cube(5);
  const State state = initial_state(model, Precision::single);
  ImageOptions options = from_front(0.0);
  options.view.color = ViewColor::type;
  options.view.draw.solid = false;
  options.view.cut.inside = CutInside::springs;
  const Camera camera = camera_of(options);
  const test::Image image = draw(model, state, options, width, height);
  // A structural spring ends at the particle (0, 0, 0), which lies on the plane: cyan.
  const auto on_spring = test::project(camera, {0.5, 0.0, -0.02});
  const auto on_ground = test::project(camera, {0.82, 0.31, -1.0});
  const auto green_of = [&](const auto& at, int c) {
    return image.channel(static_cast<int>(at->x), static_cast<int>(at->y), c);
  };
  EXPECT_GT(green_of(on_spring, 2), green_of(on_spring, 0) + 60);
  EXPECT_LT(std::abs(green_of(on_ground, 2) - green_of(on_ground, 0)), 40);
  EXPECT_GT(green_of(on_ground, 1), 0);
  // Nothing of the springs is left before the plane: the image is as wide as the section and what ends
  // there.
  EXPECT_LT(lit_pixels(image), std::pow(4.3 * test::pixels_per_meter(camera, 16.0), 2));
}

TEST_F(Cut, ParticlesOfTheSectionArePickedAndThoseCutAwayAreNot) {
  const Model model = lonely_cube(5);
  const State state = initial_state(model, Precision::single);
  const ImageOptions options = from_front(0.1);
  (void)draw(model, state, options, width, height);
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    const Vec3& x = state.position[i];
    // Those next behind the plane, and not on the outline.
    if (std::abs(x.z) > 0.01 || std::abs(x.x) > 1.5 || std::abs(x.y) > 1.5) continue;
    const auto what = picked_at(camera_of(options), {x.x, x.y, 0.1});
    ASSERT_TRUE(what && what->kind == PickKind::particle);
    EXPECT_EQ(what->index, i);
    EXPECT_NEAR(what->distance, 15.9, 1e-3);
  }
  // Seen from above, the front edge is gone.
  ImageOptions above = options;
  above.view.camera.position = {0.0, 16.0, 0.01};
  (void)draw(model, state, above, width, height);
  EXPECT_FALSE(picked_at(camera_of(above), {0.0, 2.0, 1.5}).has_value());
  EXPECT_TRUE(picked_at(camera_of(above), {0.0, 2.0, -1.5}).has_value());
}

class Orthographic : public Cut {};

TEST_F(Orthographic, PicksTheSameParticlesAsPerspective) {
  const Model model = lonely_cube(6);
  const State state = initial_state(model, Precision::single);
  for (const bool solid : {true, false}) {
    ImageOptions options = from_front(0.0);
    options.view.cut.inside = CutInside::off;
    options.view.draw = {.solid = solid, .particles = !solid};
    options.view.camera.position = {6.0, 7.0, 12.0};
    options.view.camera.projection = Projection::orthographic;
    (void)draw(model, state, options, width, height);
    const Camera camera = camera_of(options);
    for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
      const Vec3& x = state.position[i];
      if (x.z < 1.99 || std::abs(x.x) > 1.5 || std::abs(x.y) > 1.5) continue;
      const auto what = picked_at(camera, x);
      ASSERT_TRUE(what && what->kind == PickKind::particle) << solid << ' ' << i;
      EXPECT_EQ(what->index, i);
      // On the skin at the pixel's middle, or within a pixel of the particle.
      EXPECT_LT(length(what->point - x), 2.0 / test::pixels_per_meter(camera, 1.0));
    }
  }
}

TEST_F(Orthographic, TheNearAndTheFarFaceAreAsLarge) {
  const Model model = lonely_cube(4);
  const State state = initial_state(model, Precision::single);
  ImageOptions options = from_front(0.0);
  options.view.camera.projection = Projection::orthographic;
  for (const double distance : {16.0, 12.0, 9.0}) {  // what zooming changes
    options.view.camera.position = {0.0, 0.0, distance};
    const double side = 4.0 * test::pixels_per_meter(camera_of(options), 1.0);
    for (const CutInside inside : {CutInside::off, CutInside::section}) {
      options.view.cut.inside = inside;
      EXPECT_NEAR(lit_pixels(draw(model, state, options, width, height)), side * side, 2.0 * side);
    }
  }
}

TEST_F(Orthographic, BallsAndTerrainArePickedWhereTheyAre) {
  ModelSettings settings;
  settings.terrain.emplace_back();
  settings.balls.push_back({.radius = 0.5, .position = {1.0, 2.0, 0.5}});
  const Model model = test::build(settings);
  ImageOptions options;
  options.view.camera.projection = Projection::orthographic;
  (void)draw(model, initial_state(model, Precision::single), options, width, height);
  const Camera camera = camera_of(options);
  const auto ball = picked_at(camera, {1.0, 2.0, 0.5});
  ASSERT_TRUE(ball && ball->kind == PickKind::ball);
  EXPECT_NEAR(length(ball->point - Vec3{1.0, 2.0, 0.5}), 0.5, 2.0 / test::pixels_per_meter(camera, 1.0));
  const Vec3 spot = {-2.0, -1.0, 1.0};
  const auto ground = picked_at(camera, spot);
  ASSERT_TRUE(ground && ground->kind == PickKind::terrain);
  EXPECT_LT(length(ground->point - spot), 3.0 / test::pixels_per_meter(camera, 1.0));
}

}  // namespace
}  // namespace aspic
