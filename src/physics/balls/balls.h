#pragma once
// What balls do in a step (docs/balls.md): free flight with the scene's integrator, terrain, each other,
// particles, the position phase, and last faces.
//
// A phase is Jacobi's: all of its pairs are computed from the velocities the phase before left, with every
// body's mass shared among its acting pairs; a body's impulses are summed in ascending partner index, in
// blocks of 256 (physics/reductions.h). So many simultaneous contacts keep momentum and never raise the
// energy: the outcome of a body is the mean of its parts' outcomes, each in a separate collision.
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "aspic/inputs.h"
#include "model/inputs.h"
#include "model/integrator.h"
#include "physics/balls/faces.h"
#include "physics/balls/law.h"
#include "physics/balls/pairs.h"
#include "physics/balls/phase.h"
#include "physics/body_force.h"
#include "physics/particle_view.h"
#include "physics/phase.h"
#include "physics/pulls/law.h"
#include "physics/reductions.h"

namespace aspic::physics {

/// Candidates by their definition: every ball.
template <class T>
class AllBalls {
 public:
  /// `balls`: ascending indices, which must outlive this.
  AllBalls(const Field<T>&, const std::vector<std::uint32_t>& balls, double) : balls_(balls) {}
  bool empty() const { return balls_.empty(); }
  bool any_near(const SearchBox<T>&) const { return true; }
  /// Calls take(b) for every ball that may touch a ball (`of_ball`) or a particle at x, in any order.
  template <class Take>
  void candidates(const Vector<T>&, bool /*of_ball*/, const Take& take) const {
    for (const std::uint32_t b : balls_) take(b);
  }

 private:
  const std::vector<std::uint32_t>& balls_;
};

/// `Search`: finds candidates as AllBalls does, perhaps fewer.
template <class T, template <class> class Search = AllBalls>
class Balls {
 public:
  explicit Balls(const Model& model)
      : model_(&model),
        body_force_(model),
        rules_{ContactConstants<T>(model), static_cast<T>(model.contact.ball_restitution),
               static_cast<T>(model.contact.ball_friction), model.contact.spin},
        particle_weight_(model.inverse_mass),
        faces_(model) {
    for (const Ball& ball : model.balls) {
      bodies_.emplace_back(ball);
      largest_radius_ = std::max(largest_radius_, static_cast<double>(bodies_.back().radius));
    }
    for (const Terrain& terrain : model.terrain) grounds_.emplace_back(terrain);
  }

  /// Inputs of the model that rounded_inputs() returned hold until others are set; particles feel their pulls
  /// elsewhere (dynamics.h).
  void set_inputs(const Inputs& inputs) {
    pulls_.clear();
    for (const Pull& pull : inputs.pulls)
      if (pull.ball) pulls_.emplace_back(pull);
    particle_weight_ = Runs<T>(inverse_mass_under(*model_, inputs));
  }

  /// Bytes it holds on the heap, without contacts.
  std::uint64_t bytes() const {
    return particle_weight_.bytes() + bodies_.capacity() * sizeof(BallBody<T>) +
           grounds_.capacity() * sizeof(Ground<T>);
  }

  /// One step of all balls launched by step number `step`, from `start`; particles went from `particle_start`
  /// to `particles`, their terrain's response included, and are changed by the balls they meet.
  /// `fly(integrator, forces, phase, h)`: a step of an explicit method.
  template <class Fly>
  BallPhase<T> step(std::uint64_t step, const BallPhase<T>& start,
                    const ParticleView<const T>& particle_start, const ParticleView<T>& particles,
                    const Fly& fly) {
    for (Ground<T>& ground : grounds_) ground.begin_step(model_->simulation.timestep, step);
    // The force does not depend on where it is evaluated, and the course model's contact force is held at
    // (x, v).
    const Phase<T> flown = fly(free_flight_row(model_->simulation.integrator).integrator,
                               Flight{*this, start}, Phase<T>{start.x, start.v}, model_->simulation.timestep);
    BallPhase<T> end = land(step, start, flown);
    find_contacts(step, end, particles);
    exchange_among_balls(start, end);
    exchange_with_particles(start, end, particle_start, particles);
    separate(end, particles);
    faces_.meet(start, end, particle_start, particles, all_bodies());
    return end;
  }

