#include "model/skin.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace aspic {
namespace {

using Cell = std::array<int, 3>;

/// How far outside a cell: along the worst axis, and in all.
struct Outside {
  double most = 0.0, sum = 0.0;
  friend bool operator<(const Outside& a, const Outside& b) {
    return a.most < b.most || (a.most == b.most && a.sum < b.sum);
  }
};

class Binder {
 public:
  explicit Binder(const Lattice& lattice) : lattice_(lattice), cells_(lattice.cells()) { spread(); }

  SkinVertex bind(const Vec3& u, std::size_t& clamped) const {
    Cell home;
    for (int axis = 0; axis < 3; ++axis) {
      const int most = cells_[static_cast<std::size_t>(axis)] - 1;
      home[static_cast<std::size_t>(axis)] =
          static_cast<int>(std::clamp(std::floor(u[axis]), 0.0, static_cast<double>(most)));
    }
    const std::size_t at = index(home);
    // Far from every cell it is clamped, and the nearest cell by steps will do.
    const Cell cell =
        distance_[at] > 2 ? place(nearest_[at]) : best_around(u, home, static_cast<int>(distance_[at]) + 1);
    SkinVertex bound = {cell, u - corner_of(cell)};
    bool moved = false;
    for (int axis = 0; axis < 3; ++axis) {
      const double kept = std::clamp(bound.at[axis], -0.5, 1.5);
      moved = moved || kept != bound.at[axis];
      bound.at[axis] = kept;
    }
    if (moved) ++clamped;
    return bound;
  }

 private:
  static Vec3 corner_of(const Cell& cell) {
    return {static_cast<double>(cell[0]), static_cast<double>(cell[1]), static_cast<double>(cell[2])};
  }
  static Outside outside(const Vec3& u, const Cell& cell) {
    Outside result;
    const Vec3 t = u - corner_of(cell);
    for (int axis = 0; axis < 3; ++axis) {
      const double by = std::max({-t[axis], t[axis] - 1.0, 0.0});
      result.most = std::max(result.most, by);
      result.sum += by;
    }
    return result;
  }

  Cell best_around(const Vec3& u, const Cell& home, int reach) const {
    Cell best = home;
    Outside least = {1e300, 1e300};
    for (int i = home[0] - reach; i <= home[0] + reach; ++i) {
      for (int j = home[1] - reach; j <= home[1] + reach; ++j) {
        for (int k = home[2] - reach; k <= home[2] + reach; ++k) {
          if (!lattice_.full({i, j, k})) continue;
          const Outside here = outside(u, {i, j, k});
          if (here < least) {
            least = here;
            best = {i, j, k};
          }
        }
      }
    }
    return best;
  }

  std::size_t index(const Cell& c) const {
    return (static_cast<std::size_t>(c[0]) * static_cast<std::size_t>(cells_[1]) +
            static_cast<std::size_t>(c[1])) *
               static_cast<std::size_t>(cells_[2]) +
           static_cast<std::size_t>(c[2]);
  }
  Cell place(std::size_t index) const {
    const auto m = static_cast<std::size_t>(cells_[1]), l = static_cast<std::size_t>(cells_[2]);
    return {static_cast<int>(index / (m * l)), static_cast<int>(index / l % m), static_cast<int>(index % l)};
  }

  /// From the full cells outwards: of every cell the steps to a nearest full one, diagonal ones too, and
  /// which it is.
  void spread() {
    constexpr std::uint32_t unknown = 0xffffffffu;
    const std::size_t count = index({cells_[0] - 1, cells_[1] - 1, cells_[2] - 1}) + 1;
    distance_.assign(count, unknown);
    nearest_.assign(count, 0);
    std::vector<std::size_t> queue;
    for (std::size_t c = 0; c < count; ++c) {
      if (!lattice_.full(place(c))) continue;
      distance_[c] = 0;
      nearest_[c] = c;
      queue.push_back(c);
    }
    for (std::size_t at = 0; at < queue.size(); ++at) {
      const std::size_t from = queue[at];
      const auto [i, j, k] = place(from);
      for (int n = 0; n < 27; ++n) {
        const Cell next = {i + n / 9 - 1, j + n / 3 % 3 - 1, k + n % 3 - 1};
        if (next[0] < 0 || next[0] >= cells_[0] || next[1] < 0 || next[1] >= cells_[1] || next[2] < 0 ||
            next[2] >= cells_[2])
          continue;
        const std::size_t to = index(next);
        if (distance_[to] != unknown) continue;
        distance_[to] = distance_[from] + 1;
        nearest_[to] = nearest_[from];
        queue.push_back(to);
      }
    }
  }

  const Lattice& lattice_;
  std::array<int, 3> cells_;
  std::vector<std::uint32_t> distance_;  // by cell
  std::vector<std::size_t> nearest_;     // by cell: a full one
};

}  // namespace

SkinBinding bind_skin(const Lattice& lattice, std::span<const Vec3> vertices) {
  const Binder binder(lattice);
  SkinBinding binding;
  binding.vertices.reserve(vertices.size());
  for (const Vec3& v : vertices) binding.vertices.push_back(binder.bind(v, binding.clamped));
  return binding;
}

std::array<double, 8> corner_weights(const Vec3& at) {
  std::array<double, 8> weights;
  for (std::size_t n = 0; n < 8; ++n) {
    const double x = (n & 4u) != 0 ? at.x : 1.0 - at.x, y = (n & 2u) != 0 ? at.y : 1.0 - at.y,
                 z = (n & 1u) != 0 ? at.z : 1.0 - at.z;
    weights[n] = x * y * z;
  }
  return weights;
}

std::vector<std::array<std::uint32_t, 8>> skin_corners(const SkinBinding& binding, const Lattice& lattice,
                                                       std::span<const std::uint32_t> point_number) {
  std::vector<std::array<std::uint32_t, 8>> corners;
  corners.reserve(binding.vertices.size());
  for (const SkinVertex& v : binding.vertices) {
    auto& numbers = corners.emplace_back();
    for (std::size_t n = 0; n < 8; ++n)
      numbers[n] = point_number[lattice.index({v.cell[0] + static_cast<int>(n >> 2),
                                               v.cell[1] + static_cast<int>(n >> 1 & 1u),
                                               v.cell[2] + static_cast<int>(n & 1u)})];
  }
  return corners;
}

std::vector<Vec3> skin_positions(const SkinBinding& binding,
                                 std::span<const std::array<std::uint32_t, 8>> corners,
                                 std::span<const Vec3> positions) {
  std::vector<Vec3> result;
  result.reserve(corners.size());
  for (std::size_t v = 0; v < corners.size(); ++v) {
    const auto weights = corner_weights(binding.vertices[v].at);
    Vec3 sum;
    for (std::size_t n = 0; n < 8; ++n) sum = sum + weights[n] * positions[corners[v][n]];
    result.push_back(sum);
  }
  return result;
}

std::vector<Vec3> skin_normals(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  std::vector<Vec3> normals(positions.size());
  for (const auto& [a, b, c] : triangles) {
    const Vec3 n = area_vector(positions[a], positions[b], positions[c]);
    for (const std::uint32_t v : {a, b, c}) normals[v] = normals[v] + n;
  }
  for (Vec3& n : normals)
    if (const double size = length(n); size > 0.0) n = n / size;
  return normals;
}

}  // namespace aspic
