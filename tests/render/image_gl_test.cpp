// What an image shows stands where the state says.
#include <glad/gl.h>
#include <gtest/gtest.h>

#include <cmath>

#include "gpu_solver/gpu_solver.h"
#include "model/springs.h"
#include "render/overlay_text.h"
#include "render/studio.h"
#include "support/lattice_bodies.h"
#include "support/projection.h"

namespace aspic {
namespace {

class Image : public test::Studio {
 protected:
  static constexpr int width = 320, height = 240;

  /// A cube in empty space, seen from the front, on grounds that nothing else is on.
  static Model lonely_cube() {
    ModelSettings settings = test::cube_on_plane(4, 0.0);
    settings.terrain.clear();
    return test::build(settings);
  }
  static ImageOptions plain() {
    ImageOptions options;
    options.view.camera.position = {0.0, 0.0, 16.0};
    options.view.camera.target = {0.0, 0.0, 0.0};
    return options;
  }
  static bool differs(const test::Image& a, const test::Image& b, int x, int y) {
    int sum = 0;
    for (int c = 0; c < 3; ++c) sum += std::abs(a.channel(x, y, c) - b.channel(x, y, c));
    return sum > 12;
  }
};

/// The smallest box of pixels [left, right) × [top, bottom).
struct Box {
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  void add(double x0, double y0, double x1, double y1) {
    left = std::min(left, x0);
    right = std::max(right, x1);
    top = std::min(top, y0);
    bottom = std::max(bottom, y1);
  }
};

TEST_F(Image, CubeIsWhereItsStateSays) {
  const Model model = lonely_cube();
  ImageOptions empty = plain();
  empty.view.draw = {.solid = false};
  const test::Image background = draw(model, initial_state(model, Precision::single), empty, width, height);
  const Camera camera(plain().view.camera, width, height);
  for (const Vec3 offset : {Vec3{0, 0, 0}, Vec3{3.0, 1.5, 0.0}, Vec3{-2.0, -1.0, 2.0}}) {
    State state = initial_state(model, Precision::single);
    for (Vec3& x : state.position) x = x + offset;
    const test::Image image = draw(model, state, plain(), width, height);
    Box expected, seen;
    const auto middle = test::project(camera, offset);
    for (const Vec3& x : state.position) {
      const auto p = test::project(camera, x);
      ASSERT_TRUE(p && middle);
      expected.add(p->x, p->y, p->x, p->y);
      // A twentieth of the way inwards, every particle's pixel belongs to the cube.
      EXPECT_TRUE(differs(image, background, static_cast<int>(p->x + 0.05 * (middle->x - p->x)),
                          static_cast<int>(p->y + 0.05 * (middle->y - p->y))));
    }
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (differs(image, background, x, y)) seen.add(x, y, x + 1, y + 1);
    // A pixel that the outline touches counts or not by its share: at most one is missing or too many.
    EXPECT_NEAR(seen.left, expected.left, 1.0);
    EXPECT_NEAR(seen.right, expected.right, 1.0);
    EXPECT_NEAR(seen.top, expected.top, 1.0);
    EXPECT_NEAR(seen.bottom, expected.bottom, 1.0);
  }
}

TEST_F(Image, ParticlesAreBallsAtTheirPlaces) {
  const Model model = lonely_cube();
  ImageOptions options = plain();
  options.view.draw = {.solid = false, .particles = true};
  options.view.color = ViewColor::speed;  // at rest: the dark end of the scale, unlike the sky
  options.legend = false;
  const State state = initial_state(model, Precision::single);
  const test::Image with = draw(model, state, options, width, height);
  options.view.draw = {.solid = false};
  const test::Image without = draw(model, state, options, width, height);
  const Camera camera(options.view.camera, width, height);
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    const auto p = test::project(camera, state.position[i]);
    ASSERT_TRUE(p);
    EXPECT_TRUE(differs(with, without, static_cast<int>(p->x), static_cast<int>(p->y))) << "particle " << i;
  }
  // The middle of a lattice cell's face has none.
  const auto gap = test::project(camera, {4.0 / 3 + 2.0 / 3, 0.0, 2.0});
  EXPECT_FALSE(differs(with, without, static_cast<int>(gap->x) + 6, static_cast<int>(gap->y)));
}

TEST_F(Image, SpringsHaveTheirTypesColors) {
  const Model model = lonely_cube();
  ImageOptions options = plain();
  options.view.camera.position = {0.0, 0.0, 7.0};
  options.legend = false;
  const State state = initial_state(model, Precision::single);
  const auto colored = [&](const DrawSettings& draw_settings, int strong_a, int strong_b, int weak) {
    options.view.draw = draw_settings;
    const test::Image image = draw(model, state, options, width, height);
    int count = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        count += std::min(image.channel(x, y, strong_a), image.channel(x, y, strong_b)) >
                 image.channel(x, y, weak) + 60;
    return count;
  };
  EXPECT_GT(colored({.solid = false, .structural = true}, 1, 2, 0), 300);  // cyan: green and blue over red
  EXPECT_GT(colored({.solid = false, .shear = true}, 0, 1, 2), 300);       // yellow: red and green over blue
  EXPECT_GT(colored({.solid = false, .bending = true}, 1, 1, 0), 300);     // green over red
  EXPECT_EQ(colored({.solid = false}, 0, 1, 2), 0);
}

TEST_F(Image, GpuSolverIsDrawnFromItsOwnBuffer) {
  const Model model = test::build(test::cube_on_plane(6, 3.0));
  ImageOptions options;
  const test::Image from_state = draw(model, initial_state(model, Precision::single), options, width, height);
  auto solver = make_gpu_solver(context(), model);
  ASSERT_TRUE(solver.ok()) << solver.error().message();
  ASSERT_TRUE(renderer().draw(width, height, (*solver)->device_state(), options).ok());
  EXPECT_EQ(read(), from_state.rgb);
  ASSERT_TRUE((*solver)->advance(300).ok());
  ASSERT_TRUE(renderer().draw(width, height, (*solver)->device_state(), options).ok());
  const auto moved = read();
  EXPECT_NE(moved, from_state.rgb);
  const auto state = (*solver)->state();
  ASSERT_TRUE(state.ok());
  EXPECT_EQ(draw(model, *state, options, width, height).rgb, moved);
}

// Colors that show what springs do read the solver's incident words where they name neighbors of all bodies
// but whole cubes, else their own; of a whole cube there are none, and the colors are the same.
TEST_F(Image, QuantitiesOfTheSolversBuffersAreThoseOfItsState) {
  Model cube = test::build(test::cube_on_plane(6, 1.2)), listed = cube;
  list_springs(listed);
  Model cells = test::with_cells(test::cube_on_plane(2, 1.2), test::lattice_of("xxx,x.x,xxx;xxx,xxx,x.."));
  for (const ForcePathRow& path : force_paths()) {
    std::vector<std::vector<std::byte>> seen;
    for (Model* model : {&cube, &listed, &cells}) {
      GpuOptions gpu;
      gpu.force_path = path.path;
      auto solver = make_gpu_solver(context(), *model, gpu);
      ASSERT_TRUE(solver.ok()) << solver.error().message();
      ASSERT_TRUE((*solver)->advance(300).ok());
      const auto state = (*solver)->state();
      ASSERT_TRUE(state.ok());
      std::size_t n = 0;
      for (const ViewColor color : {ViewColor::strain, ViewColor::force, ViewColor::speed}) {
        ImageOptions options;
        options.view.color = color;
        ASSERT_TRUE(renderer().set_model(*model).ok());
        const std::uint64_t held = context().bytes_held();
        ASSERT_TRUE(renderer().draw(width, height, (*solver)->device_state(), options).ok());
        const auto own = read();
        const bool by_blocks = model == &cells && path.words == IncidentWords::beside_cells,
                   by_springs = model != &cube && path.words == IncidentWords::springs,
                   makes_words = (by_blocks || by_springs) && color != ViewColor::speed;
        const std::uint64_t words = 8 * spring_count(*model);
        EXPECT_EQ(context().bytes_held() - held >= words, makes_words) << path.name;
        EXPECT_EQ(draw(*model, *state, options, width, height).rgb, own) << path.name;
        if (model == &listed) {
          EXPECT_EQ(own, seen[n++]) << path.name;
        } else if (model == &cube) {
          for (const auto& other : seen) EXPECT_NE(own, other);
          seen.push_back(own);
        }
      }
    }
  }
}

TEST_F(Image, ShadowLiesOnTheGround) {
  ModelSettings settings = test::cube_on_plane(4, 1.0);
  const Model model = test::build(settings);
  ImageOptions options;
  options.view.draw = {.solid = false};
  const test::Image bare = draw(model, initial_state(model, Precision::single), options, width, height);
  options.view.draw = {.solid = true};
  const test::Image shadowed = draw(model, initial_state(model, Precision::single), options, width, height);
  // Beside the cube, on the side away from the sun, the ground darkens; far from it nothing changes.
  const Camera camera(options.view.camera, width, height);
  const auto near = test::project(camera, {2.6, -1.0, 0.5});
  const auto far = test::project(camera, {-6.0, -1.0, 0.0});
  const auto green = [](const test::Image& i, const test::Projected& p) {
    return i.channel(static_cast<int>(p.x), static_cast<int>(p.y), 1);
  };
  EXPECT_LT(green(shadowed, *near), green(bare, *near) - 25);
  EXPECT_NEAR(green(shadowed, *far), green(bare, *far), 1);
}

TEST_F(Image, TerrainThatIsNotDrawnLeavesNothing) {
  ModelSettings settings = test::cube_on_plane(4, 1.0);
  settings.terrain.emplace_back().shape = TerrainShape::sphere;
  settings.terrain.emplace_back().shape = TerrainShape::bowl;
  const Model model = test::build(settings);
  settings.terrain.clear();
  const Model bare = test::build(settings);
  const State state = initial_state(model, Precision::single);
  ImageOptions options;
  const test::Image without = draw(bare, state, options, width, height);
  EXPECT_NE(draw(model, state, options, width, height).rgb, without.rgb);
  options.view.terrain = false;
  EXPECT_EQ(draw(model, state, options, width, height).rgb, without.rgb);
}

TEST_F(Image, TextIsOnTheLeftAndCanBeLeftOut) {
  const Model model = test::build(test::cube_on_plane(3));
  ImageOptions options;
  const test::Image without = draw(model, initial_state(model, Precision::single), options, 640, 360);
  Scene scene;
  scene.model = test::cube_on_plane(3);
  options.text = overlay_lines(scene, 0.5);
  const test::Image with = draw(model, initial_state(model, Precision::single), options, 640, 360);
  int changed = 0, bright = 0, elsewhere = 0;
  for (int y = 0; y < 360; ++y) {
    for (int x = 0; x < 640; ++x) {
      const bool differs = with.channel(x, y, 1) != without.channel(x, y, 1);
      (x < 320 && y < 200 ? changed : elsewhere) += differs;
      bright += differs && with.channel(x, y, 0) > 200;
    }
  }
  EXPECT_GT(changed, 5000);
  EXPECT_GT(bright, 100);
  EXPECT_EQ(elsewhere, 0);
}

TEST_F(Image, EmptySkyAndDegenerateStatesAreDrawn) {
  const Model model = test::build(test::cube_on_plane(3));
  State state = initial_state(model, Precision::single);
  for (Vec3& x : state.position) x = {0.0, 1.0, 0.0};  // all particles in one point
  ImageOptions options;
  options.legend = options.shadows = false;
  options.view.draw = {.solid = false};
  const test::Image bare = draw(model, state, options, 64, 48);
  const auto place = test::project(Camera(options.view.camera, 64, 48), state.position[0]);
  ASSERT_TRUE(place.has_value());
  options.view.draw = {true, true, true, true, true};
  for (const ViewColor color :
       {ViewColor::material, ViewColor::type, ViewColor::strain, ViewColor::force, ViewColor::speed}) {
    options.view.color = color;
    const test::Image image = draw(model, state, options, 64, 48);
    int there = 0, elsewhere = 0;
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 64; ++x)
        if (image.channel(x, y, 0) != bare.channel(x, y, 0))
          ++(std::hypot(x + 0.5 - place->x, y + 0.5 - place->y) < 6.0 ? there : elsewhere);
    EXPECT_GT(there, 0) << static_cast<int>(color);
    EXPECT_EQ(elsewhere, 0) << static_cast<int>(color);
  }
  Model nothing;
  const test::Image sky = draw(nothing, State{}, options, 16, 16);
  EXPECT_GT(sky.channel(8, 0, 2), 100) << "the sky is blue";
}

