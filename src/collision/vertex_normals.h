#pragma once
// Vertex normals of surfaces in a force evaluation. Requested ones are computed ahead, others on demand.
#include <cstdint>
#include <span>
#include <vector>

#include "collision/closest_points.h"
#include "collision/number_set.h"
#include "collision/pieces.h"
#include "model/contact_surface.h"

namespace aspic::collision {

template <class T>
class VertexNormals {
 public:
  /// `surfaces` must outlive it.
  explicit VertexNormals(const ContactSurfaces& surfaces)
      : surfaces_(surfaces),
        g_(surfaces.triangles.size()),
        normals_(surfaces.points.size()),
        made_(surfaces.points.size()) {}

  /// Withdraws all requests.
  void clear() {
    points_.clear();
    triangles_.clear();
  }
  /// Requests the normals of a point's carriers.
  void request(const SurfacePoint& point) {
    for (const std::uint32_t own : point.own) {
      if (!points_.add(own)) continue;
      for (const std::uint32_t t : surfaces_.triangles_at(own)) triangles_.add(t);
    }
  }
  /// Sorts requests for memory locality.
  void sort() {
    points_.sort();
    triangles_.sort();
  }

  /// Computes requested normals at these places, by point; run(count, task) as in ContactSearch::find().
  template <class Run>
  void make(std::span<const Row<T>> x, const Run& run) {
    ++round_;
    for_pieces(triangles_.added(), run, [&](std::uint32_t t) {
      const auto& face = surfaces_.faces[t];
      g_[t] = row_of(area_normal<T>(vector_of(x[face[0]]), vector_of(x[face[1]]), vector_of(x[face[2]])));
    });
    for_pieces(points_.added(), run, [&](std::uint32_t point) {
      four(normals_[point]) = sum(point, [&](std::uint32_t t) -> Four { return four(g_[t]); });
      made_[point] = round_;
    });
  }
  /// Σ g of the triangles at a particle's point; only the signs of its products are used.
  Vector<T> at(std::uint32_t point, std::span<const Row<T>> x) const {
    if (made_[point] == round_) return vector_of(normals_[point]);
    return sum(point, [&](std::uint32_t t) {
      const auto& face = surfaces_.faces[t];
      return area_normal<T>(vector_of(x[face[0]]), vector_of(x[face[1]]), vector_of(x[face[2]]));
    });
  }

  /// By point; valid for requested ones.
  const Row<T>* rows() const { return normals_.data(); }

  std::uint64_t bytes() const {
    return g_.capacity() * sizeof(g_[0]) + normals_.capacity() * sizeof(normals_[0]) +
           made_.capacity() * sizeof(round_) + points_.bytes() + triangles_.bytes();
  }

 private:
  template <class Run, class Make>
  static void for_pieces(const std::vector<std::uint32_t>& all, const Run& run, const Make& make) {
    run_pieces(all.size(), 512, run, [&](std::size_t n) { make(all[n]); });
  }
  /// Rows as vectors of four, which compilers keep in one register.
  using Four = Eigen::Array<T, 4, 1>;
  static Eigen::Map<const Four> four(const Row<T>& row) { return Eigen::Map<const Four>(row.data()); }
  static Eigen::Map<Four> four(Row<T>& row) { return Eigen::Map<Four>(row.data()); }
  template <class Normal>
  auto sum(std::uint32_t point, const Normal& g) const {
    const auto triangles = surfaces_.triangles_at(point);
    auto sum = g(triangles.front());
    for (const std::uint32_t t : triangles.subspan(1)) sum = sum + g(t);
    return sum;
  }

  const ContactSurfaces& surfaces_;
  NumberSet points_, triangles_;  // requested, and the triangles at them
  std::uint64_t round_ = 0;
  std::vector<Row<T>> g_;            // by triangle
  std::vector<Row<T>> normals_;      // by point,
  std::vector<std::uint64_t> made_;  // with the round they are of
};

}  // namespace aspic::collision
