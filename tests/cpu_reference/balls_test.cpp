#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "aspic/analysis.h"
#include "model/integrator.h"
#include "support/epsilon.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

using test::after;
using test::expect_near;
using test::solver_for;
using test::weightless;

using test::eps;

struct TwoBodies {
  double m1, m2, e;
};
class TwoBalls : public testing::TestWithParam<TwoBodies> {};

// Newton's impact: v₁' = v₁ − (1 + e)·u/(w₁ + w₂)·w₁·n, v₂' the opposite.
TEST_P(TwoBalls, FollowTheImpactFormula) {
  const auto [m1, m2, e] = GetParam();
  ModelSettings settings = weightless();
  settings.contact.ball_restitution = e;
  const Vec3 n = Vec3{2.0, -1.0, 2.0} / 3.0, v1 = {-3.0, 0.5, 1.0}, v2 = {1.0, 0.25, -2.0};
  const double h = settings.simulation.timestep, r1 = 0.5, r2 = 0.3;
  // After the free flight the first center stands at (R₁ + R₂ + 0.004)·n from the second.
  settings.balls.push_back({r1, m1, (r1 + r2 + 0.004) * n - h * v1, v1, {}});
  settings.balls.push_back({r2, m2, -h * v2, v2, {}});
  const State end = after(test::build(settings), 1);
  const double u = dot(v1 - v2, n), w1 = 1.0 / m1, w2 = 1.0 / m2;
  ASSERT_LT(u, 0.0);
  const double J = -(1.0 + e) * u / (w1 + w2);
  // Velocities of a few m/s through about twenty operations; a light partner's impulse is w times as large.
  const double tolerance = 64 * eps * (4.0 + J * std::max(w1, w2));
  expect_near(end.ball_velocity[0], v1 + (w1 * J) * n, tolerance);
  expect_near(end.ball_velocity[1], v2 - (w2 * J) * n, tolerance);
}

INSTANTIATE_TEST_SUITE_P(Masses, TwoBalls,
                         testing::Values(TwoBodies{1, 1, 1}, TwoBodies{1, 1, 0.3}, TwoBodies{1000, 1, 1},
                                         TwoBodies{1, 1000, 0.5}, TwoBodies{2, 3, 0}));

TEST(Balls, BounceFromAPinnedParticleAsFromAWall) {
  ModelSettings settings = weightless();
  settings.balls.push_back({0.5, 2.0, {0.503, 0.0, 0.0}, {-4.0, 1.0, 0.0}, {}});
  Model model = test::build(settings);
  model.initial_position = {{0.0, 0.0, 0.0}};
  model.initial_velocity = {{}};
  model.mass = {1.0};
  model.inverse_mass = {0.0};
  const State end = after(model, 1);
  // The center has moved by h·v when they meet: the normal is that of the meeting.
  const Vec3 meeting = {0.503 - 0.004, 0.001, 0.0};
  const Vec3 n = meeting / length(meeting), v = {-4.0, 1.0, 0.0};
  expect_near(end.ball_velocity[0], v - (2.0 * dot(v, n)) * n, 64 * eps * 8.0);
  EXPECT_EQ(end.position[0], Vec3{});
  EXPECT_EQ(end.velocity[0], Vec3{});
}

TEST(Balls, ExchangeVelocityWithAParticle) {
  ModelSettings settings = weightless();
  settings.balls.push_back({0.5, 3.0, {0.0, 0.0, 0.0}, {0.0, -2.0, 0.0}, {}});
  Model model = test::build(settings);
  model.initial_position = {{0.0, -0.505, 0.0}};
  model.initial_velocity = {{}};
  model.mass = {1.0};
  model.inverse_mass = {1.0};
  const State end = after(model, 1);
  // (m₁ − m₂)/(m₁ + m₂)·v and 2m₁/(m₁ + m₂)·v
  expect_near(end.ball_velocity[0], {0.0, -1.0, 0.0}, 64 * eps);
  expect_near(end.velocity[0], {0.0, -3.0, 0.0}, 64 * eps);
}

