#pragma once
// What balls do in a step, spec §2.7: free flight with the scene's integrator, terrain, each other,
// particles, and last the position phase.
//
// A phase is Jacobi's: all of its pairs are computed from the velocities the phase before left, with every
// body's mass shared among its acting pairs; a body's impulses are summed in ascending partner index. So many
// simultaneous contacts keep momentum and never raise the energy: the outcome of a body is the mean of what
// its parts would do, each in a collision of its own.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "cpu_reference/ball_contact.h"
#include "cpu_reference/integrators.h"

namespace aspic::reference {

/// Positions, velocities and angular velocities of all balls.
template <class T>
struct BallPhase {
  Field<T> x, v, omega;
};

template <class T>
class Balls {
 public:
  explicit Balls(const Model& model)
      : model_(model),
        gravity_(rounded<T>(model.simulation.gravity)),
        rules_{ContactConstants<T>(model), static_cast<T>(model.contact.ball_restitution),
               static_cast<T>(model.contact.ball_friction), model.contact.spin} {
    for (const Ball& ball : model.balls) {
      bodies_.emplace_back(ball);
      largest_radius_ = std::max(largest_radius_, static_cast<double>(bodies_.back().radius));
    }
    for (const Terrain& terrain : model.terrain) grounds_.emplace_back(terrain);
    for (std::uint32_t i = 0; i < model.particle_count(); ++i)
      particle_weight_.push_back(static_cast<T>(model.inverse_mass[i]));
  }

  /// One step of all balls launched by step number `step`, from `start`; particles went from `particle_start`
  /// to `particles`, their terrain's response included, and are changed by the balls they meet.
  BallPhase<T> step(std::uint64_t step, const BallPhase<T>& start, const Phase<T>& particle_start,
                    Phase<T>& particles) {
    BallPhase<T> end = fly(step, start);
    find_touches(step, end, particles);
    exchange_among_balls(start, end);
    exchange_with_particles(start, end, particle_start, particles);
    separate(end, particles);
    return end;
  }

 private:
  /// Two bodies closer than ε, as `own` sees it.
  struct Touch {
    std::uint32_t own, other;
    Gap<T> gap;
    bool acting = false;
  };
  using Counts = std::vector<std::uint32_t>;

  /// The forces of one step from `start`: gravity, then what every terrain adds.
  struct Flight {
    const Balls& balls;
    const BallPhase<T>& start;

    /// a(x, v) of every ball [m/s²].
    Field<T> acceleration(const Field<T>& x, const Field<T>& v) const {
      const bool course = balls.model_.contact.model == ContactModel::course;
      Field<T> a(3, x.cols());
      for (Eigen::Index b = 0; b < x.cols(); ++b) {
        const BallBody<T>& ball = balls.bodies_[static_cast<std::size_t>(b)];
        Vector<T> f = ball.mass * balls.gravity_;
        for (const Ground<T>& ground : balls.grounds_) {
          f = course ? with_contact_force<T>(ground, balls.rules_.contact.epsilon,
                                             ball_gap<T>(ground, ball.radius, x.col(b)), v.col(b), f)
                     : with_ball_reaction<T>(ground, balls.rules_, ball, start.x.col(b), start.v.col(b), f);
        }
        a.col(b) = ball.inverse_mass * f;
      }
      return a;
    }
  };

  BallPhase<T> fly(std::uint64_t step, const BallPhase<T>& start) const {
    // The force does not depend on where it is evaluated, and the course model's contact force is held at
    // (x, v).
    const Integrator integrator = free_flight_row(model_.simulation.integrator).integrator;
    const Phase<T> flown = explicit_step(integrator, Flight{*this, start}, Phase<T>{start.x, start.v},
                                         model_.simulation.timestep);
    BallPhase<T> end = start;
    for (Eigen::Index b = 0; b < start.x.cols(); ++b) {
      const auto ball = static_cast<std::size_t>(b);
      if (!model_.balls[ball].launched(step)) continue;
      Vector<T> x = flown.x.col(b), v = flown.v.col(b), omega = start.omega.col(b);
      Vector<T> f = bodies_[ball].mass * gravity_;
      for (const Ground<T>& ground : grounds_) {
        if (model_.contact.model == ContactModel::course) {
          respond_ball_course<T>(ground, rules_, bodies_[ball], x, v, omega);
        } else {
          respond_ball_coulomb<T>(ground, rules_, bodies_[ball], start.x.col(b), start.v.col(b), f, x, v,
                                  omega);
        }
      }
      end.x.col(b) = x;
      end.v.col(b) = v;
      end.omega.col(b) = omega;
    }
    return end;
  }

  void find_touches(std::uint64_t step, const BallPhase<T>& balls, const Phase<T>& particles);
  void exchange_among_balls(const BallPhase<T>& start, BallPhase<T>& balls);
  void exchange_with_particles(const BallPhase<T>& start, BallPhase<T>& balls, const Phase<T>& particle_start,
                               Phase<T>& particles);
  void separate(BallPhase<T>& balls, Phase<T>& particles);

