#include "model/cube.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "model/bodies.h"
#include "model/material.h"
#include "model/springs.h"

namespace aspic {
namespace {

constexpr Side faces[] = {{"top", 1, true},   {"bottom", 1, false}, {"left", 0, false},
                          {"right", 0, true}, {"front", 2, true},   {"back", 2, false}};
constexpr PinNames cube_pins = {"cube", faces, "face",
                                "three faces joined by hyphens, such as left-top-front",
                                "n³ − 1, or n₀·n₁·n₂ − 1 of a box"};

/// The type's stiffness and damping.
const SpringSettings& springs_of_type(const CubeSettings& cube, SpringType type) {
  return type == SpringType::structural ? cube.structural
         : type == SpringType::shear    ? cube.shear
                                        : cube.bending;
}

}  // namespace

ModelCounts box_counts(const std::array<int, 3>& particles) {
  const Lattice lattice = {particles, {}};
  ModelCounts counts;
  counts.particles = lattice.points();
  std::uint64_t* const of_type[] = {&counts.structural, &counts.shear, &counts.bending};
  for (const LatticeDirection& o : upper_directions())
    *of_type[static_cast<std::size_t>(lattice_class_types[o.spring_class])] += springs_along(lattice, o);
  return counts;
}

double spacing_of(const CubeSettings& cube) {
  return cube.edge_length / (std::ranges::max(cube.lattice()) - 1);
}

Vec3 edges_of(const CubeSettings& cube) {
  const std::array<int, 3> n = cube.lattice();
  const double s = spacing_of(cube);
  // The longest are the given number, not what its rounded parts add up to.
  const auto edge = [&](int along) {
    return along == std::ranges::max(n) ? cube.edge_length : s * (along - 1);
  };
  return {edge(n[0]), edge(n[1]), edge(n[2])};
}

std::array<int, 3> with_longest_edge(const CubeSettings& cube, int longest) {
  std::array<int, 3> n = cube.lattice();
  const double share = (longest - 1.0) / (std::ranges::max(n) - 1.0);
  for (int& along : n) along = std::max(2, 1 + static_cast<int>(std::lround(share * (along - 1))));
  return n;
}

void resize(CubeSettings& cube, int longest) {
  if (cube.particles)
    cube.particles = with_longest_edge(cube, longest);
  else
    cube.particles_per_edge = longest;
}

double material_particle_mass(const CubeSettings& cube) {
  const Vec3 edges = edges_of(cube);
  const auto [ni, nj, nk] = cube.lattice();
  return cube.material->density * edges.x * edges.y * edges.z / (static_cast<double>(ni) * nj * nk);
}

SpringSettings material_springs(const CubeSettings& cube) {
  return lattice_springs(*cube.material, spacing_of(cube), material_particle_mass(cube));
}

namespace {

/// Appends a cube whose material, if it has one, holds numbers.
Status add_made(Model& model, const CubeSettings& cube) {
  const double s = spacing_of(cube);
  ASPIC_TRY(const auto pinned, pinned_particles(cube_pins, cube.pinned, cube.lattice()));
  const std::optional<SpringSettings> same =
      cube.material ? std::optional(material_springs(cube)) : std::nullopt;
  const double mass = cube.material ? material_particle_mass(cube) : cube.particle_mass;

  Body body;
  body.first_particle = model.particle_count();
  body.particle_count = static_cast<std::uint32_t>(pinned.size());
  body.first_class = static_cast<std::uint32_t>(model.spring_classes.size());
  body.class_count = static_cast<std::uint32_t>(lattice_class_types.size());
  body.lattice = Lattice{cube.lattice(), {}};
  body.size = s * (std::ranges::max(cube.lattice()) - 1);
  body.friction = cube.friction;

  for (std::size_t c = 0; c < lattice_class_types.size(); ++c) {
    const SpringType type = lattice_class_types[c];
    const SpringSettings& springs = same ? *same : springs_of_type(cube, type);
    model.spring_classes.push_back(
        {type, springs.stiffness, springs.damping, s * std::sqrt(static_cast<double>(c + 1)), false});
  }

  model.initial_position.append(LatticePlaces{
      cube.lattice(), s, edges_of(cube) / 2.0, cube.position, {cube.rotation.axis, cube.rotation.angle}});
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

}  // namespace

Status add_cube(Model& model, const ModelSettings& settings, const CubeSettings& cube) {
  if (!cube.material || cube.material->name.empty()) return add_made(model, cube);
  CubeSettings made = cube;
  ASPIC_TRY(made.material, material_of(settings, *cube.material));
  return add_made(model, made);
}

BodyRow row_of(const CubeSettings&) {
  constexpr auto counts = [](const CubeSettings& cube) { return box_counts(cube.lattice()); };
  BodyRow row = body_row<&ModelSettings::cubes, counts, add_cube>("cube", "particles-per-edge", &cube_pins);
  row.size_keys.emplace_back("particles");
  return row;
}

}  // namespace aspic
