#pragma once
// Bodies in contact in the kinds of motion that a search for contacts may get wrong, for comparing backends.
#include <string>
#include <vector>

#include "support/actuated.h"
#include "support/model_building.h"

namespace aspic::test {

struct ContactMotion {
  const char* name;
  ModelSettings settings;
  std::uint64_t steps;
  double pull = 0.0;          ///< stiffness of a pull on particle 0 to the origin [N/m]
  double impact_share = 0.0;  ///< speed of the first body along −y in shares of the speed limit
};

/// A box of so many particles per edge with spacing s, without gravity in contact_motions().
inline CubeSettings contact_cube(int n, double s, const Vec3& position, const Vec3& velocity) {
  CubeSettings cube;
  cube.particles_per_edge = n;
  cube.edge_length = (n - 1) * s;
  cube.position = position;
  cube.velocity = velocity;
  return cube;
}

inline std::vector<ContactMotion> contact_motions() {
  constexpr double s = 4.0 / 9;  // of default springs and masses [m]
  const auto weightless = [](std::vector<CubeSettings> cubes) {
    ModelSettings settings;
    settings.cubes = std::move(cubes);
    settings.contact.bodies = true;
    settings.simulation.gravity = {};
    return settings;
  };
  std::vector<ContactMotion> all;
  // Edges that miss each other's middle, so that both bodies spin away.
  all.push_back({"spin",
                 weightless({contact_cube(4, s, {1.1, 1.5, 0.9}, {0, -6, 0}),
                             contact_cube(4, s, {0, 0, 0}, {0, 6, 0})}),
                 500});
  all.push_back({"impact",
                 weightless({contact_cube(4, s, {0.1, 1.5, 0.2}, {}), contact_cube(5, s, {0, 0, 0}, {})}),
                 300, 0.0, 0.9});
  all.push_back({"sizes",
                 weightless({contact_cube(4, 0.2 * s, {0.2, 0.97 + 0.2 * s, 0.1}, {0.5, -1, 0}),
                             contact_cube(5, s, {0, 0, 0}, {})}),
                 400});
  all.push_back({"pulled",
                 weightless({contact_cube(3, s, {1.5, 1.2, 0.3}, {}), contact_cube(4, s, {0, 0, 0}, {})}),
                 400, 2000.0});
  all.push_back({"late",
                 weightless({contact_cube(2, s, {0, s + 0.2, 0}, {0, -0.008, 0}),
                             contact_cube(2, s, {0.1, 0, 0.1}, {})}),
                 21500});
  ModelSettings driven = actuated(Integrator::symplectic_euler, ContactModel::coulomb);
  driven.contact.bodies = driven.contact.self = true;
  driven.cubes[0].position = {1.2, 3.2, 0.1};
  driven.cloths[0].position = {-1.0, 3.3, 0.0};
  all.push_back({"actuated", driven, 400});
  return all;
}

}  // namespace aspic::test