/// A crowd of balls and loose particles that press on each other in many places at once.
Model crowd(double restitution, bool spin, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto number = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  const auto point = [&](double half) {
    return Vec3{number(-half, half), number(-half, half), number(-half, half)};
  };
  ModelSettings settings = weightless();
  settings.contact.spin = spin;
  settings.contact.ball_restitution = restitution;
  settings.contact.ball_friction = 0.7;
  for (int b = 0; b < 60; ++b) {
    settings.balls.push_back(
        {number(0.1, 0.4), std::exp(number(-2.0, 4.0)), point(1.2), point(3.0), point(9.0)});
  }
  Model model = test::build(settings);
  for (int p = 0; p < 200; ++p) {
    model.initial_position.push_back(point(1.2));
    model.initial_velocity.push_back(point(3.0));
    model.mass.push_back(std::exp(number(-3.0, 1.0)));
    model.inverse_mass.push_back(1.0 / model.mass.back());
  }
  return model;
}

TEST(Balls, ManyContactsKeepMomentumAndNeverRaiseTheEnergy) {
  for (const bool spin : {false, true}) {
    for (const double restitution : {0.0, 0.6, 1.0}) {
      const Model model = crowd(restitution, spin, 5);
      auto solver = solver_for(model);
      Measures before = measure(model, *solver->state());
      const double momentum_scale = 260.0 * 55.0 * 5.0;  // bodies · kg · m/s, at most
      const double first = before.kinetic;
      double lost = 0.0;
      for (int step = 0; step < 200; ++step) {
        ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
        const Measures now = measure(model, *solver->state());
        expect_near(now.momentum, before.momentum, eps * momentum_scale);
        ASSERT_LE(now.kinetic, before.kinetic * (1.0 + 1000 * eps)) << "step " << step;
        lost = (first - now.kinetic) / first;
        before = now;
      }
      EXPECT_GT(lost, restitution < 1.0 || spin ? 0.1 : 1e-3);  // there were contacts, and many
    }
  }
}

// Several hundred in one place, so that every sum has more than one block, balls and particles mixed.
TEST(Balls, CrowdsKeepMomentumAndNeverRaiseTheEnergy) {
  for (const int balls : {33, 256, 257, 500}) {
    Model model = crowd(0.6, true, 21);
    const std::vector<Ball> few = model.balls;
    model.balls.clear();
    for (int b = 0; b < balls; ++b) {
      Ball ball = few[static_cast<std::size_t>(b) % few.size()];
      ball.initial_position = 1e-3 * ball.initial_position + Vec3{1e-6 * b, 0.0, 0.0};
      model.balls.push_back(ball);
    }
    for (std::size_t i = 0; i < model.initial_position.size(); ++i)
      model.initial_position.set(i, 1e-3 * model.initial_position[i]);
    auto solver = solver_for(model);
    const double momentum_scale = (balls + 200.0) * 55.0 * 5.0;  // bodies · kg · m/s, at most
    Measures before = measure(model, *solver->state());
    for (int step = 0; step < 10; ++step) {
      ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
      const Measures now = measure(model, *solver->state());
      expect_near(now.momentum, before.momentum, 4 * eps * momentum_scale);
      ASSERT_LE(now.kinetic, before.kinetic * (1.0 + 1000 * eps)) << balls << " balls, step " << step;
      before = now;
    }
  }
}

// What the sort along x and the grid leave out has no partner. Every ball that has one is moved: the
// positions of the others are those of free flight.
TEST(Balls, AreFoundWhereverTheyAre) {
  std::mt19937_64 random(3);
  const auto number = [&](double half) {
    return half * (2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0);
  };
  for (const Vec3& box :
       {Vec3{40.0, 1.0, 1.0}, Vec3{3.0, 3.0, 3.0}, Vec3{0.2, 6.0, 6.0}, Vec3{0.3, 0.3, 0.3}}) {
    ModelSettings settings = weightless();
    for (int b = 0; b < 700; ++b) {
      settings.balls.push_back(
          {0.05 + 0.1 * (b % 3), 1.0, {number(box.x), number(box.y), number(box.z)}, {}, {}});
    }
    const Model model = test::build(settings);
    const State end = after(model, 1);
    int overlapping = 0;
    for (std::size_t a = 0; a < model.balls.size(); ++a) {
      bool overlaps = false;
      for (std::size_t b = 0; b < model.balls.size() && !overlaps; ++b) {
        const Vec3 e = model.balls[a].initial_position - model.balls[b].initial_position;
        overlaps = a != b && length(e) < model.balls[a].radius + model.balls[b].radius;
      }
      EXPECT_EQ(end.ball_position[a] != model.balls[a].initial_position, overlaps) << "ball " << a;
      overlapping += overlaps;
    }
    EXPECT_GT(overlapping, 50);
  }
}

