#pragma once
// What `aspic bench` is made of: who is measured, what was measured, how it is shown.
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/run.h"
#include "aspic/scene.h"
#include "base/stopwatch.h"
#include "cli/json.h"
#include "command_line/arguments.h"
#include "gpu/pass_profiler.h"
#include "io/program.h"

namespace aspic::cli {

using Clock = std::chrono::steady_clock;
/// What a run took [s]: by the clock, and of all processors together.
struct Took {
  double seconds = 0.0, processor_seconds = 0.0;
};

/// Whether a peer (bench/peers) moves as it should.
struct PeerCheck {
  bool passed = false;
  std::uint64_t steps = 0;
  double deviation = 0.0;               ///< largest, from the reference in double precision [m]
  double bound = 0.0;                   ///< largest allowed [m]
  double fall = 0.0, fall_bound = 0.0;  ///< what the center's fall is off by, and may be [m]
};

/// A row of the table: a backend or a peer with a scene of one size and integrator, run several times.
struct Measurement {
  std::string name;  ///< "gpu:gather", "taichi"
  std::string backend, force_path, device;
  Arithmetic arithmetic = Arithmetic::exact;
  std::optional<PeerCheck> peer;
  Integrator integrator = Integrator::explicit_euler;
  int size = 0;  ///< particles per edge of the first cube; 0 without cubes
  std::uint64_t particles = 0, springs = 0;
  std::optional<std::uint64_t> bytes;  ///< that the solver holds; nothing of peers
  double timestep = 0.0;
  std::uint64_t steps = 0;          ///< of each repeat
  double evaluations_per_step = 1;  ///< of all spring forces, Jacobians counted as such
  std::vector<Took> repeats;        ///< in the order of measuring
  std::vector<gl::PassTime> passes;
  std::optional<Divergence> divergence;
  std::optional<double> growth;  ///< cost of a spring evaluation, relative to the first size's
  std::optional<double> ratio;   ///< the first row's throughput with this size and integrator over this one's
  std::optional<double> processor_ratio;  ///< the same by a second of processor time

  /// Whether it has figures: at least one repeat, of what moves as it should.
  bool counts() const { return !repeats.empty() && !divergence && (!peer || peer->passed); }
  /// Seconds below which a share q of the repeats lies, from 0 (fastest) to 1, linear between two of them;
  /// counts() first.
  double quantile(double q) const;
  double median() const { return quantile(0.5); }
  /// Median of the repeats' processor time [s]; counts() first.
  double processor_median() const;
  /// Processors that it kept busy: below its number of threads where others had them meanwhile.
  double processors() const { return processor_median() / median(); }
  double spread() const { return (quantile(1.0) - quantile(0.0)) / median(); }
  double steps_per_second() const { return static_cast<double>(steps) / median(); }
  double milliseconds_per_step() const { return 1e3 / steps_per_second(); }
  /// Device time of a step, the sum of its passes [ms]; nothing where the backend has none.
  std::optional<double> kernel_milliseconds_per_step() const;
  double spring_evaluations_per_second() const {
    return static_cast<double>(springs) * evaluations_per_step * steps_per_second();
  }
  double spring_evaluations_per_processor_second() const {
    return spring_evaluations_per_second() / processors();
  }
  double seconds_per_simulated_second() const { return 1.0 / (steps_per_second() * timestep); }
};

/// Sets growth and ratio of every row.
void compare_rows(std::vector<Measurement>& rows);

/// Who is measured. Its runs may alternate with those of others.
class Contestant {
 public:
  explicit Contestant(Measurement measurement) : m(std::move(measurement)) {}
  virtual ~Contestant() = default;
  Contestant(const Contestant&) = delete;
  Contestant& operator=(const Contestant&) = delete;

  /// From the start over `steps` steps, until the device is done with them; the state is not read. Notes a
  /// divergence. Errors: interrupted, and those of the backend.
  virtual Result<Took> run(std::uint64_t steps) = 0;
  /// After the last run: what is not measured within runs.
  virtual Status finish() { return {}; }

  Measurement m;
};

/// A backend with a model. Errors: as make_backend.
Result<std::unique_ptr<Contestant>> make_backend_contestant(const BackendChoice& choice,
                                                            const SharedModel& shared_model,
                                                            const InterruptGuard& interrupt);

/// The same with its solver.
std::unique_ptr<Contestant> make_backend_contestant(Backend backend, const InterruptGuard& interrupt);

/// Runs shorter than this are at clocks of an idle device [s]: work that goes before the calibration.
inline constexpr double warm_seconds = 0.3;
/// Repeats of fewer steps measure the waits at their ends too.
inline constexpr std::uint64_t fewest_steps = 20;

/// Steps that take about `seconds`, 1 to `most`: by a run of at least a quarter of that, at the end of
/// warm_seconds of work. Errors: those of Contestant::run().
Result<std::uint64_t> steps_for(Contestant& contestant, double seconds, std::uint64_t most);

/// What to say of a row whose repeats have fewer than fewest_steps; nothing of others. `option`: what makes
/// them longer.
std::string steps_warning(const Measurement& m, std::string_view option);

/// Who is measured next to the backends of a case, and how many steps all of them may make.
struct Guests {
  std::vector<std::unique_ptr<Contestant>> contestants;
  std::uint64_t most_steps = aspic::most_steps;
};
using InviteGuests = std::function<Result<Guests>(const ModelSettings& settings, const Model& model,
                                                  const Measurement& like, const InterruptGuard& interrupt)>;

/// `aspic bench`, with guests where there is something that invites them. Errors: of model, time step,
/// backends and guests.
Status execute_bench(const BenchOptions& options, const InviteGuests& invite = nullptr);

/// What was measured, as a table and as JSON.
struct BenchReport {
  std::string scene;
  int repeats = 0, warm_up = 0;
  bool interrupted = false;
  std::vector<Measurement> rows;
};
std::string table_of(const BenchReport& report);
Json json_of(const BenchReport& report);
/// Where and with what it was measured: the head of the JSON.
Json origin_json();
/// A value below which a share q of the samples lies, 0 (least) … 1, linear between two; not empty.
double quantile_of(std::vector<double> samples, double q);

/// `aspic bench --images`. Errors: as measure_frames.
Status execute_images(const BenchOptions& options, const Scene& scene, const InterruptGuard& interrupt);

}  // namespace aspic::cli
