// What is picked is what the image shows under the cursor.
#include <glad/gl.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/terrain.h"
#include "render/light_maps.h"
#include "render/studio.h"
#include "support/projection.h"

namespace aspic {
namespace {

class Pick : public test::Studio {
 protected:
  static constexpr int width = 320, height = 240;

  static ImageOptions from(const Vec3& position, const Vec3& target = {}) {
    ImageOptions options;
    options.view.camera.position = position;
    options.view.camera.target = target;
    options.legend = false;
    return options;
  }
  /// A cube of n per edge in empty space, 4 m wide, around the origin.
  static ModelSettings lonely_cube(int n) {
    ModelSettings settings = test::cube_on_plane(n, 0.0);
    settings.terrain.clear();
    return settings;
  }
  void show(const Model& model, const ImageOptions& options) {
    shown_ = initial_state(model, Precision::single);
    (void)draw(model, shown_, options, width, height);
    camera_.emplace(options.view.camera, width, height);
  }
  /// What lies under a place of the image, waited for.
  std::optional<Picked> at(double x, double y) {
    const auto number = renderer().request_pick({x, y, width, height});
    if (!number) {
      ADD_FAILURE() << number.error().message();
      return std::nullopt;
    }
    glFinish();
    const PickAnswer answer = renderer().picked();
    EXPECT_EQ(answer.request, *number);
    return answer.what;
  }
  std::optional<Picked> at(const Vec3& point, double right = 0.0, double down = 0.0) {
    const auto seen = test::project(camera(), point);
    EXPECT_TRUE(seen.has_value());
    return at(seen->x + right, seen->y + down);
  }
  const Camera& camera() const { return *camera_; }
  const State& shown() const { return shown_; }