 private:
  /// Particles next to each other in number, which are mostly so in space: a box around them is far from all
  /// balls, or each of them looks for its own.
  static constexpr std::uint32_t neighborhood = 64;
  static constexpr std::uint32_t no_ball = 0xffffffffu;
  using Counts = std::vector<std::uint32_t>;
  /// What balls receive in a phase.
  using Impulses = std::vector<std::pair<std::uint32_t, Impulse<T>>>;
  /// Impulses on one body, summed up.
  struct ImpulseSum {
    PartnerSum<Vector<T>> linear{Vector<T>::Zero()}, turning{Vector<T>::Zero()};
    void add(const Impulse<T>& impulse) {
      linear.add(impulse.linear);
      turning.add(impulse.turning);
    }
    Impulse<T> total() { return {linear.total(), turning.total()}; }
  };

  /// What acts on a ball throughout a step from `start`: gravity, and drag and pulls as they are then [N].
  Vector<T> constant_force(const BallPhase<T>& start, Eigen::Index b) const {
    Vector<T> f = body_force_.at(bodies_[static_cast<std::size_t>(b)].mass, start.v.col(b));
    for (const PullConstants<T>& pull : pulls_) {
      if (pull.particle != b) continue;
      f += pull_force<T>(pull, start.x.col(b), start.v.col(b));
    }
    return f;
  }

  /// The forces of one step from `start`: the constant one, then what every terrain adds.
  struct Flight {
    const Balls& balls;
    const BallPhase<T>& start;

    /// a(x, v) of every ball [m/s²].
    Field<T> acceleration(const Field<T>& x, const Field<T>& v, double /*share*/) const {
      const bool course = balls.model_->contact.model == ContactModel::course;
      Field<T> a(3, x.cols());
      for (Eigen::Index b = 0; b < x.cols(); ++b) {
        const BallBody<T>& ball = balls.bodies_[static_cast<std::size_t>(b)];
        Vector<T> f = balls.constant_force(start, b);
        for (const Ground<T>& ground : balls.grounds_) {
          f = course ? with_contact_force<T>(ground, balls.rules_.contact,
                                             ball_gap<T>(ground, ground.start, ball.radius, x.col(b)),
                                             v.col(b), f)
                     : with_ball_reaction<T>(ground, balls.rules_, ball, start.x.col(b), start.v.col(b), f);
        }
        a.col(b) = ball.inverse_mass * f;
      }
      return a;
    }
  };

