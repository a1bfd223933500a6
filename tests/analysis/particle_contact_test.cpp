#include "analysis/particle_contact.h"

#include <gtest/gtest.h>

#include <numeric>

#include "cpu_reference/reference_solver.h"
#include "support/model_building.h"

namespace aspic {
namespace {

/// The state of double precision after so many steps.
State after(const Model& model, std::uint64_t steps) {
  auto solver = make_reference_solver(model, Precision::double_);
  EXPECT_TRUE(solver.ok() && (*solver)->advance(steps).ok());
  return (*solver)->state().value();
}

TEST(ParticleContact, AParticleAtRestIsCarriedByItsWeight) {
  Model model = test::particles({{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}, {{}, {}}, 2.0);
  model.terrain.emplace_back();
  const State state = initial_state(model, Precision::double_);
  const auto contacts = contacts_of(model, SpringFinder(model), state);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].particle, 0u);
  EXPECT_EQ(contacts[0].normal, (Vec3{0.0, 1.0, 0.0}));
  const double weight = 2.0 * length(model.simulation.gravity);
  EXPECT_LT(length(contacts[0].force - Vec3{0.0, weight, 0.0}), weight * 8 * 0x1p-52);
}

TEST(ParticleContact, ForcesAreThoseOfTheNextStep) {
  // A soft cube that has come to lie on the ground, pulled along it.
  ModelSettings settings = test::low_cube(4, Integrator::explicit_euler, ContactModel::coulomb);
  settings.cubes[0].rotation.angle = 0.0;
  settings.cubes[0].position = {0.0, 1.0, 0.0};
  settings.cubes[0].velocity = {0.3, 0.0, 0.1};
  const Model model = test::build(settings);
  const State state = after(model, 300);
  auto solver = make_reference_solver(model, Precision::double_);
  ASSERT_TRUE((*solver)->load(state).ok());
  ASSERT_TRUE((*solver)->advance(1).ok());
  const State next = (*solver)->state().value();
  const SpringFinder springs(model);
  const auto contacts = contacts_of(model, springs, state);
  int with_force = 0;
  for (const ParticleContact& c : contacts) {
    if (c.force == Vec3{}) continue;
    ++with_force;
    // What moves the particle in the step is its forces and that of the contact.
    const ParticleForce f = particle_force(model, springs, state, c.particle);
    const Vec3 moved = (model.mass[c.particle] / model.simulation.timestep) *
                       (next.velocity[c.particle] - state.velocity[c.particle]);
    EXPECT_LT(length(moved - f.net), 1e-9 * length(c.force)) << c.particle;
    EXPECT_LT(length(f.contact - c.force), 1e-9 * length(c.force)) << c.particle;
    EXPECT_GE(dot(c.force, c.normal), 0.0);
  }
  EXPECT_GE(with_force, 4);
}

TEST(ParticleContact, TheCourseModelsForceIsThatOfTheReadout) {
  ModelSettings settings = test::low_cube(4, Integrator::explicit_euler, ContactModel::course);
  settings.cubes[0].rotation.angle = 0.0;
  settings.cubes[0].position = {0.0, 1.0, 0.0};
  settings.cubes[0].velocity = {};
  const Model model = test::build(settings);
  const State state = initial_state(model, Precision::double_);
  const SpringFinder springs(model);
  const auto contacts = contacts_of(model, springs, state);
  EXPECT_EQ(contacts.size(), 16u);
  for (const ParticleContact& c : contacts) {
    const Vec3 expected = particle_force(model, springs, state, c.particle).contact;
    EXPECT_GT(length(c.force), 0.0);
    EXPECT_LT(length(c.force - expected), 8 * 0x1p-52 * length(expected));
  }
}

}  // namespace
}  // namespace aspic
