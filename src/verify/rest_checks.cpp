// Coming to rest under Coulomb contact, and what the total energy does on the way.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "analysis/stability.h"
#include "aspic/analysis.h"
#include "model/terrain.h"
#include "verify/experiments.h"

namespace aspic::verify {
namespace {

constexpr double bound_single = 1e-3, bound_double = 1e-6;  // [m/s]
constexpr double bottom_bound = 1e-5;                       // [m]

Result<Model> dropped_cube(int particles_per_edge, const Vec3& center, Integrator integrator,
                           double angle = 0.0) {
  ModelSettings settings = cube_settings(particles_per_edge, center);
  settings.cubes[0].rotation = {{1.0, 0.0, 1.0}, angle};
  settings.terrain.push_back({});
  settings.simulation.integrator = integrator;
  settings.simulation.timestep = usual_step(integrator);
  return build_model(settings);
}

Result<Finding> comes_to_rest(const Subject& subject, Integrator integrator) {
  ASPIC_TRY(auto model, dropped_cube(10, {0, 9, 0}, integrator));
  const std::uint64_t steps = steps_of(model, 10.0);
  ASPIC_TRY(auto single, run_reference(subject, model, Precision::single, steps));
  ASPIC_TRY(auto fine, run_reference(subject, model, Precision::double_, steps));
  const double v_single = measure(model, single).max_speed, v_double = measure(model, fine).max_speed;
  return Finding{v_single <= bound_single && v_double <= bound_double,
                 fmt::format("{:.2g} and {:.2g} m/s at h = {:.3g} ms", v_single, v_double,
                             1e3 * model.simulation.timestep)};
}

/// Turned by 30°, the cube lands on an edge and then rocks to and fro on another: most of its bottom layer
/// rises and comes down again and again, which a rule of contact has to end.
Result<Finding> rocks_to_rest(const Subject& subject, Integrator integrator) {
  ASPIC_TRY(auto model, dropped_cube(10, {0, 4, 0}, integrator, 30.0));
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, steps_of(model, 12.0)));
  return at_most(measure(model, end).max_speed, bound_single, "m/s");
}

/// Largest distance from the ground [m] in the layer of particles that began lowest.
double bottom_layer(const Model& model, const State& end) {
  double lowest = std::numeric_limits<double>::infinity(), worst = 0.0;
  for (const Vec3& x : model.initial_position) lowest = std::min(lowest, x.y);
  for (std::size_t i = 0; i < end.position.size(); ++i) {
    if (model.initial_position[i].y > lowest + 1e-6) continue;
    worst = std::max(worst, std::abs(signed_distance(model.terrain[0], end.position[i])));
  }
  return worst;
}

Result<Finding> bottom(const Subject& subject) {
  double worst = 0.0;
  for (const Integrator integrator : all_integrators) {
    for (const Precision precision : {Precision::single, Precision::double_}) {
      ASPIC_TRY(auto model, dropped_cube(5, {0, 2, 0}, integrator));
      ASPIC_TRY(auto end, run_reference(subject, model, precision, steps_of(model, 4.0)));
      worst = std::max(worst, bottom_layer(model, end));
    }
  }
  return at_most(worst, bottom_bound, "m");
}

/// Planes through a point.
struct Planes {
  Vec3 point;
  std::vector<Vec3> normals;
  double friction;
};
const Planes groove = {{0, 0, 0}, {{1.0, 1.0, 0.0}, {-1.0, 1.2, 0.0}}, 0.3};
const Planes corner = {{3, 0, 3}, {{0.3, 1.0, 0.2}, {-1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}}, 0.1};

Result<Finding> rests_between(const Subject& subject, Integrator integrator, const Planes& planes) {
  ModelSettings settings = cube_settings(4, {0.1, 4.5, 0.05});
  settings.cubes[0].rotation = {{1.0, 0.3, 0.2}, 20.0};
  for (const Vec3& normal : planes.normals) {
    TerrainSettings plane;
    plane.geometry["point"] = planes.point;
    plane.geometry["normal"] = normal;
    plane.friction = planes.friction;
    settings.terrain.push_back(plane);
  }
  settings.simulation.integrator = integrator;
  settings.simulation.timestep = usual_step(integrator);
  ASPIC_TRY(auto model, build_model(settings));
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, steps_of(model, 30.0)));
  const double speed = measure(model, end).max_speed, depth = std::max(0.0, deepest(model, end));
  return Finding{speed <= bound_double && depth <= bottom_bound,
                 fmt::format("{:.2g} m/s, {:.2g} m deep", speed, depth)};
}

/// How the total energy [J] goes from the first contact on, in double precision.
struct Rise {
  double above_least = 0.0;    ///< largest rise above the least so far
  double start = 0.0;          ///< at the first contact
  std::uint64_t airborne = 0;  ///< steps that began and ended without contact
};

Result<Rise> energy_rise(const Subject& subject, const Model& model, double duration) {
  const auto in_contact = [&](const State& state) {
    return std::any_of(state.position.begin(), state.position.end(), [&](const Vec3& x) {
      return signed_distance(model.terrain[0], x) < model.contact.distance;
    });
  };
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  Rise rise;
  bool had_contact = false, contact = false;
  double least = 0.0;
  for (std::uint64_t step = 0; step < steps_of(model, duration); ++step) {
    ASPIC_TRY(auto now, run(*solver, 1));
    const double energy = measure(model, now).total();
    const bool was_contact = std::exchange(contact, in_contact(now));
    if (!had_contact && contact) {
      had_contact = true;
      least = rise.start = energy;
    }
    if (had_contact && !was_contact && !contact) ++rise.airborne;
    if (had_contact) rise.above_least = std::max(rise.above_least, energy - least);
    least = std::min(least, energy);
  }
  if (!had_contact) return Error{ErrorCode::check_failed, "nothing touched the ground"};
  return rise;
}

