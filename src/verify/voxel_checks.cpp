// Bodies of cells against theory: a beam under its own weight, its vibrations, and bodies of two materials,
// in free fall and next to those of one.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "verify/experiments.h"

namespace aspic::verify {
namespace {

constexpr double beam_length = 1.0, slenderness = 8.0, beam_density = 1000.0, beam_modulus = 1e5;
/// So small that deflections are a hundredth of the length.
constexpr double beam_gravity = 0.01;

/// A beam n cells thick, held at its left face, without gravity and damping.
ModelSettings beam(int cells) {
  ModelSettings settings;
  settings.simulation.gravity = {0.0, 0.0, 0.0};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  const auto thick = static_cast<std::size_t>(cells);
  voxels.size = beam_length / (slenderness * cells);
  voxels.layers.assign(thick, std::vector(thick, std::string(8 * thick, '1')));
  voxels.material = {beam_density, beam_modulus, 0.0};
  voxels.pinned.names = {"left"};
  return settings;
}

/// The figure that those of beams of 2, 4 and 6 cells tend to for ever finer ones: the parabola in 1/n
/// through them at 0, since the lattice's own error is a/n + b/n².
constexpr std::array beam_cells = {2, 4, 6};
double in_the_limit(const std::array<double, 3>& figures) {
  return 0.5 * figures[0] - 4.0 * figures[1] + 4.5 * figures[2];
}

/// Mean deflection of the free end [m]. Implicit Euler at steps far longer than the vibrations leaves the
/// beam at rest.
Result<double> deflection(const Subject& subject, int cells) {
  ModelSettings settings = beam(cells);
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 0.5;
  settings.simulation.gravity = {0.0, -beam_gravity, 0.0};
  settings.simulation.implicit = {20, 3000, 1e-12};
  ASPIC_TRY(auto model, build_model(settings));
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

/// G = C₄₄ = 7/3 of the lattice.
constexpr double beam_shear_modulus = beam_modulus * (7.0 / 3.0) / 7.3125;

/// That of a cantilever of the solid: bending ρgAL⁴/8EI, and shear ρgL²/(2·5/6·G) (Timoshenko, 1921).
double solid_deflection() {
  const double height = beam_length / slenderness, load = beam_density * beam_gravity;
  return load * 12.0 / (height * height) * std::pow(beam_length, 4) / (8.0 * beam_modulus) +
         load * beam_length * beam_length / (2.0 * (5.0 / 6.0) * beam_shear_modulus);
}

Result<Finding> cantilever(const Subject& subject) {
  std::array<double, 3> stiffness = {};
  for (std::size_t i = 0; i < beam_cells.size(); ++i) {
    ASPIC_TRY(const double found, deflection(subject, beam_cells[i]));
    stiffness[i] = solid_deflection() / found;
  }
  const double limit = in_the_limit(stiffness);
  return Finding{std::abs(limit - 1.0) <= 0.01,
                 fmt::format("{:.4f} (of 2, 4, 6 cells {:.3f})", limit, fmt::join(stiffness, ", "))};
}

/// βL of the bending modes of a clamped and free beam that does not shear: cos βL·cosh βL = −1.
constexpr std::array slender_modes = {1.87510407, 4.69409113, 7.85475744};

/// Deflection of such a mode at x of 0 … 1 along the beam.
double mode_shape(double beta, double x) {
  const double ratio = (std::cosh(beta) + std::cos(beta)) / (std::sinh(beta) + std::sin(beta));
  return std::cosh(beta * x) - std::cos(beta * x) - ratio * (std::sinh(beta * x) - std::sin(beta * x));
}

/// ω√(ρA/EI)·L² of the solid's beam, the root next to that of the slender one: with shear and the inertia of
/// its turning sections, after Huang, Journal of Applied Mechanics 28 (1961), equation 32.
double solid_frequency(std::size_t mode) {
  const double height = beam_length / slenderness;
  const double r = height * height / (12.0 * beam_length * beam_length);
  const double s = r * beam_modulus / ((5.0 / 6.0) * beam_shear_modulus);
  const auto determinant = [&](double b) {
    const double root = std::sqrt((r - s) * (r - s) + 4.0 / (b * b));
    const double alpha = b * std::sqrt((root - r - s) / 2.0), beta = b * std::sqrt((root + r + s) / 2.0);
    return 2.0 + (b * b * (r - s) * (r - s) + 2.0) * std::cosh(alpha) * std::cos(beta) -
           b * (r + s) / std::sqrt(1.0 - b * b * r * s) * std::sinh(alpha) * std::sin(beta);
  };
  const double slender = slender_modes[mode] * slender_modes[mode];
  double low = 0.7 * slender, high = slender;  // shear and inertia make it slower
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2.0;
    ((determinant(low) > 0.0) == (determinant(middle) > 0.0) ? low : high) = middle;
  }
  return low;
}

/// The frequency [rad/s] of which samples have most, next to a guess: that of the largest |Σ wₖqₖe^(−iωkΔt)|
/// with Hann's weights, which keep other frequencies out. Searched from 0.9 to 2 times the guess, then by
/// golden section.
double strongest(const std::vector<double>& samples, double between, double guess) {
  const auto strength = [&](double omega) {
    double real = 0.0, imaginary = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const double part = (static_cast<double>(k) + 0.5) / static_cast<double>(samples.size());
      const double weighted = (0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * part)) * samples[k];
      real += weighted * std::cos(omega * between * static_cast<double>(k));
      imaginary += weighted * std::sin(omega * between * static_cast<double>(k));
    }
    return real * real + imaginary * imaginary;
  };
  constexpr double step = 0.01, golden = 0.381966;
  double best = 0.9 * guess;
  for (double omega = best; omega < 2.0 * guess; omega += step * guess)
    if (strength(omega) > strength(best)) best = omega;
  double low = best - step * guess, high = best + step * guess;
  for (int i = 0; i < 40; ++i) {
    const double one = low + golden * (high - low), other = high - golden * (high - low);
    (strength(one) > strength(other) ? high : low) = strength(one) > strength(other) ? other : one;
  }
  return (low + high) / 2.0;
}

