#pragma once
// What the plots show of a run: energies, and the difference of two backends.
#include <cstdint>
#include <deque>
#include <optional>

#include "aspic/analysis.h"
#include "aspic/state.h"

namespace aspic {

/// Energies at one time, a point of the plot.
struct EnergySample {
  double time = 0.0;  ///< [s]
  Measures measures;
  std::uint64_t step = 0;
  ActuatorWork actuators = {};      ///< of this state alone: 16 bytes for each class of springs that act
  std::optional<double> work = {};  ///< of actuators since the first sample [J], which Samples adds up
};

/// How far the two backends of shadow mode were apart at one time.
struct DifferenceSample {
  double time = 0.0;       ///< [s]
  double meters = 0.0;     ///< largest |difference| of a position's component; infinite if one alone diverged
  std::uint64_t ulp = 0;   ///< largest distance of any component of the state
  bool identical = false;  ///< every bit is the same
};

/// The first step after `step` that has a point of the plot during a run: the steps nearest to
/// multiples of `stride` · 0.02 s, so that runs of different time steps [s] have points at the same times, to
/// half a step; every `stride`-th step where that is about as long.
std::uint64_t next_sample_step(std::uint64_t step, double timestep, std::uint64_t stride = 1);

/// Samples in the order of time, one for each.
class Samples {
 public:
  /// Of more than most_energies those with the least and the largest of each quantity stay, in intervals of
  /// one length over the whole run: peaks keep their height.
  const std::deque<EnergySample>& energies() const { return energies_; }
  static constexpr std::size_t most_energies = 40'000;
  /// The one that is nearest to a time of the run [s]; null if there is none.
  const EnergySample* nearest(double time) const;
  const std::deque<DifferenceSample>& differences() const { return differences_; }
  /// Since shadow mode began, or the last change of setup.
  bool ever_differed() const { return ever_differed_; }

  /// Takes the place of one at the same time.
  void add(const EnergySample& sample);
  /// Compares the states of two backends at a time of the run [s], of which one alone may have diverged.
  void compare(double time, const State& leader, const State& shadow, bool one_diverged);
  /// Forgets what came after a time [s].
  void truncate(double time);
  void clear_differences();
  void clear_differed() { ever_differed_ = false; }
  void clear();

 private:
  void add_up_work(std::size_t from);
  void thin();

  std::deque<EnergySample> energies_;
  std::deque<DifferenceSample> differences_;
  bool ever_differed_ = false;
};

}  // namespace aspic
