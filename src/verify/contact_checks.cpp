// One particle on a terrain against closed forms.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/amplification.h"
#include "model/terrain.h"
#include "verify/experiments.h"

namespace aspic::verify {
namespace {

constexpr double g = 9.8, friction = 0.3;

/// A particle of 1 kg at the origin, on the level ground y = 0 or on a slope through it.
Model particle_on_plane(Integrator integrator, ContactModel contact, double slope_angle,
                        const Vec3& velocity) {
  Model model = loose_particles({{0, 0, 0}}, {velocity});
  model.simulation.integrator = integrator;
  model.simulation.implicit.tolerance = 1e-15;
  model.contact.model = contact;
  model.terrain.push_back(plane_through_origin(model, {std::sin(slope_angle), std::cos(slope_angle), 0}));
  return model;
}

/// Error of the speed after a fall of 5 m/s without gravity, relative.
Result<double> bounce_error(const Subject& subject, Integrator integrator, ContactModel contact, double mass,
                            double restitution, double factor) {
  Model model = particle_on_plane(integrator, contact, 0.0, {0, -5, 0});
  model.initial_position = {{0.0, 0.1, 0.0}};
  model.simulation.gravity = {0, 0, 0};
  model.terrain[0].mass = mass;
  model.terrain[0].restitution = restitution;
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 100));
  return std::abs(end.velocity[0].y / (factor * 5.0) - 1.0);
}

Result<Finding> bounce(const Subject& subject) {
  double worst = 0.0;
  for (const Integrator integrator : all_integrators) {
    for (const ContactModel contact : both_contact_models) {
      ASPIC_TRY(auto heavy, bounce_error(subject, integrator, contact,
                                         std::numeric_limits<double>::infinity(), 0.8, 0.8));
      ASPIC_TRY(auto light, bounce_error(subject, integrator, contact, 10.0, 1.0, 9.0 / 11.0));
      worst = std::max({worst, heavy, light});
    }
  }
  return at_most(worst, 8 * epsilon_double);
}

Result<Finding> resist(const Subject& subject) {
  double worst = 0.0;
  for (const Integrator integrator : all_integrators) {
    const Model model = particle_on_plane(integrator, ContactModel::course, 0.0, {0, 0, 0});
    ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 1000));
    worst = std::max({worst, length(end.position[0]), length(end.velocity[0])});
  }
  return at_most(worst, 0.0);
}

/// Sliding on level ground in the course model: v̇ = −μg·v, so one step multiplies the speed by R(−hμg).
Result<Finding> viscous(const Subject& subject, Integrator integrator) {
  constexpr int steps = 1000;
  const Model model = particle_on_plane(integrator, ContactModel::course, 0.0, {2, 0, 0});
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, steps));
  const double z = -model.simulation.timestep * friction * g;
  double factor = 1 + z;  // of implicit Euler, which holds the contact force of the step's start
  if (const Staged* const staged = row_of(integrator).staged()) {
    const auto r = amplification_polynomial(*staged);
    factor = 0.0;
    for (std::size_t i = r.size(); i-- > 0;) factor = factor * z + r[i];
  }
  return at_most(std::abs(end.velocity[0].x / (2 * std::pow(factor, steps)) - 1), 4 * steps * epsilon_double);
}

Result<Finding> sticks(const Subject& subject, Integrator integrator) {
  const Model model =
      particle_on_plane(integrator, ContactModel::coulomb, std::atan(0.99 * friction), {0, 0, 0});
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 3000));
  return at_most(length(end.position[0]), 1e-12, "m");
}

Result<Finding> slides(const Subject& subject, Integrator integrator) {
  const double angle = std::atan(1.01 * friction);
  const Model model = particle_on_plane(integrator, ContactModel::coulomb, angle, {0, 0, 0});
  ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 3000));
  const double expected = 3.0 * g * (std::sin(angle) - friction * std::cos(angle));
  return at_most(std::abs(length(end.velocity[0]) / expected - 1), 1e-3);
}

/// Two surfaces in a corner, without friction. The first sends the particle up at 0.8 of its speed, and the
/// second, which it then leaves, does nothing; in the other order the second would act first.
Result<Finding> file_order(const Subject& subject) {
  double worst = 0.0;
  for (const Integrator integrator : all_integrators) {
    for (const ContactModel contact : both_contact_models) {
      Model model = particle_on_plane(integrator, contact, 0.0, {0, -5, 0});
      model.simulation.gravity = {0, 0, 0};
      const TerrainSettings slope = {
          .geometry = {{"point", Vec3{}}, {"normal", Vec3{std::sqrt(0.5), std::sqrt(0.5), 0}}}};
      model.terrain.push_back(make_terrain(slope, model.contact));
      for (Terrain& terrain : model.terrain) terrain.friction = 0.0;
      ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 1));
      worst = std::max(worst, length(end.velocity[0] - Vec3{0, 4, 0}));
    }
  }
  return at_most(worst, 8 * 5 * epsilon_double, "m/s");
}

