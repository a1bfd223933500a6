// Contact between bodies: impacts and drops, their momentum and energy; two default cubes at rest; a tower.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "aspic/analysis.h"
#include "cpu_reference/body_contact.h"
#include "verify/contact_bodies.h"

namespace aspic::verify {

ContactSample sample_contacts(const Model& model, const State& state) {
  using Contact = reference::BodyContact<double>;
  using Vector = physics::Vector<double>;
  Contact search(model);
  const auto x = physics::field<double>(state.position), v = physics::field<double>(state.velocity);
  const Contact::Particles at = {physics::components(x.data()), physics::components(v.data()), 3};
  ContactSample found;
  if (!search.begin_step(state.step, at) || !search.find(at)) return found;
  const auto velocity = [&](std::uint32_t place) { return Vector(at.velocity(search.particles()[place])); };
  for (const auto& contact : search.contacts()) {
    const Vector r =
        physics::over_carriers<double>(contact, velocity) - physics::over_corners<double>(contact, velocity);
    const double way = model.simulation.timestep * physics::dot3<double>(contact.n, r);
    ++found.count;
    found.least = std::min(found.least, contact.d / contact_spacing);
    found.greatest = std::max(found.greatest, contact.d / contact_spacing);
    found.first_step += 0.5 * contact.k * way * way;
  }
  return found;
}

namespace {

constexpr double side = contact_spacing;       // of a cell [m]
constexpr double speeds[] = {1.0, 5.0, 20.0};  // m/s
enum Placement { head_on, offset, edge_on_face, crossed_edges };
constexpr Placement placements[] = {head_on, offset, edge_on_face, crossed_edges};

/// Two free 4³ cubes that meet at ±v along y.
ModelSettings meeting(Placement how, double v, Integrator integrator) {
  const double edge = 3 * side, across = std::numbers::sqrt2 * edge;
  CubeSettings below = box_at({4, 4, 4}, {}), above = box_at({4, 4, 4}, {0, edge + 0.25 * side, 0});
  below.velocity.y = v;
  above.velocity.y = -v;
  if (how == offset) above.position = {edge / 2, edge + 0.25 * side, edge / 2};
  if (how == edge_on_face) above.position.y = (edge + across) / 2 + 0.25 * side;
  if (how == crossed_edges) above.position.y = across + 0.25 * side;
  if (how == edge_on_face || how == crossed_edges) above.rotation = {{1, 0, 0}, 45};
  if (how == crossed_edges) below.rotation = {{0, 0, 1}, 45};
  ModelSettings settings;
  settings.simulation.integrator = integrator;
  settings.simulation.gravity = {};
  settings.cubes = {below, above};
  return settings;
}

struct Impact {
  double momentum = 0.0;  ///< change, in Σ m·|v|
  double gained = 0.0;    ///< energy above the start where nothing touches, relative
  double restitution = 0.0;
  bool apart = false;  ///< nothing touches at the end
};

Result<Impact> meet(const Subject& subject, Placement how, double v, Integrator integrator,
                    Precision precision) {
  ASPIC_TRY(auto model, build_model(meeting(how, v, integrator)));
  ASPIC_TRY(auto solver, subject.reference(model, precision));
  ASPIC_TRY(const State start, solver->state());
  const Measures before = measure(model, start);
  Impact result;
  State end;
  const auto steps = static_cast<int>((3 * side / v + 0.3) / model.simulation.timestep);
  for (int n = 0; n < steps; n += 20) {
    ASPIC_TRY(end, run(*solver, 20));
    result.apart = sample_contacts(model, end).count == 0;
    if (result.apart)
      result.gained = std::max(result.gained, measure(model, end).total() / before.total() - 1.0);
  }
  result.momentum = length(measure(model, end).momentum - before.momentum) / (model.particle_count() * v);
  result.restitution =
      (mean_of(end.velocity, model.bodies[1]).y - mean_of(end.velocity, model.bodies[0]).y) / (2 * v);
  return result;
}

constexpr double momentum_single = 128 * epsilon_single;

Result<Finding> impacts(const Subject& subject, Integrator integrator) {
  double momentum = 0.0, in_single = 0.0, gained = 0.0, off = 0.0;
  bool apart = true;
  for (const double v : speeds) {
    for (const Placement how : placements) {
      ASPIC_TRY(const Impact fine, meet(subject, how, v, integrator, Precision::double_));
      ASPIC_TRY(const Impact usual, meet(subject, how, v, Integrator::symplectic_euler, Precision::double_));
      momentum = std::max(momentum, fine.momentum);
      gained = std::max(gained, fine.gained);
      off = std::max(off, std::abs(fine.restitution - usual.restitution));
      apart = apart && fine.apart;
    }
    ASPIC_TRY(const Impact single, meet(subject, crossed_edges, v, integrator, Precision::single));
    in_single = std::max(in_single, single.momentum);
  }
  return Finding{
      momentum <= 1e-14 && in_single <= momentum_single && gained <= 1e-12 && off <= 0.03 && apart,
      fmt::format("{:.2g} and {:.2g}, gain {:.2g}, e within {:.2g}", momentum, in_single, gained, off)};
}

/// A 4³ cube that falls on another whose lowest layer is pinned.
ModelSettings drop(Integrator integrator) {
  ModelSettings settings;
  settings.simulation.integrator = integrator;
  settings.cubes = {box_at({4, 4, 4}, {}), box_at({4, 4, 4}, {0, 3.5 * side, 0})};
  settings.cubes[0].pinned.names = {"bottom"};
  return settings;
}

/// Energy never above the start, but for what the first step of a contact brings and, of explicit Euler, its
/// own gain ½m(g·h)² in every step of a fall.
Result<Finding> drops(const Subject& subject, Integrator integrator) {
  ASPIC_TRY(auto model, build_model(drop(integrator)));
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  ASPIC_TRY(const State start, solver->state());
  const double before = measure(model, start).total(), h = model.simulation.timestep;
  const double fall = length(model.simulation.gravity) * h;
  const double own = integrator == Integrator::explicit_euler ? 0.5 * 112.0 * fall * fall : 0.0;
  double most = 0.0, worst = -1e300;
  for (std::uint64_t n = 5; n <= steps_of(model, 2.0); n += 5) {
    ASPIC_TRY(const State at, run(*solver, 5));
    const double over = measure(model, at).total() - before;
    const double allowed = sample_contacts(model, at).first_step + static_cast<double>(n) * own;
    most = std::max(most, over);
    worst = std::max(worst, over - allowed - 4096 * epsilon_double * std::abs(before));
  }
  return Finding{worst <= 0.0, fmt::format("{:.2g} J above the start", most)};
}

/// Two cubes with default values, the upper dropped on the lower, which stands on a plane.
Result<Finding> default_cubes(const Subject& subject, Integrator integrator) {
  ModelSettings settings;
  settings.simulation.integrator = integrator;
  settings.simulation.timestep = usual_step(integrator);
  settings.terrain.push_back({.geometry = {{"point", Vec3{}}}});
  settings.cubes.resize(2);
  settings.cubes[0].position = {0.0, 2.0, 0.0};
  settings.cubes[1].position = {0.0, 6.2, 0.0};
  ASPIC_TRY(auto model, build_model(settings));
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::single, steps_of(model, 10.0)));
  const double speed = measure(model, end).max_speed;
  const ContactSample in_contact = sample_contacts(model, end);
  // At 8 m a velocity below half a unit in the last place per step changes no position, so nothing damps it.
  const double hidden = 0.5 * 8.0 * epsilon_single / settings.simulation.timestep;
  return Finding{speed < std::max(1e-4, hidden) && in_contact.count > 0 && in_contact.least >= 0.09 &&
                     in_contact.greatest <= 0.10,
                 fmt::format("{:.2g} m/s, {:.4f} … {:.4f} s", speed, in_contact.least, in_contact.greatest)};
}

