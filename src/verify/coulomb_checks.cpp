// Coulomb contact against closed forms: restitution, the friction cone under a body, and no adhesion.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "aspic/inputs.h"
#include "model/terrain.h"
#include "verify/experiments.h"
#include "verify/studies.h"

namespace aspic::verify {
namespace {

constexpr double gravity = 9.8;                      // [m/s²]
constexpr double strong = 1.01 * gravity;            // [N/m] of a pull 1 m long on 1 kg
constexpr double pull_bound = 1e-3 * 1e-3 * strong;  // h²·k/m

constexpr int phases = 16;
constexpr double drop_height = 1.0;  // [m], and up to 3 cm more, more than a step's way

/// Sixteen particles that meet the ground at different points of a step. Largest error of the first apex
/// after the bounce against e²·height [m], and, for e = 1, by how much any later one is above the start [m].
struct Apexes {
  double error = 0.0, above = -1.0;
};

Result<Apexes> apexes(const Subject& subject, Integrator integrator, double e) {
  std::vector<Vec3> positions;
  for (int i = 0; i < phases; ++i)
    positions.push_back({static_cast<double>(i), drop_height + 0.03 * i / phases, 0});
  Model model = loose_particles(positions, std::vector<Vec3>(phases));
  model.simulation.integrator = integrator;
  model.simulation.timestep = usual_step(integrator);
  model.simulation.implicit.tolerance = 1e-14;
  model.terrain.push_back(plane_through_origin(model, {0, 1, 0}));
  model.terrain[0].restitution = e;
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  // Past the first apex of all, and with e = 1 some twenty bounces.
  const double fall = std::sqrt(2 * drop_height / gravity);
  const double duration = fall * (e < 1.0 ? 1 + 2.2 * e : 41.0) + 0.05;
  const std::uint64_t steps = steps_of(model, duration);
  std::vector<int> bounces(phases, 0);
  std::vector<double> first(phases, 0.0), later(phases, 0.0);
  State before = initial_state(model, Precision::double_);
  for (std::uint64_t step = 0; step < steps; ++step) {
    ASPIC_TRY(auto now, run(*solver, 1));
    for (std::size_t i = 0; i < phases; ++i) {
      if (before.velocity[i].y < -0.05 && now.velocity[i].y > 0) ++bounces[i];
      if (bounces[i] == 1) first[i] = std::max(first[i], now.position[i].y);
      if (bounces[i] > 0) later[i] = std::max(later[i], now.position[i].y);
    }
    before = std::move(now);
  }
  Apexes result;
  for (std::size_t i = 0; i < phases; ++i) {
    if (bounces[i] == 0) return Error{ErrorCode::check_failed, "a particle never bounced"};
    result.error = std::max(result.error, std::abs(first[i] - e * e * positions[i].y));
    result.above = std::max(result.above, later[i] - positions[i].y);
  }
  return result;
}

Result<Finding> restitution(const Subject& subject, Integrator integrator) {
  const double h = usual_step(integrator), bound = 0.5 * gravity * h * h;
  Finding finding{true, ""};
  double above = -1.0;
  for (const double e : {0.2, 0.5, 0.8, 1.0}) {
    ASPIC_TRY(auto found, apexes(subject, integrator, e));
    finding.passed = finding.passed && found.error <= bound;
    finding.measured += fmt::format("{}{:.2g}", e > 0.2 ? ", " : "", found.error);
    above = std::max(above, found.above);
  }
  finding.measured += fmt::format(" m; highest apex {:+.1g} m from the start", above);
  finding.passed = finding.passed && above <= bound;
  return finding;
}

}  // namespace

Result<Slide> study_slide(const Subject& subject, Integrator integrator, ContactModel contact, double degrees,
                          double friction, double seconds) {
  const double angle = degrees * std::numbers::pi / 180;
  const Vec3 normal = {std::sin(angle), std::cos(angle), 0}, down = {std::cos(angle), -std::sin(angle), 0};
  ModelSettings settings = cube_settings(5, 2.02 * normal);
  settings.cubes[0].rotation = {{0, 0, 1}, -degrees};
  settings.simulation.integrator = integrator;
  settings.simulation.timestep = usual_step(integrator);
  settings.contact.model = contact;
  ASPIC_TRY(auto model, build_model(settings));
  model.terrain.push_back(plane_through_origin(model, normal));
  model.terrain[0].friction = friction;
  const auto mean = [&](const std::vector<Vec3>& values) {
    double sum = 0.0;
    for (const Vec3& value : values) sum += dot(value, down);
    return sum / static_cast<double>(values.size());
  };
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  ASPIC_TRY(auto early, run(*solver, steps_of(model, seconds - 2)));
  ASPIC_TRY(auto end, run(*solver, steps_of(model, 2)));
  return Slide{(mean(end.velocity) - mean(early.velocity)) / 2,
               (mean(end.position) - mean(early.position)) / 2};
}

namespace {

Result<Finding> cone(const Subject& subject, Integrator integrator) {
  double worst = 0.0;
  for (const double degrees : {15.0, 25.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const double expected = gravity * (std::sin(angle) - 0.2 * std::cos(angle));
    ASPIC_TRY(auto found, study_slide(subject, integrator, ContactModel::coulomb, degrees, 0.2, 3.0));
    worst = std::max(worst, std::abs(found.acceleration / expected - 1));
  }
  ASPIC_TRY(auto stuck, study_slide(subject, integrator, ContactModel::coulomb, 15.0, 0.3, 12.0));
  return Finding{worst <= 1e-5 && std::abs(stuck.creep) <= 1e-6,
                 fmt::format("{:.2g}, creep {:.2g} m/s", worst, stuck.creep)};
}

/// A particle at rest is pulled up by a hand. It flies as it would without ground, or stays where it is. What
/// rests rises no faster than its velocity at a step's end, which takes off what a method's position is ahead
/// of it: under the one-pass method h²·k/m of the way, its own order of error.
Result<Finding> no_adhesion(const Subject& subject) {
  double lag = 0.0, held = 0.0;
  for (const Integrator integrator : all_integrators) {
    Model model = loose_particles({{0, 0, 0}}, {{0, 0, 0}});
    model.simulation.integrator = integrator;
    model.simulation.implicit.tolerance = 1e-15;
    const Model airborne = model;
    model.terrain.push_back(plane_through_origin(model, {0, 1, 0}));
    const auto pulled = [&](const Model& of, double force) -> Result<State> {
      ASPIC_TRY(auto solver, subject.reference(of, Precision::double_));
      if (!of.terrain.empty()) ASPIC_CHECK(require_good(solver->advance(100)));
      Pull pull;
      pull.stiffness = force;  // the anchor is 1 m above
      pull.anchor = {0, 1, 0};
      ASPIC_CHECK(solver->set_inputs(inputs_of(pull)));
      return run(*solver, 200);
    };
    ASPIC_TRY(auto free, pulled(airborne, strong));
    ASPIC_TRY(auto lifted, pulled(model, strong));
    ASPIC_TRY(auto weak, pulled(model, 0.99 * gravity));
    lag = std::max({lag, length(lifted.position[0] - free.position[0]) / length(free.position[0]),
                    length(lifted.velocity[0] - free.velocity[0]) / length(free.velocity[0])});
    held = std::max({held, length(weak.position[0]), length(weak.velocity[0])});
  }
  return Finding{lag <= pull_bound && held <= 1e-12,
                 fmt::format("{:.2g} of the way, {:.2g} m from rest", lag, held)};
}

}  // namespace

void add_coulomb_checks(std::vector<Check>& checks) {
  for (const Integrator integrator : all_integrators) {
    checks.push_back(
        {fmt::format("contact/restitution/{}", name_of(integrator)),
         "16 phases of a drop from 1 m: first apex − e²·height for e = 0.2, 0.5, 0.8, 1; twenty "
         "bounces at e = 1 never higher than the start",
         at_most_text(0.5 * gravity * usual_step(integrator) * usual_step(integrator), "m = ½gh²"), true,
         false, [=](const Subject& subject) { return restitution(subject, integrator); }});
  }
  add_for_each_integrator(
      checks, "contact/cone",
      "5³ cube on 15° and 25°, μ = 0.2: acceleration over g(sin θ − μ cos θ), less 1; μ = "
      "0.3 on 15° holds: creep from 10 to 12 s",
      "≤ 1e-05, 1e-06 m/s", false, cone);
  checks.push_back({"contact/pull",
                    "a hand with 1.01 of its weight lifts a particle off the ground as off nothing, with "
                    "0.99 not at all; every integrator",
                    fmt::format("≤ {:.3g}, 1e-12 m", pull_bound), true, false, no_adhesion});
}

}  // namespace aspic::verify
