#pragma once
// What every backend can do: advance a State of a Model by steps.
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "aspic/error.h"
#include "aspic/export.h"
#include "aspic/inputs.h"
#include "aspic/model.h"
#include "aspic/state_view.h"

namespace aspic {

/// A step whose result was not a finite number or was faster than 1,000 m/s, or whose implicit solve ended
/// with a residual that is not finite: then its result, finite or not, means nothing.
struct Divergence {
  std::uint64_t step = 0;      ///< the step that failed: it would have been this step's end
  std::uint32_t particle = 0;  ///< lowest index of those that failed; particles come before balls
  bool finite = true;          ///< false: NaN or infinity; true: too fast
  bool ball = false;           ///< true: `particle` is the index of a ball
  bool residual = false;       ///< true: it was the solve's residual, and `particle` says nothing

  friend bool operator==(const Divergence&, const Divergence&) = default;
};

/// How far advance() came and what ended it. If neither reason is set, all steps were made.
struct Advance {
  std::uint64_t steps = 0;  ///< made in this call; of a gpu solver that does not wait, those queued
  std::optional<Divergence> divergence = {};  ///< ended the steps
  bool stopped = false;                       ///< the stop flag ended them

  friend bool operator==(const Advance&, const Advance&) = default;
};

/// What diverged, for messages: `particle 7`, `ball 2`, `the residual of the implicit solve`.
ASPIC_API std::string body_text(const Divergence& divergence);
/// How it did, after body_text: `became faster than 1000 m/s` or `is no longer a finite number`.
ASPIC_API std::string fault_text(const Divergence& divergence);

/// How a step's solve ended (docs/physics.md, section 4): stagnated, its residual no longer became smaller.
enum class SolveEnd : std::uint32_t { converged = 0, stagnated = 1, not_converged = 2 };

/// One step's solve.
struct SolveReport {
  std::uint32_t newton_iterations = 0;  ///< linear systems solved
  std::uint32_t cg_iterations = 0;      ///< of all of them
  double residual = 0.0;  ///< largest component of |(v' − v) − h·a|, on the ground |v' − P(v + h·a)| [m/s]
  SolveEnd end = SolveEnd::converged;  ///< why it stopped
};

/// A run's solves since the state was loaded.
struct SolveStatistics {
  std::uint64_t steps = 0, converged = 0, stagnated = 0, not_converged = 0;  ///< all; then by their end
  std::uint64_t newton_iterations = 0, cg_iterations = 0;                    ///< in all steps
  double worst_residual = 0.0;                                               ///< [m/s]
  SolveReport last;                                                          ///< of the latest step

  ASPIC_API void add(const SolveReport& report);  ///< counts one more step
};

/// How a solver may round.
enum class Arithmetic {
  exact,  ///< every operation once, in the documented order (docs/determinism.md): the reference's bits
  fast  ///< may fuse operations and use reciprocal roots: other last bits, on each kind of processor its own
};
ASPIC_API std::string_view name_of(Arithmetic arithmetic);  ///< "exact", "fast"

/// How spring forces reach particles on a GPU. Every path gives the same bits.
enum class ForcePath {
  automatic,  ///< lattice where the model has cubes or bodies of cells, else gather
  lattice,    ///< gather on cubes and boxes without connectivity in memory, and as below on all else
  gather,     ///< one invocation per particle evaluates its springs, everything fused
  per_spring  ///< one invocation per spring writes its force, a second pass sums
};

/// Speed above which a step counts as diverged [m/s].
inline constexpr double divergence_speed = 1000.0;

/// A backend with a model loaded. After a divergence the state stays the last good one, and further advances
/// do nothing but report the same divergence again until load(). Calls come from one thread at a time; those
/// of a gpu solver, destruction apart, from the thread that made it: another gets the error no_device. Only
/// the flag of set_stop_flag() is for every thread.
class ASPIC_API Solver {
 public:
  virtual ~Solver();

  /// "reference", "gpu", …
  virtual std::string_view backend() const = 0;
  /// Device, force path, precision: one line for summaries.
  virtual std::string description() const = 0;
  virtual Precision precision() const = 0;  ///< that it computes in
  virtual const Model& model() const = 0;   ///< the one in use; set_constants() replaces it
  /// Bytes the solver holds for this model.
  virtual std::uint64_t bytes() const = 0;

