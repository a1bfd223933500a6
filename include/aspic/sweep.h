#pragma once
// Runs of a sweep: what each one is, the key that names it on every machine, the figures of its row. How they
// are kept: docs/sweeps.md.
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "aspic/error.h"
#include "aspic/export.h"
#include "aspic/model.h"
#include "aspic/parameters.h"
#include "aspic/run.h"
#include "aspic/scene.h"
#include "aspic/state.h"

namespace aspic {

/// A value in which a run differs from its scene.
struct Difference {
  std::string key;    ///< a path of --set, "backend", or a short name: integrator, h, k, c, n, e, mu
  std::string value;  ///< as --set or --backend takes it
  friend bool operator==(const Difference&, const Difference&) = default;
};

/// How far a run goes, counted from the scene's start, also when resumed.
struct RunLength {
  std::optional<std::uint64_t> steps;  ///< at most 2⁵³
  std::optional<double> duration;      ///< [s], ≥ 0; rounded to the nearest whole number of steps
};

/// A run of a sweep.
struct SweepRun {
  /// 32 hexadecimal digits: equal for runs of the same version of the library, motion, number of steps and
  /// backend as it was asked for (`auto` is one), that differ from their scenes in the same keys. How a
  /// scene looks, the order of its keys and how numbers were written do not count.
  std::string key;
  Scene scene;                  ///< with the differences
  BackendChoice backend;        ///< likewise
  std::string backend_words;    ///< as parse_backend() takes them: "auto", "cpu", "reference:double"
  std::uint64_t steps = 0;      ///< to be made
  std::uint64_t particles = 0;  ///< that are moved
  std::optional<Error> error;   ///< no such run: its scene or backend was rejected; the others are unset
  /// Keys of the differences and their values as the scene has them, the first target's of a short name; text
  /// where it has none, and of a run that was rejected.
  std::vector<std::pair<std::string, ParameterValue>> values;
};

/// The run of a scene and a backend with differences, each key once. Of equal arguments it is equal on every
/// machine.
ASPIC_API SweepRun sweep_run(const Scene& scene, const BackendChoice& backend, const RunLength& length,
                             std::span<const Difference> differences);
/// 32 hexadecimal digits of the scene's complete file, to_toml(): its name where runs are kept.
ASPIC_API std::string scene_key(const Scene& scene);

/// A figure of a run.
struct RunFigure {
  std::string_view name;        ///< a column of `aspic sweep`; docs/report.md has meanings and units
  std::optional<double> value;  ///< absent: it was never so, or is not finite
};

/// The figures of a run, from its states. One thread at a time.
class ASPIC_API RunFigures {
 public:
  explicit RunFigures(SharedModel model);
  RunFigures(RunFigures&&) noexcept;
  RunFigures& operator=(RunFigures&&) noexcept;
  ~RunFigures();

  /// Steps between the states that it takes, 60 a simulated second, for a time step [s] > 0. At least 1.
  static std::uint64_t interval(double timestep);
  /// Takes the state of the start, of every interval() steps, and the last one, in their order. The state has
  /// the model's numbers of particles and balls.
  void take(const State& state);
  /// In the order of columns, once a state was taken.
  std::vector<RunFigure> figures() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace aspic
