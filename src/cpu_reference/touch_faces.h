#pragma once
// Faces of triangles and normals of particles where forces are evaluated: those that are wanted by many are
// made ahead, the others where something asks for them.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "cpu_reference/ball_particles.h"
#include "cpu_reference/touch_geometry.h"
#include "model/touch_surface.h"

namespace aspic::reference {

/// Numbers below a bound, ascending and each once, however often they are added.
class NumberSet {
 public:
  void clear() { marked_.assign(marked_.size(), false); }
  void add(std::uint32_t number) {
    if (number >= marked_.size()) marked_.resize(number + 1, false);
    marked_[number] = true;
  }
  std::vector<std::uint32_t> list() const {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t n = 0; n < marked_.size(); ++n)
      if (marked_[n]) numbers.push_back(n);
    return numbers;
  }

 private:
  std::vector<char> marked_;
};

/// Triangles, and points of particles whose normals are asked for; with the triangles at them.
struct WantedFaces {
  std::vector<std::uint32_t> triangles, points;

  void begin() {
    triangle_set_.clear();
    point_set_.clear();
  }
  void add(std::span<const std::uint32_t> more) {
    for (const std::uint32_t t : more) triangle_set_.add(t);
  }
  void add_carriers(const TouchPoint& point) {
    for (const std::uint32_t own : point.own) point_set_.add(own);
  }
  /// Without the triangles at points.
  std::vector<std::uint32_t> added() const { return triangle_set_.list(); }
  void end(const TouchSurfaces& surfaces) {
    points = point_set_.list();
    for (const std::uint32_t point : points) add(surfaces.triangles_at(point));
    triangles = triangle_set_.list();
  }

 private:
  NumberSet triangle_set_, point_set_;
};

template <class T>
class TouchFaces {
 public:
  using Particles = ParticleView<const T>;
  static constexpr std::size_t piece_size = 256;

  /// `surfaces` must outlive it.
  explicit TouchFaces(const TouchSurfaces& surfaces) : surfaces_(surfaces) {}

  /// Faces are made anew, these ahead: prepare(n) of every piece, then prepare_normals(). `wanted` must
  /// outlive that.
  void begin(const WantedFaces& wanted) {
    ++round_;
    wanted_ = &wanted;
    faces_.resize(surfaces_.triangles.size());
    made_.resize(surfaces_.triangles.size());
    normals_.resize(surfaces_.points.size());
    summed_.resize(surfaces_.points.size());
  }
  std::size_t pieces() const { return (wanted_->triangles.size() + piece_size - 1) / piece_size; }
  void prepare(std::size_t piece, const Particles& at) {
    const std::size_t end = std::min(wanted_->triangles.size(), (piece + 1) * piece_size);
    for (std::size_t n = piece * piece_size; n < end; ++n) {
      const std::uint32_t t = wanted_->triangles[n];
      faces_[t] = made(t, at);
      made_[t] = round_;
    }
  }
  void prepare_normals() {
    for (const std::uint32_t point : wanted_->points) {
      normals_[point] = sum(point, [&](std::uint32_t t) -> const Vector<T>& { return faces_[t].g; });
      summed_[point] = round_;
    }
  }

  /// `room`: for one that is not made.
  const Face<T>& face(std::uint32_t triangle, const Particles& at, Face<T>& room) const {
    if (made_[triangle] == round_) return faces_[triangle];
    room = made(triangle, at);
    return room;
  }
  /// Of a particle's point: Σ g of the triangles at it, of which only the sign of products matters.
  Vector<T> normal(std::uint32_t point, const Particles& at) const {
    if (summed_[point] == round_) return normals_[point];
    Face<T> room;
    return sum(point, [&](std::uint32_t t) { return face(t, at, room).g; });
  }

  std::uint64_t bytes() const {
    return faces_.capacity() * (sizeof(Face<T>) + sizeof(round_)) +
           normals_.capacity() * (sizeof(Vector<T>) + sizeof(round_));
  }

 private:
  Face<T> made(std::uint32_t triangle, const Particles& at) const {
    const auto& corner = surfaces_.triangles[triangle].corner;
    return face_of<T>(at.position(corner[0]), at.position(corner[1]), at.position(corner[2]));
  }
  template <class Normal>
  Vector<T> sum(std::uint32_t point, const Normal& g) const {
    const auto triangles = surfaces_.triangles_at(point);
    Vector<T> sum = g(triangles.front());
    for (const std::uint32_t t : triangles.subspan(1)) sum = sum + g(t);
    return sum;
  }

  const TouchSurfaces& surfaces_;
  const WantedFaces* wanted_ = nullptr;
  std::uint64_t round_ = 0;
  // By triangle and by point, with the round they are of.
  std::vector<Face<T>> faces_;
  std::vector<Vector<T>> normals_;
  std::vector<std::uint64_t> made_, summed_;
};

}  // namespace aspic::reference
