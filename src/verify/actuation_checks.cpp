// Actuated bodies against theory: free expansion, a beam of two layers of which one swells, and the order of
// methods whose springs' rest lengths change with time.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "model/springs.h"
#include "verify/experiments.h"
#include "verify/studies.h"

namespace aspic::verify {
namespace {

/// Always w = 1.
const SignalTable constant = {{0.0, 1.0}, {1.0, 1.0}};

/// Implicit Euler, at steps far longer than any vibration, comes to rest.
ModelSettings at_rest() {
  ModelSettings settings;
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 0.5;
  settings.simulation.gravity = {0.0, 0.0, 0.0};
  settings.simulation.implicit = {20, 3000, 1e-13};
  return settings;
}

ActuatorSettings swelling(BodyAxis axis) {
  ActuatorSettings actuator;
  actuator.axis = axis;
  actuator.signal = Signal::table;
  actuator.table = constant;
  return actuator;
}

/// How much any spring of a free body with a hole differs from its length in the body that its actuator makes
/// of it, 1 + v times as large in volume, relative to that length.
Result<Finding> expansion(const Subject& subject, BodyAxis axis) {
  constexpr double change = 0.5;
  ModelSettings settings = at_rest();
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  voxels.layers = {{"1111", "1.11"}, {"1111", "1111"}, {"11..", "1111"}};
  settings.actuators = {swelling(axis)};
  settings.actuators[0].volume_change = change;
  // Slowly, so that the body stays near equilibrium; then it is left to itself.
  settings.actuators[0].ramp = 20.0;
  ASPIC_TRY(auto model, build_model(settings));
  ASPIC_TRY(const auto state, run_reference(subject, model, Precision::double_, 60));
  const double every_way = axis == BodyAxis::none ? std::cbrt(1.0 + change) : 1.0;
  const Vec3 stretch =
      axis == BodyAxis::y ? Vec3{1.0, 1.0 + change, 1.0} : Vec3{every_way, every_way, every_way};
  double worst = 0.0;
  for (const Spring& spring : springs_of(model)) {
    Vec3 rest = model.initial_position[spring.a] - model.initial_position[spring.b];
    for (int i = 0; i < 3; ++i) rest[i] *= stretch[i];
    const double found = length(state.position[spring.a] - state.position[spring.b]) / length(rest);
    worst = std::max(worst, std::abs(found - 1.0));
  }
  return at_most(worst, 1e-9);
}

constexpr double length_over_height = 8.0, swell = 1e-3;

/// Curvature [1/m] of a free beam of length 1 m, n cells thick, whose lower half stretches by a thousandth
/// along it: from the heights of its middle and of the places a quarter of the length away.
Result<double> curvature(const Subject& subject, int cells) {
  ModelSettings settings = at_rest();
  settings.materials = {{1000.0, 1e5, 0.0, "upper"}, {1000.0, 1e5, 0.0, "lower"}};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  const auto thick = static_cast<std::size_t>(cells);
  const std::size_t along = static_cast<std::size_t>(length_over_height) * thick;
  voxels.size = 1.0 / static_cast<double>(along);
  voxels.layers.clear();
  for (std::size_t y = 0; y < thick; ++y)
    voxels.layers.emplace_back(thick, std::string(along, 2 * y < thick ? '1' : '2'));
  voxels.palette = {{"1", "lower"}, {"2", "upper"}};
  settings.actuators = {swelling(BodyAxis::x)};
  settings.actuators[0].select.materials = {"lower"};
  settings.actuators[0].amplitude = swell;
  ASPIC_TRY(auto model, build_model(settings));
  ASPIC_TRY(const auto state, run_reference(subject, model, Precision::double_, 60));
  const auto height = [&](double x) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < state.position.size(); ++i) {
      if (std::abs(model.initial_position[i].x - settings.voxels[0].position.x - x) > 1e-9) continue;
      sum += state.position[i].y;
      ++count;
    }
    return sum / count;
  };
  constexpr double quarter = 0.25;
  return std::abs(height(quarter) + height(-quarter) - 2.0 * height(0.0)) / (quarter * quarter);
}

/// Of two equal layers of one modulus, κ = 3ε/2h (Timoshenko, Journal of the Optical Society of America 11,
/// 1925).
Result<Finding> bimorph(const Subject& subject) {
  constexpr std::array cells = {2, 4, 6};
  constexpr std::array weights = {0.5, -4.0, 4.5};
  std::array<double, 3> found = {};
  double limit = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    ASPIC_TRY(const double bent, curvature(subject, cells[i]));
    found[i] = bent / (1.5 * swell * length_over_height);
    limit += weights[i] * found[i];
  }
  return Finding{std::abs(limit - 1.0) <= 0.02,
                 fmt::format("{:.4f} (of 2, 4, 6 cells {:.3f})", limit, fmt::join(found, ", "))};
}

}  // namespace

void add_actuation_checks(std::vector<Check>& checks) {
  for (const BodyAxis axis : {BodyAxis::none, BodyAxis::y})
    checks.push_back(
        {fmt::format("actuation/expansion/{}", axis == BodyAxis::none ? "all" : "y"),
         "a free body that swells by half its volume, every way or along one axis: springs' lengths "
         "against those of the body 1 + v times as large",
         at_most_text(1e-9), true, false,
         [axis](const Subject& subject) { return expansion(subject, axis); }});
  checks.push_back(
      {"actuation/bimorph",
       "beams of 2, 4 and 6 cells whose lower half stretches by ε along them: curvature over κ = 3ε/2h tends "
       "to 1",
       "1 ± 0.02", true, false, bimorph});
  for (const IntegratorRow& row : integrator_table) {
    const Integrator integrator = row.integrator;
    const int order = row.order;
    checks.push_back(
        {fmt::format("actuation/order/{}", name_of(integrator)),
         fmt::format("rest lengths that follow a sine: halving h divides the error of {} by 2^{}",
                     name_of(integrator), order),
         fmt::format("{} ± 0.05", order), true, false, [=](const Subject& subject) -> Result<Finding> {
           ASPIC_TRY(const auto study, study_actuated_order(subject, integrator));
           return Finding{std::abs(study.observed - order) <= 0.05,
                          fmt::format("{:.4f} (finest error {:.2g})", study.observed, study.finest)};
         }});
  }
}

}  // namespace aspic::verify
