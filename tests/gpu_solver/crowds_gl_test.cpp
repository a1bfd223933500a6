// Bodies with many partners: the device ends every step with the reference's bits, whatever the number.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cpu_reference/reference_solver.h"
#include "gpu_solver/gpu_solver.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/value_of.h"

namespace aspic {
namespace {

class Crowds : public aspic::testing::GlTest {
 protected:
  static std::unique_ptr<GpuSolver> solver_for(const Model& model, const GpuOptions& options = {}) {
    return test::value_of(make_gpu_solver(context(), model, options));
  }

  static void expect_equal_steps(const Model& model, int steps, const GpuOptions& options = {}) {
    auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    auto solver = solver_for(model, options);
    for (int step = 1; step <= steps; ++step) {
      ASSERT_FALSE((*reference->advance(1)).divergence.has_value());
      const auto advanced = solver->advance(1);
      ASSERT_TRUE(advanced.ok()) << advanced.error().message();
      ASSERT_FALSE(advanced->divergence.has_value());
      ASSERT_EQ(*solver->state(), *reference->state())
          << "step " << step << ", " << model.ball_count() << " balls, " << model.particle_count()
          << " particles";
    }
  }

  /// Balls of three sizes and loose particles whose centers lie in a cube of this size, in motion.
  static Model crowd(int balls, int particles, double size = 1e-3,
                     Integrator integrator = Integrator::symplectic_euler) {
    std::mt19937_64 random(static_cast<std::uint64_t>(1000 * balls + particles));
    const auto within = [&](double half) {
      const auto number = [&] { return half * (static_cast<double>(random() >> 11) * 0x1p-52 - 1.0); };
      const double x = number(), y = number();
      return Vec3{x, y, number()};
    };
    ModelSettings settings;
    settings.simulation.integrator = integrator;
    settings.contact.spin = true;
    settings.contact.ball_restitution = 0.5;
    for (int b = 0; b < balls; ++b) {
      settings.balls.push_back(
          {0.1 + 0.02 * (b % 3), 0.5 + 0.25 * (b % 5), within(size), within(1.0), within(5.0)});
    }
    Model model = test::build(settings);
    for (int p = 0; p < particles; ++p) {
      model.initial_position.push_back(within(size));
      model.initial_velocity.push_back(within(1.0));
      model.mass.push_back(0.1 + 0.05 * (p % 7));
      model.inverse_mass.push_back(p % 11 == 0 ? 0.0 : 1.0 / model.mass.back());
    }
    return model;
  }

  /// One ball and this many loose particles on its surface, within ε, moving against it.
  static Model bristling(int particles, Integrator integrator = Integrator::symplectic_euler) {
    Model model = crowd(1, 0, 0.0, integrator);
    for (int p = 0; p < particles; ++p) {
      // A spiral over the sphere.
      const double y = 1.0 - (2.0 * p + 1.0) / particles, r = std::sqrt(1.0 - y * y), turn = 2.399963 * p;
      const Vec3 n = {r * std::cos(turn), y, r * std::sin(turn)};
      model.initial_position.push_back((0.1 - 0.004 * (p % 2)) * n);
      model.initial_velocity.push_back(-0.5 * n);
      model.mass.push_back(0.001 + 0.0005 * (p % 3));
      model.inverse_mass.push_back(1.0 / model.mass.back());
    }
    return model;
  }
};

TEST_F(Crowds, OfBallsInOnePlace) {
  for (const int balls : {1, 2, 32, 33, 34, 255, 256, 257, 258, 500, 600})
    expect_equal_steps(crowd(balls, 0), 4);
}

TEST_F(Crowds, OfBallsAndParticles) {
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::runge_kutta_4,
                                      Integrator::implicit_euler_one_pass, Integrator::implicit_euler}) {
    for (const int balls : {2, 33, 257, 300}) expect_equal_steps(crowd(balls, 400, 1e-3, integrator), 2);
  }
}

TEST_F(Crowds, BySearchAndGroupSize) {
  for (const Model& model : {crowd(300, 100), crowd(300, 100, 0.4)}) {
    for (const BallSearch search : {BallSearch::all_pairs, BallSearch::grid}) {
      for (const std::uint32_t group : {1u, 256u}) {
        GpuOptions options;
        options.ball_search = search;
        options.group_size = group;
        expect_equal_steps(model, 2, options);
      }
    }
  }
}

// Who looks at more candidates than MAX_WALK takes the way of crowds.
TEST_F(Crowds, WhoLooksAtManyIsAsRight) {
  for (const BallSearch search : {BallSearch::all_pairs, BallSearch::grid}) {
    for (const char* walk : {"0u", "40u"}) {
      GpuOptions options;
      options.ball_search = search;
      options.defines = {{"MAX_WALK", walk}};
      expect_equal_steps(crowd(300, 100, 0.3), 2, options);
    }
  }
}

