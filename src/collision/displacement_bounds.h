#pragma once
// Whether candidate lists still hold: upper bounds of the displacements of surface particles since the lists
// were made, and of the displacements relative to each other. No state depends on them.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "collision/candidate_lists.h"
#include "collision/contact_batch.h"
#include "collision/pieces.h"
#include "model/contact_surface.h"
#include "physics/particle_view.h"

namespace aspic::collision {

template <class T>
class DisplacementBounds {
 public:
  using Particles = ParticleView<const T>;

  /// `surfaces` must outlive it.
  explicit DisplacementBounds(const ContactSurfaces& surfaces) : surfaces_(surfaces) {
    for (const SurfacePoint& point : surfaces.points) particle_.push_back(point.carrier[0]);
    for (std::uint32_t n = 0; n < surfaces.bodies.size(); ++n) {
      const ContactBody& body = surfaces.bodies[n];
      for (std::uint32_t p = 0; p < body.surface_particles; p += part_size)
        parts_.push_back({n,
                          body.first_point + p,
                          body.first_point + std::min(p + part_size, body.surface_particles),
                          {},
                          T(0)});
    }
  }

  /// Lists have been made for particles at these places.
  void begin(const Particles& at) {
    from_.resize(surfaces_.points.size());
    for (const ContactBody& body : surfaces_.bodies)
      for (std::uint32_t p = body.first_point; p < body.first_point + body.surface_particles; ++p)
        from_[p] = place(p, at);
  }
  /// Measures displacements to these places; `x`: places of the points of body pairs, by point; run(count,
  /// task) as in ContactSearch::find().
  template <class Run>
  void measure(const CandidateLists& near, const Particles& at, std::span<const Row<T>> x, const Run& run) {
    if (from_.empty()) return;
    run_pieces(parts_.size(), task_size(parts_.size()), run, [&](std::size_t n) { measure(parts_[n], at); });
    const std::span<const BodyPair> body_pairs = near.body_pairs();
    relative_of_.resize(body_pairs.size());
    run_pieces(body_pairs.size(), task_size(body_pairs.size()), run,
               [&](std::size_t n) { relative_of_[n] = relative(body_pairs[n], near, x); });
    largest_ = T(0);
    relative_ = relative_of_.empty() ? T(0) : std::ranges::max(relative_of_);
    bodies_.assign(surfaces_.bodies.size(), {});
    T sum = T(0);
    for (const Part& part : parts_) {
      Body& body = bodies_[part.body];
      body.moved.add(part.way.moved);
      body.around.add(part.way.around);
      sum += part.sum;
    }
    for (const Body& body : bodies_)
      largest_ = std::max(largest_, norm(body.moved.low.abs().max(body.moved.high.abs())));
    // NaN displacements count as infinite.
    if (!std::isfinite(sum)) largest_ = relative_ = far;
  }
  /// Whether the lists hold, also if limits are exceeded by up to `over` [m].
  bool hold(const CandidateLists& near, double over = 0.0) const {
    if (from_.empty() || !(relative_ <= near.slack() + over)) return false;
    if (largest_ <= near.displacement_limit() + 0.5 * over) return true;
    // Bodies may have moved far together. The lists allow for rounding twice as far from the origin.
    if (bodies_.size() > most_bodies || !(largest_ <= 1e6 * near.rounding())) return false;
    const auto margin = static_cast<T>(near.most_margin() + near.rounding());
    for (std::uint32_t a = 0; a < bodies_.size(); ++a) {
      for (std::uint32_t b = 0; b <= a; ++b) {
        if (bodies_[a].around.beyond(bodies_[b].around, margin)) continue;
        const bool neighbors = std::ranges::binary_search(near.neighbors(), std::array{b, a});
        if (a != b && !neighbors) return false;
        if (neighbors &&
            !(bodies_[a].moved.relative(bodies_[b].moved) <= 2.0 * near.displacement_limit() + over))
          return false;
      }
    }
    return true;
  }