 private:
  State shown_;
  std::optional<Camera> camera_;
};

TEST_F(Pick, SkinStandsForItsNearestParticle) {
  const int n = 5;
  const Model model = test::build(lonely_cube(n));
  show(model, from({0.0, 0.0, 14.0}));
  // The face z = 2, whose particles are a meter apart.
  for (const double x : {-1.9, -1.3, -0.4, 0.2, 0.9, 1.7}) {
    for (const double y : {-1.8, -0.7, 0.1, 0.6, 1.4}) {
      const auto picked = at(Vec3{x, y, 2.0});
      ASSERT_TRUE(picked) << x << ", " << y;
      EXPECT_EQ(picked->kind, PickKind::particle);
      const auto i = static_cast<std::uint32_t>(std::lround(x + 2.0)),
                 j = static_cast<std::uint32_t>(std::lround(y + 2.0));
      EXPECT_EQ(picked->index, (i * n + j) * n + (n - 1)) << x << ", " << y;
      // Half a pixel to each side of where the sight line was asked for, and single precision.
      const double pixel = 1.0 / test::pixels_per_meter(camera(), 12.0);
      EXPECT_NEAR(length(picked->point - Vec3{x, y, 2.0}), 0.0, 0.75 * pixel);
      EXPECT_NEAR(picked->distance, 12.0, 1e-4);
    }
  }
  EXPECT_FALSE(at(Vec3{2.0, 0.0, 2.0}, pick_reach + 2));
  EXPECT_TRUE(at(Vec3{2.0, 0.0, 2.0}, pick_reach - 2)) << "beside the outline, but near";
}

TEST_F(Pick, ParticlesAreMeantFromNearAndTheFrontOnesFirst) {
  const int n = 3;
  const Model model = test::build(lonely_cube(n));
  for (const DrawSettings& draw :
       {DrawSettings{.solid = false, .particles = true}, DrawSettings{.solid = false, .structural = true},
        DrawSettings{.solid = false, .shear = true}}) {
    ImageOptions options = from({2.0, 3.0, 14.0});
    options.view.draw = draw;
    show(model, options);
    // In meters: a ball's where balls are drawn, at least three pixels.
    const double drawn = draw.particles ? particle_radius(2.0) : 0.0;
    int checked = 0;
    for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
      const auto place = test::project(camera(), shown().position[i]);
      ASSERT_TRUE(place);
      // The foremost of the discs that cover this pixel, unless an outline passes through it.
      std::uint32_t expected = i;
      bool on_outline = false;
      for (std::uint32_t k = 0; k < model.particle_count(); ++k) {
        const auto other = test::project(camera(), shown().position[k]);
        const double off = std::hypot(other->x - place->x, other->y - place->y);
        const double radius = std::max(3.0, drawn * test::pixels_per_meter(camera(), other->distance));
        on_outline = on_outline || std::abs(off - radius) < 1.5;
        if (off < radius && other->distance < test::project(camera(), shown().position[expected])->distance)
          expected = k;
      }
      if (on_outline) continue;
      const auto picked = at(shown().position[i]);
      ASSERT_TRUE(picked);
      EXPECT_EQ(picked->kind, PickKind::particle);
      EXPECT_EQ(picked->index, expected);
      ++checked;
    }
    EXPECT_GE(checked, 18);
    // Nearer to one of two neighbors.
    const std::uint32_t corner = (0 * n + 2) * n + 2;
    EXPECT_EQ(at(shown().position[corner], -8.0, -4.0)->index, corner);
    EXPECT_FALSE(at(shown().position[corner], -30.0, -30.0));
  }
  ImageOptions nothing = from({0.0, 0.0, 14.0});
  nothing.view.draw = {.solid = false};
  show(model, nothing);
  EXPECT_FALSE(at(Vec3{0.0, 0.0, 2.0})) << "what is not drawn is not picked";
}

TEST_F(Pick, SolidBodiesHideWhatLiesBehindThem) {
  ModelSettings settings = lonely_cube(3);
  CubeSettings behind = settings.cubes[0];
  behind.position = {0.5, 0.3, -8.0};
  behind.edge_length = 2.0;
  settings.cubes.push_back(behind);
  BallSettings ball;
  ball.position = {0.4, 0.2, -4.0};
  ball.radius = 0.5;
  settings.balls.push_back(ball);
  const Model model = test::build(settings);
  show(model, from({0.0, 0.0, 14.0}));
  const std::uint32_t first_behind = model.bodies[1].first_particle;
  for (std::uint32_t i = first_behind; i < model.particle_count(); ++i) {
    const auto picked = at(shown().position[i]);
    ASSERT_TRUE(picked);
    EXPECT_EQ(picked->kind, PickKind::particle);
    EXPECT_LT(picked->index, first_behind);
  }
  EXPECT_EQ(at(ball.position)->kind, PickKind::particle);
  // From the other side they are what is seen.
  show(model, from({0.0, 0.0, -22.0}));
  const auto middle = first_behind + (1 * 3 + 1) * 3;  // of the face towards the eye
  EXPECT_EQ(at(shown().position[middle])->index, middle);
}

TEST_F(Pick, BallsAndTerrainAreMetWhereTheSightLineMeetsThem) {
  ModelSettings settings;
  settings.terrain.push_back({});
  TerrainSettings globe;
  globe.shape = TerrainShape::sphere;
  const Vec3 center = {-4.0, 0.0, 0.0};
  globe.geometry["center"] = center;
  globe.geometry["radius"] = 1.5;
  settings.terrain.push_back(globe);
  BallSettings ball;
  ball.position = {3.0, 1.0, 0.0};
  ball.radius = 1.0;
  settings.balls.push_back(ball);
  const Model model = test::build(settings);
  show(model, from({0.0, 3.0, 14.0}, {0.0, 1.0, 0.0}));
  const auto of_ball = at(ball.position);
  ASSERT_TRUE(of_ball);
  EXPECT_EQ(of_ball->kind, PickKind::ball);
  EXPECT_EQ(of_ball->index, 0u);
  // Single precision at this distance.
  EXPECT_NEAR(length(of_ball->point - ball.position), 1.0, 1e-4);
  const auto of_globe = at(center);
  ASSERT_TRUE(of_globe);
  EXPECT_EQ(of_globe->kind, PickKind::terrain);
  EXPECT_EQ(of_globe->index, 1u);
  EXPECT_NEAR(signed_distance(model.terrain[1], of_globe->point), 0.0, 1e-4);
  EXPECT_LT(length(of_globe->point - Vec3{0.0, 3.0, 14.0}), length(center - Vec3{0.0, 3.0, 14.0}));
  const Vec3 place = {0.5, -1.0, 3.0};
  const auto of_ground = at(place);
  ASSERT_TRUE(of_ground);
  EXPECT_EQ(of_ground->kind, PickKind::terrain);
  EXPECT_EQ(of_ground->index, 0u);
  EXPECT_NEAR(signed_distance(model.terrain[0], of_ground->point), 0.0, 1e-4);
  // A pixel covers the more of the ground the lower the sight line.
  const double pixel =
      1.0 / test::pixels_per_meter(camera(), of_ground->distance) / (4.0 / length(place - Vec3{0, 3, 14}));
  EXPECT_NEAR(length(of_ground->point - place), 0.0, 0.75 * pixel);
  EXPECT_FALSE(at(160.0, 2.0)) << "the sky";
  ImageOptions bare = from({0.0, 3.0, 14.0}, {0.0, 1.0, 0.0});
  bare.view.terrain = false;
  show(model, bare);
  EXPECT_TRUE(at(ball.position));
  EXPECT_FALSE(at(center)) << "terrain that is not drawn";
}

TEST_F(Pick, GroundHidesWhatLiesBelowItAndWaitingBallsAreNotThere) {
  ModelSettings settings = test::cube_on_plane(2, -8.0);
  BallSettings ball;
  ball.position = {0.0, 3.0, 0.0};
  settings.balls.push_back(ball);
  Model model = test::build(settings);
  model.balls[0].launch_step = 5;
  show(model, from({0.0, 6.0, 14.0}));
  for (const Vec3& x : shown().position) EXPECT_EQ(at(x)->kind, PickKind::terrain);
  EXPECT_NE(at(ball.position)->kind, PickKind::ball);
  // Seen from below the ground is glass.
  show(model, from({0.0, -6.0, 14.0}, {0.0, -8.0, 0.0}));
  EXPECT_EQ(at(shown().position[1])->kind, PickKind::particle);
}

TEST_F(Pick, BowlsAreSeenThrough) {
  ModelSettings settings = test::cube_on_plane(3, 0.0);
  settings.terrain[0].shape = TerrainShape::bowl;
  settings.terrain[0].geometry["center"] = Vec3{};
  settings.terrain[0].geometry["radius"] = 5.0;
  const Model model = test::build(settings);
  show(model, from({0.0, 0.0, 16.0}));
  EXPECT_EQ(at(Vec3{0.0, 0.0, 2.0})->kind, PickKind::particle);
  const auto wall = at(Vec3{4.0, 0.0, 0.0});
  ASSERT_TRUE(wall);
  EXPECT_EQ(wall->kind, PickKind::terrain);
  EXPECT_LT(wall->point.z, 0.0) << "the far wall";
}

TEST_F(Pick, NetsArePickedByTheirKnots) {
  ModelSettings settings;
  GoalNetSettings net;
  net.particles = {4, 5, 6};
  settings.goal_nets.push_back(net);
  const Model model = test::build(settings);
  ImageOptions options = from({9.0, 3.0, 7.0}, {0.0, 0.6, 0.0});
  for (const bool solid : {true, false}) {
    options.view.draw = {.solid = solid, .structural = !solid};
    show(model, options);
    int own = 0;
    for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
      const auto picked = at(shown().position[i]);
      ASSERT_TRUE(picked);
      own += picked->index == i;
      // Another only where it stands before this one.
      const auto other = test::project(camera(), shown().position[picked->index]);
      EXPECT_LE(other->distance, test::project(camera(), shown().position[i])->distance + 1e-6);
      EXPECT_LE(std::hypot(other->x - test::project(camera(), shown().position[i])->x,
                           other->y - test::project(camera(), shown().position[i])->y),
                5.0);
    }
    EXPECT_GE(own, 0.8 * model.particle_count());
  }
}

