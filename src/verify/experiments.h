#pragma once
// Models and runs that several checks share.
#include <array>
#include <cstdint>

#include "base/split_mix.h"
#include "model/integrator.h"
#include "verify/check.h"

namespace aspic::verify {

inline constexpr std::array both_contact_models = {ContactModel::coulomb, ContactModel::course};

inline constexpr double epsilon_double = 2.220446049250313e-16;
inline constexpr double epsilon_single = 1.1920929e-7;

/// Settings of one cube of edge 4 m with the default springs, its centre at `centre`; no terrain.
ModelSettings cube_settings(int particles_per_edge, const Vec3& centre = {0.0, 9.0, 0.0});

/// A tilted cube that reaches the terrain of this shape within the first tenth of 2,000 steps.
ModelSettings cube_on_terrain(int particles_per_edge, TerrainShape shape, Integrator integrator,
                              ContactModel contact);

/// Loose particles of mass m without springs; gravity stays the default.
Model loose_particles(std::vector<Vec3> positions, std::vector<Vec3> velocities, double mass = 1.0);

/// Numbers in [−1, 1), the same on every machine.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : random_(seed) {}
  double operator()() { return 2.0 * random_.share() - 1.0; }
  Vec3 vector() {
    const double x = (*this)(), y = (*this)(), z = (*this)();
    return {x, y, z};
  }

 private:
  SplitMix64 random_;
};

/// The model's start in double precision, each position moved by up to `shift` [m] and each velocity set up
/// to `speed` [m/s] along every axis.
State shaken(const Model& model, double shift, double speed, std::uint64_t seed);

/// Ground through the origin with the model's contact constants.
Terrain plane_through_origin(const Model& model, const Vec3& normal);

/// How far the deepest particle is inside a terrain [m]; negative if all are outside.
double deepest(const Model& model, const State& state);

/// The step of a row: the scene's default, or what implicit Euler is there for [s].
double usual_step(Integrator integrator);

/// Steps that a duration [s] takes, the nearest whole number.
std::uint64_t steps_of(const Model& model, double duration);

/// The solver after `steps` steps from `start` (the model's own if null).
/// Error (check_failed): it diverged.
Result<State> run(Solver& solver, std::uint64_t steps, const State* start = nullptr);

/// The same on a new reference solver.
Result<State> run_reference(const Subject& subject, const Model& model, Precision precision,
                            std::uint64_t steps, const State* start = nullptr);

/// Error (check_failed) unless `advanced` is success without divergence.
Status require_good(const Result<std::optional<Divergence>>& advanced);

}  // namespace aspic::verify
