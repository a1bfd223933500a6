// Balls: impact, momentum and energy in a crowd, rolling, spin, overlap, and equality of the backends.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "aspic/analysis.h"
#include "aspic/scene.h"
#include "verify/experiments.h"

namespace aspic::verify {
namespace {

/// Balls alone in space without gravity or spin.
ModelSettings weightless() {
  ModelSettings settings;
  settings.simulation.gravity = {};
  settings.contact.spin = false;
  return settings;
}

/// v₁' = v₁ − (1 + e)·u/(w₁ + w₂)·w₁·n and v₂' the opposite (Newton's impact), over what rounding may do: 64
/// operations on speeds of a few m/s, and w times as large an impulse on a light partner.
Result<Finding> impact(const Subject& subject) {
  struct Pair {
    double m1, m2, e;
  };
  double worst = 0.0;
  for (const auto& [m1, m2, e] :
       {Pair{1, 1, 1}, Pair{1, 1, 0.3}, Pair{1000, 1, 1}, Pair{1, 1000, 0.5}, Pair{2, 3, 0}}) {
    ModelSettings settings = weightless();
    settings.contact.ball_restitution = e;
    const Vec3 n = Vec3{2.0, -1.0, 2.0} / 3.0, v1 = {-3.0, 0.5, 1.0}, v2 = {1.0, 0.25, -2.0};
    const double h = settings.simulation.timestep;
    settings.balls.push_back({0.5, m1, 0.804 * n - h * v1, v1, {}});
    settings.balls.push_back({0.3, m2, -h * v2, v2, {}});
    ASPIC_TRY(auto model, build_model(settings));
    ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 1));
    const double w1 = 1.0 / m1, w2 = 1.0 / m2, J = -(1.0 + e) * dot(v1 - v2, n) / (w1 + w2);
    const double error = std::max(length(end.ball_velocity[0] - (v1 + (w1 * J) * n)),
                                  length(end.ball_velocity[1] - (v2 - (w2 * J) * n)));
    worst = std::max(worst, error / (64 * epsilon_double * (4.0 + J * std::max(w1, w2))));
  }
  return Finding{worst <= 1.0, fmt::format("{:.3g} of the bound", worst)};
}

/// 60 balls and 200 loose particles of very different masses that press on each other in many places at once.
Result<Model> crowd(double restitution, bool spin) {
  Noise noise(5);
  const auto within = [&](double half) { return half * noise.vector(); };
  ModelSettings settings = weightless();
  settings.contact.spin = spin;
  settings.contact.ball_restitution = restitution;
  settings.contact.ball_friction = 0.7;
  for (int b = 0; b < 60; ++b) {
    const double radius = 0.25 + 0.15 * noise(), mass = std::exp(1.0 + 3.0 * noise());
    settings.balls.push_back({radius, mass, within(1.2), within(3.0), within(9.0)});
  }
  auto model = build_model(settings);
  if (!model) return model;
  for (int p = 0; p < 200; ++p) {
    model->initial_position.push_back(within(1.2));
    model->initial_velocity.push_back(within(3.0));
    model->mass.push_back(std::exp(-1.0 + 2.0 * noise()));
    model->inverse_mass.push_back(1.0 / model->mass.back());
  }
  return model;
}

/// Largest change of momentum in a step over Σm|v|, and largest gain of kinetic energy in a step over its
/// own.
Result<Finding> crowd_conserves(const Subject& subject) {
  double drift = 0.0, gain = -1.0, lost = 1.0;
  for (const bool spin : {false, true}) {
    for (const double restitution : {0.0, 0.6, 1.0}) {
      ASPIC_TRY(auto model, crowd(restitution, spin));
      ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
      ASPIC_TRY(auto state, run(*solver, 0));
      Measures before = measure(model, state);
      const double first = before.kinetic;
      double scale = 0.0;
      for (std::size_t b = 0; b < model.balls.size(); ++b)
        scale += model.balls[b].mass * length(state.ball_velocity[b]);
      for (std::size_t p = 0; p < model.mass.size(); ++p) scale += model.mass[p] * length(state.velocity[p]);
      for (int step = 0; step < 200; ++step) {
        ASPIC_TRY(auto next, run(*solver, 1));
        const Measures now = measure(model, next);
        drift = std::max(drift, length(now.momentum - before.momentum) / scale);
        gain = std::max(gain, now.kinetic / before.kinetic - 1.0);
        before = now;
      }
      if (restitution < 1.0 || spin) lost = std::min(lost, 1.0 - before.kinetic / first);
    }
  }
  // Bodies that never met would keep both as well.
  const bool met = lost > 0.1;
  return Finding{
      met && drift <= 260 * epsilon_double && gain <= 1000 * epsilon_double,
      fmt::format("momentum {:.3g}, energy {:+.3g}{}", drift, gain, met ? "" : ", but hardly anything met")};
}

/// A ball at rest on a slope of 30° after a second: v/(g·sin θ) and ω against what friction decides.
Result<Finding> slope(const Subject& subject, double friction, double share_of_gravity, double spin_share) {
  ModelSettings settings;
  const double s = 0.5, c = std::sqrt(3.0) / 2.0, R = 0.4;
  settings.terrain.emplace_back();
  settings.terrain[0].geometry["point"] = Vec3{};
  settings.terrain[0].geometry["normal"] = Vec3{s, c, 0.0};
  settings.terrain[0].friction = friction;
  settings.balls.push_back({R, 2.5, {R * s, R * c, 0.0}, {}, {}});
  ASPIC_TRY(auto model, build_model(settings));
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 1000));
  const double along = 9.8 * s;
  const double v = std::abs(length(end.ball_velocity[0]) - share_of_gravity * along);
  const double w = std::abs(length(end.ball_angular_velocity[0]) * R - spin_share * along);
  return at_most(std::max(v, w), 1000 * 160 * epsilon_double * 5.0, "m/s");
}

