#pragma once
// A scene, a solver and the inputs so far.
#include <aspic/analysis.h>
#include <aspic/inputs.h>
#include <aspic/run.h>
#include <aspic/scene.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "convert.h"
#include "turns.h"

namespace aspic::python {

/// A backend's words with options. Error (usage).
BackendChoice choice_of(const std::string& words, std::optional<bool> doubles, unsigned threads);

/// How a video is made.
struct VideoWish {
  std::string path;  ///< of a video where it has an ending, else a directory of images
  std::uint64_t steps = 0;
  std::optional<double> fps;
  double speed = 1.0;
  ImageSize size;
  bool text = true, overwrite = false;
};

/// How a page for browsers is made.
struct PageWish {
  std::string path;
  std::uint64_t steps = 0;
  std::optional<double> fps;
  double speed = 1.0;
  bool live = false, overwrite = false;
  std::string command = {};  ///< that writes it too; empty: none does
};

/// Steps between two looks at signals and other threads: as many as take about a twentieth of a second.
class Chunk {
 public:
  std::uint64_t size() const { return size_; }
  void took(std::uint64_t steps, double seconds);

 private:
  std::uint64_t size_ = 1;
};

/// Every call is one thread's at a time, and waits for its turn without the GIL. Those that step or draw look
/// for signals between chunks of steps; what a signal raises leaves the state of a complete step. Errors are
/// thrown as LibraryError.
class Simulation {
 public:
  /// `doubles`: in double precision, absent: as the backend's words say.
  Simulation(Scene scene, const std::string& backend, std::optional<bool> doubles, unsigned threads);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  // What does not change, or no other thread changes.
  const Backend& backend() const { return backend_; }

  /// Runs f alone, without the GIL: it may not touch Python.
  template <class F>
  auto alone(const F& f) {
    const Unlocked others;
    const std::lock_guard turn(turns_);
    return f();
  }

  Scene scene();
  SharedModel model();
  std::uint64_t step();
  bool doubles() const { return backend_.solver->precision() == Precision::double_; }
  State state();
  /// As Solver::read_into().
  std::uint64_t read_into(const StateView& view);
  /// Error (usage): numbers of another model.
  void load(const State& state, const InputLog* log);
  Measures measures();
  /// Without elastic energy, as measure_motion().
  Measures motion();
  /// Of actuators up to this state: ActuatorWork::add().
  std::optional<double> add_work(ActuatorWork& work);
  StateQuantities quantities();
  /// A state with what belongs to it, for f(model, state, inputs), without the GIL.
  template <class F>
  void show(const F& f) {
    alone([&] { f(model_, state_alone(), backend_.solver->inputs()); });
  }

  /// The step that failed ends it, and stop().
  Advance advance(std::uint64_t steps);
  /// Ends what steps in another thread.
  void stop() { stop_ = true; }
  /// Figures of implicit Euler; nothing with other integrators.
  std::optional<SolveStatistics> solves();
  std::optional<Divergence> video(const VideoWish& wish);
  std::optional<Divergence> page(const PageWish& wish);
  /// The first step whose states differ, of so many; both advance until there.
  std::optional<std::uint64_t> compare(Simulation& other, std::uint64_t steps);

  /// A kind (solve, step, or Diagnostic::id), a body or nothing, a step and a sentence.
  using Warning = std::tuple<std::string, std::string, std::uint64_t, std::string>;
  /// All so far.
  std::vector<Warning> warnings();
  /// Those since the last call.
  std::vector<Warning> new_warnings();

  std::vector<std::byte> image(const std::vector<std::string>& view, const ImageSize& size, bool text);
  /// Another model of the same topology.
  void update(const std::vector<std::string>& overrides);

  Inputs inputs();
  void set_inputs(const Inputs& inputs);
  InputLog log();
  void set_log(InputLog log);
  std::string log_text();

  void write_state(const std::string& path, bool overwrite);
  void write_checkpoint(const std::string& path, bool overwrite);

  /// A field of the state in the solver's memory, which nothing may change until end_view(). Nothing: it lies
  /// on a device.
  std::optional<ConstVectors> begin_view(std::size_t field);
  void end_view() { --views_; }

 private:
  /// The current state into one that is empty or was read by this before.
  void read_alone(State& into);
  /// The current state, until the next call of it.
  const State& state_alone();
  void write_file(const std::string& option, const std::string& path, bool overwrite);
  void refuse_while_viewed() const;
  RunFacts facts_alone() const;
  void start(const BackendChoice& choice, bool& stopped);
  double time_alone() const { return static_cast<double>(step_) * scene_.model.simulation.timestep; }
  Advance advance_alone(std::uint64_t steps);
  void look_at_solves();
  void check_stopped(bool stopped) const;
  void keep(const std::vector<Diagnostic>& found);
  /// Steps to the next look at what may be wrong, and the look where it is due.
  std::uint64_t steps_to_look() const { return watch_->next_step(step_) - step_; }
  void look_alone(std::uint64_t before);
  /// Steps to `last`, with visit() at the steps that next_step() names, until a divergence, a signal or
  /// stop().
  template <class Next, class Visit>
  Result<std::optional<Divergence>> advance_visiting(std::uint64_t last, const Next& next_step,
                                                     const Visit& visit, bool& stopped);
  Result<std::optional<Divergence>> video_alone(const VideoWish& wish, bool& stopped);
  Result<std::optional<Divergence>> page_alone(const PageWish& wish, bool& stopped);

  Turns turns_;
  Scene scene_;
  SharedModel model_;
  std::optional<Meter> meter_;  // of model_, once energies were asked for
  Backend backend_;
  InputLog log_;
  std::uint64_t step_ = 0;
  std::optional<RunWatch> watch_;  // of model_
  bool state_set_ = false;         // since it last looked
  std::vector<Warning> warnings_;
  std::size_t told_ = 0;  // of these
  std::atomic<bool> stop_ = false;
  bool solves_told_ = false;
  std::atomic<int> views_ = 0;
  State state_;  // the latest that was measured or written; its memory is used again
  std::unique_ptr<StillPainter> painter_;  // after backend_, which it draws from
};

}  // namespace aspic::python
