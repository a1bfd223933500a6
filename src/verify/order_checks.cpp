// Order of convergence on a smooth free spring system.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "verify/experiments.h"
#include "verify/studies.h"
#include "verify/textbook.h"

namespace aspic::verify {
namespace {

constexpr double duration = 0.4, first_step = 0.004;
constexpr int halvings = 6;

constexpr double pulse_amplitude = 0.1, pulse_frequency = 2.0;

/// A 2³ cube of edge 1 m, k = 20 N/m, c = 0.2 N·s/m, deformed and moving, far from any singular length.
ModelSettings smooth_system(Integrator integrator, double h) {
  ModelSettings settings = cube_settings(2, {0.0, 0.0, 0.0});
  settings.simulation.integrator = integrator;
  settings.simulation.timestep = h;
  settings.simulation.gravity = {0.0, 0.0, 0.0};
  // Far below the error of any step here: the solve takes no part in the order.
  settings.simulation.implicit = {50, 500, 1e-15};
  CubeSettings& cube = settings.cubes[0];
  cube.edge_length = 1.0;
  cube.structural = cube.shear = cube.bending = {20.0, 0.2};
  return settings;
}

long double pulse(long double time) {
  return 1.0L + pulse_amplitude * std::sin(2.0L * std::numbers::pi_v<long double> * pulse_frequency * time);
}

Result<OrderStudy> studied(const Subject& subject, Integrator integrator, bool actuated) {
  OrderStudy study;
  Motion<long double> truth;
  for (int halving = 0; halving <= halvings; ++halving) {
    const double h = first_step / (1 << halving);
    ModelSettings settings = smooth_system(integrator, h);
    ASPIC_TRY(const auto passive, build_model(settings));
    if (actuated) {
      settings.actuators.emplace_back();
      settings.actuators[0].amplitude = pulse_amplitude;
      settings.actuators[0].frequency = pulse_frequency;
    }
    ASPIC_TRY(auto model, build_model(settings));
    const State start = shaken(model, 0.08, 0.3, 11);
    // hω of the truth is 2e-3 at most: its error, of fourth order, is below 1e-14.
    if (halving == 0)
      truth = actuated ? exact_motion(passive, start, duration, 4000, pulse)
                       : exact_motion(model, start, duration, 4000);
    ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, steps_of(model, duration), &start));
    const Motion<long double> reached = motion_of<long double>(end);
    const double error = static_cast<double>(
        std::sqrt((reached.x - truth.x).squaredNorm() + (reached.v - truth.v).squaredNorm()));
    if (halving > 0 && error > 1e-12) {
      study.observed = std::log2(study.error.back() / error);
      study.finest = error;
    }
    study.step.push_back(h);
    study.error.push_back(error);
  }
  return study;
}

}  // namespace

Result<OrderStudy> study_order(const Subject& subject, Integrator integrator) {
  return studied(subject, integrator, false);
}

Result<OrderStudy> study_actuated_order(const Subject& subject, Integrator integrator) {
  return studied(subject, integrator, true);
}

void add_order_checks(std::vector<Check>& checks) {
  for (const IntegratorRow& row : integrator_table) {
    const Integrator integrator = row.integrator;
    const int order = row.order;
    checks.push_back(
        {fmt::format("order/{}", name_of(integrator)),
         fmt::format("halving h divides the error of {} by 2^{}", name_of(integrator), order),
         fmt::format("{} ± 0.05", order), true, false, [=](const Subject& subject) -> Result<Finding> {
           ASPIC_TRY(const auto study, study_order(subject, integrator));
           return Finding{std::abs(study.observed - order) <= 0.05,
                          fmt::format("{:.4f} (finest error {:.2g})", study.observed, study.finest)};
         }});
  }
}

}  // namespace aspic::verify
