#pragma once
// Device time by kind of pass, from time stamps between passes that are read when the device got there.
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <deque>
#include <string>
#include <vector>

#include "gpu/context.h"

namespace aspic::gl {

/// What one kind of pass took of a step.
struct PassTime {
  std::string name;
  double milliseconds = 0.0;  ///< device time in one step, mean over the recent steps that were measured
  double dispatches = 0.0;    ///< in one step, likewise
  double processor_milliseconds = 0.0;  ///< of all threads of this process, likewise; 0 without waiting
};

/// Whether every stamp waits until the device has done what was queued before it. Software rasterizers need
/// that: they draw an image tile by tile, all its passes together, and stamps in between mean nothing.
enum class PassStamps { queued, waiting };

/// Measures single steps, one at a time: a time stamp at the step's start and one after each dispatch, so
/// that an interval belongs to the dispatch at its end. Never waits for the device; steps that begin while
/// older results are still out are not measured. Its context must outlive it and be current.
class PassProfiler {
 public:
  /// Measured steps that the means are taken over, the last ones.
  static constexpr std::size_t window = 64;
  /// Dispatches of the longest step that is measured; a longer one is left out.
  static constexpr std::size_t most_dispatches = 16384;

  /// `names`: of the kinds of passes, which mark() counts from 0.
  PassProfiler(Context& context, std::vector<std::string> names, PassStamps stamps = PassStamps::queued);
  ~PassProfiler();
  PassProfiler(const PassProfiler&) = delete;
  PassProfiler& operator=(const PassProfiler&) = delete;

  /// Begins to measure a step, and forgets one that was begun and not ended; false, and nothing happens up to
  /// end(), while no place is free.
  bool begin();
  /// A dispatch of this kind has just been queued. Nothing happens outside a step that is measured.
  void mark(std::size_t kind);
  void end();

  /// Kinds that were dispatched in the recent steps, in the order of their names. Empty at first.
  std::vector<PassTime> times();

 private:
  struct HostTime {
    std::chrono::steady_clock::time_point time;
    std::clock_t processor = 0;
  };
  struct Sample {
    std::vector<std::uint32_t> queries;  // grows to the longest step so far; none with waiting
    std::vector<HostTime> host_times;    // with waiting
    std::vector<std::size_t> kinds;      // of each interval
  };
  struct Sum {
    std::uint64_t nanoseconds = 0;
    std::uint64_t dispatches = 0;
    double processor_seconds = 0.0;
    void add(const Sum& other) {
      nanoseconds += other.nanoseconds;
      dispatches += other.dispatches;
      processor_seconds += other.processor_seconds;
    }
  };
  void stamp(Sample& sample, std::size_t index);
  bool arrived(const Sample& sample) const;
  Sum interval(const Sample& sample, std::size_t index) const;
  void collect();

  Context& context_;
  std::vector<std::string> names_;
  PassStamps stamps_;
  std::array<Sample, 4> samples_;
  std::size_t first_ = 0, pending_ = 0;
  bool measuring_ = false;
  std::deque<std::vector<Sum>> steps_;  // by kind
};

}  // namespace aspic::gl
