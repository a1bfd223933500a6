#pragma once
// The past of a run, where in it the run is, and where it is on its way to.
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

#include "playback/history.h"
#include "playback/present.h"

namespace aspic {

class Timeline {
 public:
  /// `present` must outlive it.
  explicit Timeline(const Present& present);

  const History& history() const { return history_; }
  History& history() { return history_; }
  Moment here() const { return {stretch_, present_.step()}; }
  bool at_end() const { return here() == history_.end_moment(); }
  /// The history ended with a divergence, wherever in it this is.
  bool ends_diverged() const { return present_.divergence() || ended_; }

  /// The run is on its way to this step of its stretch; else nothing.
  const std::optional<std::uint64_t>& destination() const { return destination_; }
  bool seeking() const { return destination_.has_value(); }
  void set_out(std::uint64_t destination) { destination_ = destination; }
  /// The way ends where it is.
  void stop() { destination_.reset(); }

  void clear();
  /// The run continues with the present setup from this state, where it is. `same`: the history ends with it.
  void begin(const State& state, bool same = false);
  /// The run is in another stretch of the same history, or of another history.
  void move_to(std::uint64_t stretch) { stretch_ = stretch; }
  void replace(History history);
  /// What comes after the present is no more.
  void forget_future();
  /// The run leaves the end: should it have diverged there, it has when it comes back.
  void remember_end();
  /// How the history ended, if the present is its end.
  std::optional<Divergence> end() const;
  /// A state that was come to is kept, now and then.
  void keep(const State& state);

 private:
  const Present& present_;
  History history_;
  std::uint64_t stretch_ = 0;
  std::optional<std::uint64_t> destination_;
  std::optional<std::pair<Moment, Divergence>> ended_;  // how the history ended, while elsewhere in it
  std::chrono::steady_clock::time_point last_kept_ = {};
};

}  // namespace aspic
