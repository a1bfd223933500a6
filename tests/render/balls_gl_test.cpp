// Balls stand where a state says, once they are launched, and turn from image to image.
#include <gtest/gtest.h>

#include <cmath>

#include "gpu_solver/gpu_solver.h"
#include "render/studio.h"
#include "support/projection.h"

namespace aspic {
namespace {

constexpr double pi = 3.14159265358979323846;

class Balls : public test::Studio {
 protected:
  static constexpr int width = 160, height = 120;

  /// A ball in empty space that floats and turns once in 1000 steps.
  static ModelSettings spinning_ball() {
    ModelSettings settings;
    settings.simulation.gravity = {};
    BallSettings ball;
    ball.radius = 1.0;
    ball.position = {0.5, 0.25, 0.0};
    ball.velocity = {};
    ball.angular_velocity = {0.0, 2.0 * pi / (1000.0 * settings.simulation.timestep), 0.0};
    settings.balls.push_back(ball);
    return settings;
  }
  static ImageOptions plain() {
    ImageOptions options;
    options.view.camera.position = {0.0, 0.0, 8.0};
    options.view.camera.target = {0.0, 0.0, 0.0};
    options.legend = false;
    return options;
  }
  test::Image next(const State& state) {
    const auto uploaded = renderer().upload(state);
    EXPECT_TRUE(uploaded.ok());
    EXPECT_TRUE(renderer().draw(width, height, *uploaded, plain()).ok());
    return {width, height, read()};
  }
  static int different(const test::Image& a, const test::Image& b) {
    int count = 0;
    for (int y = 0; y < a.height; ++y) {
      for (int x = 0; x < a.width; ++x) {
        int sum = 0;
        for (int c = 0; c < 3; ++c) sum += std::abs(a.channel(x, y, c) - b.channel(x, y, c));
        count += sum > 24;
      }
    }
    return count;
  }
};

TEST_F(Balls, AreDiscsWhereTheStateSays) {
  const Model model = test::build(spinning_ball());
  ImageOptions empty = plain();
  empty.view.draw = {.solid = false};
  const State state = initial_state(model, Precision::single);
  const test::Image background = draw(model, state, empty, width, height);
  const test::Image image = draw(model, state, plain(), width, height);
  const Camera camera(plain().view.camera, width, height);
  // The outline is where sight lines touch the sphere.
  const Vec3 eye = plain().view.camera.position, x = state.ball_position[0];
  const double away = length(x - eye), sine = 1.0 / away;
  const double outline = 1.0 * std::sqrt(1.0 - sine * sine);
  const Vec3 towards = (1.0 / away) * (x - eye);
  const Vec3 aside = cross(towards, {0.0, 1.0, 0.0});
  const Vec3 touch = x - sine * towards;
  const Vec3 right = (outline / length(aside)) * aside;
  const auto seen = [&](const Vec3& at) {
    const auto p = test::project(camera, at);
    int sum = 0;
    for (int c = 0; c < 3; ++c)
      sum += std::abs(image.channel(static_cast<int>(p->x), static_cast<int>(p->y), c) -
                      background.channel(static_cast<int>(p->x), static_cast<int>(p->y), c));
    return sum > 24;
  };
  const double pixel = 2.0 * away * std::tan(22.5 * pi / 180.0) / height;
  EXPECT_TRUE(seen(x));
  for (const double side : {-1.0, 1.0}) {
    EXPECT_TRUE(seen(touch + side * (1.0 - 2.0 * pixel) * right));
    EXPECT_FALSE(seen(touch + side * (1.0 + 2.0 * pixel) * right));
  }
}

TEST_F(Balls, CastShadowsAsWideAsTheyAre) {
  ModelSettings settings;
  settings.terrain.push_back({});
  BallSettings ball;
  ball.radius = 0.5;
  ball.position = {0.0, -0.4, 0.0};  // a tenth above the ground
  settings.balls.push_back(ball);
  Model model = test::build(settings);
  ImageOptions options = plain();
  options.view.camera.position = {0.0, 7.0, 4.0};
  options.view.camera.target = {0.0, -1.0, 0.0};
  const State state = initial_state(model, Precision::single);
  const test::Image with = draw(model, state, options, width, height);
  options.shadows = false;
  const test::Image without = draw(model, state, options, width, height);
  const Camera camera(options.view.camera, width, height);
  // Half the sun's shadow lies on one side, for it stands in the left; beyond a ball's width and the sun's
  // blur there is none.
  double widest = 0.0;
  int darker = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (with.channel(x, y, 1) >= without.channel(x, y, 1) - 25) continue;
      ++darker;
      const Ray ray = camera.ray_through(x + 0.5, y + 0.5);
      const double t = (-1.0 - ray.origin.y) / ray.direction.y;
      const Vec3 ground = ray.origin + t * ray.direction;
      widest = std::max(widest, std::hypot(ground.x, ground.z));
    }
  }
  EXPECT_GT(darker, 50);
  // The sun stands 52° high: the top's shadow falls 1.1/tan 52° aside, the blur is a tenth of the height.
  EXPECT_LT(widest, 0.5 + 1.1 / std::tan(52.0 * pi / 180.0));
  model.balls[0].launch_step = 5;
  options.shadows = true;
  const test::Image waiting = draw(model, state, options, width, height);
  options.shadows = false;
  EXPECT_EQ(draw(model, state, options, width, height).rgb, waiting.rgb) << "no shadow of what is not there";
}

