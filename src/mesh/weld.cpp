#include "mesh/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "base/split_mix.h"
#include "model/triangle_mesh.h"

namespace aspic {
namespace {

struct Mixed {
  std::size_t operator()(std::uint64_t key) const { return SplitMix64::mix(key); }
};

constexpr std::uint32_t no_point = 0xffffffffu;

/// The points that stand for others, by the cell of a grid that they are in. Those of one cell are farther
/// from each other than the tolerance, so they are few.
class Cells {
 public:
  Cells(std::span<const Vec3> points, double tolerance)
      : points_(points), tolerance_(tolerance), width_(8.0 * tolerance), next_(points.size(), no_point) {
    Bounds bounds;
    for (const Vec3& p : points) bounds.add(p);
    low_ = bounds.low;
    heads_.reserve(points.size());
  }

  /// The first point within the tolerance, or `no_point`.
  std::uint32_t find(const Vec3& p) const {
    std::uint32_t best = no_point;
    std::array<std::array<std::uint64_t, 2>, 3> range;
    for (int axis = 0; axis < 3; ++axis)
      range[static_cast<std::size_t>(axis)] = {cell(p, axis, -tolerance_), cell(p, axis, tolerance_)};
    for (std::uint64_t i = range[0][0]; i <= range[0][1]; ++i)
      for (std::uint64_t j = range[1][0]; j <= range[1][1]; ++j)
        for (std::uint64_t k = range[2][0]; k <= range[2][1]; ++k)
          best = std::min(best, find_in(p, key(i, j, k)));
    return best;
  }

  void add(std::uint32_t index) {
    const Vec3& p = points_[index];
    auto [at, fresh] = heads_.try_emplace(key(cell(p, 0, 0.0), cell(p, 1, 0.0), cell(p, 2, 0.0)), no_point);
    next_[index] = at->second;
    at->second = index;
  }

 private:
  std::uint32_t find_in(const Vec3& p, std::uint64_t cell_key) const {
    const auto at = heads_.find(cell_key);
    std::uint32_t best = no_point;
    for (std::uint32_t i = at == heads_.end() ? no_point : at->second; i != no_point; i = next_[i]) {
      const Vec3 d = points_[i] - p;
      if (dot(d, d) <= tolerance_ * tolerance_) best = std::min(best, i);
    }
    return best;
  }
  std::uint64_t cell(const Vec3& p, int axis, double moved) const {
    return static_cast<std::uint64_t>(std::max(0.0, std::floor((p[axis] - low_[axis] + moved) / width_)));
  }
  /// Cells along an axis are fewer than 2²⁰ by the bound on the tolerance.
  static std::uint64_t key(std::uint64_t i, std::uint64_t j, std::uint64_t k) {
    return (i << 42) | (j << 21) | k;
  }

  std::span<const Vec3> points_;
  double tolerance_, width_;
  Vec3 low_;
  std::unordered_map<std::uint64_t, std::uint32_t, Mixed> heads_;
  std::vector<std::uint32_t> next_;
};

}  // namespace

std::vector<std::uint32_t> weld_points(std::span<const Vec3> points, double tolerance) {
  std::vector<std::uint32_t> first(points.size());
  std::iota(first.begin(), first.end(), 0u);
  if (!(tolerance > 0.0)) {  // all points are one
    std::ranges::fill(first, 0u);
    return first;
  }
  Cells cells(points, tolerance);
  for (std::uint32_t i = 0; i < first.size(); ++i) {
    const std::uint32_t known = cells.find(points[i]);
    if (known == no_point)
      cells.add(i);
    else
      first[i] = known;
  }
  return first;
}

}  // namespace aspic
