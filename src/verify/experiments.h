#pragma once
// Models and runs that several checks share.
#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include "base/split_mix.h"
#include "model/integrator.h"
#include "verify/check.h"

namespace aspic::verify {

inline constexpr std::array both_contact_models = {ContactModel::coulomb, ContactModel::course};

inline constexpr double epsilon_double = 2.220446049250313e-16;
inline constexpr double epsilon_single = 1.1920929e-7;

/// Settings of one cube of edge 4 m with the default springs, its center at `center`; no terrain.
ModelSettings cube_settings(int particles_per_edge, const Vec3& center = {0.0, 9.0, 0.0});

/// A tilted cube that reaches the terrain of this shape within the first tenth of 2,000 steps, or of 60 steps
/// of 0.01 s where the method is solved.
ModelSettings cube_on_terrain(int particles_per_edge, TerrainShape shape, Integrator integrator,
                              ContactModel contact);

/// Loose particles of mass m without springs; gravity stays the default.
Model loose_particles(std::vector<Vec3> positions, const std::vector<Vec3>& velocities, double mass = 1.0);

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

/// The step of a row: the scene's default, or the large one that implicit Euler is meant for [s].
double usual_step(Integrator integrator);

/// Steps that a duration [s] takes, the nearest whole number.
std::uint64_t steps_of(const Model& model, double duration);

/// The solver after `steps` steps from `start` (the model's own if null).
/// Error (check_failed): it diverged.
Result<State> run(Solver& solver, std::uint64_t steps, const State* start = nullptr);

/// The same on a new reference solver.
Result<State> run_reference(const Subject& subject, const Model& model, Precision precision,
                            std::uint64_t steps, const State* start = nullptr);

/// Runs of a backend compared with the same runs of the reference in single precision.
class BitComparison {
 public:
  BitComparison(const Subject& subject, const BackendRow& row) : subject_(subject), row_(row) {}

  /// One more run, on a backend of a device once with each of `variants`. Errors: the solvers' and the run's.
  Status add(const Model& model, const std::function<Result<State>(Solver&)>& run,
             std::span<const GpuOptions> variants);

  bool same() const { return ulp_ == 0; }
  /// Largest difference and number of runs. A device that the canary found to compute otherwise has a bound
  /// on single steps, since long runs through contact drive any two roundings apart: from states along the
  /// reference's run, it may differ, at their median, by 1 + 2p·√n times what a step in single precision
  /// differs from one in double precision, with p = Arithmetic::worst_ulps() and n forces that act on a
  /// particle in a step. Of these, roundings of half a unit add up like √n; a device that is always wrong by
  /// p units to the same side adds up 2p·n of them.
  Finding finding() const;

 private:
  Status bound(const Model& model, GpuSolver& gpu, std::uint64_t steps);

  const Subject& subject_;
  const BackendRow& row_;
  std::uint64_t ulp_ = 0;
  double absolute_ = 0.0;
  int runs_ = 0;
  /// In units of the last place of the largest component.
  struct StepBound {
    double off = 0.0, allowed = 0.0;
    double share() const { return off / allowed; }
  };
  double share_ = 0.0;  // of its bound that the median step of the worst run takes; infinite: without one
  StepBound step_;
  std::string arithmetic_;  // the canary's sentences
};

/// Adds a check NAME/INTEGRATOR for each integrator; `run` takes the subject and the integrator.
template <class Run>
void add_for_each_integrator(std::vector<Check>& checks, const std::string& name, const std::string& claim,
                             const std::string& bound, bool quick, Run run) {
  for (const Integrator integrator : all_integrators) {
    checks.push_back({name + "/" + std::string(name_of(integrator)), claim, bound, quick, false,
                      [=](const Subject& subject) { return run(subject, integrator); }});
  }
}

/// Error (check_failed) unless `advanced` is success without divergence.
Status require_good(const Result<Advance>& advanced);

}  // namespace aspic::verify
