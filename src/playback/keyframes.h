#pragma once
// States of a run that are kept, packed.
#include <cstdint>
#include <deque>
#include <variant>
#include <vector>

#include "aspic/state.h"

namespace aspic {

/// A state, packed in its own precision.
struct Keyframe {
  std::uint64_t step = 0;
  std::uint32_t particles = 0, balls = 0;
  std::variant<std::vector<float>, std::vector<double>> numbers;  ///< as for_each_vector() meets them
  std::uint64_t bytes() const;
};

Keyframe pack(const State& state);
State unpack(const Keyframe& keyframe);

/// Those of a run of one setup, in ascending order of steps.
class Keyframes {
 public:
  std::size_t count() const { return frames_.size(); }
  bool empty() const { return frames_.empty(); }
  const Keyframe& front() const { return frames_.front(); }
  /// A state later than the last one; one of the same step is not taken again. False: it was not taken.
  bool add(const State& state);
  /// The newest at or before `step`, which is none before the first one's.
  const Keyframe& before(std::uint64_t step) const;
  void drop_first();
  /// Drops every second one; the first stays.
  void thin();
  /// Drops those after `step`; the first stays.
  void forget_after(std::uint64_t step);
  std::uint64_t bytes() const { return bytes_; }

 private:
  std::deque<Keyframe> frames_;
  std::uint64_t bytes_ = 0;  // of frames_
};

}  // namespace aspic