/// Eight cubes of edge 4 m on each other and on a plane, twenty times as stiff as by default, or as by
/// default.
Result<double> lean_of_tower(const Subject& subject, double stiffness) {
  ModelSettings settings;
  settings.simulation.integrator = Integrator::symplectic_euler;
  settings.simulation.timestep = 0.0008;  // stable in contact with either stiffness
  settings.terrain.push_back({.geometry = {{"point", Vec3{}}}});
  for (int i = 0; i < 8; ++i) {
    CubeSettings& cube = settings.cubes.emplace_back();
    cube.particles_per_edge = 5;
    cube.position = {0.0, 2.05 + 4.1 * i, 0.0};
    for (SpringSettings* springs : {&cube.structural, &cube.shear, &cube.bending})
      springs->stiffness = stiffness;
  }
  // A push, as no tower stands quite straight.
  settings.cubes[7].velocity.x = 0.01;
  ASPIC_TRY(auto model, build_model(settings));
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, steps_of(model, 20.0)));
  const Vec3 top = mean_of(end.position, model.bodies[7]);
  return std::hypot(top.x, top.z);
}

Result<Finding> towers(const Subject& subject) {
  ASPIC_TRY(const double stiff, lean_of_tower(subject, 40000.0));
  ASPIC_TRY(const double soft, lean_of_tower(subject, 2000.0));
  return Finding{stiff <= 0.01 && soft > 1.0, fmt::format("{:.2g} m; {:.2g} m", stiff, soft)};
}

}  // namespace

void add_contact_impact_checks(std::vector<Check>& checks) {
  const auto for_explicit = [&](const std::string& name, const std::string& claim, const std::string& bound,
                                auto of) {
    for (const Integrator integrator : explicit_integrators)
      checks.push_back({fmt::format("{}/{}", name, name_of(integrator)), claim, bound, false, false,
                        [=](const Subject& subject) { return of(subject, integrator); }});
  };
  for_explicit(
      "bodies/impact",
      "4³ cubes meet at ±1, 5 and 20 m/s in four placements: change of momentum relative to Σm|v| in "
      "double and single precision, energy once apart, restitution against symplectic Euler's",
      fmt::format("≤ 1e-14 and {:.2g}, none gained, 0.03", momentum_single), impacts);
  for_explicit("bodies/drop",
               "a 4³ cube falls on another: energy never above the start, but for ½Σk(h·u)² while they touch",
               "none but explicit Euler's own", drops);
  add_for_each_integrator(checks, "bodies/default",
                          "a default cube dropped on another, on a plane, 10 s later in single precision: "
                          "fastest particle, distances of contacts",
                          "< 1e-04 m/s or ½ulp(8 m)/h, 0.09 … 0.10 s", false, default_cubes);
  checks.push_back(
      {"bodies/tower",
       "eight cubes of 5³, 32 m high and pushed by 1 cm/s: lean of the top after 20 s with k = 40,000 "
       "N/m, where they stand, and with 2,000, where they fall",
       "≤ 0.01 m; > 1 m", false, false, towers});
}

}  // namespace aspic::verify
