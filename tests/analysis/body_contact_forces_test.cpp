#include "analysis/body_contact_forces.h"

#include <gtest/gtest.h>

#include "analysis/particle_contact.h"
#include "aspic/analysis.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

CubeSettings cube_at(double height, double slip) {
  CubeSettings cube;
  cube.particles_per_edge = 4;
  cube.edge_length = 2.0;
  cube.position = {0.2 * height, height, 0.1 * height};
  cube.velocity = {slip, 0.0, 0.0};
  return cube;
}

/// A cube that has landed on another on the ground, and still slides on it.
struct Stacked {
  Model model;
  State state;
};
Stacked stacked(Integrator integrator, double timestep = 0.001) {
  ModelSettings settings;
  settings.simulation.integrator = integrator;
  settings.simulation.timestep = timestep;
  settings.terrain.push_back({.geometry = {{"point", Vec3{}}}});
  settings.cubes = {cube_at(1.0, 0.0), cube_at(3.06, 0.8)};
  Stacked stacked = {test::build(settings), {}};
  stacked.state = test::after(stacked.model, static_cast<std::uint64_t>(0.15 / timestep));
  return stacked;
}

// What moves every particle in the next step is the net force: springs, gravity, the ground and the other
// body.
TEST(BodyContactForces, AreThoseOfTheNextStep) {
  for (const Integrator integrator : {Integrator::explicit_euler, Integrator::symplectic_euler}) {
    const auto [model, state] = stacked(integrator);
    const auto solver = test::solver_for(model);
    ASSERT_TRUE(solver->load(state).ok());
    const State next = test::advanced(*solver, 1);
    const SpringFinder springs(model);
    const BodyContactForces bodies(model, springs, state, {});
    ASSERT_GE(bodies.forces().size(), 16u);
    Vec3 sum;
    double largest = 0.0, after_friction = 0.0;
    for (const BodyContactForce& each : bodies.forces()) {
      sum = sum + each.force;
      largest = std::max(largest, length(each.force));
      after_friction = std::max(after_friction, std::abs(each.force.x));
      EXPECT_EQ(bodies.on(each.particle), each.force);
    }
    EXPECT_GT(largest, 5.0);
    EXPECT_GT(after_friction, 0.5) << "the upper one slides";
    EXPECT_LT(length(sum), 1e-10 * largest);
    for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
      // The ground's bounces are impulses.
      const Vec3 moved = (model.mass[i] / model.simulation.timestep) * (next.velocity[i] - state.velocity[i]);
      const ParticleForce f = particle_force(model, springs, state, i, {}, &bodies);
      if (f.contact != Vec3{} || bodies.on(i) != Vec3{}) {
        EXPECT_LT(length(moved - f.net), 1e-8 * largest) << i;
      }
    }
  }
}

TEST(BodyContactForces, CountAmongContactsAndQuantities) {
  const auto [model, state] = stacked(Integrator::symplectic_euler);
  const SpringFinder springs(model);
  const BodyContactForces bodies(model, springs, state, {});
  const auto contacts = contacts_of(model, springs, state, {}, &bodies);
  const StateQuantities q = quantities_of(model, state);
  std::size_t of_bodies = 0, of_ground = 0;
  for (const ParticleContact& c : contacts) {
    (c.terrain == ParticleContact::of_bodies ? of_bodies : of_ground) += 1;
    EXPECT_NEAR(length(c.normal), 1.0, 1e-12);
    EXPECT_EQ(q.contact[c.particle], 1);
  }
  EXPECT_EQ(of_bodies, bodies.forces().size());
  EXPECT_EQ(of_ground, 16u);
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    const ParticleForce f = particle_force(model, springs, state, i, {}, &bodies);
    EXPECT_LT(length(q.contact_force[i] - (f.contact + f.bodies)), 1e-9) << i;
    EXPECT_LT(length(q.force[i] - f.net), 1e-9) << i;
  }
}

// At rest nothing has a net force, under implicit Euler too.
TEST(BodyContactForces, BalanceAtRest) {
  for (const Integrator integrator : {Integrator::velocity_verlet, Integrator::implicit_euler}) {
    ModelSettings settings;
    settings.simulation.integrator = integrator;
    settings.simulation.timestep = integrator == Integrator::implicit_euler ? 1.0 / 60.0 : 0.001;
    settings.terrain.push_back({.geometry = {{"point", Vec3{}}}});
    settings.cubes = {cube_at(1.0, 0.0), cube_at(3.1, 0.0)};
    settings.cubes[0].particles_per_edge = settings.cubes[1].particles_per_edge = 3;
    const Model model = test::build(settings);
    const State state = test::after(model, static_cast<std::uint64_t>(5.0 / settings.simulation.timestep));
    const SpringFinder springs(model);
    const BodyContactForces bodies(model, springs, state, {});
    EXPECT_GE(bodies.forces().size(), 9u);
    for (std::uint32_t i = 0; i < model.particle_count(); ++i)
      EXPECT_LT(length(particle_force(model, springs, state, i, {}, &bodies).net), 0.02) << i;
  }
}

TEST(BodyContactForces, AreNoneWithoutBodyContact) {
  ModelSettings settings;
  settings.cubes = {cube_at(1.0, 0.0), cube_at(1.5, 0.0)};
  settings.contact.bodies = false;
  const Model model = test::build(settings);
  const State state = initial_state(model, Precision::double_);
  EXPECT_TRUE(BodyContactForces(model, SpringFinder(model), state, {}).forces().empty());
  EXPECT_FALSE(measure(model, state).contact.has_value());
}

}  // namespace
}  // namespace aspic
