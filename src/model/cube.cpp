#include "model/cube.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "model/bodies.h"
#include "model/springs.h"

namespace aspic {
namespace {

constexpr Side faces[] = {{"top", 1, true},   {"bottom", 1, false}, {"left", 0, false},
                          {"right", 0, true}, {"front", 2, true},   {"back", 2, false}};
constexpr PinNames cube_pins = {"cube", faces, "face",
                                "three faces joined by hyphens, such as left-top-front", "n³ − 1"};

/// The six faces of n³ particles.
std::vector<Patch> surface_of(std::uint32_t first, int n) {
  const auto count = static_cast<std::uint32_t>(n);
  const std::array<std::uint32_t, 3> stride = {count * count, count, 1};
  std::vector<Patch> surface;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool high : {false, true}) {
      surface.push_back({first + (high ? (count - 1) * stride[axis] : 0),
                         {count, count},
                         {stride[(axis + 1) % 3], stride[(axis + 2) % 3]},
                         !high});
    }
  }
  return surface;
}

}  // namespace

ModelCounts cube_counts(int particles_per_edge) {
  const auto n = static_cast<std::uint64_t>(particles_per_edge);
  ModelCounts counts;
  counts.particles = n * n * n;
  counts.structural = 3 * n * n * (n - 1);
  counts.shear = 6 * n * (n - 1) * (n - 1) + 4 * (n - 1) * (n - 1) * (n - 1);
  counts.bending = 3 * n * n * (n - 2);
  return counts;
}

double material_particle_mass(const MaterialSettings& material, int particles_per_edge, double edge_length) {
  const double n = particles_per_edge;
  return material.density * edge_length * edge_length * edge_length / (n * n * n);
}

SpringSettings material_springs(const MaterialSettings& material, int particles_per_edge,
                                double edge_length) {
  const double spacing = edge_length / (particles_per_edge - 1);
  const double mass = material_particle_mass(material, particles_per_edge, edge_length);
  SpringSettings springs;
  springs.stiffness = material.youngs_modulus * spacing / 7.3125;
  springs.damping = 2.0 * material.damping_ratio * std::sqrt(springs.stiffness * mass / 2.0);
  return springs;
}

Status add_cube(Model& model, const CubeSettings& cube) {
  const int n = cube.particles_per_edge;
  const double s = cube.edge_length / (n - 1);
  ASPIC_TRY(const auto pinned, pinned_particles(cube_pins, cube.pinned, cube.lattice()));

  SpringSettings structural = cube.structural, shear = cube.shear, bending = cube.bending;
  double mass = cube.particle_mass;
  if (cube.material) {
    structural = shear = bending = material_springs(*cube.material, n, cube.edge_length);
    mass = material_particle_mass(*cube.material, n, cube.edge_length);
  }

  Body body;
  body.first_particle = model.particle_count();
  body.particle_count = static_cast<std::uint32_t>(pinned.size());
  body.first_class = static_cast<std::uint32_t>(model.spring_classes.size());
  body.class_count = 4;
  body.lattice_edge = static_cast<std::uint32_t>(n);
  body.surface = surface_of(body.first_particle, n);
  body.size = s * (n - 1);

  // In the order that lattice_directions() names them by.
  model.spring_classes.push_back(
      {SpringType::structural, structural.stiffness, structural.damping, s, false});
  model.spring_classes.push_back(
      {SpringType::shear, shear.stiffness, shear.damping, s * std::sqrt(2.0), false});
  model.spring_classes.push_back(
      {SpringType::shear, shear.stiffness, shear.damping, s * std::sqrt(3.0), false});
  model.spring_classes.push_back({SpringType::bending, bending.stiffness, bending.damping, 2.0 * s, false});

  model.initial_position.append(
      LatticePlaces{n, s, cube.edge_length / 2.0, cube.position, {cube.rotation.axis, cube.rotation.angle}});
  model.mass.push_back(mass, pinned.size());
  for (std::size_t first = 0; first < pinned.size();) {
    const bool held = pinned[first];
    const auto from = pinned.begin() + static_cast<std::ptrdiff_t>(first);
    const auto count = static_cast<std::size_t>(std::find(from, pinned.end(), !held) - from);
    model.initial_velocity.push_back(held ? Vec3{} : cube.velocity, count);
    model.inverse_mass.push_back(held ? 0.0 : 1.0 / mass, count);
    first += count;
  }
  model.bodies.push_back(std::move(body));
  return {};
}

BodyRow cube_row() {
  constexpr auto counts = [](const CubeSettings& cube) { return cube_counts(cube.particles_per_edge); };
  return body_row<&ModelSettings::cubes, counts, add_cube>("cube", "particles-per-edge", &cube_pins);
}

}  // namespace aspic
