#pragma once
// Moves the solvers of a run forward.
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "aspic/inputs.h"
#include "base/result.h"
#include "playback/engines.h"
#include "playback/figures.h"
#include "playback/jobs.h"
#include "playback/pacer.h"
#include "playback/present.h"
#include "playback/timeline.h"

namespace aspic {

/// A leader in the context advances on this thread, in batches that keep within a frame; without it in jobs,
/// while the state it finished last is drawn.
class Stepper {
 public:
  /// The references must outlive it.
  Stepper(Present& present, Timeline& timeline, Jobs& jobs, Figures& figures, EngineFactory& factory)
      : present_(present), timeline_(timeline), jobs_(jobs), figures_(figures), factory_(factory) {}

  Pacer& pacer() { return pacer_; }
  const Pacer& pacer() const { return pacer_; }
  void set_running(bool running);
  bool running() const { return running_; }
  /// What acts from the next step on besides a log, which adds to it.
  struct Acts {
    std::optional<Pull> hand;                ///< nothing: it lets go
    std::map<std::string, double> channels;  ///< w by actuator that follows an input, whatever logs say
    Inputs followed;                         ///< of another run that this one follows
  };
  Acts& acts() { return acts_; }
  const Acts& acts() const { return acts_; }
  /// From the next step on a log's inputs at their steps, in addition to all others; an empty one: none.
  void replay(InputLog log) {
    log_ = std::make_shared<const InputLog>(std::move(log));
    resumed_ = false;
  }
  /// The same with the log of a run that is continued, which a start from the beginning forgets.
  void resume(InputLog log) {
    replay(std::move(log));
    resumed_ = true;
  }
  void forget_resumed() {
    if (resumed_) replay({});
  }
  const InputLog& log() const { return *log_; }
  /// What holds in the step that begins here: a log's, those that are followed, the hand's.
  Inputs inputs() const {
    return composed(acts_, present_.setup().pinned, present_.model(), *log_, present_.step());
  }
  /// Single steps that were asked for and not done.
  std::uint64_t single_steps() const { return single_steps_; }
  void ask_single_step() { ++single_steps_; }
  void drop_single_steps() { single_steps_ = 0; }
  void single_step_done() { --single_steps_; }
  /// A step takes so little time that the window can wait for it.
  bool steps_quickly() const;

  /// The steps that are due `dt` after the last call [s], for about `budget` seconds.
  Status advance(double dt, double budget);
  /// New steps up to this one at most.
  Status advance_to(std::uint64_t to, double budget);
  /// Steps of the history up to this one at most, with these inputs. The leader goes alone.
  Status repeat_to(std::uint64_t to, double budget, const Inputs& inputs);
  /// Reads the state back; of a backend outside the context the newest that is finished.
  Status refresh_snapshot();

  /// Another setup with its solvers; on an error nothing changes.
  Status install(Setup setup, Result<Engines> engines);
  /// Another solver is the leader.
  void leader_changed() { batch_ = 1; }
  Status load(const State& state);
  /// What comes after the present is no more: `now` is its time, as samples have it [s].
  void forget_future(double now);
  /// A run that uses the context continues without it from the last copy of its state; another returns the
  /// error.
  Status fall_back(const Error& error);

 private:
  Status prepare();
  Status advance_here(std::uint64_t steps, double budget);
  static Inputs composed(Acts acts, const std::map<std::uint32_t, bool>& by_hand, const Model& model,
                         const InputLog& log, std::uint64_t step);
  std::uint64_t next_change(std::uint64_t otherwise) const;
  void start_job(std::uint64_t to, double budget, const std::optional<Inputs>& repeated);
  Status take_up(JobResult result);
  Status follow(JobResult result);
  Status sample_here();
  void note(std::uint64_t steps, const std::optional<Divergence>& divergence);
  void reach(std::uint64_t step, const std::optional<Divergence>& divergence);

  Present& present_;
  Timeline& timeline_;
  Jobs& jobs_;
  Figures& figures_;
  EngineFactory& factory_;
  Pacer pacer_;
  Acts acts_;
  std::shared_ptr<const InputLog> log_ = std::make_shared<const InputLog>();  // jobs hold it too
  bool resumed_ = false, running_ = false;
  std::uint64_t single_steps_ = 0;
  std::uint64_t batch_ = 1;     // steps between two looks at the clock, of a backend in the context
  std::uint64_t job_to_ = 0;    // of the newest job
  std::uint64_t job_step_ = 0;  // where the solvers are; the jobs' own
};

}  // namespace aspic
