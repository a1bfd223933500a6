#pragma once
// Bodies on lattices some of whose cells are empty, as a builder of bodies makes them.
#include <array>
#include <string_view>
#include <vector>

#include "model/cube.h"
#include "model/springs.h"
#include "support/model_building.h"

namespace aspic::test {

/// Instead of the one cube, boxes with few and with many particles along each of the axes, one of them
/// pinned.
inline ModelSettings with_odd_boxes(ModelSettings settings) {
  constexpr std::array<int, 3> boxes[] = {{2, 3, 9}, {9, 2, 3}, {3, 9, 2},  {2, 2, 7},
                                          {2, 7, 2}, {7, 2, 2}, {3, 3, 40}, {4, 12, 15}};
  const CubeSettings one = settings.cubes[0];
  settings.cubes.clear();
  for (const auto& particles : boxes) {
    CubeSettings& box = settings.cubes.emplace_back(one);
    box.particles = particles;
    box.position.x = 6.0 * static_cast<double>(settings.cubes.size());
  }
  settings.cubes[1].pinned.names = {"left-top-front"};
  return settings;
}

/// A lattice of so many cells along x, y and z, full where the word of their planes has an x: "xx,x." are two
/// cells along y, of which the second has one along z. Planes are separated by ";".
inline Lattice lattice_of(std::string_view planes) {
  Lattice lattice;
  std::array<int, 3> cells = {1, 1, 0};
  for (const char c : planes) {
    cells[0] += c == ';';
    cells[1] += c == ',';
    if (c == 'x' || c == '.') lattice.full_cells.push_back(c == 'x');
  }
  cells[1] = 1 + (cells[1] - 1) / cells[0];
  cells[2] = static_cast<int>(lattice.full_cells.size()) / (cells[0] * cells[1]);
  for (std::size_t axis = 0; axis < 3; ++axis) lattice.particles[axis] = cells[axis] + 1;
  return lattice;
}

/// The first body of the settings' cubes, without what belongs to empty cells alone; its springs are listed.
inline Model with_cells(ModelSettings settings, const Lattice& lattice) {
  settings.cubes[0].particles = lattice.particles;
  const Model box = build(settings);
  const std::vector<std::uint32_t> numbers = particle_numbers(lattice);
  Model model = box;
  model.initial_position = {};
  model.initial_velocity = {};
  model.mass = {};
  model.inverse_mass = {};
  for (std::size_t point = 0; point < numbers.size(); ++point) {
    if (numbers[point] == no_particle) continue;
    model.initial_position.push_back(box.initial_position[point]);
    model.initial_velocity.push_back(box.initial_velocity[point]);
    model.mass.push_back(box.mass[point]);
    model.inverse_mass.push_back(box.inverse_mass[point]);
  }
  Body& body = model.bodies[0];
  body.particle_count = model.particle_count();
  body.lattice = lattice;
  body.listed_surface = surface_of(lattice, 0);
  model.listed_springs = springs_of(lattice, 0, 0);
  return model;
}

}  // namespace aspic::test