TEST_F(Image, PresentsEncodedValues) {
  const Model model = test::build(test::cube_on_plane(3));
  const test::Image image = draw(model, initial_state(model, Precision::single), {}, 64, 48);
  // A framebuffer that stores values as they are, as a window's does.
  GLuint texture = 0, framebuffer = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, 64, 48);
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture, 0);
  renderer().present(framebuffer, 64, 48);
  std::vector<unsigned char> rgba(std::size_t{4} * 64 * 48);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glReadPixels(0, 0, 64, 48, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      // One rounding to 8 bits each way.
      EXPECT_NEAR(rgba[4 * static_cast<std::size_t>((47 - y) * 64 + x)], image.channel(x, y, 0), 1);
  glDeleteFramebuffers(1, &framebuffer);
  glDeleteTextures(1, &texture);
}

TEST_F(Image, TooLargeIsRefusedWithASentence) {
  const Model model = test::build(test::cube_on_plane(3));
  ASSERT_TRUE(renderer().set_model(model).ok());
  const auto particles = renderer().upload(initial_state(model, Precision::single));
  const Status drawn = renderer().draw(1 << 20, 16, *particles, {});
  ASSERT_FALSE(drawn.ok());
  EXPECT_NE(drawn.error().message().find("1048576 x 16"), std::string::npos) << drawn.error().message();
}

}  // namespace
}  // namespace aspic
