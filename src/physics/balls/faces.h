#pragma once
// Balls and faces of bodies (docs/balls.md, "Faces"): each ball and the nearest face of each body that it
// touches are a pair, whose face is carried by the triangle's corners. Pairs are found after flight; once
// balls have met particles, they exchange velocities and are separated.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model/ball_faces.h"
#include "physics/balls/law.h"
#include "physics/balls/phase.h"
#include "physics/contact/geometry.h"
#include "physics/particle_view.h"

namespace aspic::physics {

/// A ball and a place on a triangle, A + b·(B − A) + c·(C − A), found near each other.
template <class T>
struct FacePair {
  std::uint32_t ball = 0;
  std::array<std::uint32_t, 3> corner = {};  ///< particles
  std::array<std::uint32_t, 3> place = {};   ///< of each in the list of all that pairs name
  std::array<T, 3> share = {};               ///< of each in the place: (1 − b) − c, b, c
  bool within = false;                       ///< the place is within the face, not on an edge
  T side = T(1);                             ///< of N, or of e on an edge: −1 where it points from the ball
  Gap<T> gap = {};                           ///< n towards the ball
  bool acts = false;                         ///< in the phase under way
  Impulse<T> received = {};  ///< by the ball; in the phase of positions `linear` is its shift [m·kg]
};

/// Σ share·y over the corners.
template <class T, class Value>
auto over_shares(const FacePair<T>& pair, const Value& value) {
  using Sum = decltype(value(std::size_t{0}));
  return Sum((pair.share[0] * value(0) + pair.share[1] * value(1)) + pair.share[2] * value(2));
}

/// The gap between a ball of radius R at P and the pair's place on the triangle (A, B, C).
template <class T>
Gap<T> face_gap(const FacePair<T>& pair, const Vector<T>& P, T R, const Vector<T>& A, const Vector<T>& B,
                const Vector<T>& C) {
  const Vector<T> e = ((P - A) - pair.share[1] * (B - A)) - pair.share[2] * (C - A);
  const Vector<T> g = area_normal<T>(A, B, C);
  if (pair.within && dot3<T>(g, g) > T(0)) {
    const Vector<T> N = (T(1) / norm3<T>(g)) * g;
    const Vector<T> n = pair.side * N;
    return {dot3<T>(e, n) - R, n};
  }
  const T L = norm3<T>(e);
  if (!(L > T(0))) return {-R, Vector<T>(0, 1, 0)};
  const T q = T(1) / L;
  return {pair.side * L - R, pair.side * (q * e)};
}

template <class T>
class BallsOnFaces {
 public:
  /// What balls and particles bring with them.
  struct Bodies {
    const BallRules<T>& rules;
    const std::vector<BallBody<T>>& balls;
    const Runs<T>& particle_weight;
  };

  explicit BallsOnFaces(const Model& model) : faces_(ball_faces(model)) {}

  /// Finds the pairs closer than ε of the balls `present`, ascending.
  void find(const std::vector<std::uint32_t>& present, const BallPhase<T>& balls, const Bodies& bodies,
            const ParticleView<T>& particles) {
    pairs_.clear();
    if (present.empty() || faces_.bodies.empty()) return;
    make_boxes(particles);
    for (const std::uint32_t b : present) {
      const T limit = bodies.balls[b].radius + bodies.rules.contact.distance;
      for (const FacesOfBody& body : faces_.bodies) find_nearest(b, balls.x.col(b), limit, body, particles);
    }
    name_particles();
  }

  /// Exchanges velocities, then separates what overlaps. Particles went from `particle_start` on.
  void meet(const BallPhase<T>& start, BallPhase<T>& balls, const ParticleView<const T>& particle_start,
            const ParticleView<T>& particles, const Bodies& bodies) {
    if (pairs_.empty()) return;
    exchange(start, balls, particle_start, particles, bodies);
    separate(balls, particles, bodies);
  }

  /// The pairs of the step, ascending by ball, then by body.
  std::span<const FacePair<T>> pairs() const { return pairs_; }

