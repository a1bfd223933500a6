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

/// How a run ended.
enum class RunOutcome {
  ok,        ///< it reached its end
  diverged,  ///< figures are those of the last good step
  rejected,  ///< by scene or backend, before its first step
  failed     ///< device, memory or process; it may succeed another time
};
/// "ok", "diverged", "rejected" or "failed".
ASPIC_API std::string_view name_of(RunOutcome outcome);

/// The result of a run.
struct RunRow {
  RunOutcome outcome = RunOutcome::ok;  ///< how it ended
  std::string reason;                   ///< one line; empty: ok
  std::uint64_t steps = 0;              ///< the last good one
  std::vector<RunFigure> figures;       ///< in the order of columns; empty: it never began
  std::string hash;                     ///< of the last good state
  std::string solver;                   ///< Backend::variant(); empty: it never began
  double seconds = 0.0;                 ///< that its steps took
};

/// The file of a run: JSON, with a line end (docs/sweeps.md). `scene`: scene_key() of what the run differs
/// from.
ASPIC_API std::string run_file(const SweepRun& run, const RunRow& row, const std::string& scene);

/// Finished runs, a file each. Several threads, processes and machines may use one folder at once.
class ASPIC_API RunFolder {
 public:
  /// Makes nothing.
  explicit RunFolder(std::string path) : path_(std::move(path)) {}

  /// Makes the folder, with the scene that its runs differ from. Error (io).
  Status make(const Scene& scene) const;
  /// The file of a run; nothing where it is missing, damaged or no regular file.
  std::optional<std::string> read(const std::string& key) const;
  /// Keeps a file KEY.ENDING of a run; one that is there is replaced. Error (io).
  Status write(const std::string& key, std::string_view ending, std::string_view content) const;
  /// The path of KEY.ENDING.
  std::string file(const std::string& key, std::string_view ending) const;

 private:
  std::string path_;
};

}  // namespace aspic