  const BallBody<T>& body(std::uint32_t b) const { return bodies_[b]; }
  static T number(std::uint32_t count) { return static_cast<T>(count); }

  const Model& model_;
  Vector<T> gravity_;
  BallRules<T> rules_;
  double largest_radius_ = 0.0;
  std::vector<BallBody<T>> bodies_;
  std::vector<Ground<T>> grounds_;
  std::vector<T> particle_weight_;  // w of every particle
  // Of the step under way, each sorted by (own, other).
  std::vector<Touch> ball_ball_, ball_particle_, particle_ball_;
};

/// All pairs closer than ε. Balls sorted along x leave few candidates; the test itself is that of all pairs.
template <class T>
void Balls<T>::find_touches(std::uint64_t step, const BallPhase<T>& balls, const Phase<T>& particles) {
  std::vector<std::pair<T, std::uint32_t>> along_x;
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    if (model_.balls[b].launched(step) && balls.x.col(b).allFinite()) along_x.push_back({balls.x(0, b), b});
  }
  std::sort(along_x.begin(), along_x.end());
  // A relative margin far above rounding keeps every pair that the exact test would take.
  const auto candidates = [&](T x, double reach, const auto& take) {
    const double from = static_cast<double>(x) - reach * 1.001, to = static_cast<double>(x) + reach * 1.001;
    auto at = std::lower_bound(along_x.begin(), along_x.end(), from, [](const auto& entry, double limit) {
      return static_cast<double>(entry.first) < limit;
    });
    for (; at != along_x.end() && static_cast<double>(at->first) <= to; ++at) take(at->second);
  };
  const double margin = static_cast<double>(rules_.contact.epsilon);

  ball_ball_.clear();
  for (const auto& [x, own] : along_x) {
    candidates(x, 2.0 * largest_radius_ + margin, [&, own = own](std::uint32_t other) {
      if (own == other) return;
      const Vector<T> e = balls.x.col(own) - balls.x.col(other);
      const Gap<T> g = pair_gap<T>(e, body(own).radius + body(other).radius, own < other);
      if (g.d < rules_.contact.epsilon) ball_ball_.push_back({own, other, g});
    });
  }
  ball_particle_.clear();
  particle_ball_.clear();
  for (std::uint32_t p = 0; p < particle_weight_.size(); ++p) {
    if (along_x.empty() || !particles.x.col(p).allFinite()) continue;
    candidates(particles.x(0, p), largest_radius_ + margin, [&](std::uint32_t b) {
      const Vector<T> e = particles.x.col(p) - balls.x.col(b), back = balls.x.col(b) - particles.x.col(p);
      const Gap<T> g = pair_gap<T>(e, body(b).radius, true);
      if (!(g.d < rules_.contact.epsilon)) return;
      particle_ball_.push_back({p, b, g});
      ball_particle_.push_back({b, p, pair_gap<T>(back, body(b).radius, false)});
    });
  }
  for (std::vector<Touch>* list : {&ball_ball_, &ball_particle_, &particle_ball_}) {
    std::sort(list->begin(), list->end(), [](const Touch& a, const Touch& b) {
      return a.own != b.own ? a.own < b.own : a.other < b.other;
    });
  }
}

template <class T>
void Balls<T>::exchange_among_balls(const BallPhase<T>& start, BallPhase<T>& balls) {
  Counts c(bodies_.size(), 0);
  for (Touch& touch : ball_ball_) {
    const Vector<T> dv = balls.v.col(touch.own) - balls.v.col(touch.other);
    touch.acting = dot3<T>(dv, touch.gap.n) < T(0);
    c[touch.own] += touch.acting;
  }
  std::vector<Impulse<T>> sum(bodies_.size(), {Vector<T>::Zero(), Vector<T>::Zero()});
  for (const Touch& touch : ball_ball_) {
    if (!touch.acting) continue;
    const std::uint32_t i = touch.own, j = touch.other;
    const Vector<T> dv = balls.v.col(i) - balls.v.col(j), dv0 = start.v.col(i) - start.v.col(j);
    const Vector<T> rolling = body(i).radius * balls.omega.col(i) + body(j).radius * balls.omega.col(j);
    const T weight = number(c[i]) * body(i).inverse_mass + number(c[j]) * body(j).inverse_mass;
    const T slip_weight = weight + (number(c[i]) * body(i).slip + number(c[j]) * body(j).slip);
    const Impulse<T> p = impact<T>(rules_, touch.gap.n, dv, dv0, rolling, weight, slip_weight);
    sum[i].linear += p.linear;
    sum[i].turning += p.turning;
  }
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    if (c[b] == 0) continue;
    balls.v.col(b) += body(b).inverse_mass * sum[b].linear;
    if (rules_.spin) balls.omega.col(b) += body(b).turn * sum[b].turning;
  }
}

