#pragma once
// Reductions as trees over fixed blocks of 256 elements (docs/determinism.md): the sum of n numbers does not
// depend on how many threads or work groups shared the work, on any backend.
#include <cstddef>
#include <vector>

namespace aspic::physics {

inline constexpr std::size_t reduction_block = 256;

/// Combines the elements of each block of 256 by halving (0 with 128, 1 with 129, … then 0 with 64, …),
/// missing elements counting as zero, then the blocks' results in the same way until one is left. Zero if
/// there are no elements.
template <class T, class Combine>
T tree_reduce(std::vector<T> values, Combine combine) {
  while (values.size() > 1) {
    std::vector<T> blocks;
    for (std::size_t first = 0; first < values.size(); first += reduction_block) {
      T block[reduction_block] = {};
      for (std::size_t i = 0; i < reduction_block && first + i < values.size(); ++i)
        block[i] = values[first + i];
      for (std::size_t half = reduction_block / 2; half > 0; half /= 2) {
        for (std::size_t i = 0; i < half; ++i) block[i] = combine(block[i], block[i + half]);
      }
      blocks.push_back(block[0]);
    }
    values = std::move(blocks);
  }
  return values.empty() ? T(0) : values.front();
}

template <class T>
T tree_sum(std::vector<T> values) {
  return tree_reduce<T>(std::move(values), [](T a, T b) { return a + b; });
}

/// Largest element; elements must not be negative.
template <class T>
T tree_max(std::vector<T> values) {
  return tree_reduce<T>(std::move(values), [](T a, T b) { return b > a ? b : a; });
}

/// The sum over a body's partners: blocks of 256, one partner after the other, each from zero; then the
/// blocks' sums, one after the other from the first. So up to 256 partners make a plain sum.
template <class V>
class PartnerSum {
 public:
  explicit PartnerSum(const V& zero) : zero_(zero), block_(zero), total_(zero) {}

  void add(const V& value) {
    block_ += value;
    if (++in_block_ == reduction_block) end_block();
  }
  V total() {
    if (in_block_ > 0) end_block();
    return total_;
  }

 private:
  void end_block() {
    total_ = first_ ? block_ : V(total_ + block_);
    first_ = false;
    block_ = zero_;
    in_block_ = 0;
  }
  V zero_, block_, total_;
  std::size_t in_block_ = 0;
  bool first_ = true;
};

}  // namespace aspic::physics