TEST_F(Pick, ViewsOfOtherSizesShowTheSameImage) {
  const Model model = test::build(lonely_cube(5));
  show(model, from({0.0, 0.0, 14.0}));
  const auto small = at(Vec3{-0.9, 1.1, 2.0});
  const auto seen = test::project(camera(), {-0.9, 1.1, 2.0});
  ASSERT_TRUE(renderer().request_pick({4.0 * seen->x, 4.0 * seen->y, 4.0 * width, 4.0 * height}).ok());
  glFinish();
  const auto large = renderer().picked().what;
  ASSERT_TRUE(small && large);
  EXPECT_EQ(large->index, small->index);
  const double pixel = 0.25 / test::pixels_per_meter(camera(), 12.0);
  EXPECT_NEAR(length(large->point - Vec3{-0.9, 1.1, 2.0}), 0.0, 0.75 * pixel);
}

TEST_F(Pick, AnswersComeInOrderAndOnlyTheLastPlaceCounts) {
  const Model model = test::build(lonely_cube(3));
  show(model, from({0.0, 0.0, 14.0}));
  EXPECT_EQ(renderer().picked().request, 0u);
  std::uint64_t last = 0;
  for (int i = 0; i < 7; ++i) {
    const auto number = renderer().request_pick({i < 6 ? 1.0 : 160.0, 120.0, width, height});
    ASSERT_TRUE(number.ok());
    EXPECT_EQ(*number, last + 1);
    last = *number;
    EXPECT_LE(renderer().picked().request, last) << "nobody waits";
  }
  glFinish();
  EXPECT_EQ(renderer().picked().request, last);
  EXPECT_TRUE(renderer().picked().what);
  // Another model's particles are others.
  const Model other = test::build(lonely_cube(2));
  ASSERT_TRUE(renderer().set_model(other).ok());
  EXPECT_EQ(renderer().picked().request, 0u);
  EXPECT_FALSE(renderer().picked().what);
}

TEST_F(Pick, LeavesTheImageAsItWas) {
  const Model model = test::build(test::cube_on_plane(4, 2.0));
  const ImageOptions options;
  const test::Image before = draw(model, initial_state(model, Precision::single), options, width, height);
  (void)at(160.0, 120.0);
  EXPECT_EQ(read(), before.rgb);
  EXPECT_EQ(draw(model, initial_state(model, Precision::single), options, width, height).rgb, before.rgb);
}

}  // namespace
}  // namespace aspic
