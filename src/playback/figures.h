#pragma once
// The figures of a run that plots show, measured as it goes.
#include <chrono>
#include <cstdint>
#include <vector>

#include "playback/jobs.h"
#include "playback/present.h"
#include "playback/samples.h"
#include "playback/timeline.h"

namespace aspic {

class Figures {
 public:
  /// The references must outlive it.
  Figures(const Present& present, Timeline& timeline, Jobs& jobs)
      : present_(present), timeline_(timeline), jobs_(jobs) {}

  const Samples& samples() const { return samples_; }
  Samples& samples() { return samples_; }

  /// The next step of which a backend in the context has energies.
  std::uint64_t next_step() const;
  /// Before and after a state is read for them: the stride follows from the time that takes. False: too many
  /// states wait to be measured.
  bool begin_reading();
  void end_reading();
  /// Measures a state in a job.
  void measure(const State& state);
  /// Measures the state that is shown, unless its energies are known.
  void complete();
  /// Keeps a state that was come to now and then, and energies.
  void remember(const State& state, const std::vector<EnergySample>& energies);
  /// There is another model.
  void restart_stride() { stride_ = 1; }

 private:
  void take_up(const State& state, const EnergySample& energies);

  const Present& present_;
  Timeline& timeline_;
  Jobs& jobs_;
  Samples samples_;
  /// Of a backend in the context: energies are those of every next_sample_step() with this stride, a
  /// power of two that keeps the time for reading states back low.
  std::uint64_t stride_ = 1;
  double read_seconds_ = 0.0;  // for the last energies
  std::chrono::steady_clock::time_point last_read_ = {};
};

}  // namespace aspic
