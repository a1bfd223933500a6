// Contact between bodies over many seconds: rest, stacks and where they buckle, sticking and sliding.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "aspic/analysis.h"
#include "verify/contact_bodies.h"

namespace aspic::verify {
namespace {

constexpr double s = contact_spacing;
constexpr double rest_double = 1e-5, rest_single = 2e-4;  // [m/s]

ModelSettings bodies(Integrator integrator) {
  ModelSettings settings;
  settings.contact.bodies = true;
  settings.simulation.integrator = integrator;
  return settings;
}

/// Cubes of n³ above each other, dropped by a fifth of a spacing; the lowest is held by its lowest layer, or
/// lands on a plane.
ModelSettings stack(int n, int count, bool pinned, Integrator integrator) {
  ModelSettings settings = bodies(integrator);
  for (int i = 0; i < count; ++i)
    settings.cubes.push_back(box_at({n, n, n}, {0, ((n - 1) * 0.5 + i * (n - 0.8)) * s, 0}));
  if (pinned)
    settings.cubes[0].pinned.names = {"bottom"};
  else
    settings.terrain.push_back({.geometry = {{"point", Vec3{0, -0.1 * s, 0}}}});
  return settings;
}

Vec3 center(const Model& model, const State& state, std::size_t body) {
  return mean_of(state.position, model.bodies[body]);
}

/// After nine and ten seconds.
struct Rested {
  State end;
  double drift = 0.0;  ///< of the upper cube in the last of them [m]
};
Result<Rested> rested(const Subject& subject, const Model& model, Precision precision) {
  ASPIC_TRY(auto solver, subject.reference(model, precision));
  ASPIC_TRY(const State nine, run(*solver, steps_of(model, 9.0)));
  ASPIC_TRY(const State ten, run(*solver, steps_of(model, 1.0)));
  return Rested{ten, length(center(model, ten, 1) - center(model, nine, 1))};
}

Result<Finding> rests(const Subject& subject, Integrator integrator) {
  ASPIC_TRY(auto model, build_model(stack(4, 2, true, integrator)));
  ASPIC_TRY(auto usual, build_model(stack(4, 2, true, Integrator::symplectic_euler)));
  ASPIC_TRY(auto single, rested(subject, model, Precision::single));
  ASPIC_TRY(auto fine, rested(subject, model, Precision::double_));
  ASPIC_TRY(auto other, rested(subject, usual, Precision::double_));
  const double v_single = measure(model, single.end).max_speed, v_double = measure(model, fine.end).max_speed;
  const ContactSample at = sample_contacts(model, fine.end), as = sample_contacts(usual, other.end);
  const double off = std::max(std::abs(at.least - as.least), std::abs(at.greatest - as.greatest));
  return Finding{v_single <= rest_single && v_double <= rest_double && fine.drift < 1e-6 &&
                     at.least >= 0.09 && at.greatest <= 0.10 && off <= 1e-4,
                 fmt::format("{:.2g} and {:.2g} m/s, {:.2g} m, {:.4f} … {:.4f} s, {:.1g} s off", v_single,
                             v_double, fine.drift, at.least, at.greatest, off)};
}

Result<Finding> stands(const Subject& subject, int count, bool pinned) {
  ASPIC_TRY(auto model, build_model(stack(3, count, pinned, Integrator::symplectic_euler)));
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, steps_of(model, 12.0)));
  const double speed = measure(model, end).max_speed;
  double lateral = 0.0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Vec3 at = center(model, end, b);
    lateral = std::max({lateral, std::abs(at.x), std::abs(at.z)});
  }
  return Finding{speed <= rest_double && lateral <= 2e-5,
                 fmt::format("{:.2g} m/s, {:.2g} m aside", speed, lateral)};
}

/// Six 3³ cubes are too high a tower: rounding starts a lean, which grows as the softest mode of the settled
/// state says.
Result<Finding> buckles(const Subject& subject) {
  ASPIC_TRY(auto model, build_model(stack(3, 6, true, Integrator::symplectic_euler)));
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  const auto lean = [&](const State& state) {
    const Vec3 at = center(model, state, 5);
    return std::hypot(at.x, at.z);
  };
  ASPIC_TRY(auto early, run(*solver, steps_of(model, 8.0)));
  ASPIC_TRY(auto late, run(*solver, steps_of(model, 4.0)));
  const double rate = std::log(lean(late) / lean(early)) / 4.0;
  return Finding{std::abs(rate - 0.945) <= 0.05, fmt::format("{:.3f} 1/s", rate)};
}

/// A 4³ cube on a pinned slab, gravity leaning by a share of the friction angle.
ModelSettings leaning(double share, Integrator integrator) {
  constexpr double mu = 0.5;
  ModelSettings settings = bodies(integrator);
  settings.contact.body_friction = mu;
  CubeSettings slab = box_at({14, 3, 8}, {});
  for (int i = 0; i < 14 * 3 * 8; ++i) slab.pinned.indices.push_back(i);
  settings.cubes = {slab, box_at({4, 4, 4}, {-3.75 * s, 2.6 * s, 0.25 * s})};
  const double angle = std::atan(share * mu);
  settings.simulation.gravity = {9.8 * std::sin(angle), -9.8 * std::cos(angle), 0.0};
  return settings;
}

