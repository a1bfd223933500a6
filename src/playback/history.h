#pragma once
// The run so far, so that any step can be restored: keyframes, and the inputs between them. Steps
// between two keyframes are simulated once more, which gives the same bits (docs/determinism.md).
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "aspic/inputs.h"
#include "aspic/state.h"
#include "playback/keyframes.h"
#include "playback/setup.h"

namespace aspic {

/// A step of the history. Stretches are numbered from the run's start and keep their numbers.
struct Moment {
  std::uint64_t stretch = 0;
  std::uint64_t step = 0;
  friend bool operator==(const Moment&, const Moment&) = default;
};

/// A part of the run with the same setup throughout.
struct Stretch {
  Setup setup;
  std::uint64_t first = 0, last = 0;  ///< restorable steps
  Keyframes keyframes;                ///< not empty; the first one is of step `first`
  InputLog inputs;
  std::uint64_t bytes() const { return inputs.bytes() + keyframes.bytes(); }
  double timestep() const { return setup.settings.simulation.timestep; }
  double time(std::uint64_t step) const { return static_cast<double>(step) * timestep(); }
};

class History {
 public:
  /// The oldest steps are dropped once more than `most_bytes` are held.
  explicit History(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

  void clear();
  bool empty() const { return stretches_.empty(); }

  /// The run continues from this state with another setup. A stretch without a step is replaced. `same`: the
  /// history ends with this state.
  void begin(const Setup& setup, const State& state, bool same = false);
  /// The last stretch has come to this step.
  void reach(std::uint64_t step);
  /// A state of the last stretch, later than the last keyframe; one of the same step is not taken again.
  void add_keyframe(const State& state);
  /// From this step on the last stretch has these inputs.
  void set_inputs(std::uint64_t step, Inputs inputs);
  /// Does with `bytes` if keyframes that lie between others suffice for that: the same steps can be had, some
  /// after more steps from the keyframe before them. Else the oldest steps are dropped too.
  void thin(std::uint64_t bytes);
  /// Forgets whatever came after `moment`, which becomes the end.
  void truncate(const Moment& moment);

  /// All of the following need a history that is not empty.
  Moment begin_moment() const;
  Moment end_moment() const;
  const Stretch& stretch(std::uint64_t number) const;
  double time(const Moment& moment) const { return stretch(moment.stretch).time(moment.step); }
  /// One step earlier or later; nothing at the ends. Where one stretch ends and the next begins is one
  /// moment, that of the next.
  std::optional<Moment> before(const Moment& moment) const;
  std::optional<Moment> after(const Moment& moment) const;
  /// The moment nearest to a time [s].
  Moment nearest(double time) const;
  /// The newest keyframe at or before `moment`, within its stretch.
  const Keyframe& keyframe(const Moment& moment) const;
  /// The newest keyframe's moment that is at least `count` keyframes before `moment`; else the beginning.
  Moment keyframes_before(const Moment& moment, std::size_t count) const;
  /// Those of the step that starts at `moment`.
  const Inputs& inputs_at(const Moment& moment) const;
  /// The first step after `moment`'s, within its stretch, that starts with others; nothing if none.
  std::optional<std::uint64_t> next_input_change(const Moment& moment) const;
  /// Times at which the setup changed, oldest first [s].
  std::vector<double> changes() const;

  std::uint64_t bytes() const;
  std::uint64_t most_bytes() const { return most_bytes_; }
  std::size_t keyframe_count() const;

 private:
  Stretch& last() { return stretches_.back(); }
  void drop_oldest();
  Moment canonical(Moment moment) const;

  std::uint64_t most_bytes_;
  std::uint64_t first_number_ = 0;  // of stretches_.front()
  std::deque<Stretch> stretches_;
};

}  // namespace aspic
