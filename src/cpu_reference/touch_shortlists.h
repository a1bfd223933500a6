#pragma once
// Which of the triangles near a point may matter to it for a while: those that cannot come near enough before
// bodies have moved by a certain way are left out. Where bodies rest on each other, a look at a point is a
// look at a few triangles. Generous: nothing in a state depends on it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "aspic/vec.h"
#include "cpu_reference/ball_particles.h"

namespace aspic::reference {

template <class T>
class TouchShortlists {
 public:
  static constexpr std::size_t most = 14;
  struct List {
    double until = -1.0;      ///< holds while both bodies have strained no more than this [m],
    Vec3 apart;               ///< and while they have not moved otherwise against each other [m]
    std::uint32_t count = 0;  ///< of triangles
    std::uint32_t nearest;    ///< the list holds only while this one counts for the point; or `none`
    std::array<std::uint32_t, most> triangle;  ///< ascending
  };
  static constexpr std::uint32_t none = 0xffffffffu;

  /// For encounters of other points with other triangles; of particles it is asked where they go.
  void reset(std::size_t encounters, std::size_t bodies,
             std::vector<std::array<std::uint32_t, 2>> body_and_particle) {
    lists_.assign(encounters, {});
    bodies_.assign(bodies, {});
    followed_ = std::move(body_and_particle);
    places_.clear();
  }

  /// Particles are at these places now.
  void follow(const ParticleView<const T>& at) {
    const bool known = !places_.empty();
    places_.resize(followed_.size());
    ways_.resize(followed_.size());
    for (Body& body : bodies_) body.way = {}, body.count = 0, body.most = 0.0;
    for (std::size_t n = 0; n < followed_.size(); ++n) {
      const Vector<T> x = at.position(followed_[n][1]), way = x - places_[n];
      ways_[n] = {way.x(), way.y(), way.z()};
      places_[n] = x;
      Body& body = bodies_[followed_[n][0]];
      body.way = body.way + ways_[n];
      ++body.count;
    }
    if (!known) return;
    for (Body& body : bodies_) body.way = (1.0 / std::max(body.count, 1u)) * body.way;
    for (std::size_t n = 0; n < followed_.size(); ++n) {
      Body& body = bodies_[followed_[n][0]];
      const Vec3 other = ways_[n] - body.way;
      const double far = dot(other, other);
      // What is no number has gone anywhere.
      body.most = std::max(body.most, far <= nowhere ? far : nowhere);
    }
    for (Body& body : bodies_) {
      body.gone = body.gone + body.way;
      body.strained += 1.001 * std::sqrt(body.most);
    }
  }

  bool holds(std::size_t encounter, std::uint32_t a, std::uint32_t b) const {
    const List& list = lists_[encounter];
    const double left = list.until - (bodies_[a].strained + bodies_[b].strained);
    const Vec3 moved = (bodies_[a].gone - bodies_[b].gone) - list.apart;
    return left >= 0.0 && dot(moved, moved) <= left * left;
  }
  const List& operator[](std::size_t encounter) const { return lists_[encounter]; }

  /// Begins a list that holds while no particle of bodies a and b goes further than `way` [m] against one of
  /// the other.
  List& begin(std::size_t encounter, std::uint32_t a, std::uint32_t b, double way) {
    List& list = lists_[encounter];
    list.until = bodies_[a].strained + bodies_[b].strained + way;
    list.apart = bodies_[a].gone - bodies_[b].gone;
    list.count = 0;
    list.nearest = none;
    return list;
  }
  static void add(List& list, std::uint32_t triangle) {
    if (list.count == most)
      list.until = -1.0;
    else
      list.triangle[list.count++] = triangle;
  }

  std::uint64_t bytes() const {
    return lists_.capacity() * sizeof(List) + bodies_.capacity() * sizeof(Body) +
           followed_.capacity() * (sizeof(followed_[0]) + sizeof(Vector<T>) + sizeof(Vec3));
  }

 private:
  static constexpr double nowhere = std::numeric_limits<double>::infinity();
  struct Body {
    Vec3 gone;              ///< the way of its mean [m]
    double strained = 0.0;  ///< how far any particle has gone at most against that [m]
    Vec3 way;               ///< of the mean in this step [m]
    double most = 0.0;      ///< the square of the farthest against it [m²]
    std::uint32_t count = 0;
  };
  std::vector<List> lists_;
  std::vector<Body> bodies_;
  std::vector<std::array<std::uint32_t, 2>> followed_;  // body, particle
  std::vector<Vector<T>> places_;                       // where these were
  std::vector<Vec3> ways_;
};

}  // namespace aspic::reference
