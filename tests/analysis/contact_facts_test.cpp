#include "analysis/contact_facts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/stability.h"
#include "model/integrator.h"
#include "support/model_building.h"

namespace aspic {
namespace {

ModelSettings two_default_cubes() {
  ModelSettings settings;
  settings.cubes.resize(2);
  settings.cubes[1].position.y += 5.0;
  return settings;
}

// docs/contact.md, "Limits", and the constants of a pair; s = 4/9 m.
TEST(ContactFacts, OfDefaultCubes) {
  const ContactFacts facts = contact_facts(test::build(two_default_cubes()));
  ASSERT_EQ(facts.kinds.size(), 1u);
  const ContactKind& kind = facts.kinds[0];
  EXPECT_EQ(kind.bodies, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_NEAR(kind.sound, 53.7, 0.1);
  EXPECT_TRUE(kind.damped);
  ASSERT_TRUE(kind.stack.has_value());
  EXPECT_NEAR(*kind.stack, 0.8 * 15.6, 0.1);
  ASSERT_EQ(facts.pairings.size(), 1u);
  const ContactPairing& pairing = facts.pairings[0];
  EXPECT_FALSE(pairing.self);
  EXPECT_NEAR(pairing.pair.stiffness, 14625.0, 1e-9);
  EXPECT_NEAR(pairing.pair.damping, 0.4 * std::sqrt(14625.0 / 2.0), 1e-9);
  EXPECT_NEAR(pairing.pair.reach, 0.4 / 9, 1e-12);
  EXPECT_NEAR(pairing.pair.depth, 1.0 / 9, 1e-12);
  EXPECT_EQ(pairing.pair.friction, 0.3);
  EXPECT_NEAR(pairing.sound_speed, 0.9 * kind.sound, 1e-9);
  EXPECT_NEAR(pairing.step_speed, 0.5 * 4.0 / 9 / 0.001, 1e-9);
  EXPECT_NEAR(pairing.least_zeta, 0.5 * 0.001 * std::sqrt(2.0 * 14625.0), 1e-9);
}

TEST(ContactFacts, DependOnDampingMethodFrictionAndKind) {
  ModelSettings settings = two_default_cubes();
  for (SpringSettings* springs :
       {&settings.cubes[1].structural, &settings.cubes[1].shear, &settings.cubes[1].bending})
    springs->damping = 4.0;
  settings.cubes[1].friction = 0.05;
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 1.0 / 60.0;
  settings.contact.self = true;
  ClothSettings cloth;
  cloth.position.y = 30.0;
  settings.cloths = {cloth};
  const ContactFacts facts = contact_facts(test::build(settings));
  ASSERT_EQ(facts.kinds.size(), 3u);
  EXPECT_FALSE(facts.kinds[1].damped);
  EXPECT_FALSE(facts.kinds[2].stack.has_value());
  // Each with itself, and each two; a kind of one body has no other of its kind.
  ASSERT_EQ(facts.pairings.size(), 6u);
  for (const ContactPairing& pairing : facts.pairings) {
    if (pairing.a == 0 && pairing.b == 1) {
      EXPECT_NEAR(pairing.sound_speed, 0.3 * facts.kinds[1].sound, 1e-9);
      EXPECT_NEAR(pairing.step_speed, 0.3 * 4.0 / 9 * 60.0, 1e-9);
      EXPECT_EQ(pairing.pair.friction, 0.05);
    }
    if (pairing.a == 0 && pairing.b == 2) {
      EXPECT_NEAR(pairing.step_speed, pairing.pair.spacing * 0.25 * 60.0, 1e-9);
      EXPECT_EQ(pairing.pair.friction, 0.3);
    }
  }
  // Bodies of one cell, of unequal masses, and the energy of contact with a sheet.
  settings = two_default_cubes();
  settings.cubes[0].particles_per_edge = settings.cubes[1].particles_per_edge = 2;
  EXPECT_NEAR(contact_facts(test::build(settings)).pairings[0].speed(), 0.5 * 4.0 * std::sqrt(14625.0), 1e-9);
  settings.cubes[1].particle_mass = 4.0;
  settings.cubes[1].structural.damping = 120.0;
  EXPECT_NEAR(contact_facts(test::build(settings)).pairings[0].speed(), 0.4 * 2.0 * std::sqrt(14625.0), 1e-9);
  settings.cubes.pop_back();
  settings.cloths = {cloth};
  settings.contact.body_gap = 0.2;
  const ContactPairing& sheet = contact_facts(test::build(settings)).pairings[0];
  EXPECT_NEAR(sheet.speed(), 0.9 * 0.5 * sheet.pair.spacing * std::sqrt(sheet.pair.stiffness / 1.0), 1e-9);
  settings.contact.bodies = settings.contact.self = false;
  EXPECT_TRUE(contact_facts(test::build(settings)).pairings.empty());
}

TEST(ContactLimits, AreBelowTheFreeOnesByWhatContactAdds) {
  ModelSettings settings = two_default_cubes();
  for (CubeSettings& cube : settings.cubes) cube.particles_per_edge = 4;
  settings.cubes[0].edge_length = settings.cubes[1].edge_length = 4.0 / 3;
  settings.simulation.integrator = Integrator::symplectic_euler;
  const Model model = test::build(settings);
  const auto free = stability_limits(model, explicit_integrators, StabilityEffort::quick);
  const auto faces = contact_limits(model, explicit_integrators, Meeting::faces, StabilityEffort::quick),
             edges = contact_limits(model, explicit_integrators, Meeting::edges, StabilityEffort::quick);
  const double alone = largest_stiffness_eigenvalue(model);
  for (std::size_t i = 0; i < explicit_integrators.size(); ++i) {
    ASSERT_TRUE(free[i].step && faces[i].step && edges[i].step);
    EXPECT_LE(*edges[i].step, *faces[i].step);
    EXPECT_LE(*faces[i].step, *free[i].step);
    EXPECT_FALSE(edges[i].exact);
    // The default cube keeps a millisecond; that of the one-pass method is 1.02 ms without contact.
    const bool one_pass = explicit_integrators[i] == Integrator::implicit_euler_one_pass;
    EXPECT_GT(*edges[i].step, one_pass ? 0.00075 : 0.001) << name_of(explicit_integrators[i]);
  }
  // Symplectic Euler's h: κh² + 2γh = 4 at both bounds.
  const double kappa = alone + 12.0 * 14625.0, gamma = alone * 0.03 + 12.0 * 0.4 * std::sqrt(14625.0 / 2.0);
  const double h = (-gamma + std::sqrt(gamma * gamma + 4.0 * kappa)) / kappa;
  const auto at = std::ranges::find(explicit_integrators, Integrator::symplectic_euler);
  EXPECT_NEAR(*edges[static_cast<std::size_t>(at - explicit_integrators.begin())].step, h, 1e-3 * h);
  // Without contact both are the same.
  settings.contact.bodies = false;
  const auto none =
      contact_limits(test::build(settings), explicit_integrators, Meeting::edges, StabilityEffort::quick);
  for (std::size_t i = 0; i < none.size(); ++i) EXPECT_EQ(none[i].step, free[i].step);
}

}  // namespace
}  // namespace aspic