  std::uint64_t bytes() const {
    return from_.capacity() * sizeof(from_[0]) + particle_.capacity() * sizeof(particle_[0]) +
           bodies_.capacity() * sizeof(bodies_[0]) + parts_.capacity() * sizeof(parts_[0]) +
           relative_of_.capacity() * sizeof(relative_of_[0]);
  }

 private:
  using Array = Eigen::Array<T, 4, 1>;  // x, y, z, 0: one load
  /// Most bodies that are compared pair by pair.
  static constexpr std::size_t most_bodies = 64;
  /// Most particles of a part, and most parts of a task.
  static constexpr std::uint32_t part_size = 1024;
  static constexpr std::size_t most_tasks = 64;
  static constexpr T far = std::numeric_limits<T>::infinity();
  struct Box {
    Array low = Array::Constant(far), high = Array::Constant(-far);
    void add(const Array& value) {
      low = low.min(value);
      high = high.max(value);
    }
    void add(const Box& other) {
      low = low.min(other.low);
      high = high.max(other.high);
    }
    /// Upper bound of the distance between any two places of the boxes.
    T relative(const Box& other) const {
      return std::max((high - other.low).maxCoeff(), (other.high - low).maxCoeff());
    }
    bool beyond(const Box& other, T margin) const {
      return (low > other.high + margin).any() || (other.low > high + margin).any();
    }
  };
  struct Body {
    Box moved, around;
  };
  /// Particles of one body.
  struct Part {
    std::uint32_t body, first, end;  // of points
    Body way;
    T sum;  // of displacements: NaN if one of them is
  };

  /// Size of a task out of `count`.
  static std::size_t task_size(std::size_t count) { return count / most_tasks + 1; }
  /// Component by component: a vector assembled in memory would stall the load that follows.
  void measure(Part& part, const Particles& at) const {
    std::array<T, 3> least_gone = {far, far, far}, most_gone = {-far, -far, -far};
    std::array<T, 3> least = least_gone, most = most_gone;
    T sum = T(0);
    for (std::uint32_t p = part.first; p < part.end; ++p) {
      const std::size_t n = particle_[p] * at.stride;
      std::array<T, 3> moved;
      for (std::size_t c = 0; c < 3; ++c) {
        const T now = at.x[c][n];
        moved[c] = now - from_[p][static_cast<Eigen::Index>(c)];
        least_gone[c] = std::min(least_gone[c], moved[c]);
        most_gone[c] = std::max(most_gone[c], moved[c]);
        least[c] = std::min(least[c], now);
        most[c] = std::max(most[c], now);
      }
      sum += (moved[0] + moved[1]) + moved[2];
    }
    const auto array = [](const std::array<T, 3>& of) { return Array(of[0], of[1], of[2], T(0)); };
    part.way = {{array(least_gone), array(most_gone)}, {array(least), array(most)}};
    part.sum = sum;
  }
  T relative(const BodyPair& meeting, const CandidateLists& near, std::span<const Row<T>> x) const {
    const auto moved = [&](std::uint32_t first, std::uint32_t end) {
      Box box;
      for (std::uint32_t n = first; n < end; ++n) {
        const std::uint32_t p = near.pair_points()[n];
        box.add(Eigen::Map<const Array>(x[p].data()) - from_[p]);
      }
      return box;
    };
    const Box second = moved(meeting.second, meeting.end);
    return (meeting.second == meeting.first ? second : moved(meeting.first, meeting.second)).relative(second);
  }
  static T norm(const Array& a) { return std::sqrt(a.square().sum()); }
  Array place(std::uint32_t point, const Particles& at) const {
    const std::size_t n = particle_[point] * at.stride;
    return {at.x[0][n], at.x[1][n], at.x[2][n], T(0)};
  }

  const ContactSurfaces& surfaces_;
  std::vector<std::uint32_t> particle_;  // by point
  std::vector<Array> from_;              // places when the lists were made, by point
  std::vector<Part> parts_;
  std::vector<T> relative_of_;  // by body pair
  std::vector<Body> bodies_;
  T largest_ = T(0), relative_ = T(0);  // largest displacement; largest relative one of a body pair [m]
};

}  // namespace aspic::collision
