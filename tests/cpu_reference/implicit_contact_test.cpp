// Contact between bodies in the equation of implicit Euler, in steps of 1/60 s: every step is solved, bodies
// rest and stick, impacts keep momentum and gain no energy.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cpu_reference/bodies_in_contact.h"
#include "physics/contact/implicit.h"

namespace aspic {
namespace {

using test::advanced;
using test::build;
using test::contacts_in;
using test::cube_of;
using test::fixed;
using test::mean;
using test::moving;
using test::turned;

constexpr double S = test::spacing;

ModelSettings solved(std::vector<CubeSettings> cubes, double rate = 60.0) {
  ModelSettings settings = test::contact_scene(std::move(cubes), Integrator::implicit_euler);
  settings.simulation.timestep = 1.0 / rate;
  return settings;
}

void expect_solved(Solver& solver) {
  const SolveStatistics statistics = *solver.solve_statistics();
  EXPECT_EQ(statistics.converged, statistics.steps) << "worst residual " << statistics.worst_residual;
}

double energy(const Model& model, const State& state) {
  return measure(model, state).total();
}

/// A cube of n³ on a pinned slab, gravity leaning by this tangent, μ = 0.5.
ModelSettings on_slope(double tangent, int n) {
  ModelSettings settings =
      solved({fixed(test::box_of({7, 2, 5}, {})), cube_of(n, {0, (0.5 + 0.5 * (n - 1) + 0.1) * S, 0.1 * S})});
  settings.contact.body_friction = 0.5;
  const double angle = std::atan(tangent);
  settings.simulation.gravity = {9.8 * std::sin(angle), -9.8 * std::cos(angle), 0};
  return settings;
}

TEST(ImplicitBodyContact, SticksBelowTheFrictionAngle) {
  for (const int n : {3, 4}) {
    const Model model = build(on_slope(0.9 * 0.5, n));
    const auto solver = test::solver_for(model);
    const double start = energy(model, *solver->state());
    const State three = advanced(*solver, 180), four = advanced(*solver, 60);
    const double creep = mean(four.position, model.bodies[1]).x - mean(three.position, model.bodies[1]).x;
    EXPECT_LE(std::abs(creep), 1e-5) << n;
    const State ten = advanced(*solver, 360), eleven = advanced(*solver, 60);
    EXPECT_LE(std::abs(mean(eleven.position, model.bodies[1]).x - mean(ten.position, model.bodies[1]).x),
              2e-6)
        << n;
    EXPECT_LE(energy(model, eleven), start);
    expect_solved(*solver);
  }
}

TEST(ImplicitBodyContact, SlidesBeyondItAsCoulombSays) {
  const Model model = build(on_slope(1.1 * 0.5, 4));
  const auto solver = test::solver_for(model);
  const double before = mean(advanced(*solver, 21).velocity, model.bodies[1]).x,
               after = mean(advanced(*solver, 21).velocity, model.bodies[1]).x;
  const double angle = std::atan(0.55), coulomb = 9.8 * (std::sin(angle) - 0.5 * std::cos(angle));
  EXPECT_NEAR((after - before) / (21.0 / 60.0), coulomb, 0.01 * coulomb);
  expect_solved(*solver);
}

TEST(ImplicitBodyContact, StacksRest) {
  for (const int count : {2, 4}) {
    std::vector<CubeSettings> cubes = {test::on_its_bottom(cube_of(3, {}))};
    for (int i = 1; i < count; ++i) cubes.push_back(cube_of(3, {0, i * 2.3 * S, 0}));
    const Model model = build(solved(cubes));
    for (const Precision precision : {Precision::double_, Precision::single}) {
      const auto solver = test::solver_for(model, precision);
      const double start = energy(model, *solver->state());
      State state;
      for (int n = 0; n < 36; ++n) {
        state = advanced(*solver, 10);
        EXPECT_LE(energy(model, state), start * (1 + 1e-6));
      }
      EXPECT_LE(test::fastest(state), precision == Precision::double_ ? 5e-5 : 2e-3);
      const test::ContactDistances contacts = contacts_in(model, state);
      EXPECT_GT(contacts.count, 9u * static_cast<std::size_t>(count - 1));
      EXPECT_GE(contacts.least, count == 2 ? 0.097 : 0.092);
      EXPECT_LE(contacts.greatest, 0.1);
      expect_solved(*solver);
    }
  }
}

TEST(ImplicitBodyContact, ImpactsKeepMomentumAndGainNoEnergy) {
  const double edge = 3 * S, across = std::numbers::sqrt2 * edge, v = 5.0;
  for (const int how : {0, 1, 2, 3}) {
    CubeSettings below = moving(cube_of(4, {}), {0, v, 0}), above = moving(cube_of(4, {}), {0, -v, 0});
    above.position.y = edge + 0.25 * S;
    if (how == 1) above.position = {edge / 2, edge + 0.25 * S, edge / 2};
    if (how >= 2) above = turned(above, {1, 0, 0}, 45);
    if (how == 2) above.position.y = (edge + across) / 2 + 0.25 * S;
    if (how == 3) below = turned(below, {0, 0, 1}, 45), above.position.y = across + 0.25 * S;
    for (const double rate : {60.0, 240.0}) {
      ModelSettings settings = solved({below, above}, rate);
      settings.simulation.gravity = {};
      const Model model = build(settings);
      const auto solver = test::solver_for(model);
      const double start = energy(model, *solver->state());
      State state;
      for (int n = 0; n < 0.8 * rate; ++n) {
        state = advanced(*solver, 1);
        EXPECT_LE(energy(model, state), start) << how << ' ' << n;
        EXPECT_GE(contacts_in(model, state).least, -0.1) << how << ' ' << n;
      }
      EXPECT_LE(length(measure(model, state).momentum), 1e-8 * model.particle_count() * v);
      if (how != 1) {  // these turn, and pass each other
        EXPECT_GT(mean(state.position, model.bodies[1]).y - mean(state.position, model.bodies[0]).y, 2.5 * S);
      }
      expect_solved(*solver);
    }
  }
}

TEST(ImplicitBodyContact, EasesBodiesApartThatOverlapAtTheStart) {
  ModelSettings settings = solved({cube_of(4, {}), cube_of(4, {0.3 * S, 2.7 * S, 0.2 * S})});
  settings.simulation.gravity = {};
  const Model model = build(settings);
  const auto solver = test::solver_for(model);
  const State state = advanced(*solver, 90);
  EXPECT_EQ(contacts_in(model, state).count, 0u);
  const double parting = mean(state.velocity, model.bodies[1]).y - mean(state.velocity, model.bodies[0]).y;
  EXPECT_GT(parting, 0.1);
  EXPECT_LT(parting, 0.6);
}

// Friction at landing is bounded by the normal forces that stop the body, not by those at the start.
TEST(ImplicitBodyContact, LandsWithinTheConeOfFriction) {
  CubeSettings cube = moving(cube_of(3, {-2 * S, 1.8 * S, 0.1 * S}), {6, -3, 0});
  ModelSettings settings = solved({fixed(test::box_of({9, 2, 5}, {})), cube}, 240.0);
  settings.simulation.gravity = {};
  const Model model = build(settings);
  const State end = test::after(model, 60);
  const Vec3 v = mean(end.velocity, model.bodies[1]);
  EXPECT_NEAR((6.0 - v.x) / (v.y + 3.0), 0.3, 0.03);
}

TEST(ImplicitBodyContact, KeepsEveryBitWhereNothingIsNear) {
  ModelSettings settings = solved({cube_of(4, {0, 2, 0}), cube_of(4, {4, 2.5, 0})});
  settings.terrain.push_back({});
  const State with = test::after(build(settings), 120, Precision::single);
  settings.contact.bodies = false;
  EXPECT_EQ(state_hash_text(with), state_hash_text(test::after(build(settings), 120, Precision::single)));
}

// The matrix is the derivative of the force: −h·∂F/∂v'.
TEST(ImplicitBodyContact, MatrixIsTheDerivativeOfTheForce) {
  using physics::Vector;
  physics::ContactPoint<double> contact;
  contact.n = Vector<double>(0.48, 0.6, 0.64);
  contact.static_force = 3.0;
  contact.c = 250.0;
  const double h = 0.02;
  for (const double cone : {0.0, 0.4, 50.0}) {
    for (const double u : {-0.05, 0.05}) {
      contact.friction = 0.3 * Vector<double>(0.8, 0.0, -0.6);
      const Vector<double> r = u * contact.n + Vector<double>(0.02, 0.01, -0.03);
      physics::ContactResponse<double> at, plus, minus;
      at.cone = plus.cone = minus.cone = cone;
      physics::answer<double>(contact, r, h, at);
      for (int c = 0; c < 3; ++c) {
        const Vector<double> step = 1e-6 * Vector<double>::Unit(c);
        physics::answer<double>(contact, r + step, h, plus);
        physics::answer<double>(contact, r - step, h, minus);
        const Vector<double> slope = -h / 2e-6 * (plus.force - minus.force);
        EXPECT_LE((slope - physics::product_of<double>(contact, at, Vector<double>::Unit(c))).norm(), 1e-6)
            << cone << ' ' << u;
      }
    }
  }
}

}  // namespace
}  // namespace aspic