// The position phase alone: bodies at rest that overlap are pushed apart and keep their center of mass.
TEST(Balls, OverlapIsMendedAboutTheCenterOfMass) {
  ModelSettings settings = weightless();
  settings.balls.push_back({0.5, 1.0, {0.0, 0.0, 0.0}, {}, {}});
  settings.balls.push_back({0.5, 3.0, {0.8, 0.0, 0.0}, {}, {}});
  const State end = after(test::build(settings), 1);
  expect_near(end.ball_position[0], {-0.15, 0.0, 0.0}, 16 * eps);
  expect_near(end.ball_position[1], {0.85, 0.0, 0.0}, 16 * eps);
  EXPECT_EQ(end.ball_velocity[0], Vec3{});

  const Model many = crowd(1.0, true, 8);
  const State start = initial_state(many, Precision::double_), moved = after(many, 1);
  Vec3 expected, center;
  for (std::size_t p = 0; p < many.mass.size(); ++p) {
    expected = expected + many.mass[p] * (start.position[p] + many.simulation.timestep * start.velocity[p]);
    center = center + many.mass[p] * moved.position[p];
  }
  for (std::size_t b = 0; b < many.balls.size(); ++b) {
    expected = expected + many.balls[b].mass *
                              (start.ball_position[b] + many.simulation.timestep * start.ball_velocity[b]);
    center = center + many.balls[b].mass * moved.ball_position[b];
  }
  expect_near(center, expected, eps * 260.0 * 55.0 * 5.0);
}

TEST(Balls, CentersThatCoincidePartAlongY) {
  ModelSettings settings = weightless();
  settings.balls.assign(2, {0.5, 1.0, {1.0, 2.0, 3.0}, {}, {}});
  const State end = after(test::build(settings), 1);
  expect_near(end.ball_position[0], {1.0, 2.5, 3.0}, 16 * eps);
  expect_near(end.ball_position[1], {1.0, 1.5, 3.0}, 16 * eps);
}

TEST(Balls, FlyByEveryIntegratorsFormula) {
  for (const Integrator integrator : all_integrators) {
    ModelSettings settings;
    settings.simulation.integrator = integrator;
    settings.simulation.timestep = 0.01;
    settings.balls.push_back({0.3, 7.0, {1.0, 2.0, 3.0}, {1.0, 5.0, -1.0}, {1.0, 2.0, 3.0}});
    const State end = after(test::build(settings), 100);
    // One second: y = 2 + 5 − g/2, and ±g·h/2 for methods of first order in x.
    const double shift = -(free_fall_lead(integrator) - 0.5) * 9.8 * 0.01;
    expect_near(end.ball_position[0], {2.0, 7.0 - 4.9 + shift, 2.0}, 100 * 8 * eps * 8.0);
    expect_near(end.ball_velocity[0], {1.0, 5.0 - 9.8, -1.0}, 100 * 4 * eps * 10.0);
    EXPECT_EQ(end.ball_angular_velocity[0], (Vec3{1.0, 2.0, 3.0}));
  }
}

