#pragma once
// Normals of particles of surfaces where forces are evaluated: those that are wanted are made ahead, the
// others where something asks for them.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "cpu_reference/ball_particles.h"
#include "cpu_reference/number_set.h"
#include "cpu_reference/touch_geometry.h"
#include "model/touch_surface.h"

namespace aspic::reference {

template <class T>
class TouchNormals {
 public:
  using Particles = ParticleView<const T>;

  /// `surfaces` must outlive it.
  explicit TouchNormals(const TouchSurfaces& surfaces)
      : surfaces_(surfaces),
        g_(surfaces.triangles.size()),
        normals_(surfaces.points.size()),
        made_(surfaces.points.size()) {}

  /// Nothing is wanted.
  void clear() {
    points_.clear();
    triangles_.clear();
  }
  /// Those of the carriers of a point are wanted.
  void want(const TouchPoint& point) {
    for (const std::uint32_t own : point.own) {
      if (!points_.add(own)) continue;
      for (const std::uint32_t t : surfaces_.triangles_at(own)) triangles_.add(t);
    }
  }
  /// So that what lies together is made together.
  void sort() {
    points_.sort();
    triangles_.sort();
  }

  /// Makes anew what is wanted; run(count, task) as in BodyContact::find().
  template <class Run>
  void make(const Particles& at, const Run& run) {
    ++round_;
    for_pieces(triangles_.added(), run, [&](std::uint32_t t) { g_[t] = area_normal_of(t, at); });
    for_pieces(points_.added(), run, [&](std::uint32_t point) {
      normals_[point] = sum(point, [&](std::uint32_t t) { return g_[t]; });
      made_[point] = round_;
    });
  }
  /// Of a particle's point: Σ g of the triangles at it, of which only the sign of products matters.
  Vector<T> at(std::uint32_t point, const Particles& at) const {
    if (made_[point] == round_) return normals_[point];
    return sum(point, [&](std::uint32_t t) { return area_normal_of(t, at); });
  }

  std::uint64_t bytes() const {
    return (g_.capacity() + normals_.capacity()) * sizeof(Vector<T>) + made_.capacity() * sizeof(round_);
  }

 private:
  template <class Run, class Make>
  static void for_pieces(const std::vector<std::uint32_t>& all, const Run& run, const Make& make) {
    constexpr std::size_t size = 512;
    run((all.size() + size - 1) / size, [&](std::size_t piece) {
      const std::size_t end = std::min(all.size(), (piece + 1) * size);
      for (std::size_t n = piece * size; n < end; ++n) make(all[n]);
    });
  }
  Vector<T> area_normal_of(std::uint32_t triangle, const Particles& at) const {
    const auto& corner = surfaces_.triangles[triangle].corner;
    return area_normal<T>(at.position(corner[0]), at.position(corner[1]), at.position(corner[2]));
  }
  template <class Normal>
  Vector<T> sum(std::uint32_t point, const Normal& g) const {
    const auto triangles = surfaces_.triangles_at(point);
    Vector<T> sum = g(triangles.front());
    for (const std::uint32_t t : triangles.subspan(1)) sum = sum + g(t);
    return sum;
  }

  const TouchSurfaces& surfaces_;
  NumberSet points_, triangles_;  // wanted, and the triangles at them
  std::uint64_t round_ = 0;
  std::vector<Vector<T>> g_;         // by triangle
  std::vector<Vector<T>> normals_;   // by point,
  std::vector<std::uint64_t> made_;  // with the round they are of
};

}  // namespace aspic::reference
