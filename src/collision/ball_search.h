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

#include "physics/particle_view.h"
#include "physics/vectors.h"

namespace aspic::collision {

using namespace physics;

/// The balls that take part in a step, for one step.
template <class T>
class BallSearch {
 public:
  /// `balls`: ascending indices of balls with finite positions `x`, which must outlive this; `reach`: largest
  /// radius + ε [m].
  BallSearch(const Field<T>& x, const std::vector<std::uint32_t>& balls, double reach)
      : x_(x), reach_(reach) {
    along_x_.reserve(balls.size());
    for (const std::uint32_t b : balls) along_x_.push_back({x(0, b), b});
    std::sort(along_x_.begin(), along_x_.end());
    if (slabs_are_full()) fill_grid(x, balls);
  }

  bool empty() const { return along_x_.empty(); }

  /// False only if the surfaces of all balls are further than ε from the box.
  bool any_near(const SearchBox<T>& box) const {
    const double reach = margin * reach_;
    const auto within = [&](std::uint32_t ball, std::size_t axis) {
      const auto x = static_cast<double>(x_(static_cast<Eigen::Index>(axis), ball));
      return x >= static_cast<double>(box.min[axis]) - reach &&
             x <= static_cast<double>(box.max[axis]) + reach;
    };
    for (auto at = first_from(static_cast<double>(box.min[0]) - reach);
         at != along_x_.end() && within(at->second, 0); ++at) {
      if (within(at->second, 1) && within(at->second, 2)) return true;
    }
    return false;
  }

  /// Calls take(b) for every ball whose surface may be within ε of that of a ball at x (`of_ball`) or of x,
  /// in no particular order.
  template <class Take>
  void candidates(const Vector<T>& x, bool of_ball, const Take& take) const {
    if (entries_.empty()) {
      const double reach = margin * (of_ball ? 2.0 * reach_ : reach_), at_x = static_cast<double>(x(0));
      for (auto at = first_from(at_x - reach);
           at != along_x_.end() && static_cast<double>(at->first) <= at_x + reach; ++at)
        take(at->second);
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
  /// A relative margin far above rounding keeps every pair that the exact test would take.
  static constexpr double margin = 1.001;
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

  /// The first ball along x that is not below `from`.
  auto first_from(double from) const {
    return std::lower_bound(along_x_.begin(), along_x_.end(), from, [](const auto& entry, double limit) {
      return static_cast<double>(entry.first) < limit;
    });
  }

  void fill_grid(const Field<T>& x, const std::vector<std::uint32_t>& balls) {
    cells_per_meter_ = 1.0 / (2.5 * reach_);
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
      const double in_cells = static_cast<double>(x(axis)) * cells_per_meter_;
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

  const Field<T>& x_;
  double reach_, cells_per_meter_ = 0.0;
  std::vector<std::pair<T, std::uint32_t>> along_x_;
  std::size_t mask_ = 0;
  std::vector<std::size_t> bucket_start_;
  std::vector<Entry> entries_;  // of the grid, bucket by bucket, ascending; empty without one
};

}  // namespace aspic::collision
