#pragma once
// What points see of triangles, many at a time, so that a backend may compute them side by side.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "cpu_reference/ball_particles.h"
#include "cpu_reference/touch_geometry.h"

namespace aspic::reference {

template <class T>
struct SightBatch {
  static constexpr std::size_t room = 256, block = 4;
  /// As many as may be written behind the last: a multiple of any number of lanes.
  static constexpr std::size_t behind = 16;
  template <class Value>
  using Lane = std::array<Value, room + behind>;

  std::size_t count = 0;
  // What is asked: a point, its normal if only faces count that turn to it, the corners of a triangle.
  alignas(64) std::array<Lane<T>, 3> P, N_P;
  alignas(64) Lane<T> opposing;  ///< 1 with a normal, else 0
  alignas(64) std::array<Lane<std::int32_t>, 3> corner;
  // What is seen, as in Sight.
  alignas(64) std::array<Lane<T>, 3> e, N;
  alignas(64) Lane<T> b, c, L, z;
  alignas(64) Lane<std::int32_t> face, counts;

  /// A point looks from `first` on at so many triangles, of those that turn to it if it has a normal. What
  /// comes behind them is overwritten.
  void ask(std::size_t first, std::size_t number, const Vector<T>& point,
           const std::optional<Vector<T>>& normal) {
    const auto fill = [&](Lane<T>& of, T value) {
      for (std::size_t n = 0; n < number; n += block)
        for (std::size_t each = 0; each < block; ++each) of[first + n + each] = value;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      fill(P[axis], point[static_cast<Eigen::Index>(axis)]);
      fill(N_P[axis], normal ? (*normal)[static_cast<Eigen::Index>(axis)] : T(0));
    }
    fill(opposing, normal ? T(1) : T(0));
  }
  void set_corner(std::size_t n, const std::array<std::uint32_t, 3>& particle) {
    for (std::size_t k = 0; k < 3; ++k) corner[k][n] = static_cast<std::int32_t>(particle[k]);
  }

  Vector<T> at(const std::array<Lane<T>, 3>& of, std::size_t n) const {
    return {of[0][n], of[1][n], of[2][n]};
  }
  Sight<T> sight(std::size_t n, std::uint32_t triangle, std::uint32_t side) const {
    return {triangle, side, {b[n], c[n], face[n] != 0}, at(e, n), L[n], at(N, n), z[n]};
  }
};

/// Fills in what is seen of the first `count`; of a triangle that does not count nothing but that.
template <class T>
void look_one_by_one(const ParticleView<const T>& particles, SightBatch<T>& batch) {
  for (std::size_t n = 0; n < batch.count; ++n) {
    const auto corner = [&](std::size_t c) {
      return particles.position(static_cast<std::uint32_t>(batch.corner[c][n]));
    };
    const Face<T> face = face_of<T>(corner(0), corner(1), corner(2));
    batch.counts[n] =
        face.real && (batch.opposing[n] == T(0) || dot3<T>(batch.at(batch.N_P, n), face.g) < T(0));
    if (!batch.counts[n]) continue;
    const Sight<T> seen = sight_of<T>(0, 0, face, batch.at(batch.P, n));
    for (std::size_t c = 0; c < 3; ++c) {
      batch.e[c][n] = seen.e[static_cast<Eigen::Index>(c)];
      batch.N[c][n] = seen.N[static_cast<Eigen::Index>(c)];
    }
    batch.b[n] = seen.at.b;
    batch.c[n] = seen.at.c;
    batch.face[n] = seen.at.face;
    batch.L[n] = seen.L;
    batch.z[n] = seen.z;
  }
}

}  // namespace aspic::reference
