#pragma once
// The model of a run with the solvers that advance it.
#include <atomic>
#include <cassert>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aspic/analysis.h"
#include "aspic/inputs.h"
#include "aspic/solver.h"
#include "aspic/state.h"
#include "base/result.h"
#include "gpu/context.h"
#include "playback/samples.h"
#include "playback/setup.h"
#include "run/backends.h"
#include "run/window_host.h"

namespace aspic {

/// What a solver did in a job.
struct Advanced {
  State state;
  std::optional<Divergence> divergence;
};

/// What a worker's job leaves: steps done, or the energies of a state.
struct JobResult {
  std::uint64_t steps = 0;
  Advanced leader, shadow;             ///< each where it took part
  std::vector<EnergySample> energies;  ///< of the one that set the pace, at each next_sample_step()
  Inputs inputs;                       ///< of these steps
};

/// How far a job of steps goes.
struct JobLimits {
  std::uint64_t from = 0, to = 0;  ///< steps of the run; `from` is where the solvers are
  double seconds = 0.0;            ///< no step begins later than this after the first
  bool alone = false;              ///< the leader goes without its shadow
};

/// A model, the solver whose state is shown, and in shadow mode a second one that does the same steps.
class Engines {
 public:
  Engines() = default;
  Engines(SharedModel model, Backend leader, Backend shadow)
      : model_(std::move(model)),
        meter_(std::make_unique<Meter>(*model_)),
        leader_(std::move(leader)),
        shadow_(std::move(shadow)) {}

  /// In what these engines are not like those they replace, in a sentence; nothing: in nothing.
  std::optional<Error> departure;

  const Model& model() const { return *model_; }
  const SharedModel& shared_model() const { return model_; }
  const Backend& leader() const { return leader_; }
  const Backend& shadow() const { return shadow_; }
  bool shadowed() const { return shadow_.solver != nullptr; }
  /// A solver computes in the window's context, on the window's thread.
  bool use_context() const { return in_context(leader_) || in_context(shadow_); }
  /// All solvers do.
  bool only_context() const { return in_context(leader_) && (!shadowed() || in_context(shadow_)); }
  /// A worker's job advances the shadow, and the leader follows in the context.
  bool shadow_paces() const { return in_context(leader_) && shadowed() && !in_context(shadow_); }
  static bool in_context(const Backend& engine) { return engine.row && engine.row->needs_context; }
  /// One of the solvers on the context, to share buffers with; may be null.
  const GpuSolver* gpu() const {
    const GpuSolver* const leader = gpu_of(leader_);
    return leader ? leader : gpu_of(shadow_);
  }

  /// Puts another solver of the same model in the place of one; it has no inputs yet.
  void set_leader(Backend engine) { leader_ = std::move(engine); }
  /// Of another backend than the leader's: next to its like a shadow would show nothing.
  void set_shadow(Backend engine) {
    assert(!engine.row || engine.row != leader_.row);
    shadow_ = std::move(engine);
  }
  void swap() { std::swap(leader_, shadow_); }
  /// The energies of a state of the model; one call at a time.
  EnergySample measured(const State& state) const;
  Status load(const State& state);
  Status set_inputs(const Inputs& inputs);
  /// Both go over to another model of the same topology. Errors: those of Solver::set_constants().
  Status set_constants(SharedModel model);

  /// For a worker: advances the solvers that do without the context, until `canceled` at most, which drops
  /// the step in progress. The first of them sets the pace.
  Result<JobResult> advance_outside(const JobLimits& limits, const std::atomic<bool>& canceled);
  /// With the context: the solver of shadow mode that did not takes the steps of an outcome too, if it needs
  /// the context.
  Status follow(JobResult& outcome);

 private:
  SharedModel model_;
  std::unique_ptr<Meter> meter_;  // of the model
  Backend leader_, shadow_;
};

class EngineFactory {
 public:
  /// `asked`: what solvers that have it are asked for, besides their row.
  explicit EngineFactory(gl::Context& context, const BackendChoice& asked = {})
      : context_(&context), asked_(asked) {}
  void set_context(gl::Context& context);
  /// Errors: of make_backend().
  Result<Backend> make(const SharedModel& model, const BackendRow& row, const GpuSolver* like);
  /// A model with solvers on the same backends as `like`. Where a leader in the context refuses the model the
  /// contextless_backend() takes its place without a shadow, as `departure` says. Without solvers in the
  /// context it may run on another thread.
  Result<Engines> make_like(const Engines& like, const SharedModel& model);
  /// Builds the setup's model first. Errors: also those of build_model().
  Result<Engines> make_like(const Engines& like, const Setup& setup);

 private:
  gl::Context* context_;
  BackendChoice asked_;
  std::optional<gl::Arithmetic> arithmetic_;  // what the canary found once; the device does not change
};

}  // namespace aspic