TEST_F(Balls, WaitUnseenForTheirLaunch) {
  Model model = test::build(spinning_ball());
  State state = initial_state(model, Precision::single);
  ImageOptions empty = plain();
  empty.view.draw = {.solid = false};
  const test::Image background = draw(model, state, empty, width, height);
  model.balls[0].launch_step = 100;
  state.step = 99;
  EXPECT_EQ(draw(model, state, plain(), width, height).rgb, background.rgb);
  state.step = 100;
  EXPECT_GT(different(draw(model, state, plain(), width, height), background), 500);
}

TEST_F(Balls, TurnByTheirAngularVelocityBetweenImages) {
  const Model model = test::build(spinning_ball());
  State state = initial_state(model, Precision::single);
  const test::Image first = draw(model, state, plain(), width, height);
  EXPECT_EQ(next(state).rgb, first.rgb);
  state.step = 130;
  EXPECT_GT(different(next(state), first), 50);
  state.step = 480;
  (void)next(state);
  // After a whole turn in three strides every patch is back.
  state.step = 1000;
  EXPECT_EQ(different(next(state), first), 0);
  state.step = 1130;
  (void)next(state);
  state.step = 0;  // the run starts anew
  EXPECT_EQ(next(state).rgb, first.rgb);
}

TEST_F(Balls, CountInTheRangeOfSpeed) {
  ModelSettings settings = spinning_ball();
  settings.balls[0].velocity = {-12.0, 9.0, 0.0};
  const QuantityRange range = default_range(test::build(settings), ViewColor::speed);
  EXPECT_EQ(range[0], 0.0);
  EXPECT_EQ(range[1], 20.0);  // 15 m/s, rounded up
}

TEST_F(Balls, OfTheGpuSolverAreDrawnFromItsOwnBuffer) {
  ModelSettings settings = spinning_ball();
  settings.simulation.gravity = {0.0, -9.8, 0.0};
  settings.balls.push_back(settings.balls[0]);
  settings.balls[1].position = {-1.0, 0.5, 0.5};
  const Model model = test::build(settings);
  auto solver = make_gpu_solver(context(), model);
  ASSERT_TRUE(solver.ok()) << solver.error().message();
  // An odd and an even number of steps: the state takes turns between slots.
  for (const std::uint64_t steps : {std::uint64_t{0}, std::uint64_t{101}, std::uint64_t{101}}) {
    ASSERT_TRUE((*solver)->advance(steps).ok());
    const auto state = (*solver)->state();
    ASSERT_TRUE(state.ok());
    const test::Image from_state = draw(model, *state, plain(), width, height);
    ASSERT_TRUE(renderer().draw(width, height, (*solver)->device_state(), plain()).ok());
    EXPECT_EQ(read(), from_state.rgb) << "at step " << state->step;
  }
}

}  // namespace
}  // namespace aspic