Result<Finding> sticks(const Subject& subject, Integrator integrator) {
  ASPIC_TRY(auto model, build_model(leaning(0.9, integrator)));
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  std::array<double, 3> x = {};
  for (std::size_t n = 0; const double seconds : {1.0, 6.0, 1.0}) {
    ASPIC_TRY(auto at, run(*solver, steps_of(model, seconds)));
    x[n++] = center(model, at, 1).x;
  }
  const double crept = std::abs(x[2] - x[0]), last = std::abs(x[2] - x[1]);
  return Finding{crept <= 1e-4 && last <= 2e-6, fmt::format("{:.2g} and {:.2g} m", crept, last)};
}

Result<Finding> slides_in(const Subject& subject, const ModelSettings& settings) {
  ASPIC_TRY(auto model, build_model(settings));
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  std::array<double, 2> speed = {};
  for (std::size_t n = 0; const double seconds : {0.4, 0.6}) {
    ASPIC_TRY(auto at, run(*solver, steps_of(model, seconds)));
    for (std::uint32_t i = 0; i < 64; ++i) speed[n] += at.velocity[model.bodies[1].first_particle + i].x / 64;
    ++n;
  }
  const double angle = std::atan(0.55), coulomb = 9.8 * (std::sin(angle) - 0.5 * std::cos(angle));
  return at_most(std::abs((speed[1] - speed[0]) / 0.6 / coulomb - 1.0), 0.01);
}

Result<Finding> slides(const Subject& subject, Integrator integrator) {
  return slides_in(subject, leaning(1.1, integrator));
}

/// Steps of implicit Euler, 60 a second.
ModelSettings solved(ModelSettings settings) {
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 1.0 / 60.0;
  return settings;
}

std::uint64_t unsolved(Solver& solver) {
  const SolveStatistics statistics = *solver.solve_statistics();
  return statistics.steps - statistics.converged;
}

Result<Finding> sticks_solved(const Subject& subject) {
  ASPIC_TRY(auto model, build_model(solved(leaning(0.9, Integrator::implicit_euler))));
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  const double start = measure(model, initial_state(model, Precision::double_)).total();
  std::array<double, 2> x = {};
  double gained = 0.0;
  for (std::size_t n = 0; const double seconds : {5.0, 1.0}) {
    ASPIC_TRY(auto at, run(*solver, steps_of(model, seconds)));
    gained = std::max(gained, measure(model, at).total() - start);
    x[n++] = center(model, at, 1).x;
  }
  const double crept = std::abs(x[1] - x[0]);
  return Finding{crept <= 5e-6 && gained <= 0.0 && unsolved(*solver) == 0,
                 fmt::format("{:.2g} m, {:.2g} J, {} steps", crept, gained, unsolved(*solver))};
}

Result<Finding> slides_solved(const Subject& subject) {
  return slides_in(subject, solved(leaning(1.1, Integrator::implicit_euler)));
}

template <class Run>
void add_for_explicit(std::vector<Check>& checks, const std::string& name, const std::string& claim,
                      const std::string& bound, Run run) {
  for (const Integrator integrator : explicit_integrators) {
    checks.push_back({fmt::format("{}/{}", name, name_of(integrator)), claim, bound, false, false,
                      [=](const Subject& subject) { return run(subject, integrator); }});
  }
}

}  // namespace

void add_body_contact_checks(std::vector<Check>& checks) {
  add_for_explicit(
      checks, "bodies/rest",
      "a 4³ cube dropped on another, 10 s later: fastest particle in single and double precision, drift in "
      "the "
      "last second, distances of contacts, those under symplectic Euler",
      fmt::format("≤ {:.0g} and {:.0g} m/s, 1e-06 m, 0.09 … 0.10 s, 1e-04 s", rest_single, rest_double),
      rests);
  for (const int count : {4, 5}) {
    for (const bool pinned : {true, false}) {
      checks.push_back(
          {fmt::format("bodies/stack/{}-{}", count, pinned ? "held" : "on-a-plane"),
           fmt::format("{} cubes of 3³ on each other, 12 s later: fastest particle, and how far aside",
                       count),
           fmt::format("≤ {:.0g} m/s, 2e-05 m", rest_double), false, false,
           [=](const Subject& subject) { return stands(subject, count, pinned); }});
    }
  }
  checks.push_back({"bodies/buckling",
                    "six of them, too high a tower: how fast its lean grows from 8 s to 12 s",
                    "0.945 ± 0.05 1/s", false, false, buckles});
  add_for_explicit(
      checks, "bodies/stick",
      "a 4³ cube on a slope of 0.9 of the friction angle: creep from 1 s to 8 s, and in the last second",
      "≤ 1e-04 and 2e-06 m", sticks);
  add_for_explicit(checks, "bodies/slide", "the same at 1.1: error of the acceleration, relative",
                   at_most_text(0.01, ""), slides);
  checks.push_back({"bodies/stick/implicit-euler",
                    "a 4³ cube on a slope of 0.9 of the friction angle, h = 1/60 s: creep in the sixth "
                    "second, energy gained, "
                    "steps left unsolved",
                    "≤ 5e-06 m, none, none", false, false, sticks_solved});
  checks.push_back({"bodies/slide/implicit-euler", "the same at 1.1: error of the acceleration, relative",
                    at_most_text(0.01, ""), false, false, slides_solved});
}

}  // namespace aspic::verify
