// Marks stand at their particles, and nowhere when nobody asks.
#include <glad/gl.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/studio.h"
#include "support/projection.h"

namespace aspic {
namespace {

class Highlight : public test::Studio {
 protected:
  static constexpr int width = 320, height = 240;

  static Model lonely_cube(bool pinned = false) {
    ModelSettings settings = test::cube_on_plane(3, 0.0);
    settings.terrain.clear();
    if (pinned) settings.cubes[0].pinned.names = {"top"};
    return test::build(settings);
  }
  static ImageOptions plain() {
    ImageOptions options;
    options.view.camera.position = {4.0, 3.0, 13.0};
    options.view.camera.target = {};
    options.legend = false;
    return options;
  }
  /// The cube with and without marks.
  void show(const Model& model, ImageOptions options, const HighlightOptions& marks) {
    state_ = initial_state(model, Precision::single);
    without_ = draw(model, state_, options, width, height);
    options.highlight = marks;
    with_ = draw(model, state_, options, width, height);
    camera_.emplace(options.view.camera, width, height);
  }
  test::Projected place(const Vec3& point) const { return test::project(*camera_, point).value(); }
  test::Projected place(std::uint32_t particle) const { return place(state_.position[particle]); }
  /// How far a pixel is from what it was without marks.
  int change(double x, double y) const {
    int sum = 0;
    for (int c = 0; c < 3; ++c)
      sum += std::abs(with_.channel(static_cast<int>(x), static_cast<int>(y), c) -
                      without_.channel(static_cast<int>(x), static_cast<int>(y), c));
    return sum;
  }
  /// Changed pixels, by whether `expected(x, y)` says that marks are there.
  template <class Expected>
  std::array<int, 2> changed(const Expected& expected) const {
    std::array<int, 2> count = {};
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (change(x, y) > 0) ++count[expected(x + 0.5, y + 0.5) ? 1 : 0];
    return count;
  }
  static double off(const test::Projected& p, double x, double y) { return std::hypot(p.x - x, p.y - y); }

 private:
  State state_;
  test::Image with_, without_;
  std::optional<Camera> camera_;
};

TEST_F(Highlight, RingLiesAroundTheHoveredParticle) {
  const Model model = lonely_cube();
  const std::uint32_t corner = 26;
  show(model, plain(), {.hovered = corner});
  const test::Projected p = place(corner);
  const auto count = changed([&](double x, double y) { return off(p, x, y) < 11.0 && off(p, x, y) > 4.0; });
  EXPECT_GT(count[1], 100);
  EXPECT_EQ(count[0], 0) << "neither beyond the ring nor within it";
  EXPECT_GT(change(p.x + 7.2, p.y), 60);
  EXPECT_GT(change(p.x, p.y - 7.2), 60);
  show(model, plain(), {.hovered = corner, .unit = 2.0});
  EXPECT_GT(change(p.x + 14.4, p.y), 60) << "twice as large";
}

TEST_F(Highlight, PullIsABandToItsAnchor) {
  const Model model = lonely_cube();
  const std::uint32_t corner = 26;
  const Vec3 anchor = {3.5, 2.8, 3.0};
  show(model, plain(), {.pull = HighlightOptions::Pull{corner, anchor}});
  const test::Projected a = place(corner), b = place(anchor);
  const double long_way = off(a, b.x, b.y);
  for (const double share : {0.1, 0.3, 0.5, 0.7})
    EXPECT_GT(change(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)), 60) << share;
  EXPECT_GT(change(b.x, b.y), 60);
  const auto count = changed([&](double x, double y) {
    const double along = ((x - a.x) * (b.x - a.x) + (y - a.y) * (b.y - a.y)) / long_way;
    const double aside = std::abs((x - a.x) * (b.y - a.y) - (y - a.y) * (b.x - a.x)) / long_way;
    return off(b, x, y) < 10.0 || (along > -1.5 && along < long_way && aside < 4.0);
  });
  EXPECT_GT(count[1], 200);
  EXPECT_EQ(count[0], 0);
}

TEST_F(Highlight, HiddenMarksAreFaint) {
  const Model model = lonely_cube();
  const std::uint32_t front = 26, back = 0;  // corners towards the eye and away from it
  show(model, plain(), {.marked = {front, back}});
  const test::Projected f = place(front), b = place(back);
  EXPECT_GT(change(f.x, f.y), 60);
  EXPECT_GT(change(b.x, b.y), 10);
  EXPECT_LT(change(b.x, b.y), change(f.x, f.y) / 2);
  const auto count = changed([&](double x, double y) { return off(f, x, y) < 10.0 || off(b, x, y) < 10.0; });
  EXPECT_EQ(count[0], 0);
}

TEST_F(Highlight, PinnedParticlesAreMarkedWhereParticlesAreDrawn) {
  const Model model = lonely_cube(true);
  ImageOptions options = plain();
  show(model, options, {});
  EXPECT_EQ(changed([](double, double) { return true; })[1], 0) << "solid alone shows none";
  options.view.draw = {.solid = false, .particles = true};
  options.view.color = ViewColor::speed;
  show(model, options, {.pinned = false});
  EXPECT_EQ(changed([](double, double) { return true; })[1], 0);
  show(model, options, {});
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    const test::Projected p = place(i);
    if (model.inverse_mass[i] > 0.0) continue;
    EXPECT_GT(change(p.x, p.y), 60) << i;
  }
  const auto count = changed([&](double x, double y) {
    for (std::uint32_t i = 0; i < model.particle_count(); ++i)
      if (model.inverse_mass[i] == 0.0 && off(place(i), x, y) < 7.0) return true;
    return false;
  });
  EXPECT_EQ(count[0], 0) << "the others bear none";
}

