#pragma once
// A scene of actuated bodies for tests of equal bits.
#include <cstdint>
#include <string>
#include <vector>

#include "model/integrator.h"
#include "model/model.h"

namespace aspic::test {

/// Bodies of cells of two materials, a cube, a passive one, a net of cords and a cloth above the ground; a
/// wave, a table along an axis, an input that the first channel is, and phases by cell.
inline ModelSettings actuated(Integrator integrator, ContactModel contact) {
  ModelSettings settings;
  settings.simulation.integrator = integrator;
  if (row_of(integrator).traits.stable_at_any_step) settings.simulation.timestep = 0.01;
  settings.contact.model = contact;
  settings.terrain.emplace_back();
  settings.materials = {{16.0, 33000.0, 0.4, "jelly"}, {30.0, 9000.0, 0.7, "fat"}};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  voxels.name = "worm";
  voxels.size = 0.7;
  voxels.position = {0.0, 1.43, 0.0};
  voxels.rotation = {{1.0, 0.3, 0.7}, 25.0};
  voxels.velocity = {1.0, -2.0, 0.5};
  voxels.layers = {{"11221", "1.2.1", "11221"}, {"2....", ".1..2", "....2"}};
  voxels.palette = {{"1", "jelly"}, {"2", "fat"}};
  voxels.pieces = Pieces::all;
  CubeSettings& cube = settings.cubes.emplace_back();
  cube.particles_per_edge = 4;
  cube.edge_length = 2.0;
  cube.position = {6.0, 1.02, 0.0};
  cube.velocity = {0.0, -1.0, 0.3};
  settings.cubes.push_back(cube);
  settings.cubes.back().position = {12.0, 1.02, 0.0};
  GoalNetSettings& net = settings.goal_nets.emplace_back();
  net.particles = {4, 5, 6};
  net.size = {1.0, 1.2, 1.6};
  net.position = {-6.0, 0.62, 0.0};
  net.shear = net.bending = {300.0, 10.0};
  net.cord = true;
  ClothSettings& cloth = settings.cloths.emplace_back();
  cloth.particles = {7, 5};
  cloth.size = {1.5, 1.0};
  cloth.position = {-12.0, 0.36, 0.0};
  cloth.rotation = {{1.0, 0.2, 0.1}, 70.0};

  ActuatorSettings wave;
  wave.name = "wave";
  wave.bodies = {"worm", "cloth[0]"};
  wave.amplitude = 0.12;
  wave.frequency = 3.0;
  wave.phase = {0.1, BodyAxis::x, 1.7, {}};
  ActuatorSettings steps = wave;
  steps.name = "steps";
  steps.bodies = {"worm", "goal-net[0]", "cube[0]"};
  steps.select.springs = {"structural", "shear"};
  steps.axis = BodyAxis::y;
  steps.signal = Signal::table;
  steps.table = {{0.0, -0.5}, {0.3, 1.0}, {0.3, 0.0}, {1.0, -0.5}};
  steps.phase = {};
  steps.start = 0.02;
  steps.ramp = 0.05;
  ActuatorSettings hand;
  hand.name = "hand";
  hand.bodies = {"cube[0]"};
  hand.signal = Signal::input;
  hand.amplitude = 0.3;
  hand.select.box = BoxSettings{{-9.0, -9.0, -9.0}, {9.0, 0.1, 9.0}};
  ActuatorSettings cells = wave;
  cells.name = "cells";
  cells.bodies = {"cube[0]"};
  cells.signal = Signal::triangle;
  cells.phase = {};
  cells.phase.cells = "3 3 3:";
  for (int n = 0; n < 27; ++n) cells.phase.cells += n % 4 == 0 ? " 0.5" : n % 4 == 1 ? " 0.125" : " -0.3";
  settings.actuators = {wave, steps, hand, cells};
  return settings;
}

/// A body of cells along which a wave has so many phases that its springs are of more than 255 classes.
inline ModelSettings cells_of_many_classes(Integrator integrator) {
  ModelSettings settings;
  settings.simulation.integrator = integrator;
  settings.terrain.emplace_back();
  settings.materials = {{16.0, 33000.0, 0.4, "jelly"}};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  voxels.size = 0.5;
  voxels.position = {0.0, 1.02, 0.0};
  voxels.velocity = {1.0, -2.0, 0.5};
  voxels.layers.assign(4, std::vector<std::string>(4, std::string(64, '1')));
  voxels.layers[3][1].replace(5, 3, "...");
  voxels.palette = {{"1", "jelly"}};
  ActuatorSettings& wave = settings.actuators.emplace_back();
  wave.amplitude = 0.2;
  wave.frequency = 3.0;
  wave.phase = {0.1, BodyAxis::x, 20.0, {}};
  return settings;
}

/// Enough for all to meet the ground.
inline std::uint64_t actuated_steps(Integrator integrator) {
  return row_of(integrator).traits.long_steps ? 16 : 160;
}

}  // namespace aspic::test
