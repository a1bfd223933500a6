// Bodies of cells against theory: a beam under its own weight, and a body of two materials in free fall.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "verify/experiments.h"

namespace aspic::verify {
namespace {

constexpr double beam_length = 1.0, slenderness = 8.0, beam_density = 1000.0, beam_modulus = 1e5;
/// So small that deflections are a hundredth of the length.
constexpr double beam_gravity = 0.01;

/// A beam n cells thick, held at its left face; implicit Euler at steps far longer than its vibrations leaves
/// it at rest.
ModelSettings beam(int cells) {
  ModelSettings settings;
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 0.5;
  settings.simulation.gravity = {0.0, -beam_gravity, 0.0};
  settings.simulation.implicit = {20, 3000, 1e-12};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  const auto thick = static_cast<std::size_t>(cells);
  voxels.size = beam_length / (slenderness * cells);
  voxels.layers.assign(thick, std::vector(thick, std::string(8 * thick, '1')));
  voxels.material = {beam_density, beam_modulus, 0.0};
  voxels.pinned.names = {"left"};
  return settings;
}

/// Mean deflection of the free end [m].
Result<double> deflection(const Subject& subject, int cells) {
  ASPIC_TRY(auto model, build_model(beam(cells)));
  ASPIC_TRY(auto state, run_reference(subject, model, Precision::double_, 60));
  double end = 0.0, sum = 0.0;
  int count = 0;
  for (const Vec3& x : model.initial_position) end = std::max(end, x.x);
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    if (model.initial_position[i].x < end - 1e-9) continue;
    sum += model.initial_position[i].y - state.position[i].y;
    ++count;
  }
  return sum / count;
}

/// That of a cantilever of the solid: bending ρgAL⁴/8EI, and shear ρgL²/(2·5/6·G) (Timoshenko, 1921), with
/// G = C₄₄ = 7/3 of the lattice.
double solid_deflection() {
  const double height = beam_length / slenderness, load = beam_density * beam_gravity;
  const double shear_modulus = beam_modulus * (7.0 / 3.0) / 7.3125;
  return load * 12.0 / (height * height) * std::pow(beam_length, 4) / (8.0 * beam_modulus) +
         load * beam_length * beam_length / (2.0 * (5.0 / 6.0) * shear_modulus);
}

/// The stiffness that beams of 2, 4 and 6 cells tend to for ever finer ones, over that of the solid: the
/// parabola in 1/n through them at 0.
Result<Finding> cantilever(const Subject& subject) {
  constexpr std::array cells = {2, 4, 6};
  constexpr std::array weights = {0.5, -4.0, 4.5};
  double limit = 0.0;
  std::string stiffness;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    ASPIC_TRY(const double found, deflection(subject, cells[i]));
    limit += weights[i] * solid_deflection() / found;
    stiffness += fmt::format("{}{:.3f}", i == 0 ? "" : ", ", solid_deflection() / found);
  }
  return Finding{std::abs(limit - 1.0) <= 0.01,
                 fmt::format("{:.4f} (of 2, 4, 6 cells {})", limit, stiffness)};
}

/// A body of two materials with a hole, a hinge and a piece apart, which flies and spins: how far its centre
/// of mass comes off its parabola [m].
Result<Finding> free_fall(const Subject& subject, Integrator integrator) {
  ModelSettings settings;
  settings.simulation.integrator = integrator;
  // Iterations leave momentum where the residual is.
  settings.simulation.implicit.tolerance = 1e-15;
  settings.materials = {{16.0, 33000.0, 0.4, "jelly"}, {30.0, 9000.0, 0.7, "fat"}};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  voxels.layers = {{"11221", "1.2.1", "11221"}, {"2....", ".1..2", "....2"}};
  voxels.palette = {{"1", "jelly"}, {"2", "fat"}};
  voxels.pieces = Pieces::all;
  ASPIC_TRY(auto model, build_model(settings));
  State start = shaken(model, 0.0, 0.5, 30);
  const auto centre_of = [&](const std::vector<Vec3>& of) {
    Vec3 sum;
    double mass = 0.0;
    for (std::size_t i = 0; i < of.size(); ++i) {
      sum = sum + model.mass[i] * of[i];
      mass += model.mass[i];
    }
    return sum / mass;
  };
  constexpr std::uint64_t steps = 1000;
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, steps, &start));
  // Each method moves a particle without springs as its powers of the step say: the drift is exact but for
  // the order of the method, so velocities are compared.
  const double time = static_cast<double>(steps) * settings.simulation.timestep;
  const Vec3 expected = centre_of(start.velocity) + time * model.simulation.gravity;
  return at_most(length(centre_of(end.velocity) - expected), 1e-11, "m/s");
}

}  // namespace

void add_voxel_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"voxels/cantilever",
       "beams of 2, 4 and 6 cells, held at one end, under their weight: stiffness over that of the solid, "
       "δ = ρgAL⁴/8EI and shear, tends to 1",
       "1 ± 0.01", true, false, cantilever});
  add_for_each_integrator(
      checks, "voxels/free-fall",
      "two materials, a hole, a hinge and a piece apart, 1,000 steps: velocity of the centre of "
      "mass against gt",
      at_most_text(1e-11, "m/s"), true, free_fall);
}

}  // namespace aspic::verify
