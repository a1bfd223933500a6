#pragma once
// Bodies that soon touch each other and the ground, for comparing backends.
#include "support/model_building.h"

namespace aspic::test {

/// Two cubes of unlike material that land on the ground and on each other, a beam across them and a cloth
/// over all, each of which is soon touched.
inline ModelSettings pile(Integrator integrator, ContactModel contact) {
  ModelSettings settings = low_cube(5, integrator, contact);
  settings.contact.bodies = true;
  settings.cubes[0].edge_length = 2.0;
  settings.cubes[0].position = {0.0, 1.05, 0.0};
  settings.cubes[0].rotation = {{0.0, 1.0, 0.0}, 10.0};
  settings.cubes[0].velocity = {0.5, -1.0, 0.0};
  CubeSettings upper = settings.cubes[0];
  upper.particles_per_edge = 4;
  upper.particle_mass = 3.0;
  upper.position = {0.3, 3.15, 0.2};
  upper.rotation = {{1.0, 0.3, 0.7}, 8.0};
  settings.cubes.push_back(upper);
  CubeSettings beam = settings.cubes[0];
  beam.particles = {9, 2, 3};
  beam.edge_length = 3.0;
  beam.position = {2.4, 1.6, 0.0};
  beam.pinned.names = {"right"};
  settings.cubes.push_back(beam);
  ClothSettings& cloth = settings.cloths.emplace_back();
  cloth.particles = {9, 9};
  cloth.size = {3.0, 3.0};
  cloth.position = {0.2, 4.3, 0.1};
  cloth.rotation = {{1.0, 0.0, 0.0}, 90.0};
  return settings;
}

}  // namespace aspic::test
