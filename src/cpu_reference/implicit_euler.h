#pragma once
// Backward Euler, solved: v' = v + h·a(x + h·v', v'), x' = x + h·v', in the Coulomb model with the ground in
// the equation: v' = P(v + h·a(x + h·v', v')) (derivation in docs/physics.md).
//
// Newton's method on v' with a line search; its linear systems by conjugate gradients with a block-Jacobi
// preconditioner, the spring Jacobian applied spring by spring and never stored as a matrix (Baraff and
// Witkin, Large Steps in Cloth Simulation, 1998). The Jacobian of a compressed spring has negative
// eigenvalues across its axis: they are left out of the matrix (Choi and Ko, Stable but Responsive Cloth,
// 2002), which keeps it symmetric positive definite, while the residual stays that of the true equation. So
// the method converges to the true solution, linearly where springs are compressed.
#include <cmath>
#include <memory>
#include <utility>

#include "cpu_reference/body_contact.h"
#include "cpu_reference/implicit_newton.h"
#include "cpu_reference/method.h"
#include "cpu_reference/terms.h"
#include "model/springs.h"
#include "physics/contact/implicit.h"
#include "physics/diagonal_block.h"
#include "physics/reductions.h"
#include "physics/terrain/implicit.h"

namespace aspic::reference {

/// Steps of backward Euler, one after another.
template <class T>
class ImplicitEuler final : public Method<T> {
 public:
  ImplicitEuler(const Dynamics<T>& dynamics, const Model& model)
      : dynamics_(dynamics),
        terms_(dynamics),
        ahead_(dynamics.grounds(), dynamics.contact(), model.contact.model == ContactModel::coulomb),
        limits_(model.simulation.implicit),
        h_(static_cast<T>(model.simulation.timestep)) {
    if (has_body_contact(model)) bodies_ = std::make_unique<ImplicitContact<T, BodyContact<T>>>(model);
  }

  /// Bytes that the solve holds at most: nine fields and those of two products, a force and two copies of the
  /// diagonal blocks, the ground's reaction on each particle, a Jacobian for each spring, three sums.
  static std::uint64_t bytes(const Model& model) {
    return model.particle_count() *
               (sizeof(T) * (3 * 12 + 3) + 2 * sizeof(DiagonalBlock<T>) + sizeof(GroundReaction<T>)) +
           spring_count(model) * sizeof(SpringJacobian<T>) +
           (has_body_contact(model) ? contact_bytes(model) : 0);
  }

  /// The equation's solution.
  Phase<T> step(const Phase<T>& s, SolveReport& report) override;
  void respond(const Phase<T>& s, Phase<T>& end) const override;

  // What solve_step() asks of a system (implicit_newton.h).
  Trial<T> start();
  Trial<T> fall();
  Trial<T> try_step(T lambda, bool onwards);
  bool contacts() const { return in_contact_; }
  Trial<T> update_contacts(bool from_trial);
  T start_solve();
  bool prescribes() const { return prescribes_; }
  bool interrupted() const { return dynamics_.interrupted(); }
  T apply();
  T advance(T alpha, bool first);
  void turn(T beta) { p_ = z_ + beta * p_; }

 private:
  void hold_contact_force(const Phase<T>& s);
  void meet_bodies(const Phase<T>& s);
  /// The sum of all terms on a particle where the step begins, found where something asks for it.
  auto start_force() {
    return [this](std::uint32_t p) -> Vector<T> {
      if (start_force_.cols() == 0) start_force_ = terms_.force(s_->x, s_->v);
      return start_force_.col(p);
    };
  }
  auto inverse_mass() const {
    return [this](std::uint32_t p) { return dynamics_.inverse_mass(p); };
  }
  bool contact(Field<T>& held, std::vector<DiagonalBlock<T>>& blocks);
  Trial<T> evaluate();
  Field<T> product(const Field<T>& p) const;
  Field<T> precondition(const Field<T>& r) const;
  T dot(const Field<T>& a, const Field<T>& b) const;

  const Dynamics<T>& dynamics_;
  Terms<T> terms_;
  GroundAhead<T> ahead_;
  std::unique_ptr<ImplicitContact<T, BodyContact<T>>> bodies_;  ///< none where none can touch
  SolveLimits<T> limits_;
  T h_;

