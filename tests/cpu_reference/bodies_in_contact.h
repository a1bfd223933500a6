#pragma once
// Bodies that touch, for tests of contact between them: cubes and slabs of default springs, some tenths of a
// meter between neighbors, and what becomes of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "aspic/analysis.h"
#include "cpu_reference/body_contact.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic::test {

inline constexpr double spacing = 4.0 / 9;  ///< s of the default cube [m]

/// A box of so many particles, their spacing s.
inline CubeSettings box_of(std::array<int, 3> particles, const Vec3& center, double s = spacing) {
  CubeSettings box;
  box.particles = particles;
  box.edge_length = (std::ranges::max(particles) - 1) * s;
  box.position = center;
  return box;
}
inline CubeSettings cube_of(int n, const Vec3& center, double s = spacing) {
  return box_of({n, n, n}, center, s);
}
inline CubeSettings turned(CubeSettings cube, const Vec3& axis, double angle) {
  cube.rotation = {axis, angle};
  return cube;
}
inline CubeSettings moving(CubeSettings cube, const Vec3& velocity) {
  cube.velocity = velocity;
  return cube;
}
inline CubeSettings damped(CubeSettings cube, double c) {
  cube.structural.damping = cube.shear.damping = cube.bending.damping = c;
  return cube;
}
inline CubeSettings fixed(CubeSettings cube) {
  const std::array<int, 3> n = cube.lattice();
  for (int i = 0; i < n[0] * n[1] * n[2]; ++i) cube.pinned.indices.push_back(i);
  return cube;
}
inline CubeSettings on_its_bottom(CubeSettings cube) {
  cube.pinned.names = {"bottom"};
  return cube;
}

inline ModelSettings contact_scene(std::vector<CubeSettings> cubes,
                                   Integrator integrator = Integrator::symplectic_euler) {
  ModelSettings settings;
  settings.cubes = std::move(cubes);
  settings.contact.bodies = true;
  settings.simulation.integrator = integrator;
  return settings;
}
inline ModelSettings weightless_contact_scene(std::vector<CubeSettings> cubes,
                                              Integrator integrator = Integrator::symplectic_euler) {
  ModelSettings settings = contact_scene(std::move(cubes), integrator);
  settings.simulation.gravity = {};
  return settings;
}

inline physics::Vector<double> random_vector(std::mt19937& random, double size) {
  std::normal_distribution<double> some(0.0, size);
  return {some(random), some(random), some(random)};
}
inline physics::ParticleView<const double> view_of_fields(const physics::Field<double>& x,
                                                          const physics::Field<double>& v) {
  return {physics::components(x.data()), physics::components(v.data()), 3};
}

/// Mean place and velocity of a body's particles.
inline Vec3 mean(const std::vector<Vec3>& of, const Body& body) {
  Vec3 sum;
  for (std::uint32_t i = 0; i < body.particle_count; ++i) sum = sum + of[body.first_particle + i];
  return (1.0 / body.particle_count) * sum;
}

/// Contacts in a state: how many, the least and the greatest distance among them in spacings.
struct ContactDistances {
  std::size_t count = 0;
  double least = 1.0, greatest = -1.0;
};
inline ContactDistances contacts_in(const Model& model, const State& state) {
  reference::BodyContact<double> contact(model);
  const auto x = physics::field<double>(state.position), v = physics::field<double>(state.velocity);
  const auto at = view_of_fields(x, v);
  ContactDistances found;
  if (!contact.begin_step(state.step, at) || !contact.find(at)) return found;
  for (const auto& each : contact.contacts()) {
    ++found.count;
    found.least = std::min(found.least, each.d / spacing);
    found.greatest = std::max(found.greatest, each.d / spacing);
  }
  return found;
}

}  // namespace aspic::test
