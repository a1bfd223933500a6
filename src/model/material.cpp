#include "model/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/suggestion.h"

namespace aspic {

const MaterialSettings* find_material(const ModelSettings& settings, std::string_view name) {
  const auto found = std::ranges::find(settings.materials, name, &MaterialSettings::name);
  return name.empty() || found == settings.materials.end() ? nullptr : &*found;
}

std::string unknown_material(const ModelSettings& settings, std::string_view name) {
  std::vector<std::string_view> names;
  for (const MaterialSettings& m : settings.materials)
    if (!m.name.empty()) names.push_back(m.name);
  if (names.empty())
    return fmt::format("the material \"{0}\", and the scene has none: add a [[material]] with name = \"{0}\"",
                       name);
  return fmt::format("the material \"{}\", which the scene does not have; it has {}{}", name,
                     fmt::join(names, ", "), diagnostics::did_you_mean(diagnostics::nearest(name, names)));
}

Result<MaterialSettings> material_of(const ModelSettings& settings, const MaterialSettings& of_body) {
  if (of_body.name.empty()) return of_body;
  const MaterialSettings* const found = find_material(settings, of_body.name);
  if (found) return *found;
  return fail(ErrorCode::scene_rejected, "material: it is {}", unknown_material(settings, of_body.name));
}

double damping_of(const MaterialSettings& material, double stiffness, double mass) {
  return 2.0 * material.damping_ratio * std::sqrt(stiffness * mass / 2.0);
}

SpringSettings lattice_springs(const MaterialSettings& material, double spacing, double mass) {
  SpringSettings springs;
  springs.stiffness = material.youngs_modulus * spacing / lattice_modulus;
  springs.damping = damping_of(material, springs.stiffness, mass);
  return springs;
}

Result<SheetSprings> sheet_springs(const ClothSettings& cloth) {
  const auto [w, h] = cloth.particles;
  const double sx = cloth.size[0] / (w - 1), sy = cloth.size[1] / (h - 1);
  const double ratio = sx / sy;
  if (ratio * ratio >= 3.0 || ratio * ratio <= 1.0 / 3.0)
    return fail(ErrorCode::scene_rejected,
                "particles: cells of {:.4g} m × {:.4g} m are too long one way: a cloth of a material needs "
                "cells less than √3 times as long as wide; choose other particles",
                sx, sy);
  const MaterialSettings& material = *cloth.material;
  SheetSprings sheet;
  sheet.mass = material.density * cloth.thickness * cloth.size[0] * cloth.size[1] /
               (static_cast<double>(w) * static_cast<double>(h));
  // C₁₂ = C₆₆ = G and C₁₁ = C₂₂ = 3G: isotropic, and E·t = C₁₁ − C₁₂²/C₁₁.
  const double g = 3.0 * material.youngs_modulus * cloth.thickness / 8.0;
  const auto springs = [&](double stiffness) {
    return SpringSettings{stiffness, damping_of(material, stiffness, sheet.mass)};
  };
  const auto axis = [&](double r) { return g / 1.2 * (3.0 - r * r) / r; };
  sheet.along_width = springs(axis(ratio));
  sheet.along_height = springs(axis(1.0 / ratio));
  sheet.shear = springs(g * (sx * sx + sy * sy) / (2.0 * sx * sy));
  sheet.bending_width = springs(axis(ratio) / 20.0);
  sheet.bending_height = springs(axis(1.0 / ratio) / 20.0);
  return sheet;
}

}  // namespace aspic