/// What a method gains in free fall [mg²h² a particle and step]: x' = x + h·v + lead·h²·g and v' = v + h·g
/// take m·(g·h·v + lead·g²h²) from the height and give m·(g·h·v + ½g²h²) to the motion.
double free_fall_gain(Integrator integrator) {
  return std::max(0.0, 0.5 - free_fall_lead(integrator));
}

/// What a method may add to the energy [J]: sums of 13,000 terms in double precision, and its own gain in
/// free fall.
double allowed(const Model& model, const Rise& rise) {
  double mass = 0.0;
  for (const double m : model.mass) mass += m;
  const double gh = length(model.simulation.gravity) * model.simulation.timestep;
  return 4096 * epsilon_double * rise.start +
         free_fall_gain(model.simulation.integrator) * mass * gh * gh * static_cast<double>(rise.airborne);
}

/// The default cube and one turned by 30°, which arrives edge first. Springs that an impact has turned and
/// shortened have less than the largest stable step of the cube at rest: a method whose usual step is within
/// 0.95 of that runs the turned cube at 0.9 of its usual step, and what it gains without is printed.
Result<Finding> gains_nothing(const Subject& subject, Integrator integrator) {
  Finding finding{true, ""};
  const auto drop = [&](double height, double angle, double timestep, bool bounded) -> Status {
    ASPIC_TRY(auto model, dropped_cube(10, {0, height, 0}, integrator, angle));
    model.simulation.timestep = timestep;
    ASPIC_TRY(const auto rise, energy_rise(subject, model, 5.0));
    const double most = allowed(model, rise);
    finding.passed = finding.passed && (!bounded || rise.above_least <= most);
    finding.measured += fmt::format("{}{:.3g}", finding.measured.empty() ? "" : ", ", rise.above_least);
    if (free_fall_gain(integrator) > 0.0) finding.measured += fmt::format(" of {:.3g}", most);
    return {};
  };
  const double h = usual_step(integrator);
  ASPIC_TRY(auto at_rest, dropped_cube(10, {0, 4, 0}, integrator));
  const StabilityLimit limit = stability_limit(at_rest, integrator);
  if (!limit.step) return Error{ErrorCode::check_failed, "no stable step was found"};
  const bool near_limit = h > 0.95 * *limit.step;
  ASPIC_CHECK(drop(9, 0, h, true));
  ASPIC_CHECK(drop(4, 30, near_limit ? 0.9 * h : h, true));
  finding.measured += " J";
  if (near_limit) {
    finding.measured += "; turned at 1 ms";
    ASPIC_CHECK(drop(4, 30, h, false));
    finding.measured += " J";
  }
  return finding;
}

/// A tilted 5³ cube dropped on a shape: from its first contact on, the energy never rises.
Result<Finding> gains_nothing_on(const Subject& subject, TerrainShape shape) {
  ModelSettings settings = cube_on_terrain(5, shape, Integrator::symplectic_euler, ContactModel::coulomb);
  ASPIC_TRY(auto model, build_model(settings));
  ASPIC_TRY(auto rise, energy_rise(subject, model, 4.0));
  return at_most(rise.above_least, allowed(model, rise), "J");
}

}  // namespace

void add_rest_checks(std::vector<Check>& checks) {
  for (const Integrator integrator : all_integrators) {
    checks.push_back({fmt::format("rest/{}", name_of(integrator)),
                      "the default cube, dropped on the plane (Coulomb), 10 s later: fastest particle in "
                      "single and double precision",
                      fmt::format("≤ {:.0g} and {:.0g} m/s", bound_single, bound_double),
                      integrator == Integrator::symplectic_euler, false,
                      [=](const Subject& subject) { return comes_to_rest(subject, integrator); }});
  }
  add_for_each_integrator(
      checks, "rest/turned",
      "the cube turned by 30° and dropped, 12 s later, double precision: fastest particle",
      at_most_text(bound_single, "m/s"), false, rocks_to_rest);
  checks.push_back(
      {"rest/bottom",
       "bottom layer of a 5³ cube at rest: distance from the ground; every integrator, both precisions",
       at_most_text(bottom_bound, "m"), false, false, bottom});
  for (const auto& [name, claim, planes] :
       {std::tuple{"groove", "a turned 4³ cube, dropped into a groove, 30 s later: fastest particle, depth",
                   &groove},
        std::tuple{"corner", "the same on a slippery slope down into the corner of two walls", &corner}}) {
    add_for_each_integrator(checks, fmt::format("rest/{}", name), claim,
                            fmt::format("≤ {:.0g} m/s, {:.0g} m", bound_double, bottom_bound), false,
                            [in = planes](const Subject& subject, Integrator integrator) {
                              return rests_between(subject, integrator, *in);
                            });
  }
  for (const TerrainShapeRow& shape : terrain_shapes) {
    checks.push_back(
        {fmt::format("energy/on/{}", shape.name),
         fmt::format("the same of a tilted 5³ cube, dropped on a {}, 4 s, symplectic Euler", shape.title),
         "≤ 4096 ε of the energy", true, false,
         [=, value = shape.value](const Subject& subject) { return gains_nothing_on(subject, value); }});
  }
  for (const Integrator integrator : all_integrators) {
    checks.push_back(
        {fmt::format("energy/{}", name_of(integrator)),
         "from the first contact on the total energy never rises: default cube, cube turned by 30°",
         free_fall_gain(integrator) > 0.0 ? "≤ ½Mg²h² a step of flight" : "≤ 4096 ε of the energy", false,
         false, [=](const Subject& subject) { return gains_nothing(subject, integrator); }});
  }
}

}  // namespace aspic::verify