/// A particle that starts half a meter below a surface ends its first step on it.
Result<Finding> projection(const Subject& subject) {
  double worst = 0.0, largest = 0.0;
  for (const Integrator integrator : all_integrators) {
    for (const TerrainShapeRow& shape : terrain_shapes) {
      Model model = particle_on_plane(integrator, ContactModel::coulomb, 0.0, {0, 0, 0});
      const Terrain terrain = make_terrain({.shape = shape.value}, model.contact);
      model.terrain = {terrain};
      const auto [d, n] = terrain_gap(terrain, shape.drop);
      model.initial_position.set(0, shape.drop - (d + 0.5) * n);
      ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 1));
      worst = std::max(worst, std::abs(signed_distance(terrain, end.position[0])));
      largest = std::max(largest, extent(terrain));
    }
  }
  return Finding{worst <= 16 * epsilon_double * largest, fmt::format("{:.3g} m", worst)};
}

/// Largest difference between a shape's normal and the gradient of its distance, by differences over 1e-5 m,
/// over 1,000 places within 6 m of where a cube is dropped.
Result<Finding> normals_are_gradients(const Subject&) {
  constexpr double step = 1e-5;
  double worst = 0.0;
  for (const TerrainShapeRow& shape : terrain_shapes) {
    const Terrain terrain = make_terrain({.shape = shape.value}, {});
    Noise noise(7);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 x = shape.drop + 6.0 * noise.vector();
      Vec3 slope;
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 to = x, from = x;
        to[axis] += step;
        from[axis] -= step;
        slope[axis] = (signed_distance(terrain, to) - signed_distance(terrain, from)) / (2.0 * step);
      }
      worst = std::max(worst, length(slope - terrain_gap(terrain, x).n));
    }
  }
  return at_most(worst, 1e-8);
}

/// A particle on a plane that rises and falls with a quarter of gravity: its largest distance from the plane
/// in 8 s, over h² times the plane's largest acceleration. The particle moves by its velocity at one end of a
/// step, the plane by the mean of both.
Result<Finding> elevator(const Subject& subject) {
  double worst = 0.0;
  for (const Integrator integrator : all_integrators) {
    Model model = particle_on_plane(integrator, ContactModel::coulomb, 0.0, {0, 0, 0});
    const TerrainMotion motion = {{0, 1, 0}, 1.0, 0.25, 0.25};
    model.terrain[0].motion = motion;
    const double h = model.simulation.timestep, turn = 2 * std::numbers::pi * motion.frequency;
    model.initial_position.set(0, pose_at(motion, h, 0).offset);
    ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
    for (std::uint64_t step = 1; step <= 8000; ++step) {
      ASPIC_TRY(auto now, run(*solver, 1));
      const double d = signed_distance(terrain_at(model.terrain[0], h, step), now.position[0]);
      worst = std::max(worst, std::abs(d) / (h * h * motion.amplitude * turn * turn));
    }
  }
  return at_most(worst, 2.0);
}

}  // namespace

void add_contact_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"contact/bounce",
       "speed after an impact: −e·u, and 9/11·|u| for e = 1, M = 10, m = 1; every integrator, both models",
       at_most_text(8 * epsilon_double), true, false, bounce});
  checks.push_back({"contact/resist",
                    "course model: the ground carries a resting particle exactly; every integrator",
                    at_most_text(0.0), true, false, resist});
  checks.push_back({"contact/order",
                    "two surfaces in a corner act in file order; every integrator, both models",
                    at_most_text(40 * epsilon_double, "m/s"), true, false, file_order});
  checks.push_back({"contact/projection",
                    "Coulomb: from 0.5 m below each terrain to its surface in one step; every integrator",
                    "≤ 16 ε of the coordinates", true, false, projection});
  checks.push_back({"contact/gradient",
                    "every shape's normal is the gradient of its distance, 1,000 places each",
                    at_most_text(1e-8), true, false, normals_are_gradients});
  checks.push_back(
      {"contact/elevator",
       "a particle's distance from a plane that rises and falls, 8 s, over h²a; every integrator",
       at_most_text(2.0), true, false, elevator});
  add_for_each_integrator(checks, "contact/viscous",
                          "course friction slows a slide by R(−hμg) a step, 1,000 steps",
                          at_most_text(4000 * epsilon_double), true, viscous);
  add_for_each_integrator(checks, "contact/stick", "Coulomb: tan θ = 0.99 μ holds a particle for 3 s",
                          at_most_text(1e-12, "m"), true, sticks);
  add_for_each_integrator(checks, "contact/slide",
                          "Coulomb: tan θ = 1.01 μ slides with g(sin θ − μ cos θ) for 3 s",
                          at_most_text(1e-3), true, slides);
}

}  // namespace aspic::verify
