#include "cli/scene_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "model/material.h"

namespace aspic::cli {
namespace {

/// Of the springs and masses of a cube, as docs/physics.md has them: E = 7.3125·k/s, ρ = m·n³/edge³.
struct Equivalent {
  double stiffness, youngs_modulus, density, sound;  // [N/m], [Pa], [kg/m³], [m/s]
  std::vector<std::size_t> cubes;
};

double spacing_of(const CubeSettings& cube, int times) {
  return cube.edge_length / (times * std::ranges::max(cube.lattice()) - 1);
}

double modulus_of(const CubeSettings& cube, int times = 1) {
  return lattice_modulus * cube.structural.stiffness / spacing_of(cube, times);
}

double density_of(const CubeSettings& cube, int times = 1) {
  const double s = spacing_of(cube, times);
  double density = cube.particle_mass;
  for (const int n : cube.lattice()) density *= times * n / ((times * n - 1) * s);
  return density;
}

std::vector<Equivalent> equivalents_of(const ModelSettings& settings) {
  std::vector<Equivalent> all;
  for (std::size_t n = 0; n < settings.cubes.size(); ++n) {
    const CubeSettings& cube = settings.cubes[n];
    const double k = cube.structural.stiffness;
    if (cube.material || !(k > 0.0) || cube.shear.stiffness != k || cube.bending.stiffness != k) continue;
    const double s = spacing_of(cube, 1);
    const Equivalent made = {
        k, modulus_of(cube), density_of(cube), s * std::sqrt(lattice_modulus * k / cube.particle_mass), {n}};
    const auto same = std::ranges::find_if(all, [&](const Equivalent& e) {
      return e.stiffness == k && e.youngs_modulus == made.youngs_modulus && e.density == made.density;
    });
    if (same == all.end())
      all.push_back(made);
    else
      same->cubes.push_back(n);
  }
  return all;
}

std::string pascal(double E) {
  return E < 1e3   ? fmt::format("{:.3g} Pa", E)
         : E < 1e6 ? fmt::format("{:.3g} kPa", E / 1e3)
                   : fmt::format("{:.3g} MPa", E / 1e6);
}

}  // namespace

std::string materials_text(const ModelSettings& settings) {
  std::string text;
  for (const Equivalent& e : equivalents_of(settings)) {
    const CubeSettings& cube = settings.cubes[e.cubes.front()];
    std::string names = fmt::format("cube[{}]", e.cubes.front());
    if (e.cubes.size() > 1) names = fmt::format("{} cubes from cube[{}] on", e.cubes.size(), e.cubes.front());
    text += fmt::format(
        "material     {}: k = {:g} N/m at this resolution equals E = {}, density {:.3g} kg/m³; with twice "
        "the particles along each edge, {} and {:.3g} kg/m³; impacts above {:.3g} m/s flatten cells\n",
        names, e.stiffness, pascal(e.youngs_modulus), e.density, pascal(modulus_of(cube, 2)),
        density_of(cube, 2), e.sound);
  }
  return text;
}

Json materials_json(const ModelSettings& settings) {
  Json all = Json::array();
  for (const Equivalent& e : equivalents_of(settings))
    all.push_back({{"cubes", e.cubes},
                   {"stiffness", e.stiffness},
                   {"youngs_modulus", e.youngs_modulus},
                   {"density", e.density},
                   {"speed_of_sound", e.sound}});
  return all;
}

}  // namespace aspic::cli