TEST_F(Crowds, OfParticlesAroundABall) {
  for (const int particles : {1, 31, 33, 255, 256, 257, 511, 512, 513, 5000})
    expect_equal_steps(bristling(particles), 4);
  expect_equal_steps(bristling(2000, Integrator::implicit_euler), 2);
}

TEST_F(Crowds, OfAHundredThousandParticlesAroundABall) {
  expect_equal_steps(bristling(100000), 2);
}

// The device's room for contacts is made for heaps: what does not fit is repeated with more, also in the
// midst of a queue of steps, and the buffers then count.
TEST_F(Crowds, FindRoomInMidRun) {
  for (const Integrator integrator : {Integrator::midpoint, Integrator::implicit_euler}) {
    ModelSettings settings;
    settings.simulation.integrator = integrator;
    LauncherSettings launcher;
    launcher.count = 300;
    launcher.interval = 0.0003;
    launcher.from = {{0.0, 3.0, 0.0}, {0.001, 3.001, 0.001}};
    launcher.towards = {{-1.0, 3.0, -1.0}, {1.0, 4.0, 1.0}};
    launcher.speed_factor = 0.02;
    launcher.ball = {0.1, 1.0};
    settings.launchers.push_back(launcher);
    Model model = test::build(settings);
    const Model loose = crowd(0, 300, 0.05);
    for (std::size_t p = 0; p < loose.mass.size(); ++p) {
      model.initial_position.push_back(loose.initial_position[p] + Vec3{0.0, 3.0, 0.0});
      model.initial_velocity.push_back({0.0, 0.1, 0.0});
      model.mass.push_back(loose.mass[p]);
      model.inverse_mass.push_back(1.0 / loose.mass[p]);
    }
    auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    ASSERT_FALSE((*reference->advance(110)).divergence.has_value());
    auto solver = solver_for(model);
    EXPECT_EQ(solver->bytes(), gpu_bytes(model, ForcePath::gather));
    const auto advanced = solver->advance(110);
    ASSERT_TRUE(advanced.ok()) << advanced.error().message();
    ASSERT_FALSE(advanced->divergence.has_value());
    EXPECT_EQ(*solver->state(), *reference->state());
    EXPECT_GT(solver->bytes(), gpu_bytes(model, ForcePath::gather));
  }
}

// Divergence in a step that has to be repeated is that of the step, once.
TEST_F(Crowds, DivergenceInAStepWithoutRoom) {
  Model model = crowd(300, 700);
  model.initial_position.push_back({50.0, 0.0, 0.0});
  model.initial_velocity.push_back({1001.0, 0.0, 0.0});
  model.mass.push_back(1.0);
  model.inverse_mass.push_back(1.0);
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::implicit_euler}) {
    model.simulation.integrator = integrator;
    auto solver = solver_for(model);
    const auto advanced = solver->advance(3);
    ASSERT_TRUE(advanced.ok()) << advanced.error().message();
    ASSERT_TRUE(advanced->divergence.has_value());
    EXPECT_EQ(advanced->divergence->step, 1u);
    EXPECT_EQ(body_text(*advanced->divergence), "particle 700");
    State last = initial_state(model, Precision::single);
    for (std::size_t i = 0; i < last.velocity.size(); ++i)
      if (model.inverse_mass[i] == 0.0) last.velocity[i] = {};  // pinned ones stand from the step's start on
    EXPECT_EQ(*solver->state(), last);
  }
}

// The slow ones, as tests of their own (CMakeLists.txt).
TEST_F(Crowds, SlowFiveThousandBallsInOnePlace) {
  expect_equal_steps(crowd(5000, 0), 2);
}

TEST_F(Crowds, SlowFiveHundredBallsAmongManyParticles) {
  expect_equal_steps(crowd(500, 20000, 0.05), 2);
}

TEST_F(Crowds, SlowBallOnALargeCube) {
  ModelSettings settings = test::cube_on_plane(80, 1.001);
  settings.simulation.timestep = 0.0002;
  settings.cubes[0].particle_mass = 0.01;
  settings.cubes[0].structural = settings.cubes[0].shear = settings.cubes[0].bending = {2000.0, 1.0};
  settings.balls.push_back({1.45, 600.0, {0.1, 4.44, 0.2}, {0.0, -2.0, 0.0}, {}});
  expect_equal_steps(test::build(settings), 3);
  settings.balls[0].position = {0.0, 1.0, 0.0};  // among 100,000
  expect_equal_steps(test::build(settings), 1);
}

}  // namespace
}  // namespace aspic