/// ω√(ρA/EI)·L² of a mode of the lattice: that of a beam which was pushed in the slender beam's shape, small
/// enough for springs to be linear, seen by its share of that shape.
Result<double> vibration_frequency(const Subject& subject, int cells, std::size_t mode) {
  ModelSettings settings = beam(cells);
  settings.simulation.integrator = Integrator::symplectic_euler;
  ASPIC_TRY(auto model, build_model(settings));
  // Four fifths of the longest stable step of an infinite lattice.
  const double stiffness = beam_modulus * settings.voxels[0].size / 7.3125;
  const double h = 1.6 / std::sqrt(17.63 * stiffness / model.mass[0]);
  model.simulation.timestep = h;
  double left = 0.0;
  for (const Vec3& x : model.initial_position) left = std::min(left, x.x);
  std::vector<double> shape;
  for (const Vec3& x : model.initial_position)
    shape.push_back(mode_shape(slender_modes[mode], (x.x - left) / beam_length));
  State start = initial_state(model, Precision::double_);
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (model.inverse_mass[i] > 0.0) start.velocity[i].y = 1e-4 * shape[i];
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  ASPIC_CHECK(solver->load(start));
  // ω in these units is (βL)².
  const double unit = std::sqrt(beam_modulus / (12.0 * beam_density)) / (slenderness * beam_length);
  const double guess = solid_frequency(mode) * unit, period = 2.0 * std::numbers::pi / guess;
  const auto stride = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(period / (60.0 * h)));
  const double between = static_cast<double>(stride) * h, periods = mode == 0 ? 4.0 : 8.0;
  std::vector<double> shares;
  while (static_cast<double>(shares.size()) * between < periods * period) {
    ASPIC_TRY(const State now, run(*solver, stride));
    double share = 0.0;
    for (std::size_t i = 0; i < shape.size(); ++i)
      share += shape[i] * (now.position[i].y - model.initial_position[i].y);
    shares.push_back(share);
  }
  // Symplectic Euler's frequency, and from it that of the springs.
  return 2.0 / h * std::sin(strongest(shares, between, guess) * h / 2.0) / unit;
}

