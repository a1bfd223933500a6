#pragma once
// Which balls are near a point: candidates that an exact test then judges. Balls sorted along x leave few;
// where that leaves many, a grid of cells hashed into buckets does, so that balls spread out cost no more
// than their number.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "cpu_reference/vectors.h"

namespace aspic::reference {

/// Bodies' partners, body after body, each in ascending index.
struct Contacts {
  std::vector<std::size_t> start;     ///< of each body's partners; one more entry than bodies
  std::vector<std::uint32_t> other;   ///< the partners
  std::vector<std::uint8_t> acting;   ///< of each pair: it takes part in the phase of velocities
  std::vector<std::uint8_t> overlap;  ///< of each pair: its gap is negative

  void clear() {
    start.assign(1, 0);
    other.clear();
    overlap.clear();
  }
  void add(std::uint32_t partner, bool overlaps) {
    other.push_back(partner);
    overlap.push_back(overlaps);
  }
  /// The partners of the next body have been added.
  void end_body() { start.push_back(other.size()); }
};

/// The balls that take part in a step, for one step.
template <class T>
class BallSearch {
 public:
  /// `balls`: ascending indices of balls with finite positions `x`; `reach`: largest radius + ε [m].
  BallSearch(const Field<T>& x, const std::vector<std::uint32_t>& balls, double reach) : reach_(reach) {
    along_x_.reserve(balls.size());
    for (const std::uint32_t b : balls) along_x_.push_back({x(0, b), b});
    std::sort(along_x_.begin(), along_x_.end());
    if (slabs_are_full()) fill_grid(x, balls);
  }

  bool empty() const { return along_x_.empty(); }

  /// Calls take(b) for every ball whose surface may be within ε of that of a ball at x (`of_ball`) or of x,
  /// in no particular order.
  template <class Take>
  void candidates(const Vector<T>& x, bool of_ball, const Take& take) const {
    if (entries_.empty()) {
      // A relative margin far above rounding keeps every pair that the exact test would take.
      const double reach = 1.001 * (of_ball ? 2.0 * reach_ : reach_);
      const double from = static_cast<double>(x(0)) - reach, to = static_cast<double>(x(0)) + reach;
      auto at = std::lower_bound(along_x_.begin(), along_x_.end(), from, [](const auto& entry, double limit) {
        return static_cast<double>(entry.first) < limit;
      });
      for (; at != along_x_.end() && static_cast<double>(at->first) <= to; ++at) take(at->second);
      return;
    }
    // A ball reaches less than one cell, a particle less than half of one.
    const Cell home = cell_of(x, of_ball ? -1.0 : -0.5);
    const std::int64_t span = of_ball ? 3 : 2;
    for (std::int64_t i = 0; i < span * span * span; ++i) {
      const Cell cell = {home[0] + i % span, home[1] + i / span % span, home[2] + i / (span * span)};
      const std::size_t bucket = bucket_of(cell);
      for (std::size_t e = bucket_start_[bucket]; e < bucket_start_[bucket + 1]; ++e) {
        if (entries_[e].cell == cell) take(entries_[e].ball);
      }
    }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Entry {
    Cell cell;
    std::uint32_t ball = 0;
  };
  /// Candidates along x that a ball may have on average; a grid's 27 cells cost about as much.
  static constexpr std::size_t few = 32;
  /// Cells past these are one with those at the edge; within, rounding moves no body by a tenth of a cell.
  static constexpr double farthest_cell = 1e12;

  bool slabs_are_full() const {
    std::size_t pairs = 0, first = 0;
    for (std::size_t last = 0; last < along_x_.size(); ++last) {
      const double from = static_cast<double>(along_x_[last].first) - 2.0 * reach_;
      while (static_cast<double>(along_x_[first].first) < from) ++first;
      pairs += 2 * (last - first);
    }
    return pairs > few * along_x_.size();
  }

  void fill_grid(const Field<T>& x, const std::vector<std::uint32_t>& balls) {
    cells_per_metre_ = 1.0 / (2.5 * reach_);
    mask_ = std::bit_ceil(2 * balls.size()) - 1;
    std::vector<Cell> cells;
    cells.reserve(balls.size());
    for (const std::uint32_t b : balls) cells.push_back(cell_of(x.col(b), 0.0));
    bucket_start_.assign(mask_ + 2, 0);
    for (const Cell& cell : cells) ++bucket_start_[bucket_of(cell) + 1];
    std::partial_sum(bucket_start_.begin(), bucket_start_.end(), bucket_start_.begin());
    std::vector<std::size_t> next(bucket_start_.begin(), bucket_start_.end() - 1);
    entries_.resize(balls.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      entries_[next[bucket_of(cells[i])]++] = {cells[i], balls[i]};
    }
  }

  Cell cell_of(const Vector<T>& x, double shift) const {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
      const double in_cells = static_cast<double>(x(axis)) * cells_per_metre_;
      cell[static_cast<std::size_t>(axis)] =
          static_cast<std::int64_t>(std::floor(std::clamp(in_cells, -farthest_cell, farthest_cell) + shift));
    }
    return cell;
  }

  std::size_t bucket_of(const Cell& cell) const {
    std::uint64_t hash = static_cast<std::uint64_t>(cell[0]) * 73856093u ^
                         static_cast<std::uint64_t>(cell[1]) * 19349663u ^
                         static_cast<std::uint64_t>(cell[2]) * 83492791u;
    hash ^= hash >> 15;
    return hash & mask_;
  }

  double reach_, cells_per_metre_ = 0.0;
  std::vector<std::pair<T, std::uint32_t>> along_x_;
  std::size_t mask_ = 0;
  std::vector<std::size_t> bucket_start_;
  std::vector<Entry> entries_;  // of the grid, bucket by bucket, ascending; empty without one
};

}  // namespace aspic::reference
