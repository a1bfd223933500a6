#pragma once
// A batch with the scenes and inputs of its instances.
#include <aspic/analysis.h>
#include <aspic/batch.h>
#include <aspic/inputs.h>
#include <aspic/run.h>
#include <aspic/scene.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "convert.h"
#include "turns.h"

namespace aspic::python {

/// By instance. A scene may be that of several.
struct Contents {
  aspic::Batch batch;
  std::vector<std::shared_ptr<const Scene>> scenes;
  std::vector<Inputs> inputs;
  std::map<std::size_t, Meter> meters = {};  ///< of those whose energies were asked for
};

/// (instances, vectors, 3).
struct Gathered {
  std::size_t instances = 0, vectors = 0;
  std::vector<float> numbers;
};

/// Every call is one thread's at a time, and waits for its turn without the GIL; on the main thread a signal
/// ends that wait. Errors are thrown as LibraryError.
class Batch {
 public:
  /// Instance i has scene `which[i]` of those, a model for each.
  Batch(std::vector<Scene> scenes, const std::vector<std::size_t>& which, unsigned threads);
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  /// f(Contents&) alone, without the GIL: it may not touch Python.
  template <class F>
  auto alone(const F& f) {
    const Unlocked others;
    if (!turns_.lock_unless(signalled)) raise();
    const std::lock_guard turn(turns_, std::adopt_lock);
    return f(*contents_);
  }
  /// Ends advance() and run(), from any thread.
  void stop() { stop_ = true; }
  /// How many are diverged. Error (interrupted): stop().
  std::size_t advance(std::uint64_t steps);
  BatchRecord run(double duration, double interval, const BatchQuantities& quantities);
  /// A field of all instances. Error (usage): they have different numbers of vectors.
  Gathered gather(std::size_t field);

 private:
  /// f(contents), which looks at the stop flag, on another thread: this one looks for signals, without the
  /// GIL. What one raises sets the flag, and is thrown at the end.
  template <class F>
  static auto watched(std::atomic<bool>& stop, Contents& contents, const F& f) {
    auto work = std::async(std::launch::async, [&] { return f(contents); });
    while (work.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
      if (!signalled()) continue;
      stop = true;
      work.wait();
      raise();
    }
    return work.get();
  }
  /// What a signal's handler raised.
  [[noreturn]] static void raise();

  Turns turns_;
  std::atomic<bool> stop_ = false;
  std::uint64_t brief_ = 0;  // so many steps take too little time for another thread
  std::optional<Contents> contents_;
};

/// One of them. The batch must outlive it.
class Instance {
 public:
  Instance(Batch& batch, std::size_t number) : batch_(batch), number_(number) {}

  Scene scene();
  SharedModel model();
  std::uint64_t step();
  bool doubles() const { return false; }
  State state();
  Measures measures();
  /// Without elastic energy, as measure_motion().
  Measures motion();
  std::optional<double> add_work(ActuatorWork& work);
  StateQuantities quantities();
  std::uint64_t read_into(const StateView& view);
  std::optional<Divergence> divergence();
  /// With the inputs that the log has for its step. Error (usage): numbers of another model.
  void load(const State& state, const InputLog* log);
  void update(const std::vector<std::string>& overrides);
  /// Another scene, of a model of the same topology.
  void set_scene(const Scene& scene);
  Inputs inputs();
  void set_inputs(const Inputs& inputs);
  /// The present inputs alone, from this step on.
  InputLog log();

 private:
  Batch& batch_;
  std::size_t number_;
};

}  // namespace aspic::python