TEST_F(Highlight, GoesOverAPresentedImageToo) {
  const Model model = lonely_cube();
  const State state = initial_state(model, Precision::single);
  const test::Image image = draw(model, state, plain(), width, height);
  // A window twice the image's size that stores values as they are, with room around the view.
  const int left = 10, bottom = 20, wide = 2 * width, high = 2 * height;
  GLuint texture = 0, framebuffer = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, wide + 40, high + 40);
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture, 0);
  const auto look = [&] {
    std::vector<unsigned char> rgba(4 * static_cast<std::size_t>(wide + 40) *
                                    static_cast<std::size_t>(high + 40));
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glReadPixels(0, 0, wide + 40, high + 40, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return rgba;
  };
  renderer().present(framebuffer, wide, high, left, bottom);
  const auto before = look();
  ASSERT_TRUE(renderer().present_highlight({.hovered = 26}, framebuffer, wide, high, left, bottom).ok());
  const auto after = look();
  const test::Projected p =
      test::project(Camera(plain().view.camera, wide, high), state.position[26]).value();
  int on_ring = 0, elsewhere = 0;
  for (int y = 0; y < high + 40; ++y) {
    for (int x = 0; x < wide + 40; ++x) {
      const std::size_t at = 4 * static_cast<std::size_t>(y * (wide + 40) + x);
      if (std::equal(before.begin() + static_cast<std::ptrdiff_t>(at),
                     before.begin() + static_cast<std::ptrdiff_t>(at + 4),
                     after.begin() + static_cast<std::ptrdiff_t>(at)))
        continue;
      const double away = std::hypot(x + 0.5 - left - p.x, y + 0.5 - bottom - (high - p.y));
      ++(away < 11.0 && away > 4.0 ? on_ring : elsewhere);
    }
  }
  EXPECT_GT(on_ring, 100);
  EXPECT_EQ(elsewhere, 0);
  EXPECT_EQ(read(), image.rgb) << "the image itself bears no mark";
  glDeleteFramebuffers(1, &framebuffer);
  glDeleteTextures(1, &texture);
}

TEST_F(Highlight, DegeneratePullsAreDrawn) {
  const Model model = lonely_cube();
  const State state = initial_state(model, Precision::single);
  ImageOptions options = plain();
  const test::Image bare = draw(model, state, options, width, height);
  // To itself, to the eye, which shows nothing, and to behind it.
  const std::pair<Vec3, int> cases[] = {
      {state.position[26], 100}, {options.view.camera.position, 0}, {{8.0, 6.0, 26.0}, 100}};
  for (const auto& [anchor, least] : cases) {
    options.highlight = HighlightOptions{.pull = HighlightOptions::Pull{26, anchor}};
    const test::Image image = draw(model, state, options, width, height);
    int changed = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) changed += image.channel(x, y, 1) != bare.channel(x, y, 1);
    EXPECT_GE(changed, least);
    EXPECT_LT(changed, width * height / 50);
  }
}

class Shadows : public test::Studio {};

TEST_F(Shadows, CanBeLeftOut) {
  ModelSettings settings = test::cube_on_plane(4, 1.5);
  TerrainSettings globe;
  globe.shape = TerrainShape::sphere;
  globe.geometry["center"] = Vec3{-7.0, 1.0, 0.0};
  globe.geometry["radius"] = 1.0;
  settings.terrain.push_back(globe);
  const Model model = test::build(settings);
  const State state = initial_state(model, Precision::single);
  ImageOptions options;
  options.legend = false;
  options.view.draw = {.solid = false};
  options.shadows = false;
  const test::Image bare = draw(model, state, options, 320, 240);
  options.view.draw = {.solid = true};
  const test::Image unshadowed = draw(model, state, options, 320, 240);
  options.shadows = true;
  const test::Image shadowed = draw(model, state, options, 320, 240);
  const Camera camera(options.view.camera, 320, 240);
  const auto green = [&](const test::Image& image, const Vec3& at) {
    const auto p = test::project(camera, at);
    return image.channel(static_cast<int>(p->x), static_cast<int>(p->y), 1);
  };
  const Vec3 beside = {2.9, -1.0, 0.5};
  EXPECT_LT(green(shadowed, beside), green(bare, beside) - 20);
  EXPECT_EQ(green(unshadowed, beside), green(bare, beside)) << "as if nothing stood there";
  const Vec3 middle = {0.0, 1.5, 2.0};
  EXPECT_NE(green(unshadowed, middle), green(bare, middle)) << "the cube is there all the same";
  // And back again.
  EXPECT_EQ(draw(model, state, options, 320, 240).rgb, shadowed.rgb);
}

}  // namespace
}  // namespace aspic
