#pragma once
// Models for tests, in one line each.
#include <gtest/gtest.h>

#include <utility>

#include "model/model.h"

namespace aspic::test {

/// The settings of a cube on the default plane: n per edge, edge 4 m, the default springs, center at
/// `height`.
inline ModelSettings cube_on_plane(int particles_per_edge, double height = 9.0) {
  ModelSettings settings;
  CubeSettings cube;
  cube.particles_per_edge = particles_per_edge;
  cube.position = {0.0, height, 0.0};
  settings.cubes.push_back(cube);
  settings.terrain.push_back(TerrainSettings{});
  return settings;
}

/// A tilted cube that touches the default plane within 200 steps of 1 ms.
inline ModelSettings low_cube(int particles_per_edge, Integrator integrator, ContactModel contact) {
  ModelSettings settings = cube_on_plane(particles_per_edge, 1.9);
  settings.cubes[0].rotation = {{1.0, 0.3, 0.7}, 25.0};
  settings.cubes[0].velocity = {1.0, -1.0, 0.5};
  settings.simulation.integrator = integrator;
  settings.contact.model = contact;
  return settings;
}

/// Sets every constant of the medium's resistance.
inline void resist(ModelSettings& settings, double constant) {
  for (const auto& row : resistance_constants) settings.simulation.*row.value = constant;
}

inline Model build(const ModelSettings& settings) {
  auto model = build_model(settings);
  EXPECT_TRUE(model.ok()) << (model.ok() ? "" : model.error().message());
  return std::move(model).value();
}

/// A model of one body alone, in this list of the settings.
template <auto List, class Body>
Model build_alone(const Body& body) {
  ModelSettings settings;
  (settings.*List).push_back(body);
  return build(settings);
}

/// A model of loose particles without springs or terrain, for hand-made cases.
inline Model particles(std::vector<Vec3> positions, const std::vector<Vec3>& velocities, double mass = 1.0) {
  Model model;
  model.initial_position = std::move(positions);
  model.initial_velocity = velocities;
  model.mass.assign(model.initial_position.size(), mass);
  model.inverse_mass.assign(model.initial_position.size(), 1.0 / mass);
  return model;
}

}  // namespace aspic::test