 private:
  void exchange(const BallPhase<T>& start, BallPhase<T>& balls, const ParticleView<const T>& particle_start,
                const ParticleView<T>& particles, const Bodies& bodies) {
    const auto velocity = [&](const FacePair<T>& pair) {
      const auto v = [&](std::size_t n) { return particles.velocity(pair.corner[n]); };
      return Vector<T>(balls.v.col(pair.ball) - over_shares<T>(pair, v));
    };
    tally(balls, particles, bodies,
          [&](const FacePair<T>& pair) { return dot3<T>(velocity(pair), pair.gap.n) < T(0); });
    for (FacePair<T>& pair : pairs_) {
      if (!pair.acts) continue;
      const BallBody<T>& ball = bodies.balls[pair.ball];
      const auto v0 = [&](std::size_t n) { return particle_start.velocity(pair.corner[n]); };
      const Vector<T> dv0 = start.v.col(pair.ball) - over_shares<T>(pair, v0);
      const Vector<T> rolling = ball.radius * balls.omega.col(pair.ball);
      const T weight = weight_of(pair, bodies);
      const T slip_weight = weight + number(ball_pairs_[pair.ball]) * ball.slip;
      pair.received = impact<T>(bodies.rules, pair.gap.n, velocity(pair), dv0, rolling, weight, slip_weight);
    }
    for_each_ball([&](std::uint32_t b, const Impulse<T>& sum) {
      balls.v.col(b) += bodies.balls[b].inverse_mass * sum.linear;
      if (bodies.rules.spin) balls.omega.col(b) += bodies.balls[b].turn * sum.turning;
    });
    give_back(particles.v, particles, bodies);
  }

  void separate(BallPhase<T>& balls, const ParticleView<T>& particles, const Bodies& bodies) {
    tally(balls, particles, bodies, [](const FacePair<T>& pair) { return pair.gap.d < T(0); });
    for (FacePair<T>& pair : pairs_) {
      if (!pair.acts) continue;
      pair.received = {(-pair.gap.d / weight_of(pair, bodies)) * pair.gap.n, Vector<T>::Zero()};
    }
    for_each_ball([&](std::uint32_t b, const Impulse<T>& sum) {
      balls.x.col(b) += bodies.balls[b].inverse_mass * sum.linear;
    });
    give_back(particles.x, particles, bodies);
  }

  static T number(std::uint32_t count) { return static_cast<T>(count); }

  Box<T> box_of_triangle(std::uint32_t t, const ParticleView<T>& particles) const {
    const auto& corner = faces_.triangles[t];
    return Box<T>::around(particles.position(corner[0]), particles.position(corner[1]),
                          particles.position(corner[2]));
  }

  /// Of every block of each body's triangles.
  void make_boxes(const ParticleView<T>& particles) {
    boxes_.clear();
    for (const FacesOfBody& body : faces_.bodies) {
      for (std::uint32_t first = 0; first < body.triangle_count; first += face_block) {
        Box<T> all = box_of_triangle(body.first_triangle + first, particles);
        for (std::uint32_t t = first + 1; t < std::min(first + face_block, body.triangle_count); ++t)
          all.extend(box_of_triangle(body.first_triangle + t, particles));
        boxes_.push_back(all);
      }
    }
  }

  /// Looks at the triangles of a body nearer to a ball at P than `limit` [m].
  void find_nearest(std::uint32_t b, const Vector<T>& P, T limit, const FacesOfBody& body,
                    const ParticleView<T>& particles) {
    closest_.clear();
    const T far = T(1.01) * limit;
    std::size_t box = first_box(body);
    for (std::uint32_t first = 0; first < body.triangle_count; first += face_block, ++box) {
      if (boxes_[box].beyond(far, P)) continue;
      for (std::uint32_t t = first; t < std::min(first + face_block, body.triangle_count); ++t)
        look(body.first_triangle + t, P, limit, far, particles);
    }
    const ClosestPoint<T>* const nearest =
        nearest_of<T>(closest_, T(2e-6) * limit, [](const ClosestPoint<T>&) { return true; });
    if (nearest) add(b, *nearest, body.closed, limit);
  }
  std::size_t first_box(const FacesOfBody& body) const {
    std::size_t sum = 0;
    for (const FacesOfBody* of = faces_.bodies.data(); of != &body; ++of)
      sum += (of->triangle_count + face_block - 1) / face_block;
    return sum;
  }

  void look(std::uint32_t t, const Vector<T>& P, T limit, T far, const ParticleView<T>& particles) {
    if (box_of_triangle(t, particles).beyond(far, P)) return;
    const auto& corner = faces_.triangles[t];
    const Face<T> face = face_of<T>(particles.position(corner[0]), particles.position(corner[1]),
                                    particles.position(corner[2]));
    if (!face.real) return;
    const ClosestPoint<T> seen = closest_point<T>(t, 0, face, P);
    if (seen.L < limit) closest_.push_back(seen);
  }