  // Of the step under way.
  const Phase<T>* s_ = nullptr;    ///< where it began
  Field<T> held_;                  ///< contact force of the course model [N]
  bool in_contact_ = false;        ///< whether bodies may touch in it
  Field<T> start_force_;           ///< start_force() [N]
  Field<T> base_, trial_, delta_;  ///< velocities [m/s]: trial = base + λ·δ
  Field<T> r_, z_, p_, q_;         ///< of the linear system; r begins as m·(v − v') + h·f [kg·m/s]
  // At the trial.
  std::vector<DiagonalBlock<T>> preconditioner_;
  std::vector<GroundReaction<T>> ground_;  ///< on every particle
  Field<T> prescribed_;                    ///< the part of δ that the ground leaves no choice in [m/s]
  bool prescribes_ = false;                ///< whether any of it is not zero
};

template <class T>
Trial<T> ImplicitEuler<T>::start() {
  base_ = trial_ = s_->v;
  return evaluate();
}

template <class T>
Trial<T> ImplicitEuler<T>::fall() {
  const Vector<T> gained = h_ * dynamics_.body_force().gravity;
  for (Eigen::Index i = 0; i < trial_.cols(); ++i) {
    if (dynamics_.inverse_mass(i) != T(0)) trial_.col(i) = s_->v.col(i) + gained;
  }
  return evaluate();
}

template <class T>
Trial<T> ImplicitEuler<T>::try_step(T lambda, bool onwards) {
  if (onwards) base_ = trial_;
  trial_ = base_ + lambda * delta_;
  return evaluate();
}

/// The course model's contact force at the step's start, held throughout it [N]; zero in the Coulomb model.
template <class T>
void ImplicitEuler<T>::hold_contact_force(const Phase<T>& s) {
  held_ = Field<T>::Zero(3, s.x.cols());
  if (dynamics_.model().contact.model == ContactModel::coulomb) return;
  const Field<T> before = terms_.force(s.x, s.v);
  Field<T> f = before;
  dynamics_.add_contact_force(s.x, s.v, f);
  held_ = f - before;
}

/// Whether bodies may touch in the step from s.
template <class T>
void ImplicitEuler<T>::meet_bodies(const Phase<T>& s) {
  in_contact_ = bodies_ && bodies_->start(dynamics_.step(), view_of(s), start_force(), inverse_mass());
}

/// A second solve, with what touches where the first one ended.
template <class T>
Trial<T> ImplicitEuler<T>::update_contacts(bool from_trial) {
  if (!from_trial) trial_ = base_;
  const Phase<T> end = {s_->x + h_ * trial_, trial_};
  in_contact_ = bodies_->search_again(view_of(*s_), view_of(end), start_force(), inverse_mass());
  return evaluate();
}

/// Adds contact of bodies at the trial to forces and blocks. Returns whether any acts.
template <class T>
bool ImplicitEuler<T>::contact(Field<T>& held, std::vector<DiagonalBlock<T>>& blocks) {
  const bool acts = bodies_->react([&](std::uint32_t p) { return Vector<T>(trial_.col(p)); });
  Field<T> force = Field<T>::Zero(3, held.cols());
  std::vector<DiagonalBlock<T>> own(blocks.size(), DiagonalBlock<T>(T(0)));
  for (std::size_t n = 0; n < bodies_->particles().size(); ++n) {
    force.col(bodies_->particles()[n]) = bodies_->force(n);
    own[bodies_->particles()[n]] = bodies_->block(n);
  }
  held += force;
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i].add(own[i]);
  return acts;
}

template <class T>
Trial<T> ImplicitEuler<T>::evaluate() {
  const Phase<T>& s = *s_;
  const Eigen::Index count = s.x.cols();
  auto [f, blocks] = terms_.linearize(s.x, trial_);
  Field<T> held = held_;
  bool holds = in_contact_ && contact(held, blocks);
  r_ = prescribed_ = Field<T>::Zero(3, count);
  preconditioner_.clear();
  preconditioner_.reserve(static_cast<std::size_t>(count));
  ground_.assign(static_cast<std::size_t>(count), {});
  prescribes_ = false;
  std::vector<T> largest(static_cast<std::size_t>(count), T(0)), squared = largest, falling = largest;
  const Vector<T> fall = h_ * dynamics_.body_force().gravity;
  for (Eigen::Index i = 0; i < count; ++i) {
    DiagonalBlock<T>& block = blocks[static_cast<std::size_t>(i)];
    if (dynamics_.inverse_mass(i) == T(0)) {
      preconditioner_.push_back(block.inverse());
      continue;
    }
    const Vector<T> total = f.col(i) + held.col(i), change = trial_.col(i) - s.v.col(i);
    const Vector<T> gained = h_ * (dynamics_.inverse_mass(i) * total);
    r_.col(i) = h_ * total - dynamics_.mass(i) * change;
    Vector<T> R = change - gained;
    if (ahead_.acts()) {
      const Vector<T> free = s.v.col(i) + gained;
      const GroundReaction<T> reaction = ahead_.react(i, dynamics_.mass(i), free);
      if (reaction.freedom != Freedom::all) {
        R = trial_.col(i) - reaction.v;
        prescribed_.col(i) = -reaction.held_part(R);
        r_.col(i) = reaction.right_hand_side(dynamics_.mass(i), R);
        ground_[static_cast<std::size_t>(i)] = reaction;
        block.add({reaction.stiffness, T(0), reaction.across});
        holds = true;
        prescribes_ = prescribes_ || (prescribed_.col(i).array() != T(0)).any();
      }
    }
    preconditioner_.push_back(block.inverse());
    largest[static_cast<std::size_t>(i)] = largest_component<T>(R);
    squared[static_cast<std::size_t>(i)] = dot3<T>(R, R);
    const Vector<T> after_fall = R + fall;
    falling[static_cast<std::size_t>(i)] = dot3<T>(after_fall, after_fall);
  }
  return {tree_max(std::move(largest)), tree_sum(std::move(squared)), tree_sum(std::move(falling)), holds};
}

