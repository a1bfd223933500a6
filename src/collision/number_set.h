#pragma once
// Sets of small numbers that are filled and emptied again and again.
#include <cstdint>
#include <vector>

namespace aspic::collision {

/// Numbers, each once however often it is added, in the order in which they came unless they are sorted.
class NumberSet {
 public:
  /// In time linear in what it holds.
  void clear() {
    for (const std::uint32_t number : added_) holds_[number] = false;
    added_.clear();
  }
  /// Returns whether it is new.
  bool add(std::uint32_t number) {
    if (number >= holds_.size()) holds_.resize(number + 1, false);
    if (holds_[number]) return false;
    holds_[number] = true;
    added_.push_back(number);
    return true;
  }
  const std::vector<std::uint32_t>& added() const { return added_; }
  void sort() {
    added_.clear();
    for (std::uint32_t n = 0; n < holds_.size(); ++n)
      if (holds_[n]) added_.push_back(n);
  }
  std::uint64_t bytes() const {
    return holds_.capacity() * sizeof(holds_[0]) + added_.capacity() * sizeof(added_[0]);
  }

 private:
  std::vector<char> holds_;
  std::vector<std::uint32_t> added_;
};

}  // namespace aspic::collision