  /// Takes over a state: rounds it to the solver's own precision, keeps its step number, forgets any
  /// divergence. Errors (usage): the state has another number of particles or balls, or a number that is not
  /// finite in that precision; then nothing changes.
  Status load(const State& state);
  /// The same of numbers that lie elsewhere, float or double with strides; every field must be there.
  Status load(const ConstStateView& view, std::uint64_t step);
  /// What acts from outside from the next step on, until it is called again. A new solver has none; load()
  /// leaves them as they are. Cheap enough for every image, ordered after the steps that advance() was
  /// asked for, and without a say in the state before the next step begins: state() is what it was. Errors
  /// (usage), which name the list and the index in it: a particle or ball that the model does not have, or
  /// that is listed twice; a released one that the scene does not pin; a number that is not finite or too
  /// large; a negative stiffness or damping; more than there may be. Then the inputs stay what they were.
  Status set_inputs(const Inputs& inputs);
  /// Those that hold, as the solver rounded them.
  const Inputs& inputs() const { return inputs_; }
  /// Goes over to another model with the same topology (check_same_topology()), so that only constants
  /// differ: of springs, masses, gravity, contact, terrain, balls, the time step and the solve's limits. From
  /// here on the bits are those of a new solver of that model which has load()ed this state and has the same
  /// inputs. Another time step h keeps the time: the step number becomes step_at_same_time(). Forgets a
  /// divergence; solve_statistics() count on. Error (usage): another topology, or inputs that the other model
  /// refuses; then nothing changes. Error (no_device): as advance().
  Status set_constants(SharedModel model);
  /// Advances by `steps`, or until a divergence or the stop flag ends them: the result says which, and how
  /// many were made. Error (no_device): the device was lost or ran out of memory; the solver is of no use
  /// from then on.
  virtual Result<Advance> advance(std::uint64_t steps) = 0;
  /// While `*flag` is true advance() ends early, and the state is that at the start of the step it was in.
  /// Null: never. Any thread may set the flag; it must stay true until advance() has returned, and outlive
  /// the calls. GPU solvers ignore it, since they queue their work.
  virtual void set_stop_flag(const std::atomic<bool>* flag) { flag_ = flag; }
  /// Figures of implicit Euler's solves since the last load(); nothing with other integrators.
  virtual std::optional<SolveStatistics> solve_statistics() { return std::nullopt; }
  /// A copy of the current state. Error (no_device): as advance().
  Result<State> state();
  /// Writes the fields of the current state that `view` has a place for, converted to the type of the place,
  /// and returns its step number. Errors: usage, a place has another size than the model; no_device, as
  /// advance().
  Result<std::uint64_t> read_into(const StateView& view);
  /// Where the current state lies, without a copy, in the solver's own precision: valid until the next call
  /// that is not const. Nothing where it lies on a device.
  virtual std::optional<ConstStateView> view() const { return std::nullopt; }

 protected:
  /// load() of a view of the right sizes.
  virtual Status take_state(const ConstStateView& view, std::uint64_t step) = 0;
  /// read_into() of a view of the right sizes.
  virtual Result<std::uint64_t> give_state(const StateView& view) = 0;
  /// Inputs for the next step: rounded, and others than inputs(), which are still the ones before.
  virtual Status take_inputs(const Inputs& inputs) = 0;
  /// A model with the same topology, which takes inputs(); the state's step number becomes `step`.
  virtual Status take_constants(SharedModel model, std::uint64_t step) = 0;
  /// The caller's flag, or null.
  const std::atomic<bool>* stop_flag() const { return flag_; }
  /// Whether advance() should end.
  bool interrupted() const { return flag_ && flag_->load(std::memory_order_relaxed); }
  /// Result of advance() for a solver that obeys the stop flag.
  static Advance ended(std::uint64_t made, std::uint64_t wanted,
                       const std::optional<Divergence>& divergence) {
    return {made, divergence, made < wanted && !divergence};
  }

 private:
  const std::atomic<bool>* flag_ = nullptr;
  Inputs inputs_;
};

/// Solver::advance() from the state of number `step`, where the solver is, with every step's inputs.
/// Afterwards the inputs of the next step are in effect, also where the steps ended early. Errors: those of
/// the solver.
ASPIC_API Result<Advance> advance(Solver& solver, const InputLog& log, std::uint64_t step,
                                  std::uint64_t steps);

}  // namespace aspic
