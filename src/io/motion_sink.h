#pragma once
// What files of a motion have in common: which of a run's states are their samples.
#include <cstdint>
#include <optional>
#include <string>

#include "io/state_sink.h"

namespace aspic {

/// The samples of a run, without an interval of their own about one every 0.02 s. A format derives from it
/// with what it does with a sample, and when they are complete.
class MotionSink : public StateSink {
 public:
  /// Which steps are samples besides the first.
  enum class Raster {
    multiples,  ///< those that the interval divides, and the last
    even        ///< all as far apart; the last one only if it is so too
  };
  /// `every`: steps; 0: as above.
  MotionSink(std::string path, std::uint64_t every, Raster raster = Raster::multiples)
      : StateSink(std::move(path), every), raster_(raster) {}

  std::uint64_t next_step(std::uint64_t step) const final;
  /// Errors: those of add(); usage, an even raster is not: samples come to lie more than a step nearer or
  /// farther apart than the first two.
  Status take(const Sample& sample) final;
  Status finish(const Sample& last) final;

 protected:
  /// Takes a sample, each of another step. Errors: io; diverged if a number is not finite.
  virtual Status add(const Sample& sample) = 0;
  /// Completes the output; at least one sample was added.
  virtual Status complete(const Sample& last) = 0;
  /// Samples so far, and the steps of the first and the last of them.
  std::uint64_t samples() const { return samples_; }
  std::uint64_t first_step() const { return first_; }
  std::uint64_t last_step() const { return last_; }

 private:
  bool is_even(std::uint64_t step) const;

  Raster raster_;
  std::uint64_t interval_ = 0, samples_ = 0, first_ = 0, last_ = 0, spacing_ = 0;
};

/// Error (usage): the path is a device or a pipe, which cannot hold a motion.
Status check_export_name(const std::string& path);

}  // namespace aspic