  void add(std::uint32_t ball, const ClosestPoint<T>& seen, bool closed, T limit) {
    const auto& [b, c, within] = seen.at;
    const T a = (T(1) - b) - c;
    // A corner is a particle, which the ball meets as such.
    if (a == T(1) || b == T(1) || c == T(1)) return;
    if (closed && !closed_gap<T>(seen, limit, limit)) return;
    FacePair<T>& pair = pairs_.emplace_back();
    pair.ball = ball;
    pair.corner = faces_.triangles[seen.triangle];
    pair.share = {a, b, c};
    pair.within = within;
    // Of a closed surface N leads outside; the nearest place of an open one is on the ball's side.
    if (seen.z < T(0) && within != closed) pair.side = T(-1);
  }

  void name_particles() {
    named_.clear();
    for (const FacePair<T>& pair : pairs_)
      named_.insert(named_.end(), pair.corner.begin(), pair.corner.end());
    std::ranges::sort(named_);
    named_.erase(std::unique(named_.begin(), named_.end()), named_.end());
    for (FacePair<T>& pair : pairs_)
      for (std::size_t n = 0; n < 3; ++n)
        pair.place[n] =
            static_cast<std::uint32_t>(std::ranges::lower_bound(named_, pair.corner[n]) - named_.begin());
  }

  /// Which pairs act now, and how many of each body do.
  template <class Acts>
  void tally(const BallPhase<T>& balls, const ParticleView<T>& particles, const Bodies& bodies,
             const Acts& acts) {
    ball_pairs_.assign(bodies.balls.size(), 0);
    particle_pairs_.assign(named_.size(), 0);
    for (FacePair<T>& pair : pairs_) {
      const auto x = [&](std::size_t n) { return particles.position(pair.corner[n]); };
      pair.gap = face_gap<T>(pair, balls.x.col(pair.ball), bodies.balls[pair.ball].radius, x(0), x(1), x(2));
      pair.acts = acts(pair);
      ball_pairs_[pair.ball] += pair.acts;
      for (const std::uint32_t place : pair.place) particle_pairs_[place] += pair.acts;
    }
  }

  /// c·w of the ball and of the place on the face, of whose parts each moves by its share.
  T weight_of(const FacePair<T>& pair, const Bodies& bodies) const {
    const auto part = [&](std::size_t n) {
      return pair.share[n] *
             (number(particle_pairs_[pair.place[n]]) * bodies.particle_weight[pair.corner[n]]);
    };
    return number(ball_pairs_[pair.ball]) * bodies.balls[pair.ball].inverse_mass + over_shares<T>(pair, part);
  }

  /// Calls take(ball, sum) with what each ball receives.
  template <class Take>
  void for_each_ball(const Take& take) const {
    for (std::size_t n = 0; n < pairs_.size();) {
      const std::uint32_t b = pairs_[n].ball;
      Impulse<T> sum = {Vector<T>::Zero(), Vector<T>::Zero()};
      for (; n < pairs_.size() && pairs_[n].ball == b; ++n) {
        if (!pairs_[n].acts) continue;
        sum.linear = sum.linear + pairs_[n].received.linear;
        sum.turning = sum.turning + pairs_[n].received.turning;
      }
      if (ball_pairs_[b] > 0) take(b, sum);
    }
  }

  /// Corners receive the opposite by their shares.
  void give_back(const std::array<T*, 3>& values, const ParticleView<T>& particles, const Bodies& bodies) {
    sums_.assign(named_.size(), Vector<T>::Zero());
    for (const FacePair<T>& pair : pairs_)
      for (std::size_t n = 0; pair.acts && n < 3; ++n)
        sums_[pair.place[n]] = sums_[pair.place[n]] - pair.share[n] * pair.received.linear;
    for (std::size_t n = 0; n < named_.size(); ++n) {
      const T w = bodies.particle_weight[named_[n]];
      if (particle_pairs_[n] > 0 && w != T(0)) particles.add_to(values, named_[n], w * sums_[n]);
    }
  }

  BallFaces faces_;
  std::vector<Box<T>> boxes_;  // of blocks
  std::vector<ClosestPoint<T>> closest_;
  std::vector<FacePair<T>> pairs_;
  std::vector<std::uint32_t> named_;                        // particles, ascending
  std::vector<std::uint32_t> ball_pairs_, particle_pairs_;  // that act
  std::vector<Vector<T>> sums_;
};

}  // namespace aspic::physics
