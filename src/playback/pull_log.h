#pragma once
// What hands did to a run, by step.
#include <cstdint>
#include <optional>
#include <vector>

#include "model/pull.h"

namespace aspic {

class PullLog {
 public:
  /// A pull that began, moved or (nothing) ended with the step that starts at `step`.
  struct Entry {
    std::uint64_t step = 0;
    std::optional<Pull> pull;
  };

  /// The pull from this step on; those of this step and later ones are forgotten.
  void set(std::uint64_t step, const std::optional<Pull>& pull);
  /// Forgets all from this step on.
  void forget_from(std::uint64_t step);
  /// That of the step that starts at `step`; before the first entry there is none.
  std::optional<Pull> at(std::uint64_t step) const;
  /// The first step after `step` that starts with another pull; nothing if none.
  std::optional<std::uint64_t> next_change(std::uint64_t step) const;
  std::uint64_t bytes() const { return sizeof(Entry) * entries_.size(); }

 private:
  std::vector<Entry> entries_;  // ascending, at most one a step
};

}  // namespace aspic
