#pragma once
// Whether lists of what is near still hold: how far particles of surfaces have gone since these were made,
// and how far against each other. Generous: nothing in a state depends on it.
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
  /// Particles are at these places now; `x`: those that meetings name, by point; run(count, task) as in
  /// BodyContact::find().
  template <class Run>
  void measure(const CandidateLists& near, const Particles& at, std::span<const Row<T>> x, const Run& run) {
    if (from_.empty()) return;
    run_pieces(parts_.size(), task_size(parts_.size()), run, [&](std::size_t n) { measure(parts_[n], at); });
    const std::span<const Meeting> meetings = near.meetings();
    apart_of_.resize(meetings.size());
    run_pieces(meetings.size(), task_size(meetings.size()), run,
               [&](std::size_t n) { apart_of_[n] = apart(meetings[n], near, x); });
    far_ = T(0);
    apart_ = apart_of_.empty() ? T(0) : std::ranges::max(apart_of_);
    bodies_.assign(surfaces_.bodies.size(), {});
    T sum = T(0);
    for (const Part& part : parts_) {
      Body& body = bodies_[part.body];
      body.gone.add(part.way.gone);
      body.around.add(part.way.around);
      sum += part.sum;
    }
    for (const Body& body : bodies_)
      far_ = std::max(far_, norm(body.gone.low.abs().max(body.gone.high.abs())));
    // What is no number has gone anywhere.
    if (!std::isfinite(sum)) far_ = apart_ = far;
  }
  /// Whether nothing that the lists leave out has come near, or nearer than that by no more than `over` [m].
  bool hold(const CandidateLists& near, double over = 0.0) const {
    if (from_.empty() || !(apart_ <= near.slack() + over)) return false;
    if (far_ <= near.leeway() + 0.5 * over) return true;
    // They may have gone far together. Lists reckon with rounding of places twice as far from the origin.
    if (bodies_.size() > most_bodies || !(far_ <= 1e6 * near.pad())) return false;
    const auto margin = static_cast<T>(near.most_margin() + near.pad());
    for (std::uint32_t a = 0; a < bodies_.size(); ++a) {
      for (std::uint32_t b = 0; b <= a; ++b) {
        if (bodies_[a].around.beyond(bodies_[b].around, margin)) continue;
        const bool partners = std::ranges::binary_search(near.partners(), std::array{b, a});
        if (a != b && !partners) return false;
        if (partners && !(bodies_[a].gone.apart(bodies_[b].gone) <= 2.0 * near.leeway() + over)) return false;
      }
    }
    return true;
  }

  std::uint64_t bytes() const {
    return from_.capacity() * sizeof(from_[0]) + particle_.capacity() * sizeof(particle_[0]) +
           bodies_.capacity() * sizeof(bodies_[0]) + parts_.capacity() * sizeof(parts_[0]) +
           apart_of_.capacity() * sizeof(apart_of_[0]);
  }

 private:
  using Array = Eigen::Array<T, 4, 1>;  // x, y, z, 0: one load
  /// Bodies that are compared pair by pair, at most.
  static constexpr std::size_t most_bodies = 64;
  /// Particles that are measured together, at most, and tasks.
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
    /// How far anything of this and of the other is from each other, at most, in one direction.
    T apart(const Box& other) const {
      return std::max((high - other.low).maxCoeff(), (other.high - low).maxCoeff());
    }
    bool beyond(const Box& other, T margin) const {
      return (low > other.high + margin).any() || (other.low > high + margin).any();
    }
  };
  struct Body {
    Box gone, around;
  };
  /// Particles of one body.
  struct Part {
    std::uint32_t body, first, end;  // of points
    Body way;
    T sum;  // of what they have gone; a number if these are
  };

  /// Of so many, those of a task.
  static std::size_t task_size(std::size_t count) { return count / most_tasks + 1; }
  /// Number by number: vectors that are put together in memory are read again before they are there.
  void measure(Part& part, const Particles& at) const {
    std::array<T, 3> least_gone = {far, far, far}, most_gone = {-far, -far, -far};
    std::array<T, 3> least = least_gone, most = most_gone;
    T sum = T(0);
    for (std::uint32_t p = part.first; p < part.end; ++p) {
      const std::size_t n = particle_[p] * at.stride;
      std::array<T, 3> gone;
      for (std::size_t c = 0; c < 3; ++c) {
        const T now = at.x[c][n];
        gone[c] = now - from_[p][static_cast<Eigen::Index>(c)];
        least_gone[c] = std::min(least_gone[c], gone[c]);
        most_gone[c] = std::max(most_gone[c], gone[c]);
        least[c] = std::min(least[c], now);
        most[c] = std::max(most[c], now);
      }
      sum += (gone[0] + gone[1]) + gone[2];
    }
    const auto array = [](const std::array<T, 3>& of) { return Array(of[0], of[1], of[2], T(0)); };
    part.way = {{array(least_gone), array(most_gone)}, {array(least), array(most)}};
    part.sum = sum;
  }
  T apart(const Meeting& meeting, const CandidateLists& near, std::span<const Row<T>> x) const {
    const auto gone = [&](std::uint32_t first, std::uint32_t end) {
      Box box;
      for (std::uint32_t n = first; n < end; ++n) {
        const std::uint32_t p = near.met()[n];
        box.add(Eigen::Map<const Array>(x[p].data()) - from_[p]);
      }
      return box;
    };
    const Box second = gone(meeting.second, meeting.end);
    return (meeting.second == meeting.first ? second : gone(meeting.first, meeting.second)).apart(second);
  }
  static T norm(const Array& a) { return std::sqrt(a.square().sum()); }
  Array place(std::uint32_t point, const Particles& at) const {
    const std::size_t n = particle_[point] * at.stride;
    return {at.x[0][n], at.x[1][n], at.x[2][n], T(0)};
  }

  const ContactSurfaces& surfaces_;
  std::vector<std::uint32_t> particle_;  // by point, which it is or which carries it
  std::vector<Array> from_;              // where particles were when the lists were made, by point
  std::vector<Part> parts_;
  std::vector<T> apart_of_;  // by meeting
  std::vector<Body> bodies_;
  T far_ = T(0), apart_ = T(0);  // that any has gone, and those of a meeting against each other [m]
};

}  // namespace aspic::collision
