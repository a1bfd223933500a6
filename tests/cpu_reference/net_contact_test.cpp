// Nets and other bodies: their meshes catch what falls on them, and nothing else changes.
#include <gtest/gtest.h>

#include <algorithm>

#include "model/contact_surface.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

/// A cube above the roof of a net, whose meshes are as wide as a third of the cube.
ModelSettings over_a_net(bool cord) {
  ModelSettings settings;
  settings.simulation.integrator = Integrator::symplectic_euler;
  GoalNetSettings& net = settings.goal_nets.emplace_back();
  net.particles = {7, 3, 9};
  net.size = {3.0, 2.0, 4.0};
  net.position = {0.0, 1.0, 0.0};
  net.particle_mass = 0.2;
  net.structural = {1500.0, 20.0};
  net.cord = cord;
  CubeSettings& cube = settings.cubes.emplace_back();
  cube.particles_per_edge = 4;
  cube.edge_length = 1.5;
  cube.position = {0.1, 3.2, -0.2};
  cube.rotation = {{1.0, 0.2, 0.6}, 20.0};
  cube.particle_mass = 0.2;
  cube.structural = cube.shear = cube.bending = {800.0, 10.0};
  return settings;
}

double lowest_of_cube(const ModelSettings& settings) {
  const Model model = test::build(settings);
  const State end = test::after(model, 2500);
  double lowest = 1e9;
  for (std::size_t i = 0; i < 64; ++i) lowest = std::min(lowest, end.position[i].y);
  return lowest;
}

TEST(NetContact, CatchesACube) {
  for (const bool cord : {false, true}) {
    ModelSettings settings = over_a_net(cord);
    EXPECT_GT(lowest_of_cube(settings), 0.8);
    settings.contact.bodies = false;
    EXPECT_LT(lowest_of_cube(settings), -10.0);
  }
}

TEST(NetContact, IsThatOfItsMeshes) {
  const Model model = test::build(over_a_net(false));
  EXPECT_TRUE(has_body_contact(model));
  const ContactSurfaces surfaces = contact_surfaces(model);
  ASSERT_EQ(surfaces.bodies.size(), 2u);
  EXPECT_FALSE(surfaces.bodies[1].closed);
  // Back, roof and sides.
  EXPECT_EQ(surfaces.bodies[1].triangle_count, 2u * (2 * 8 + 8 * 6 + 2 * (6 * 2)));
  EXPECT_EQ(surfaces.bodies[1].surface_particles, model.bodies[1].particle_count);
}

TEST(NetContact, IsNoneOfANetAlone) {
  ModelSettings settings = over_a_net(false);
  settings.cubes.clear();
  EXPECT_FALSE(has_body_contact(test::build(settings)));
}

}  // namespace
}  // namespace aspic
