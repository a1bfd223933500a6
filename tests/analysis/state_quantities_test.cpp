#include <gtest/gtest.h>

#include "analysis/particle_contact.h"
#include "aspic/analysis.h"
#include "cpu_reference/reference_solver.h"
#include "model/springs.h"
#include "support/model_building.h"

namespace aspic {
namespace {

/// A soft cube on the ground and a net, after some time.
struct Landed {
  Model model;
  State state;
  Inputs inputs;
};

Landed landed() {
  ModelSettings settings = test::low_cube(4, Integrator::explicit_euler, ContactModel::coulomb);
  settings.cubes[0].rotation.angle = 0.0;
  settings.cubes[0].position = {0.0, 1.0, 0.0};
  settings.cubes[0].velocity = {0.3, 0.0, 0.1};
  settings.goal_nets.resize(1);
  settings.goal_nets[0].particles = {3, 3, 3};
  settings.contact.bodies = false;  // body_contact_forces_test.cpp has those of bodies
  Landed landed = {test::build(settings), {}, {}};
  landed.inputs.pulls = {{.particle = 7, .anchor = {0.5, 4.0, 0.0}, .stiffness = 90.0, .damping = 3.0},
                         {.particle = 7, .anchor = {0.0, 2.0, 1.0}, .stiffness = 20.0}};
  landed.inputs.pinned = {3, 9};
  auto solver = make_reference_solver(landed.model, Precision::double_);
  EXPECT_TRUE(solver.ok() && (*solver)->set_inputs(landed.inputs).ok() && (*solver)->advance(300).ok());
  landed.state = (*solver)->state().value();
  return landed;
}

TEST(StateQuantities, AreThoseOfEachParticleAndSpring) {
  const auto [model, state, inputs] = landed();
  const StateQuantities q = quantities_of(model, state, inputs);
  const SpringFinder finder(model);
  const std::vector<Spring> springs = all_springs(model);
  ASSERT_EQ(q.strain.size(), springs.size());
  ASSERT_EQ(q.tension.size(), springs.size());
  double largest = 0.0;
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    const ParticleForce f = particle_force(model, finder, state, i, inputs);
    largest = std::max({largest, length(f.springs), length(f.contact), length(f.pull)});
  }
  // Sums of some thirty numbers in other orders.
  const double rounding = 64 * 0x1p-52 * largest;
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    const ParticleForce f = particle_force(model, finder, state, i, inputs);
    EXPECT_EQ(q.speed[i], length(state.velocity[i]));
    EXPECT_LT(length(q.force[i] - f.net), rounding) << i;
    Vec3 pulls = f.gravity + f.pull;
    double strain = 0.0;
    const std::vector<Spring> own = finder.of(model, i);
    for (const Spring& s : own) {
      const auto at = static_cast<std::size_t>(
          std::ranges::find_if(springs, [&](const Spring& t) { return s.a == t.a && s.b == t.b; }) -
          springs.begin());
      const Vec3 e = state.position[s.a] - state.position[s.b];
      pulls = pulls + ((s.a == i ? -1.0 : 1.0) * q.tension[at] / length(e)) * e;
      strain += std::abs(length(e) / model.spring_classes[s.spring_class].rest_length - 1.0);
      EXPECT_EQ(q.strain[at], length(e) / model.spring_classes[s.spring_class].rest_length - 1.0);
    }
    EXPECT_LT(length(pulls - (f.gravity + f.pull + f.springs)), rounding) << i;
    EXPECT_NEAR(q.mean_strain[i], strain / static_cast<double>(own.size()), 1e-14);
  }
  EXPECT_EQ(q.force[3], Vec3{}) << "pinned by the inputs";
}

TEST(StateQuantities, ContactsAreThoseOfTheTerrain) {
  const auto [model, state, inputs] = landed();
  const StateQuantities q = quantities_of(model, state, inputs);
  std::vector<Vec3> force(model.particle_count());
  std::vector<std::uint8_t> touches(model.particle_count());
  for (const ParticleContact& c : contacts_of(model, SpringFinder(model), state, inputs)) {
    force[c.particle] = force[c.particle] + c.force;
    touches[c.particle] = 1;
  }
  EXPECT_EQ(q.contact_force, force);
  EXPECT_EQ(q.contact, touches);
  EXPECT_GE(std::ranges::count(touches, 1), 4);
  EXPECT_GT(length(force[static_cast<std::size_t>(std::ranges::find(touches, 1) - touches.begin())]), 0.0);
}

}  // namespace
}  // namespace aspic
