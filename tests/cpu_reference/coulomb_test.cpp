// The Coulomb contact rule, expression by expression. What it makes of bodies is in rest_test.cpp.
#include "physics/terrain/coulomb.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "cpu_reference/ground.h"
#include "model/terrain.h"
#include "support/epsilon.h"

namespace aspic::physics {
namespace {

using V = Vector<double>;
using test::eps;

/// ε = 0.01, |g| = 9.8: v_rest = max(0.01, 19.6 h).
ContactConstants<double> constants(double h = 0.001) {
  Model model;
  model.simulation.timestep = h;
  return ContactConstants<double>(model);
}

struct Particle {
  V x, v;
};
Particle respond(const Ground<double>& ground, double h, const V& x0, const V& v0, V x, V v) {
  respond_coulomb<double>(ground, constants(h), 1.0, x0, v0, x, v);
  return {x, v};
}

TEST(LeastNormalSpeed, SinksToTheSurfaceNoFasterThanByFalling) {
  const ContactConstants<double> contact = constants(0.5);  // |g|h = 4.9
  EXPECT_EQ(contact.fall, 4.9);
  EXPECT_EQ(least_normal_speed<double>(contact, -0.25), 0.0);
  EXPECT_EQ(least_normal_speed<double>(contact, 0.0), 0.0);
  EXPECT_EQ(least_normal_speed<double>(contact, 0.25), -0.5);
  EXPECT_EQ(least_normal_speed<double>(contact, 100.0), -4.9);
}

TEST(Rests, WithinTheBandAndSlowEitherWay) {
  const ContactConstants<double> contact = constants(1.0 / 1024.0);
  const double limit = contact.resting_speed;
  EXPECT_EQ(limit, 2.0 * 9.8 / 1024.0);
  EXPECT_TRUE(rests<double>(contact, 0.0099, limit));
  EXPECT_TRUE(rests<double>(contact, -1.0, -limit));
  EXPECT_FALSE(rests<double>(contact, 0.01, 0.0));
  EXPECT_FALSE(rests<double>(contact, 0.0, std::nextafter(limit, 1.0)));
  EXPECT_FALSE(rests<double>(contact, 0.0, -std::nextafter(limit, 1.0)));
}

// Against Coulomb's law, for random velocities: the normal part is c, friction opposes the slip, is within
// the cone of the normal impulse and on it where the particle slides on.
TEST(Projection, ObeysCoulombsLaw) {
  std::mt19937 random(7);
  std::normal_distribution<double> some;
  int slid = 0, stuck = 0, left = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const V n = V(some(random), some(random), some(random)).normalized();
    const V v1(some(random), some(random), some(random));
    const double mu = std::abs(some(random)), c = -0.1 * std::abs(some(random));
    const V v2 = projected<double>(mu, n, c, v1);
    const double u = v1.dot(n), size = 1.0 + v1.norm();
    if (u >= c) {
      EXPECT_EQ(v2, v1);
      ++left;
      continue;
    }
    EXPECT_NEAR(v2.dot(n), c, 8 * eps * size);
    const V before = v1 - u * n, after = v2 - v2.dot(n) * n;
    const double impulse = (after - before).norm(), cone = mu * (c - u);
    EXPECT_LE(impulse, cone + 16 * eps * size * (1.0 + mu));
    EXPECT_GE(after.dot(before), -16 * eps * size * size);
    EXPECT_NEAR(after.cross(before).norm(), 0.0, 32 * eps * size * size);
    if (after.norm() > 16 * eps * size) {
      EXPECT_NEAR(impulse, cone, 16 * eps * size * (1.0 + mu));
      ++slid;
    } else {
      ++stuck;
    }
  }
  EXPECT_GT(slid, 500);
  EXPECT_GT(stuck, 200);
  EXPECT_GT(left, 500);
}

TEST(Reaction, EndsTheStepWithTheProjectedVelocity) {
  const V n(0, 1, 0), v0(0.2, 0.004, -0.1), f(3, -20, 1);
  const double hw = 0.001 / 2.0, c = -0.002;
  const V closed = v0 + hw * with_reaction<double>(0.3, n, c, hw, v0, f);
  const V wanted = projected<double>(0.3, n, c, v0 + hw * f);
  EXPECT_LE((closed - wanted).norm(), 4 * eps * v0.norm());
  EXPECT_GT((wanted - (v0 + hw * f)).norm(), 0.001) << "else nothing happened";
  const V away(3, 20, 1);
  EXPECT_EQ(with_reaction<double>(0.3, n, c, hw, v0, away), away) << "the ground does not pull";
}

// A body under constant acceleration a: the four kinds of position an explicit method gives it, all with the
// velocity v0 + h·a. Its true speed on meeting the surface is √(u0² + 2·|a|·d0), and it leaves the step with
// what a bounce at that moment gives.
TEST(BouncedSpeed, IsThatOfAnImpactWithinTheStep) {
  const double h = 0.01, e = 0.75, u0 = -3.0, du = -9.8 * h;
  const ContactConstants<double> contact = constants(h);
  for (const double share : {0.1, 0.35, 0.5, 0.8}) {
    const double d0 = share * h * 3.0;
    for (const double lag : {-0.5, 0.0, 0.5}) {  // ū = u0 + (½ + lag)·du
      const double mean = u0 + (0.5 + lag) * du;
      const double s = d0 / (-h * mean);
      const double found = bounced_speed<double>(plane(e), contact, 1.0, d0, -h * mean, u0, du, mean);
      // B of the speed at the impact, as the position has it, and the rest of the method's own change.
      EXPECT_NEAR(found, -e * (u0 + (s + lag) * du) - lag * du, 16 * eps * 3.0);
    }
  }
}

TEST(BouncedSpeed, IsNeitherNegativeNorMuchAboveThatOfTheApproach) {
  const ContactConstants<double> contact = constants(0.01);
  EXPECT_EQ(bounced_speed<double>(plane(0.0), contact, 1.0, 0.01, 0.02, -2.0, 0.0, -1.0), 0.0);
  EXPECT_EQ(bounced_speed<double>(plane(0.5), contact, 1.0, 0.01, 0.5, -2.0, -50.0, -50.0),
            0.5 * 2.0 + 2.0 * contact.fall);
}

TEST(BouncedSpeed, KnowsTheTerrainsMass) {
  EXPECT_NEAR(bounced_speed<double>(plane(1.0, 0.0, 10.0), constants(), 1.0, 0.005, 0.011, -11.0, 0.0, -11.0),
              9.0, 16 * eps * 11.0);
}

// 4 m/s over a step of 3/64 s: every number is exact.
TEST(Coulomb, ImpactBouncesAndRubs) {
  const auto [x, v] = respond(plane(), 3.0 / 64.0, {0, 0.125, 0}, {3, -4, 0}, {0, -0.0625, 0}, {3, -4, 0});
  EXPECT_EQ(x, V(0, 0, 0));                   // projected
  EXPECT_EQ(v, V(3 - 0.25 * (2 + 4), 2, 0));  // Δu = 6, friction takes μΔu off the tangential speed
}

TEST(Coulomb, FrictionNeverTurnsTheSlipAround) {
  const auto [x, v] = respond(plane(), 3.0 / 64.0, {0, 0.125, 0}, {1, -4, 0}, {0, -0.0625, 0}, {1, -4, 0});
  EXPECT_EQ(v, V(0, 2, 0));
}

TEST(Coulomb, NobodyBouncesAboveTheSurface) {
  const V x1(0, 0.005, 0), v1(3, -4, 0);
  const auto [x, v] = respond(plane(), 0.001, {0, 0.009, 0}, v1, x1, v1);
  EXPECT_EQ(x, x1);
  EXPECT_EQ(v, v1);
}

TEST(Coulomb, SlowApproachSinksToTheSurfaceAndRests) {
  const double h = 1.0 / 1024.0;
  const auto [x, v] =
      respond(plane(), h, {0, h / 128.0, 0}, {0, -0.015, 0}, {0, -0.0001, 0}, {0.001, -0.03, 0});
  EXPECT_EQ(v, V(0, -1.0 / 128.0, 0));  // d0/h; friction stops the rest
  EXPECT_EQ(x, V(0, 0, 0));
  const auto [y, w] = respond(plane(), h, {0, 0, 0}, {0, -0.015, 0}, {0, -0.00001, 0}, {0, -0.03, 0});
  EXPECT_EQ(w, V(0, 0, 0));
  EXPECT_EQ(y, V(0, 0, 0));
}

// A load above it turned it around within the step: its approach would bring it back fast, for ever.
TEST(Coulomb, WhatRoseAndIsTurnedAroundNearTheSurfaceIsSetDown) {
  const ContactConstants<double> contact = constants(1.0 / 1024.0);
  const double fast = 2.0 * contact.resting_speed, d0 = 0.004, d = 0.005, u = -1.0;
  const auto end = [&](double u0) {
    return speed_after_contact<double>(plane(), contact, 1.0, d0, u0, d, u);
  };
  EXPECT_EQ(end(fast), least_normal_speed<double>(contact, d0));
  EXPECT_EQ(end(-fast), u) << "what arrives fast is let through to the surface";
}

TEST(Coulomb, AStoppedParticleDoesNotRise) {
  const double h = 1.0 / 1024.0;
  const auto [x, v] = respond(plane(), h, {0, 0, 0}, {0, 0.0125, 0}, {2, 0.0125 * h, 0}, {0, 0, 0});
  EXPECT_EQ(x, V(2, 0, 0));
  // Rounding of u, which the reaction leaves at ±0, does not decide it.
  const auto [y, w] = respond(plane(), h, {0, 0, 0}, {0, 0.0125, 0}, {2, 0.0125 * h, 0}, {0, 1e-18, 0});
  EXPECT_NEAR(y.y(), 0.0, 1e-20);
}

TEST(Coulomb, OneThatIsPulledAwayRisesFreely) {
  const double h = 1.0 / 1024.0;
  const V x1(0, 0.0125 * h, 0), v1(0, 0.015, 0);
  const auto [x, v] = respond(plane(), h, {0, 0, 0}, {0, 0.0125, 0}, x1, v1);
  EXPECT_EQ(x, x1);
  EXPECT_EQ(v, v1);
}

TEST(Coulomb, OneHeldBelowTheSurfaceIsLifted) {
  const auto [x, v] = respond(plane(), 0.001, {0, -0.5, 0}, {0, 0, 0}, {0, -0.6, 0}, {0, -0.01, 0});
  EXPECT_EQ(x, V(0, 0, 0));
  EXPECT_EQ(v, V(0, 0, 0));
}

TEST(Coulomb, LeavingParticleIsOnlyProjected) {
  const auto [x, v] = respond(plane(), 0.001, {0, -1, 0}, {2, 5, 0}, {0, -0.5, 0}, {2, 5, 0});
  EXPECT_EQ(x, V(0, 0, 0));
  EXPECT_EQ(v, V(2, 5, 0));
}

TEST(Coulomb, NothingTunnels) {
  const auto [x, v] = respond(plane(), 0.0625, {0, 6.25, 0}, {0, -900, 0}, {0, -50, 0}, {0, -900, 0});
  EXPECT_EQ(x, V(0, 0, 0));
  EXPECT_EQ(v, V(0, 450, 0));
}

}  // namespace
}  // namespace aspic::physics
