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
#include <utility>
#include <vector>

#include "cpu_reference/ball_particles.h"
#include "cpu_reference/near_triangles.h"
#include "cpu_reference/touch_batch.h"
#include "model/touch_surface.h"

namespace aspic::reference {

template <class T>
class TouchWays {
 public:
  using Particles = ParticleView<const T>;

  /// `surfaces` must outlive it.
  explicit TouchWays(const TouchSurfaces& surfaces) : surfaces_(surfaces) {
    for (const TouchPoint& point : surfaces.points) particle_.push_back(point.carrier[0]);
  }

  /// Lists have been made for particles at these places.
  void begin(const Particles& at) {
    from_.resize(surfaces_.points.size());
    for (const TouchBody& body : surfaces_.bodies)
      for (std::uint32_t p = body.first_point; p < body.first_point + body.surface_particles; ++p)
        from_[p] = place(p, at);
  }
  /// Particles are at these places now; `x`: those that meetings name, by point.
  void measure(const NearTriangles& near, const Particles& at, std::span<const Row<T>> x) {
    if (from_.empty()) return;
    far_ = apart_ = T(0);
    bodies_.clear();
    Array sum = Array::Zero();
    for (const TouchBody& body : surfaces_.bodies) {
      Body& way = bodies_.emplace_back();
      for (std::uint32_t p = body.first_point; p < body.first_point + body.surface_particles; ++p) {
        const Array now = place(p, at), gone = now - from_[p];
        way.gone.add(gone);
        way.around.add(now);
        sum += gone;
      }
      far_ = std::max(far_, norm(way.gone.low.abs().max(way.gone.high.abs())));
    }
    // What is no number has gone anywhere.
    if (!std::isfinite(sum.sum())) far_ = apart_ = std::numeric_limits<T>::infinity();
    for (const Meeting& meeting : near.meetings()) {
      const auto gone = [&](std::uint32_t first, std::uint32_t end) {
        Box box;
        for (std::uint32_t n = first; n < end; ++n) {
          const std::uint32_t p = near.met()[n];
          box.add(Eigen::Map<const Array>(x[p].data()) - from_[p]);
        }
        return box;
      };
      const Box second = gone(meeting.second, meeting.end);
      const Box first = meeting.second == meeting.first ? second : gone(meeting.first, meeting.second);
      apart_ = std::max(apart_, first.apart(second));
    }
  }
  /// Whether nothing that the lists leave out has come near, or nearer than that by no more than `over` [m].
  bool hold(const NearTriangles& near, double over = 0.0) const {
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
           bodies_.capacity() * sizeof(bodies_[0]);
  }

 private:
  using Array = Eigen::Array<T, 4, 1>;  // x, y, z, 0: one load
  /// Bodies that are compared pair by pair, at most.
  static constexpr std::size_t most_bodies = 64;
  struct Box {
    Array low = Array::Constant(std::numeric_limits<T>::infinity());
    Array high = Array::Constant(-std::numeric_limits<T>::infinity());
    void add(const Array& value) {
      low = low.min(value);
      high = high.max(value);
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
  static T norm(const Array& a) { return std::sqrt(a.square().sum()); }
  Array place(std::uint32_t point, const Particles& at) const {
    const std::size_t n = particle_[point] * at.stride;
    return {at.x[0][n], at.x[1][n], at.x[2][n], T(0)};
  }

  const TouchSurfaces& surfaces_;
  std::vector<std::uint32_t> particle_;  // by point, which it is or which carries it
  std::vector<Array> from_;              // where particles were when the lists were made, by point
  std::vector<Body> bodies_;
  T far_ = T(0), apart_ = T(0);  // that any has gone, and those of a meeting against each other [m]
};

}  // namespace aspic::reference