template <class T>
T ImplicitEuler<T>::dot(const Field<T>& a, const Field<T>& b) const {
  std::vector<T> products(static_cast<std::size_t>(a.cols()));
  for (Eigen::Index i = 0; i < a.cols(); ++i)
    products[static_cast<std::size_t>(i)] = dot3<T>(a.col(i), b.col(i));
  return tree_sum(std::move(products));
}

/// A·p with A = m − h·∂f/∂v' at the trial; rows of pinned particles are empty.
template <class T>
Field<T> ImplicitEuler<T>::product(const Field<T>& p) const {
  Field<T> product = terms_.product(p);
  if (in_contact_) {
    bodies_->multiply([&](std::uint32_t i) { return Vector<T>(p.col(i)); });
    Field<T> own = Field<T>::Zero(3, p.cols());
    for (std::size_t k = 0; k < bodies_->particles().size(); ++k)
      own.col(bodies_->particles()[k]) = bodies_->product(k);
    product += own;
  }
  for (Eigen::Index i = 0; i < p.cols(); ++i) {
    const GroundReaction<T>& ground = ground_[static_cast<std::size_t>(i)];
    product.col(i) = ground.free_product(p.col(i), product.col(i));
    if (dynamics_.inverse_mass(i) == T(0)) product.col(i).setZero();
  }
  return product;
}

/// B⁻¹·r in the directions that the ground leaves free.
template <class T>
Field<T> ImplicitEuler<T>::precondition(const Field<T>& r) const {
  Field<T> z(3, r.cols());
  for (Eigen::Index i = 0; i < r.cols(); ++i) {
    const auto n = static_cast<std::size_t>(i);
    z.col(i) = ground_[n].free_part(preconditioner_[n] * Vector<T>(r.col(i)));
  }
  return z;
}

template <class T>
T ImplicitEuler<T>::start_solve() {
  delta_ = prescribed_;
  if (prescribes_) r_ -= product(delta_);
  p_ = z_ = precondition(r_);
  return dot(r_, z_);
}

template <class T>
T ImplicitEuler<T>::apply() {
  q_ = product(p_);
  return dot(p_, q_);
}

template <class T>
T ImplicitEuler<T>::advance(T alpha, bool first) {
  delta_ = first ? Field<T>(alpha * p_) : Field<T>(delta_ + alpha * p_);
  r_ -= alpha * q_;
  z_ = precondition(r_);
  return dot(r_, z_);
}

template <class T>
Phase<T> ImplicitEuler<T>::step(const Phase<T>& s, SolveReport& report) {
  s_ = &s;
  start_force_.resize(3, 0);
  hold_contact_force(s);
  ahead_.start(s.x);
  meet_bodies(s);
  Field<T> v = solve_step(*this, limits_, report) ? trial_ : base_;
  for (Eigen::Index i = 0; i < v.cols(); ++i) {  // the ground gives way by no tolerance
    if (ground_[static_cast<std::size_t>(i)].freedom != Freedom::all) v.col(i) += prescribed_.col(i);
  }
  return {s.x + h_ * v, v};
}

template <class T>
void ImplicitEuler<T>::respond(const Phase<T>& s, Phase<T>& end) const {
  if (!ahead_.acts()) return dynamics_.respond(s.x, s.v, end.x, end.v);
  for (Eigen::Index i = 0; i < end.x.cols(); ++i) {
    if (dynamics_.inverse_mass(i) == T(0)) continue;
    Vector<T> x = end.x.col(i), v = end.v.col(i);
    for (std::size_t t = 0; t < dynamics_.grounds().size(); ++t) {
      const bool held = ground_[static_cast<std::size_t>(i)].holds(t);
      respond_solved<T>(dynamics_.grounds()[t], dynamics_.contact(), dynamics_.body_force().gravity,
                        dynamics_.mass(i), held, s.x.col(i), s.v.col(i), x, v);
    }
    end.x.col(i) = x;
    end.v.col(i) = v;
  }
}

// Compiled once, in implicit_euler.cpp.
extern template class ImplicitEuler<float>;
extern template class ImplicitEuler<double>;

}  // namespace aspic::reference