/// Spin about z meets level ground: the slip R·ω ends, 2/7 of it in the velocity and 5/7 in the rotation, if
/// friction suffices; else the friction impulse is μ(1 + e)m|u|.
Result<Finding> spin_turns_a_bounce(const Subject& subject) {
  double worst = 0.0;
  for (const double mu : {0.02, 5.0}) {
    ModelSettings settings = weightless();
    settings.contact.spin = true;
    settings.terrain.emplace_back();
    settings.terrain[0].friction = mu;
    settings.terrain[0].restitution = 0.5;
    const double R = 0.3, omega = 20.0, fall = 4.0;
    settings.balls.push_back({R, 2.0, {0.0, -1.0 + R + 0.002, 0.0}, {0.0, -fall, 0.0}, {0.0, 0.0, omega}});
    ASPIC_TRY(auto model, build_model(settings));
    ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 1));
    const double taken = std::min(2.0 / 7.0 * R * omega, mu * 1.5 * fall);
    worst = std::max({worst, length(end.ball_velocity[0] - Vec3{-taken, 0.5 * fall, 0.0}),
                      R * length(end.ball_angular_velocity[0] - Vec3{0.0, 0.0, omega - 2.5 * taken / R})});
  }
  return at_most(worst, 64 * epsilon_double * 12.0, "m/s");
}

/// Smallest gap between two balls of the built-in pit after 20 s, as a share of their radius.
Result<Finding> pit_overlap(const Subject& subject) {
  ASPIC_TRY(auto scene, load_scene("ball-pit"));
  ASPIC_TRY(auto model, build_model(scene.model));
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::single, steps_of(model, 20.0)));
  double worst = 0.0;
  for (std::size_t a = 0; a < model.balls.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double radii = model.balls[a].radius + model.balls[b].radius;
      const double overlap = radii - length(end.ball_position[a] - end.ball_position[b]);
      worst = std::max(worst, overlap / std::min(model.balls[a].radius, model.balls[b].radius));
    }
  }
  return at_most(worst, 0.1, "of a radius");
}

/// 1,000 steps of three scenes on a backend, on the gpu by every search, compared with the reference.
Result<Finding> same_bits(const Subject& subject, const BackendRow& row) {
  std::array<GpuOptions, 2> searches;
  searches[0].ball_search = BallSearch::all_pairs;
  searches[1].ball_search = BallSearch::grid;
  BitComparison comparison(subject, row);
  for (const char* name : {"goal-net", "penalty", "cube-and-balls"}) {
    ASPIC_TRY(auto scene, load_scene(name));
    ASPIC_TRY(auto model, build_model(scene.model));
    ASPIC_CHECK(comparison.add(
        model, [](Solver& solver) { return run(solver, 1000); }, searches));
  }
  return Finding{comparison.same(), comparison.finding().measured};
}

}  // namespace

void add_ball_checks(std::vector<Check>& checks) {
  const auto add = [&](std::string name, std::string claim, std::string bound, bool quick, auto run) {
    checks.push_back(
        {"balls/" + std::move(name), std::move(claim), std::move(bound), quick, false, std::move(run)});
  };
  add("impact", "two balls part as Newton's impact formula says: equal, heavy, light, elastic or not",
      "64 ε of speeds and impulse", true, impact);
  add("crowd", "60 balls and 200 particles, 200 steps: momentum is kept and no step raises the energy",
      "P ≤ 260 ε, E ≤ 1000 ε", true, crowd_conserves);
  const std::string rounding = at_most_text(1000 * 160 * epsilon_double * 5.0, "m/s");
  add("slide", "without friction a ball slides down 30° with g·sin θ and does not turn", rounding, true,
      [](const Subject& s) { return slope(s, 0.0, 1.0, 0.0); });
  add("roll", "with μ = 0.2 it rolls, a = 5/7·g·sin θ", rounding, true,
      [](const Subject& s) { return slope(s, 0.2, 5.0 / 7.0, 5.0 / 7.0); });
  // Below 2/7·tan θ = 0.165 it skids: a = g(sin θ − μ cos θ), ω̇·R = 5/2·μ·g·cos θ.
  const double after_friction = 0.1 * std::sqrt(3.0);
  add("skid", "with μ = 0.1 it skids, a = g(sin θ − μ cos θ), and friction turns it", rounding, true,
      [=](const Subject& s) { return slope(s, 0.1, 1.0 - after_friction, 2.5 * after_friction); });
  add("spin", "spin turns a bounce: slip ends 2/7 in velocity, or friction is μ(1 + e)m|u|",
      at_most_text(64 * epsilon_double * 12.0, "m/s"), true, spin_turns_a_bounce);
  add("pit", "ball-pit after 20 s: deepest overlap of two balls", at_most_text(0.1, "of a radius"), false,
      pit_overlap);
  for (const BackendRow& row : backends().first(backends().size() - 1)) {
    checks.push_back({fmt::format("equality/balls/{}", row.name),
                      fmt::format("goal-net, penalty and cube-and-balls on the {}{}, 1,000 steps", row.name,
                                  row.needs_context ? ", all pairs and grid" : ""),
                      "0 ULP", false, row.needs_context,
                      [&row](const Subject& subject) { return same_bits(subject, row); }});
  }
}

}  // namespace aspic::verify
