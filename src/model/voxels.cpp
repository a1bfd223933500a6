#include "model/voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "model/bodies.h"
#include "model/material.h"
#include "model/skin_text.h"
#include "model/springs.h"
#include "model/voxel_springs.h"

namespace aspic {
namespace {

constexpr Side faces[] = {{"top", 1, true},   {"bottom", 1, false}, {"left", 0, false},
                          {"right", 0, true}, {"front", 2, true},   {"back", 2, false}};
constexpr PinNames voxel_pins = {"body", faces, "face",
                                 "three faces joined by hyphens, such as left-top-front",
                                 "number of particles − 1"};

Result<std::vector<bool>> pinned_of(const PinNames& names, const Lattice& lattice,
                                    const PinnedSettings& pinned) {
  ASPIC_TRY(const auto at_points, pinned_particles(names, {pinned.names, {}}, lattice.particles));
  std::vector<bool> held;
  for (std::size_t point = 0; point < at_points.size(); ++point)
    if (lattice.has_particle(lattice.place(point))) held.push_back(at_points[point]);
  for (const std::int64_t index : pinned.indices) {
    if (index < 0 || index >= std::ssize(held))
      return fail(ErrorCode::scene_rejected, "pinned: index {} is not in the {}; allowed: 0 … {}", index,
                  names.body, held.size() - 1);
    held[static_cast<std::size_t>(index)] = true;
  }
  return held;
}

Result<VoxelShape> sound_shape(const VoxelsSettings& voxels) {
  auto shape = shape_of(voxels);
  if (const auto* const fault = std::get_if<CellFault>(&shape))
    return fail(ErrorCode::scene_rejected, "{}: {}", fault->key, fault->message);
  return std::get<VoxelShape>(std::move(shape));
}

LatticePlaces places_of(const VoxelsSettings& voxels, const VoxelShape& shape) {
  const auto half = [&](std::size_t axis) {
    return voxels.size * shape.grid[axis] / 2.0 - voxels.size * shape.offset[axis];
  };
  return {shape.lattice.particles,
          voxels.size,
          {half(0), half(1), half(2)},
          voxels.position,
          {voxels.rotation.axis, voxels.rotation.angle}};
}

/// The skin that the settings have, bound to the cells.
BodySkin skin_of(const VoxelsSettings& voxels, const VoxelShape& shape, std::uint32_t first_particle) {
  BodySkin skin;
  auto mesh = mesh_of_skin_text(voxels.skin);
  if (!mesh) return skin;
  const auto [i, j, k] = shape.offset;
  for (Vec3& v : mesh->vertices)
    v = v - Vec3{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
  skin.binding = bind_skin(shape.lattice, mesh->vertices);
  std::vector<std::uint32_t> numbers = particle_numbers(shape.lattice);
  for (std::uint32_t& number : numbers)
    if (number != no_particle) number += first_particle;
  skin.corners = skin_corners(skin.binding, shape.lattice, numbers);
  skin.triangles = std::move(mesh->triangles);
  return skin;
}

/// Particles, their masses, velocities and pins.
void add_particles(Model& model, const VoxelsSettings& voxels, const VoxelShape& shape,
                   const std::vector<double>& mass, const std::vector<bool>& pinned) {
  const LatticePlaces places = places_of(voxels, shape);
  if (shape.lattice.all_full()) {
    model.initial_position.append(places);
  } else {
    for (std::size_t point = 0; point < shape.lattice.points(); ++point)
      if (shape.lattice.has_particle(shape.lattice.place(point)))
        model.initial_position.push_back(places[point]);
  }
  for (std::size_t i = 0; i < pinned.size(); ++i) {
    model.mass.push_back(mass[i]);
    model.inverse_mass.push_back(pinned[i] ? 0.0 : 1.0 / mass[i]);
    model.initial_velocity.push_back(pinned[i] ? Vec3{} : voxels.velocity);
  }
}

}  // namespace

ModelCounts voxel_counts(const VoxelsSettings& voxels) {
  const auto found = shape_of(voxels);
  const auto* const shape = std::get_if<VoxelShape>(&found);
  if (!shape) return {};
  ModelCounts counts;
  for (std::size_t point = 0; point < shape->lattice.points(); ++point)
    counts.particles += shape->lattice.has_particle(shape->lattice.place(point));
  std::uint64_t* const of_type[] = {&counts.structural, &counts.shear, &counts.bending};
  for (const LatticeDirection& o : upper_directions())
    *of_type[static_cast<std::size_t>(lattice_class_types[o.spring_class])] +=
        springs_along(shape->lattice, o);
  const bool box = shape->lattice.all_full() &&
                   std::ranges::count(shape->cells, shape->cells.front()) == std::ssize(shape->cells);
  if (!box) counts.listed = counts.springs();
  return counts;
}

Status add_voxels(Model& model, const ModelSettings& settings, const VoxelsSettings& voxels) {
  if (const auto fault = fault_of(settings, voxels))
    return fail(ErrorCode::scene_rejected, "{}: {}", fault->key, fault->message);
  ASPIC_TRY(VoxelShape shape, sound_shape(voxels));
  ASPIC_TRY(const std::vector<bool> pinned, pinned_of(voxel_pins, shape.lattice, voxels.pinned));
  const VoxelSprings made(shape, materials_of(settings, voxels, shape), voxels.size);
  add_particles(model, voxels, shape, made.masses(), pinned);

  Body body;
  body.first_particle = model.particle_count() - static_cast<std::uint32_t>(pinned.size());
  body.particle_count = static_cast<std::uint32_t>(pinned.size());
  body.first_class = static_cast<std::uint32_t>(model.spring_classes.size());
  body.lattice = shape.lattice;
  body.size = voxels.size * (std::ranges::max(shape.lattice.particles) - 1);
  body.friction = voxels.friction;
  if (!made.uniform() && body.lattice->all_full()) body.lattice->full_cells.assign(shape.full, true);
  if (body.box()) {
    made.append_classes(model.spring_classes);
  } else {
    made.append_springs(model.listed_springs, model.spring_classes, body.first_particle);
    body.listed_surface = surface_of(*body.lattice, body.first_particle);
  }
  body.class_count = static_cast<std::uint32_t>(model.spring_classes.size()) - body.first_class;
  if (!voxels.skin.empty()) body.skin = skin_of(voxels, shape, body.first_particle);
  model.bodies.push_back(std::move(body));
  return {};
}

BodyRow row_of(const VoxelsSettings&) {
  BodyRow row = body_row<&ModelSettings::voxels, voxel_counts, add_voxels>("voxels", "layers", &voxel_pins);
  row.named = [](const PinNames& names, const ModelSettings& s, std::size_t i,
                 const PinnedSettings& pinned) -> Result<std::vector<bool>> {
    ASPIC_TRY(const VoxelShape shape, sound_shape(s.voxels[i]));
    return pinned_of(names, shape.lattice, pinned);
  };
  return row;
}

}  // namespace aspic