template <class T>
void Balls<T>::exchange_with_particles(const BallPhase<T>& start, BallPhase<T>& balls,
                                       const Phase<T>& particle_start, Phase<T>& particles) {
  Counts c_ball(bodies_.size(), 0), c_particle(particle_weight_.size(), 0);
  for (Touch& touch : ball_particle_) {
    const Vector<T> dv = balls.v.col(touch.own) - particles.v.col(touch.other);
    touch.acting = dot3<T>(dv, touch.gap.n) < T(0);
    c_ball[touch.own] += touch.acting;
  }
  for (Touch& touch : particle_ball_) {
    const Vector<T> dv = particles.v.col(touch.own) - balls.v.col(touch.other);
    touch.acting = dot3<T>(dv, touch.gap.n) < T(0);
    c_particle[touch.own] += touch.acting;
  }
  const auto received = [&](const Touch& touch, std::uint32_t b, std::uint32_t p, const Vector<T>& dv,
                            const Vector<T>& dv0) {
    const Vector<T> rolling = body(b).radius * balls.omega.col(b);
    const T weight = number(c_ball[b]) * body(b).inverse_mass + number(c_particle[p]) * particle_weight_[p];
    const T slip_weight = weight + number(c_ball[b]) * body(b).slip;
    return impact<T>(rules_, touch.gap.n, dv, dv0, rolling, weight, slip_weight);
  };
  std::vector<Impulse<T>> on_ball(bodies_.size(), {Vector<T>::Zero(), Vector<T>::Zero()});
  std::vector<Vector<T>> on_particle(particle_weight_.size(), Vector<T>::Zero());
  for (const Touch& touch : ball_particle_) {
    if (!touch.acting) continue;
    const std::uint32_t b = touch.own, p = touch.other;
    const Impulse<T> got =
        received(touch, b, p, balls.v.col(b) - particles.v.col(p), start.v.col(b) - particle_start.v.col(p));
    on_ball[b].linear += got.linear;
    on_ball[b].turning += got.turning;
  }
  for (const Touch& touch : particle_ball_) {
    if (!touch.acting) continue;
    const std::uint32_t p = touch.own, b = touch.other;
    on_particle[p] +=
        received(touch, b, p, particles.v.col(p) - balls.v.col(b), particle_start.v.col(p) - start.v.col(b))
            .linear;
  }
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    if (c_ball[b] == 0) continue;
    balls.v.col(b) += body(b).inverse_mass * on_ball[b].linear;
    if (rules_.spin) balls.omega.col(b) += body(b).turn * on_ball[b].turning;
  }
  for (std::uint32_t p = 0; p < particle_weight_.size(); ++p) {
    if (c_particle[p] == 0 || particle_weight_[p] == T(0)) continue;
    particles.v.col(p) += particle_weight_[p] * on_particle[p];
  }
}

/// The position phase, over all overlapping pairs at once: a ball's balls come before its particles.
template <class T>
void Balls<T>::separate(BallPhase<T>& balls, Phase<T>& particles) {
  const auto overlaps = [](const Touch& touch) { return touch.gap.d < T(0); };
  Counts c_ball(bodies_.size(), 0), c_particle(particle_weight_.size(), 0);
  for (const Touch& touch : ball_ball_) c_ball[touch.own] += overlaps(touch);
  for (const Touch& touch : ball_particle_) c_ball[touch.own] += overlaps(touch);
  for (const Touch& touch : particle_ball_) c_particle[touch.own] += overlaps(touch);
  const auto ball_weight = [&](std::uint32_t b) { return number(c_ball[b]) * body(b).inverse_mass; };
  const auto particle_weight = [&](std::uint32_t p) { return number(c_particle[p]) * particle_weight_[p]; };
  const auto push = [](const Touch& touch, T weight) {
    return Vector<T>((-touch.gap.d / weight) * touch.gap.n);
  };
  std::vector<Vector<T>> on_ball(bodies_.size(), Vector<T>::Zero()),
      on_particle(particle_weight_.size(), Vector<T>::Zero());
  for (const Touch& touch : ball_ball_) {
    if (overlaps(touch)) on_ball[touch.own] += push(touch, ball_weight(touch.own) + ball_weight(touch.other));
  }
  for (const Touch& touch : ball_particle_) {
    if (overlaps(touch))
      on_ball[touch.own] += push(touch, ball_weight(touch.own) + particle_weight(touch.other));
  }
  for (const Touch& touch : particle_ball_) {
    if (overlaps(touch))
      on_particle[touch.own] += push(touch, ball_weight(touch.other) + particle_weight(touch.own));
  }
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    if (c_ball[b] != 0) balls.x.col(b) += body(b).inverse_mass * on_ball[b];
  }
  for (std::uint32_t p = 0; p < particle_weight_.size(); ++p) {
    if (c_particle[p] != 0 && particle_weight_[p] != T(0))
      particles.x.col(p) += particle_weight_[p] * on_particle[p];
  }
}

}  // namespace aspic::reference
