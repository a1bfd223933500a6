#pragma once
// Many models stepped together: parameter studies, populations, environments of reinforcement learning.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "aspic/error.h"
#include "aspic/export.h"
#include "aspic/inputs.h"
#include "aspic/model.h"
#include "aspic/solver.h"
#include "aspic/state_view.h"

namespace aspic {

/// How a batch computes.
struct BatchOptions {
  unsigned threads = 0;  ///< 1 to 1024; 0: as many as there are processors, or ASPIC_THREADS
};

/// What Batch::run() records, besides the time.
struct BatchQuantities {
  bool center_of_mass = true;            ///< of all particles, pinned ones too, without balls
  bool momentum = false;                 ///< Measures::momentum, balls included
  bool energies = false;                 ///< those of Measures, balls included
  std::optional<std::size_t> body = {};  ///< positions of this body of particle_ranges(), which all must have
  bool actuator_work = false;            ///< ActuatorWork over the recorded states
};

/// Arrays of a recorded run, row-major: the last index is that of neighbors in memory. Those that were not
/// asked for are empty. In the rows after a divergence the last good state is repeated, its time too.
struct BatchRecord {
  std::size_t instances = 0, times = 0;  ///< how many
  std::size_t particles = 0;             ///< of the body whose positions are recorded
  std::vector<double> time;              ///< (instances, times): step · h of the instance [s]
  std::vector<double> center_of_mass;    ///< (instances, times, 3) [m]
  std::vector<double> momentum;          ///< (instances, times, 3) [N·s]
  std::vector<double> energy;            ///< (instances, times, 3): kinetic, elastic, gravitational [J]
  std::vector<double> actuator_work;     ///< (instances, times) [J]; 0 without actuators
  std::vector<float> positions;          ///< (instances, times, particles, 3) [m]
  std::vector<std::uint64_t> diverged;   ///< (instances): Divergence::step; 0: it did not
  std::vector<std::uint64_t> hash;       ///< (instances): state_hash() of the last state
};

/// Models that are stepped together on the processor, equal ones and others in any mixture, without contact
/// between them. Each instance has its own state, step number, constants, gravity, inputs and divergence, and
/// the bits of a solver that has its model alone (docs/determinism.md), whatever the others are and however
/// many threads compute. Models with the same topology and time step, an explicit method, at most 2,048
/// particles and no balls are the fastest: 16 of them share the lanes of the vector registers.
///
/// Instances are numbered from 0 in the order of create(); every call that takes a number has the error usage
/// for one that there is not. Nothing given out refers to memory of the batch. Calls may come from any
/// thread, one at a time; only the flag of set_stop_flag() is for all.
class ASPIC_API Batch {
 public:
  /// A batch at its models' initial states, in single precision and exact arithmetic. Models may be the same
  /// object, which saves making them. Errors: usage, no model, one is null, more than 1,024 threads or
  /// ASPIC_THREADS is no number of them; scene_rejected, no memory left.
  static Result<Batch> create(std::vector<SharedModel> models, const BatchOptions& options = {});
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;
  ~Batch();

  std::size_t size() const;  ///< instances
  /// How it computes, in one line: instances, how they are put together, threads, instruction set.
  std::string description() const;
  /// Bytes that it holds, the models apart.
  std::uint64_t bytes() const;

  /// Every instance by `steps`; fewer only where it diverges, while the others go on, and while the stop flag
  /// is set: then instances may be at different steps. One that has diverged stays at its last good state
  /// until load(), reset() or set_constants(). Returns how many are diverged.
  Result<std::size_t> advance(std::uint64_t steps);
  /// Advances every instance for `duration` [s] ≥ 0 from where it is and records it at the start, every
  /// `interval` [s] > 0 and at the end: ⌈duration/interval⌉ + 1 rows, each at the step nearest to its time.
  /// Errors: usage, other numbers, more than 2⁵³ steps, or a body that not all have with as many particles;
  /// scene_rejected, no memory for the record; interrupted, the stop flag was set.
  Result<BatchRecord> run(double duration, double interval, const BatchQuantities& quantities = {});
  /// Back to the initial states of their models, step 0, those whose number in `mask` is not 0; an empty mask
  /// means all. Inputs and constants stay. Error (usage): a mask of another size.
  Status reset(std::span<const std::uint8_t> mask = {});
  /// While `*flag` is true advance() and run() end early, each instance at the end of a step. Null: never.
  /// Any thread may set the flag; it must outlive the calls.
  void set_stop_flag(const std::atomic<bool>* flag);

  /// The model in use: the one of create() or of set_constants().
  Result<SharedModel> model(std::size_t instance) const;
  /// How it diverged, while it stays so.
  Result<std::optional<Divergence>> divergence(std::size_t instance) const;
  /// A copy of the state.
  Result<State> state(std::size_t instance) const;
  /// As Solver::read_into(): writes the fields with a place and returns the step number.
  Result<std::uint64_t> read_into(std::size_t instance, const StateView& view) const;
  /// As Solver::load(); errors (usage) as there.
  Status load(std::size_t instance, const State& state);
  Status load(std::size_t instance, const ConstStateView& view, std::uint64_t step);  ///< the same
  /// As Solver::set_inputs(); errors (usage) as there.
  Status set_inputs(std::size_t instance, const Inputs& inputs);
  /// As Solver::set_constants(), for stiffness, masses, gravity and the like; errors (usage) as there. An
  /// instance that gets another time step than those it computes with leaves them, and is slower from then
  /// on.
  Status set_constants(std::size_t instance, SharedModel model);

 private:
  struct Parts;
  explicit Batch(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace aspic
