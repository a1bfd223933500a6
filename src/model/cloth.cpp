// Cloth: a rectangular sheet of particles with structural, shear and bending springs.
#include <utility>
#include <vector>

#include "model/bodies.h"
#include "model/material.h"

namespace aspic {
namespace {

constexpr Side edges[] = {{"top", 1, true}, {"bottom", 1, false}, {"left", 0, false}, {"right", 0, true}};
constexpr PinNames cloth_pins = {"cloth", edges, "edge", "two edges joined by a hyphen, such as top-left",
                                 "w·h − 1"};

/// Spring classes, counted from the cloth's first.
enum ClassOfCloth : std::uint32_t { along_width, along_height, diagonal, two_along_width, two_along_height };

/// A spring's direction on the lattice, seen from its lower particle.
struct Direction {
  int di, dj;
  ClassOfCloth spring_class;
};

/// In ascending index of the other end, so that springs come out sorted by (a, b); h ≥ 2 keeps the order.
constexpr Direction directions[] = {{0, 1, along_height}, {0, 2, two_along_height}, {1, -1, diagonal},
                                    {1, 0, along_width},  {1, 1, diagonal},         {2, 0, two_along_width}};

/// By closed form. Pinned particles are not counted.
ModelCounts counts_of(const ClothSettings& cloth) {
  const auto w = static_cast<std::uint64_t>(cloth.particles[0]),
             h = static_cast<std::uint64_t>(cloth.particles[1]);
  ModelCounts counts;
  counts.particles = w * h;
  counts.structural = (w - 1) * h + w * (h - 1);
  counts.shear = 2 * (w - 1) * (h - 1);
  counts.bending = (w - 2) * h + w * (h - 2);
  counts.listed = counts.springs();
  return counts;
}

/// A rod along each edge of which all particles are pinned; its radius is a hundredth of that edge.
std::vector<Rod> rods_of(const Model& model, std::uint32_t first, std::uint32_t w, std::uint32_t h) {
  const std::uint32_t corners[4][2] = {
      {0, h - 1}, {(w - 1) * h, w * h - 1}, {0, (w - 1) * h}, {h - 1, w * h - 1}};
  std::vector<Rod> rods;
  for (const auto& [from, to] : corners) {
    const std::uint32_t stride = to - from < h ? 1 : h;
    bool held = true;
    for (std::uint32_t i = from; i <= to; i += stride) held = held && model.inverse_mass[first + i] == 0.0;
    const Vec3 &a = model.initial_position[first + from], &b = model.initial_position[first + to];
    if (held) rods.push_back({a, b, 0.01 * length(b - a)});
  }
  return rods;
}

/// Particle i·h + j is the i-th along the width and the j-th along the height. Error (scene_rejected): an
/// unknown edge or corner, or an index ≥ w·h, in `pinned`; an unknown material, or one that cells of this
/// shape cannot have.
Status add_cloth(Model& model, const ModelSettings& settings, const ClothSettings& cloth) {
  const auto [w, h] = cloth.particles;
  const double sx = cloth.size[0] / (w - 1), sy = cloth.size[1] / (h - 1);
  ASPIC_TRY(const std::vector<bool> pinned, pinned_particles(cloth_pins, cloth.pinned, cloth.lattice()));
  SheetSprings sheet = {cloth.particle_mass, cloth.structural, cloth.structural,
                        cloth.shear,         cloth.bending,    cloth.bending};
  if (cloth.material) {
    ClothSettings made = cloth;
    ASPIC_TRY(made.material, material_of(settings, *cloth.material));
    ASPIC_TRY(sheet, sheet_springs(made));
  }

  Body body;
  body.first_particle = model.particle_count();
  body.particle_count = static_cast<std::uint32_t>(pinned.size());
  body.first_class = static_cast<std::uint32_t>(model.spring_classes.size());
  const auto add_class = [&](SpringType type, const SpringSettings& springs, double rest_length) {
    model.spring_classes.push_back({type, springs.stiffness, springs.damping, rest_length, false});
  };
  add_class(SpringType::structural, sheet.along_width, sx);
  add_class(SpringType::structural, sheet.along_height, sy);
  add_class(SpringType::shear, sheet.shear, length(Vec3{sx, sy, 0.0}));
  add_class(SpringType::bending, sheet.bending_width, 2.0 * sx);
  add_class(SpringType::bending, sheet.bending_height, 2.0 * sy);
  body.class_count = static_cast<std::uint32_t>(model.spring_classes.size()) - body.first_class;

  const Rotation turned(cloth.rotation.axis, cloth.rotation.angle);
  for (int i = 0; i < w; ++i) {
    for (int j = 0; j < h; ++j) {
      const int local = i * h + j;
      const bool held = pinned[static_cast<std::size_t>(local)];
      const Vec3 from_center = {i * sx - cloth.size[0] / 2.0, j * sy - cloth.size[1] / 2.0, 0.0};
      model.initial_position.push_back(cloth.position + turned(from_center));
      model.initial_velocity.push_back(held ? Vec3{} : cloth.velocity);
      model.mass.push_back(sheet.mass);
      model.inverse_mass.push_back(held ? 0.0 : 1.0 / sheet.mass);
      const std::uint32_t a = body.first_particle + static_cast<std::uint32_t>(local);
      for (const Direction& d : directions) {
        if (i + d.di >= w || j + d.dj < 0 || j + d.dj >= h) continue;
        model.listed_springs.push_back(
            {a, a + static_cast<std::uint32_t>(d.di * h + d.dj), body.first_class + d.spring_class});
      }
    }
  }
  const auto columns = static_cast<std::uint32_t>(w), rows = static_cast<std::uint32_t>(h);
  body.style = SurfaceStyle::sheet;
  body.friction = cloth.friction;
  append_grid(body.listed_surface, {body.first_particle, {columns, rows}, {rows, 1}});
  body.rods = rods_of(model, body.first_particle, columns, rows);
  model.bodies.push_back(std::move(body));
  return {};
}

}  // namespace

BodyRow row_of(const ClothSettings&) {
  return body_row<&ModelSettings::cloths, counts_of, add_cloth>("cloth", "particles", &cloth_pins);
}

}  // namespace aspic
