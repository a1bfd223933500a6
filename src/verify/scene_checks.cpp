// The built-in scenes: how deep particles get, and whether the default cube comes to rest.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/terrain.h"
#include "scene/load.h"
#include "verify/experiments.h"

namespace aspic::verify {
namespace {

constexpr double resting_bound = 0.02;

double max_speed(const State& state) {
  double fastest = 0.0;
  for (const Vec3& v : state.velocity) fastest = std::max(fastest, length(v));
  return fastest;
}

double deepest(const Model& model, const State& state) {
  double depth = -std::numeric_limits<double>::infinity();
  for (const Terrain& terrain : model.terrain) {
    for (const Vec3& x : state.position) depth = std::max(depth, -signed_distance(terrain, x));
  }
  return depth;
}

/// Largest depth before the projection as a share of h·max|v|, and in metres; and whether anything came near.
struct Depth {
  double share = 0.0, metres = 0.0;
  bool touched = false;
};

/// In the Coulomb model the ground acts at the end of a step alone: what a step was before that is the step
/// of the same model without terrain.
Result<Depth> depth_before_projection(const Subject& subject, const Model& model, std::uint64_t steps) {
  Model airborne = model;
  airborne.terrain.clear();
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  ASPIC_TRY(auto unhindered, subject.reference(airborne, Precision::double_));
  State now = initial_state(model, Precision::double_);
  double extent = 0.0;
  for (const Vec3& x : now.position) extent = std::max(extent, length(x));
  for (const Terrain& terrain : model.terrain)
    extent = std::max(extent, length(terrain.point) + terrain.radius);
  const double rounding = 16 * epsilon_double * extent;
  Depth worst;
  for (std::uint64_t step = 0; step < steps; ++step) {
    ASPIC_TRY(auto before, run(*unhindered, 1, &now));
    const double depth = deepest(model, before);
    worst.touched = worst.touched || depth > -model.contact.epsilon;
    if (depth > rounding) {
      const double reach = model.simulation.timestep * std::max(max_speed(now), max_speed(before));
      worst.share = std::max(worst.share, (depth - rounding) / reach);
      worst.metres = std::max(worst.metres, depth);
    }
    ASPIC_TRY(auto next, run(*solver, 1));
    now = std::move(next);
  }
  return worst;
}

Result<Finding> depth(const Subject& subject, const std::string& scene, std::vector<std::string> overrides,
                      std::uint64_t steps) {
  ASPIC_TRY(auto loaded, load_scene(scene, overrides));
  ASPIC_TRY(auto model, build_model(loaded.model));
  ASPIC_TRY(auto worst, depth_before_projection(subject, model, steps));
  if (!worst.touched) return Finding{false, "nothing touched the ground"};
  return Finding{worst.share <= 1.0, fmt::format("{:.4f} ({:.3g} mm)", worst.share, 1000 * worst.metres)};
}

Result<Finding> course_depth(const Subject& subject) {
  ModelSettings settings = cube_settings(10);
  settings.terrain.push_back({});
  settings.contact.model = ContactModel::course;
  std::string text;
  for (const Integrator integrator : explicit_integrators) {
    settings.simulation.integrator = integrator;
    ASPIC_TRY(auto model, build_model(settings));
    ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 5000));
    text += fmt::format("{}{:.1f}", text.empty() ? "" : ", ", 1000 * std::max(0.0, deepest(model, end)));
  }
  return Finding{true, text + " mm"};
}

/// A fall and ten seconds of rest. The time step of a row is the scene's default of 1 ms unless the method
/// needs another one to rest at all (docs/physics.md, "A limit of the resting threshold"):
/// - explicit Euler: a ground particle that leaves the contact is sped up by h·n·g under a column of n
///   particles, twice before its position follows; it comes to rest if that is no more than ε, so
///   h = ε/(2·n·g) = 0.05 ms;
/// - one-pass: a mode of the dampers is damped by 1 + z + z² a step, z = −h·αc/m, which is 1 at the limit of
///   stability, z = −1, and least at z = −½: half the stable step, 0.5 ms;
/// - implicit Euler: 1/60 s, what it is there for.
struct Rest {
  Integrator integrator;
  double timestep;  ///< [s]
  bool bounded = true;
};
constexpr Rest rests[] = {{Integrator::explicit_euler, 0.05e-3},
                          {Integrator::symplectic_euler, 1e-3},
                          {Integrator::midpoint, 1e-3},
                          {Integrator::runge_kutta_4, 1e-3},
                          {Integrator::implicit_euler_one_pass, 0.5e-3},
                          {Integrator::implicit_euler, 1.0 / 60},
                          {Integrator::explicit_euler, 1e-3, false},
                          {Integrator::implicit_euler_one_pass, 1e-3, false}};

Result<Finding> comes_to_rest(const Subject& subject, const Rest& rest) {
  ModelSettings settings = cube_settings(10);
  settings.terrain.push_back({});
  settings.simulation.integrator = rest.integrator;
  settings.simulation.timestep = rest.timestep;
  ASPIC_TRY(auto model, build_model(settings));
  const auto steps = static_cast<std::uint64_t>(std::lround(10.0 / rest.timestep));
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::single, steps));
  Finding finding = at_most(max_speed(end), resting_bound, "m/s");
  finding.measured += fmt::format(" at h = {:.3g} ms", 1e3 * rest.timestep);
  if (!rest.bounded) finding.passed = true;
  return finding;
}

}  // namespace

void add_scene_checks(std::vector<Check>& checks) {
  for (const Rest& rest : rests) {
    const char* const claim =
        rest.bounded ? "the default cube, dropped on the plane (Coulomb), 10 s later: fastest particle"
                     : "the same at 1 ms, where these two do not come to rest";
    checks.push_back({fmt::format("rest/{}{}", name_of(rest.integrator), rest.bounded ? "" : "-at-1-ms"),
                      claim, rest.bounded ? at_most_text(resting_bound, "m/s") : "none",
                      rest.integrator == Integrator::symplectic_euler, false,
                      [=](const Subject& subject) { return comes_to_rest(subject, rest); }});
  }
  // Scenes without balls: a ball may push a particle further than it flies.
  for (const std::string name :
       {"cube-plane", "cube-tilted-plane", "cube-sphere", "cube-bowl", "large-cube"}) {
    const bool large = name == "large-cube";
    // The same jelly at 10 per edge: 64 per edge would take the reference half an hour.
    std::vector<std::string> overrides;
    if (large) overrides.push_back("cube[0].particles-per-edge=10");
    checks.push_back(
        {"depth/" + name,
         fmt::format("depth before projection over h·max|v|, 10,000 steps{}", large ? ", 10 per edge" : ""),
         "≤ 1", false, false,
         [=](const Subject& subject) { return depth(subject, name, overrides, 10000); }});
  }
  checks.push_back({"depth/impact", "the same for cube-plane arriving at 50 m/s, h = 0.5 ms, 4,000 steps",
                    "≤ 1", false, false, [](const Subject& subject) {
                      return depth(subject, "cube-plane",
                                   {"cube[0].velocity=[0.0, -50.0, 0.0]", "simulation.timestep=0.0005"},
                                   4000);
                    }});
  checks.push_back(
      {"depth/course",
       "course model, cube-plane after 5 s: depth under explicit-euler, symplectic-euler, midpoint, "
       "runge-kutta-4, one-pass",
       "none: it sinks", false, false, course_depth});
}

}  // namespace aspic::verify