Result<Finding> vibration(const Subject& subject, std::size_t mode) {
  std::array<double, 3> squares = {};
  for (std::size_t i = 0; i < beam_cells.size(); ++i) {
    ASPIC_TRY(const double found, vibration_frequency(subject, beam_cells[i], mode));
    squares[i] = std::pow(found / solid_frequency(mode), 2);
  }
  const double limit = in_the_limit(squares);
  return Finding{
      std::abs(limit - 1.0) <= 0.01,
      fmt::format("{:.4f} (of 2, 4, 6 cells {:.3f}); βL = {:.3f} of {:.3f}", limit, fmt::join(squares, ", "),
                  std::sqrt(std::sqrt(limit) * solid_frequency(mode)), std::sqrt(solid_frequency(mode)))};
}

/// A body of two materials with a hole, a hinge and a piece apart, which flies and spins: how far its center
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
  const auto center_of = [&](const std::vector<Vec3>& of) {
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
  const Vec3 expected = center_of(start.velocity) + time * model.simulation.gravity;
  return at_most(length(center_of(end.velocity) - expected), 1e-11, "m/s");
}

/// A spring is as stiff, and as damped, as its cells are on average. So what the springs of a body of two
/// materials do, with what they do where the two are exchanged, is what they do in bodies of either alone:
/// how far the changes of velocity in a step come off that, as a share of the largest.
Result<Finding> mixture(const Subject& subject) {
  const std::vector<std::vector<std::string>> mixed = {{"aab", "b.a", "abb"}, {"bba", "a.a", "aab"}};
  const std::array<std::array<char, 2>, 4> becomes = {{{'a', 'b'}, {'b', 'a'}, {'a', 'a'}, {'b', 'b'}}};
  std::vector<Vec3> off;
  double largest = 0.0;
  for (std::size_t body = 0; body < becomes.size(); ++body) {
    ModelSettings settings;
    settings.simulation.gravity = {};
    settings.simulation.integrator = Integrator::explicit_euler;
    settings.materials = {{1000.0, 1e5, 0.2, "soft"}, {1000.0, 7e5, 0.5, "hard"}};
    VoxelsSettings& voxels = settings.voxels.emplace_back();
    voxels.palette = {{"a", "soft"}, {"b", "hard"}};
    voxels.layers = mixed;
    for (std::vector<std::string>& layer : voxels.layers)
      for (std::string& row : layer)
        for (char& cell : row)
          if (cell != '.') cell = becomes[body][cell == 'a' ? 0 : 1];
    ASPIC_TRY(auto model, build_model(settings));
    const State start = shaken(model, 0.1 * voxels.size, 0.5, 31);
    ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 1, &start));
    off.resize(end.velocity.size());
    for (std::size_t i = 0; i < off.size(); ++i) {
      const Vec3 change = end.velocity[i] - start.velocity[i];
      off[i] = off[i] + (body < 2 ? 1.0 : -1.0) * change;
      largest = std::max(largest, length(change));
    }
  }
  double furthest = 0.0;
  for (const Vec3& each : off) furthest = std::max(furthest, length(each));
  return at_most(furthest / largest, 1e-13, "");
}

}  // namespace

void add_voxel_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"voxels/cantilever",
       "beams of 2, 4 and 6 cells, held at one end, under their weight: stiffness over that of the solid, "
       "δ = ρgAL⁴/8EI and shear, tends to 1",
       "1 ± 0.01", true, false, cantilever});
  for (std::size_t mode = 0; mode < slender_modes.size(); ++mode)
    checks.push_back(
        {fmt::format("voxels/bending/{}", mode + 1),
         fmt::format("bending mode {} of such beams, βL = {:.3f} if they were slender: square of the "
                     "frequency over that of the solid tends to 1",
                     mode + 1, slender_modes[mode]),
         "1 ± 0.01", true, false, [mode](const Subject& subject) { return vibration(subject, mode); }});
  checks.push_back({"voxels/mixture",
                    "two materials, and the two exchanged: changes of velocity together against those of "
                    "either alone",
                    at_most_text(1e-13, ""), true, false, mixture});
  add_for_each_integrator(
      checks, "voxels/free-fall",
      "two materials, a hole, a hinge and a piece apart, 1,000 steps: velocity of the center of "
      "mass against gt",
      at_most_text(1e-11, "m/s"), true, free_fall);
}

}  // namespace aspic::verify