  BallPhase<T> land(std::uint64_t step, const BallPhase<T>& start, const Phase<T>& flown) const {
    BallPhase<T> end = start;
    for (Eigen::Index b = 0; b < start.x.cols(); ++b) {
      const auto ball = static_cast<std::size_t>(b);
      if (!model_->balls[ball].launched(step)) continue;
      Vector<T> x = flown.x.col(b), v = flown.v.col(b), omega = start.omega.col(b);
      Vector<T> f = constant_force(start, b);
      for (const Ground<T>& ground : grounds_) {
        if (model_->contact.model == ContactModel::course) {
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

  void find_contacts(std::uint64_t step, const BallPhase<T>& balls, const ParticleView<T>& particles);
  /// Adds the balls closer than ε to a body of this radius at x, ball `own` or a particle (no_ball), in
  /// ascending index; gap_to(b) is the gap to ball b. They stay in near_.
  template <class GapTo>
  void add_near(const Search<T>& search, const BallPhase<T>& balls, const Vector<T>& x, T radius,
                std::uint32_t own, const GapTo& gap_to, Contacts& contacts);
  void list_particles_of_balls();
  void exchange_among_balls(const BallPhase<T>& start, BallPhase<T>& balls);
  void exchange_with_particles(const BallPhase<T>& start, BallPhase<T>& balls,
                               const ParticleView<const T>& particle_start, const ParticleView<T>& particles);
  void receive(BallPhase<T>& balls, const Impulses& impulses) const;
  void separate(BallPhase<T>& balls, const ParticleView<T>& particles);

  /// Of two balls, of a particle and a ball, and of a ball and a particle: as the first of them sees it.
  Gap<T> between_balls(const BallPhase<T>& balls, std::uint32_t own, std::uint32_t other) const {
    const Vector<T> e = balls.x.col(own) - balls.x.col(other);
    return pair_gap<T>(e, body(own).radius + body(other).radius, own < other);
  }
  Gap<T> from_particle(const BallPhase<T>& balls, const ParticleView<T>& particles, std::uint32_t p,
                       std::uint32_t b) const {
    const Vector<T> e = particles.position(p) - balls.x.col(b);
    return pair_gap<T>(e, body(b).radius, true);
  }
  Gap<T> from_ball(const BallPhase<T>& balls, const ParticleView<T>& particles, std::uint32_t b,
                   std::uint32_t p) const {
    const Vector<T> e = balls.x.col(b) - particles.position(p);
    return pair_gap<T>(e, body(b).radius, false);
  }

  /// False only for bodies that are further apart than ε, far beyond rounding.
  bool may_contact(const Vector<T>& e, T reach) const {
    const T limit = T(1.01) * (reach + rules_.contact.distance);
    return !(dot3<T>(e, e) > limit * limit);
  }

  const BallBody<T>& body(std::uint32_t b) const { return bodies_[b]; }
  typename BallsOnFaces<T>::Bodies all_bodies() const { return {rules_, bodies_, particle_weight_}; }
  static T number(std::uint32_t count) { return static_cast<T>(count); }

  const Model* model_;
  BodyForce<T> body_force_;
  BallRules<T> rules_;
  double largest_radius_ = 0.0;
  std::vector<BallBody<T>> bodies_;
  std::vector<Ground<T>> grounds_;
  std::vector<PullConstants<T>> pulls_;
  Runs<T> particle_weight_;  // w of every particle
  BallsOnFaces<T> faces_;
  // Of the step under way.
  Contacts ball_ball_, ball_particle_, particle_ball_;
  std::vector<std::uint32_t> present_;     // balls that have been launched
  std::vector<std::uint32_t> near_;        // partners of one body
  std::vector<std::uint32_t> in_contact_;  // particles near balls: the bodies of particle_ball_
};

/// All pairs closer than ε, from candidates that a grid offers: the test itself is that of all pairs.
template <class T, template <class> class Search>
void Balls<T, Search>::find_contacts(std::uint64_t step, const BallPhase<T>& balls,
                                     const ParticleView<T>& particles) {
  present_.clear();
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    if (model_->balls[b].launched(step) && balls.x.col(b).allFinite()) present_.push_back(b);
  }
  const Search<T> search(balls.x, present_, largest_radius_ + static_cast<double>(rules_.contact.distance));
  ball_ball_.clear();
  auto next = present_.begin();
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    if (next != present_.end() && *next == b) {
      const auto gap_to = [&](std::uint32_t other) { return between_balls(balls, b, other); };
      add_near(search, balls, balls.x.col(b), body(b).radius, b, gap_to, ball_ball_);
      ++next;
    }
    ball_ball_.end_body();
  }
  particle_ball_.clear();
  in_contact_.clear();
  const auto count = static_cast<std::uint32_t>(search.empty() ? 0 : particle_weight_.size());
  for (std::uint32_t first = 0; first < count; first += neighborhood) {
    const std::uint32_t end = std::min(count, first + neighborhood);
    if (!search.any_near(box_of(particles, first, end))) continue;
    for (std::uint32_t p = first; p < end; ++p) {
      const Vector<T> x = particles.position(p);
      if (!x.allFinite()) continue;
      const auto gap_to = [&](std::uint32_t b) { return from_particle(balls, particles, p, b); };
      add_near(search, balls, x, T(0), no_ball, gap_to, particle_ball_);
      if (near_.empty()) continue;
      particle_ball_.end_body();
      in_contact_.push_back(p);
    }
  }
  list_particles_of_balls();
  faces_.find(present_, balls, all_bodies(), particles);
}

template <class T, template <class> class Search>
template <class GapTo>
void Balls<T, Search>::add_near(const Search<T>& search, const BallPhase<T>& balls, const Vector<T>& x,
                                T radius, std::uint32_t own, const GapTo& gap_to, Contacts& contacts) {
  near_.clear();
  search.candidates(x, own != no_ball, [&](std::uint32_t b) {
    if (b == own || !may_contact(x - balls.x.col(b), radius + body(b).radius)) return;
    if (gap_to(b).d < rules_.contact.distance) near_.push_back(b);
  });
  if (!std::is_sorted(near_.begin(), near_.end())) std::sort(near_.begin(), near_.end());
  for (const std::uint32_t b : near_) contacts.add(b, gap_to(b).d < T(0));
}

/// The particles' pairs once more, ball by ball: partners are numbers in in_contact_. Particles come in
/// ascending index, so they do in each ball's list.
template <class T, template <class> class Search>
void Balls<T, Search>::list_particles_of_balls() {
  std::vector<std::size_t>& start = ball_particle_.start;
  start.assign(bodies_.size() + 1, 0);
  for (const std::uint32_t b : particle_ball_.other) ++start[b + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  ball_particle_.other.resize(particle_ball_.other.size());
  ball_particle_.overlap.resize(particle_ball_.other.size());
  for (std::uint32_t n = 0; n < in_contact_.size(); ++n) {
    for (std::size_t k = particle_ball_.start[n]; k < particle_ball_.start[n + 1]; ++k) {
      const std::size_t place = next[particle_ball_.other[k]]++;
      ball_particle_.other[place] = n;
      ball_particle_.overlap[place] = particle_ball_.overlap[k];
    }
  }
}

template <class T, template <class> class Search>
void Balls<T, Search>::receive(BallPhase<T>& balls, const Impulses& impulses) const {
  for (const auto& [b, impulse] : impulses) {
    balls.v.col(b) += body(b).inverse_mass * impulse.linear;
    if (rules_.spin) balls.omega.col(b) += body(b).turn * impulse.turning;
  }
}

template <class T, template <class> class Search>
void Balls<T, Search>::exchange_among_balls(const BallPhase<T>& start, BallPhase<T>& balls) {
  if (ball_ball_.other.empty()) return;
  const Counts c = tally(ball_ball_, [&](std::uint32_t i, std::uint32_t j) {
    const Vector<T> dv = balls.v.col(i) - balls.v.col(j);
    return dot3<T>(dv, between_balls(balls, i, j).n) < T(0);
  });
  Impulses impulses;
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    if (c[i] == 0) continue;
    ImpulseSum sum;
    for_each(ball_ball_, ball_ball_.acting, i, [&](std::uint32_t j) {
      const Vector<T> dv = balls.v.col(i) - balls.v.col(j), dv0 = start.v.col(i) - start.v.col(j);
      const Vector<T> rolling = body(i).radius * balls.omega.col(i) + body(j).radius * balls.omega.col(j);
      const T weight = number(c[i]) * body(i).inverse_mass + number(c[j]) * body(j).inverse_mass;
      const T slip_weight = weight + (number(c[i]) * body(i).slip + number(c[j]) * body(j).slip);
      sum.add(impact<T>(rules_, between_balls(balls, i, j).n, dv, dv0, rolling, weight, slip_weight));
    });
    impulses.push_back({i, sum.total()});
  }
  receive(balls, impulses);
}

template <class T, template <class> class Search>
void Balls<T, Search>::exchange_with_particles(const BallPhase<T>& start, BallPhase<T>& balls,
                                               const ParticleView<const T>& particle_start,
                                               const ParticleView<T>& particles) {
  if (particle_ball_.other.empty()) return;
  const Counts c_ball = tally(ball_particle_, [&](std::uint32_t b, std::uint32_t n) {
    const Vector<T> dv = balls.v.col(b) - particles.velocity(in_contact_[n]);
    return dot3<T>(dv, from_ball(balls, particles, b, in_contact_[n]).n) < T(0);
  });
  const Counts c_particle = tally(particle_ball_, [&](std::uint32_t n, std::uint32_t b) {
    const Vector<T> dv = particles.velocity(in_contact_[n]) - balls.v.col(b);
    return dot3<T>(dv, from_particle(balls, particles, in_contact_[n], b).n) < T(0);
  });
  const auto received = [&](const Vector<T>& normal, std::uint32_t b, std::uint32_t n, const Vector<T>& dv,
                            const Vector<T>& dv0) {
    const Vector<T> rolling = body(b).radius * balls.omega.col(b);
    const T weight =
        number(c_ball[b]) * body(b).inverse_mass + number(c_particle[n]) * particle_weight_[in_contact_[n]];
    const T slip_weight = weight + number(c_ball[b]) * body(b).slip;
    return impact<T>(rules_, normal, dv, dv0, rolling, weight, slip_weight);
  };
  Impulses on_ball;
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    if (c_ball[b] == 0) continue;
    ImpulseSum sum;
    for_each(ball_particle_, ball_particle_.acting, b, [&](std::uint32_t n) {
      const std::uint32_t p = in_contact_[n];
      sum.add(received(from_ball(balls, particles, b, p).n, b, n, balls.v.col(b) - particles.velocity(p),
                       start.v.col(b) - particle_start.velocity(p)));
    });
    on_ball.push_back({b, sum.total()});
  }
  std::vector<std::pair<std::uint32_t, Vector<T>>> on_particle;
  for (std::uint32_t n = 0; n < in_contact_.size(); ++n) {
    const std::uint32_t p = in_contact_[n];
    if (c_particle[n] == 0 || particle_weight_[p] == T(0)) continue;
    PartnerSum<Vector<T>> sum(Vector<T>::Zero());
    for_each(particle_ball_, particle_ball_.acting, n, [&](std::uint32_t b) {
      sum.add(received(from_particle(balls, particles, p, b).n, b, n, particles.velocity(p) - balls.v.col(b),
                       particle_start.velocity(p) - start.v.col(b))
                  .linear);
    });
    on_particle.push_back({p, sum.total()});
  }
  receive(balls, on_ball);
  for (const auto& [p, sum] : on_particle) particles.add_to(particles.v, p, particle_weight_[p] * sum);
}

/// The position phase, over all overlapping pairs at once: a ball's balls come before its particles.
template <class T, template <class> class Search>
void Balls<T, Search>::separate(BallPhase<T>& balls, const ParticleView<T>& particles) {
  if (ball_ball_.other.empty() && particle_ball_.other.empty()) return;
  Counts c_ball(bodies_.size(), 0), c_particle(in_contact_.size(), 0);
  tally_overlaps(ball_ball_, c_ball);
  tally_overlaps(ball_particle_, c_ball);
  tally_overlaps(particle_ball_, c_particle);
  const auto ball_weight = [&](std::uint32_t b) { return number(c_ball[b]) * body(b).inverse_mass; };
  const auto particle_weight = [&](std::uint32_t n) {
    return number(c_particle[n]) * particle_weight_[in_contact_[n]];
  };
  const auto correction = [](const Gap<T>& gap, T weight) { return Vector<T>((-gap.d / weight) * gap.n); };
  std::vector<std::pair<std::uint32_t, Vector<T>>> on_ball, on_particle;
  for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
    if (c_ball[b] == 0) continue;
    PartnerSum<Vector<T>> sum(Vector<T>::Zero());
    for_each(ball_ball_, ball_ball_.overlap, b, [&](std::uint32_t other) {
      sum.add(correction(between_balls(balls, b, other), ball_weight(b) + ball_weight(other)));
    });
    for_each(ball_particle_, ball_particle_.overlap, b, [&](std::uint32_t n) {
      sum.add(
          correction(from_ball(balls, particles, b, in_contact_[n]), ball_weight(b) + particle_weight(n)));
    });
    on_ball.push_back({b, sum.total()});
  }
  for (std::uint32_t n = 0; n < in_contact_.size(); ++n) {
    const std::uint32_t p = in_contact_[n];
    if (c_particle[n] == 0 || particle_weight_[p] == T(0)) continue;
    PartnerSum<Vector<T>> sum(Vector<T>::Zero());
    for_each(particle_ball_, particle_ball_.overlap, n, [&](std::uint32_t b) {
      sum.add(correction(from_particle(balls, particles, p, b), ball_weight(b) + particle_weight(n)));
    });
    on_particle.push_back({p, sum.total()});
  }
  for (const auto& [b, sum] : on_ball) balls.x.col(b) += body(b).inverse_mass * sum;
  for (const auto& [p, sum] : on_particle) particles.add_to(particles.x, p, particle_weight_[p] * sum);
}

}  // namespace aspic::physics
