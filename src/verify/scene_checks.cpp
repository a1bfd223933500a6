// The built-in scenes: how deep particles get in a step.
#include <fmt/format.h>

#include <algorithm>

#include "aspic/scene.h"
#include "model/terrain.h"
#include "verify/experiments.h"

namespace aspic::verify {
namespace {

double max_speed(const State& state) {
  double fastest = 0.0;
  for (const Vec3& v : state.velocity) fastest = std::max(fastest, length(v));
  return fastest;
}

/// Largest depth without the ground as a share of h·max|v|, and in meters; and whether anything came near.
struct Depth {
  double share = 0.0, meters = 0.0;
  bool contact = false;
};

/// How far a step would go without the ground: the step of the same model without terrain.
Result<Depth> depth_without_ground(const Subject& subject, const Model& model, std::uint64_t steps) {
  Model airborne = model;
  airborne.terrain.clear();
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  ASPIC_TRY(auto unhindered, subject.reference(airborne, Precision::double_));
  State now = initial_state(model, Precision::double_);
  double largest = 0.0;
  for (const Vec3& x : now.position) largest = std::max(largest, length(x));
  for (const Terrain& terrain : model.terrain) largest = std::max(largest, extent(terrain));
  const double rounding = 16 * epsilon_double * largest;
  Depth worst;
  for (std::uint64_t step = 0; step < steps; ++step) {
    ASPIC_TRY(auto before, run(*unhindered, 1, &now));
    const double depth = deepest(model, before);
    worst.contact = worst.contact || depth > -model.contact.distance;
    if (depth > rounding) {
      const double reach = model.simulation.timestep * std::max(max_speed(now), max_speed(before));
      worst.share = std::max(worst.share, (depth - rounding) / reach);
      worst.meters = std::max(worst.meters, depth);
    }
    ASPIC_TRY(now, run(*solver, 1));
  }
  return worst;
}

Result<Finding> depth(const Subject& subject, const std::string& scene, std::vector<std::string> overrides,
                      std::uint64_t steps) {
  ASPIC_TRY(auto loaded, load_scene(scene, overrides));
  ASPIC_TRY(auto model, build_model(loaded.model));
  ASPIC_TRY(auto worst, depth_without_ground(subject, model, steps));
  if (!worst.contact) return Finding{false, "nothing touched the ground"};
  return Finding{worst.share <= 1.0, fmt::format("{:.4f} ({:.3g} mm)", worst.share, 1000 * worst.meters)};
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

}  // namespace

void add_scene_checks(std::vector<Check>& checks) {
  // Scenes without balls: a ball may push a particle further than it flies.
  for (const std::string name :
       {"cube-plane", "cube-tilted-plane", "cube-sphere", "cube-bowl", "large-cube"}) {
    const bool large = name == "large-cube";
    // The same jelly at 10 per edge: 64 per edge would take the reference half an hour.
    std::vector<std::string> overrides;
    if (large) overrides.emplace_back("cube[0].particles-per-edge=10");
    checks.push_back(
        {"depth/" + name,
         fmt::format("depth that a step without the ground would reach, over h·max|v|, 10,000 steps{}",
                     large ? ", 10 per edge" : ""),
         "≤ 1", false, false,
         [=](const Subject& subject) { return depth(subject, name, overrides, 10000); }});
  }
  checks.push_back({"depth/impact", "the same for cube-plane arriving at 50 m/s, h = 0.5 ms, 4,000 steps",
                    "≤ 1", false, false, [](const Subject& subject) {
                      return depth(subject, "cube-plane",
                                   {"cube[0].velocity=[0.0, -50.0, 0.0]", "simulation.timestep=0.0005"},
                                   4000);
                    }});
  std::string names;
  for (const Integrator integrator : explicit_integrators)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", name_of(integrator));
  checks.push_back({"depth/course", "course model, cube-plane after 5 s: depth under " + names,
                    "none: it sinks", false, false, course_depth});
}

}  // namespace aspic::verify