TEST(Balls, WaitForTheirLaunchAndSplittingARunChangesNoBit) {
  ModelSettings settings;
  settings.launchers.emplace_back();
  settings.launchers[0].count = 4;
  settings.launchers[0].interval = 0.1;
  settings.goal_nets.emplace_back();
  settings.terrain.emplace_back();
  const Model model = test::build(settings);
  const State start = initial_state(model, Precision::single);
  const State early = after(model, 100, Precision::single);
  EXPECT_NE(early.ball_position[0], start.ball_position[0]);
  EXPECT_EQ(early.ball_position[1], start.ball_position[1]);
  EXPECT_EQ(early.ball_velocity[1], start.ball_velocity[1]);
  EXPECT_NE(after(model, 101, Precision::single).ball_position[1], start.ball_position[1]);

  const State whole = after(model, 450, Precision::single), middle = after(model, 250, Precision::single);
  auto resumed = solver_for(model, Precision::single);
  ASSERT_TRUE(resumed->load(middle).ok());
  ASSERT_FALSE((*resumed->advance(200)).divergence.has_value());
  EXPECT_EQ(*resumed->state(), whole);
  EXPECT_EQ(state_hash(*resumed->state()), state_hash(whole));

  State other = start;
  other.ball_position.pop_back();
  EXPECT_EQ(resumed->load(other).error().code, ErrorCode::usage);
}

TEST(Balls, ThatAreTooFastAreNamed) {
  ModelSettings settings;
  settings.balls.resize(3);
  settings.balls[1].velocity = {1001.0, 0.0, 0.0};
  settings.balls[2].velocity = {0.0, 3e38, 0.0};
  const Model model = test::build(settings);
  auto solver = solver_for(model);
  const auto divergence = solver->advance(5)->divergence;
  ASSERT_TRUE(divergence.has_value());
  EXPECT_EQ(body_text(*divergence), "ball 1");
  EXPECT_TRUE(divergence->finite);
  EXPECT_EQ(divergence->step, 1u);
}

TEST(GoalNetShot, IsStoppedByTheNet) {
  ModelSettings settings;
  settings.terrain.emplace_back();
  settings.goal_nets.emplace_back();
  settings.balls.emplace_back();
  const Model model = test::build(settings);
  auto solver = solver_for(model, Precision::single);
  double deepest = 10.0, latest = 0.0;
  for (int step = 0; step < 1000; ++step) {
    ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
    const State state = *solver->state();
    deepest = std::min(deepest, state.ball_position[0].x);
    latest = state.ball_velocity[0].x;
    for (std::uint32_t p = 0; p < model.particle_count(); ++p) {
      if (model.inverse_mass[p] == 0.0) {
        ASSERT_EQ(state.velocity[p], Vec3{}) << "pinned particle " << p;
      }
    }
  }
  EXPECT_LT(deepest, -1.0);  // it bulges the back of the net, at x = −1,
  EXPECT_GT(deepest, -3.0);  // which gives way by less than its own width,
  EXPECT_GT(latest, 0.0);    // and turns the ball round.
}

TEST(BallPit, SettlesWithoutOverlap) {
  ModelSettings settings;
  settings.simulation.integrator = Integrator::symplectic_euler;
  settings.contact.ball_restitution = 0.5;
  settings.terrain.emplace_back();
  settings.terrain[0].shape = TerrainShape::bowl;
  settings.terrain[0].restitution = 0.5;
  LauncherSettings launcher;
  launcher.count = 100;
  launcher.interval = 0.02;
  launcher.from = {{0.0, 5.0, -1.0}, {4.0, 7.0, 3.0}};
  launcher.towards = {{1.0, 3.0, 0.0}, {3.0, 3.0, 2.0}};
  launcher.speed_factor = 1.0;
  launcher.ball = {0.25, 1.0};
  settings.launchers.push_back(launcher);
  const Model model = test::build(settings);
  const State end = after(model, 8000, Precision::single);
  const double R = 0.25;
  double closest = 1e9;
  for (std::size_t a = 0; a < 100; ++a) {
    EXPECT_LT(length(end.ball_position[a] - Vec3{2.0, 7.0, 1.0}), 7.0 - R + 0.1 * R);
    for (std::size_t b = 0; b < a; ++b) {
      closest = std::min(closest, length(end.ball_position[a] - end.ball_position[b]));
    }
  }
  EXPECT_GT(closest, 2.0 * R - 0.1 * R);
  EXPECT_LT(closest, 2.0 * R + 0.05);  // they do lie on each other
}

}  // namespace
}  // namespace aspic
