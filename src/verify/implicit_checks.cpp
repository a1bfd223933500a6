// Implicit Euler: the equation is solved, and the method does what backward Euler does.
#include <fmt/format.h>

#include <algorithm>

#include "analysis/stability.h"
#include "aspic/analysis.h"
#include "aspic/scene.h"
#include "model/implicit.h"
#include "verify/experiments.h"
#include "verify/textbook.h"

namespace aspic::verify {
namespace {

Result<Finding> bounded(const Subject& subject) {
  ModelSettings settings = cube_settings(5);
  settings.simulation.gravity = {0, 0, 0};
  ASPIC_TRY(auto explicit_model, build_model(settings));
  const auto limit = stability_limit(explicit_model, Integrator::explicit_euler).step;
  if (!limit) return Error{ErrorCode::check_failed, "explicit Euler has no limit here"};
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 1000 * *limit;
  ASPIC_TRY(auto model, build_model(settings));
  State state = initial_state(model, Precision::double_);
  Noise noise(23);
  for (Vec3& x : state.position) x = x + 0.01 * noise.vector();  // 1 % of the spacing of 1 m
  const double energy = measure(model, state).total();
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  ASPIC_CHECK(solver->load(state));
  double worst = 0.0;
  for (int step = 0; step < 100; ++step) {
    ASPIC_TRY(auto now, run(*solver, 1));
    worst = std::max(worst, measure(model, now).total() / energy);
  }
  return Finding{worst <= 1.0, fmt::format("{:.3g} of the start's energy", worst)};
}

/// Worst residual of a scene run to its end; `must_converge`: in every step.
Result<Finding> solved_scene(const Subject& subject, const std::string& scene, ContactModel contact, double h,
                             bool must_converge) {
  ASPIC_TRY(auto loaded, load_scene(scene));
  loaded.model.simulation.integrator = Integrator::implicit_euler;
  loaded.model.simulation.timestep = h;
  loaded.model.contact.model = contact;
  ASPIC_TRY(auto model, build_model(loaded.model));
  ASPIC_TRY(auto solver, subject.reference(model, Precision::single));
  ASPIC_CHECK(require_good(solver->advance(steps_of(model, model.simulation.duration))));
  const auto solves = solver->solve_statistics();
  if (!solves) return Error{ErrorCode::check_failed, "the solver keeps no statistics"};
  const double tolerance = implicit_tolerance(model.simulation.implicit, Precision::single);
  return Finding{solves->steps > 0 && (!must_converge || solves->worst_residual <= tolerance),
                 fmt::format("{:.3g} m/s, {} of {} steps unconverged", solves->worst_residual,
                             solves->steps - solves->converged, solves->steps)};
}

Result<Finding> dense(const Subject& subject) {
  ModelSettings settings = cube_settings(4);
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 1.0 / 60;
  ASPIC_TRY(auto model, build_model(settings));
  double worst = 0.0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const State state = shaken(model, 0.05, 1.0, seed);
    const Eigen::VectorXd expected = dense_backward_euler(model, state);
    ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 1, &state));
    worst = std::max(worst, (motion_of<double>(end).v - expected).cwiseAbs().maxCoeff());
  }
  return at_most(worst, 1e-8, "m/s");
}

}  // namespace

void add_implicit_checks(std::vector<Check>& checks) {
  checks.push_back({"implicit/bounded",
                    "free 5³ cube, 1 % perturbed, at 1,000 times explicit Euler's limit, 100 steps: energy "
                    "never above the start's",
                    "≤ 1", true, false, bounded});
  checks.push_back({"implicit/dense",
                    "one step equals a dense Newton solve in double precision (shaken 4³ cube, h = 1/60 s)",
                    at_most_text(1e-8, "m/s"), true, false, dense});
  const auto add = [&](const std::string& name, const char* claim, const std::string& bound,
                       ContactModel contact, double h, bool must_converge) {
    for (const std::string scene : {"cube-plane", "cube-tilted-plane", "cube-sphere", "cube-bowl"}) {
      checks.push_back({fmt::format("implicit/{}/{}", name, scene), claim, bound, false, false,
                        [=](const Subject& s) { return solved_scene(s, scene, contact, h, must_converge); }});
    }
  };
  const std::string tolerance = at_most_text(1e-4, "m/s");
  add("residual/course", "course model, h = 1/60 s: residual in every step", tolerance, ContactModel::course,
      1.0 / 60, true);
  add("residual/coulomb", "Coulomb model, h = 2 ms: residual in every step", tolerance, ContactModel::coulomb,
      0.002, true);
  add("large-step", "Coulomb model, h = 1/60 s: never diverges; unconverged steps counted", "no divergence",
      ContactModel::coulomb, 1.0 / 60, false);
}

}  // namespace aspic::verify
