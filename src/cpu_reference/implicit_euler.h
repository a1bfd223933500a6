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
#include <utility>

#include "cpu_reference/implicit_ground.h"
#include "cpu_reference/integrators.h"
#include "cpu_reference/reductions.h"
#include "model/implicit.h"
#include "model/springs.h"

namespace aspic::reference {

/// −h·∂f/∂v' of a spring as seen from one end: H·d = across·d + (along − across)·n(n·d).
template <class T>
struct SpringJacobian {
  T along, across;  ///< [kg]
  Vector<T> n;      ///< unit vector along the spring

  Vector<T> operator*(const Vector<T>& d) const {
    return across * d + ((along - across) * dot3<T>(n, d)) * n;
  }
};

/// Force on end a and Jacobian of a spring whose vector at the step's end is e and whose relative velocity is
/// v.
template <class T>
std::pair<Vector<T>, SpringJacobian<T>> linearised(const SpringConstants<T>& spring, T h, const Vector<T>& e,
                                                   const Vector<T>& v) {
  const Vector<T> none = Vector<T>::Zero();
  const T L = norm3<T>(e);
  if (L == T(0) || (spring.cord && L < spring.r)) return {none, {T(0), T(0), none}};
  const T q = T(1) / L;
  const T s = spring.k * (L - spring.r) + spring.c * (dot3<T>(v, e) * q);
  const Vector<T> f = -((s * q) * e);
  const T along = (h * h) * spring.k + h * spring.c;
  const T across = s > T(0) ? (h * h) * (s * q) : T(0);
  return {f, {along, across, Vector<T>(q * e)}};
}

/// The symmetric 3×3 block of one particle on the matrix's diagonal, and the solution of B·z = r by Cramer's
/// rule.
template <class T>
struct DiagonalBlock {
  T xx, yy, zz, xy, xz, yz;

  explicit DiagonalBlock(T m) : xx(m), yy(m), zz(m), xy(0), xz(0), yz(0) {}

  void add(const SpringJacobian<T>& H) {
    const Vector<T>& n = H.n;
    const T w = H.along - H.across;
    xx += H.across + w * (n.x() * n.x());
    yy += H.across + w * (n.y() * n.y());
    zz += H.across + w * (n.z() * n.z());
    xy += w * (n.x() * n.y());
    xz += w * (n.x() * n.z());
    yz += w * (n.y() * n.z());
  }

  /// The inverse, symmetric as well.
  DiagonalBlock inverse() const {
    DiagonalBlock c(T(0));
    c.xx = yy * zz - yz * yz;
    c.xy = xz * yz - xy * zz;
    c.xz = xy * yz - xz * yy;
    c.yy = xx * zz - xz * xz;
    c.yz = xy * xz - xx * yz;
    c.zz = xx * yy - xy * xy;
    const T d = T(1) / ((xx * c.xx + xy * c.xy) + xz * c.xz);
    c.xx *= d, c.yy *= d, c.zz *= d, c.xy *= d, c.xz *= d, c.yz *= d;
    return c;
  }

  Vector<T> operator*(const Vector<T>& r) const {
    return {(xx * r.x() + xy * r.y()) + xz * r.z(), (xy * r.x() + yy * r.y()) + yz * r.z(),
            (xz * r.x() + yz * r.y()) + zz * r.z()};
  }
};

/// Steps of backward Euler, one after another.
template <class T>
class ImplicitEuler {
 public:
  ImplicitEuler(const Dynamics<T>& dynamics, const Model& model)
      : dynamics_(dynamics),
        model_(model),
        ahead_(dynamics.grounds(), dynamics.contact().step, model.contact.model == ContactModel::coulomb),
        h_(static_cast<T>(model.simulation.timestep)),
        tolerance_(static_cast<T>(implicit_tolerance(
            model.simulation.implicit, sizeof(T) == 4 ? Precision::single : Precision::double_))),
        max_newton_(static_cast<std::uint32_t>(model.simulation.implicit.newton_iterations)),
        max_cg_(static_cast<std::uint32_t>(model.simulation.implicit.cg_iterations)) {}

  /// The equation's solution from `s`, before the terrain's response.
  Phase<T> step(const Phase<T>& s, SolveReport& report);

  /// The terrain's response at the end of the step from `s` that step() was last asked for.
  void respond(const Phase<T>& s, Phase<T>& end) const;

 private:
  /// Everything about one trial velocity.
  struct Evaluation {
    Field<T> r;  ///< right-hand side of the linear system: m·(v − v') + h·f [kg·m/s]
    std::vector<SpringJacobian<T>> jacobian;  ///< of every spring
    SpringJacobian<T> pull_jacobian;          ///< of the pull, where there is one
    std::vector<DiagonalBlock<T>> preconditioner;
    std::vector<GroundReaction<T>> ground;  ///< on every particle
    Field<T> prescribed;                    ///< the part of δ that the ground leaves no choice in [m/s]
    bool holds = false;                     ///< whether the ground holds any particle
    bool prescribes = false;                ///< whether any prescribed part is not zero
    T residual;  ///< largest component of |R|, R = (v' − v) − h·a, or v' − P(v + h·a) on the ground [m/s]
    T merit;  ///< Σ |R|² [m²/s²]
  };

  Evaluation evaluate(const Phase<T>& s, const Field<T>& held, const Field<T>& trial) const;
  Field<T> solve(const Evaluation& at, T forcing, std::uint32_t& iterations) const;
  Field<T> apply(const Evaluation& at, const Field<T>& p) const;
  Field<T> precondition(const Evaluation& at, const Field<T>& r) const;
  T dot(const Field<T>& a, const Field<T>& b) const;

  const Dynamics<T>& dynamics_;
  const Model& model_;
  GroundAhead<T> ahead_;
  std::vector<GroundReaction<T>> ground_;  ///< of the solution
  T h_, tolerance_;
  std::uint32_t max_newton_, max_cg_;
};

template <class T>
typename ImplicitEuler<T>::Evaluation ImplicitEuler<T>::evaluate(const Phase<T>& s, const Field<T>& held,
                                                                 const Field<T>& trial) const {
  const Eigen::Index count = s.x.cols();
  Evaluation at;
  Field<T> f(3, count);
  std::vector<DiagonalBlock<T>> blocks;
  for (Eigen::Index i = 0; i < count; ++i) {
    f.col(i) = dynamics_.mass(i) * dynamics_.gravity();
    blocks.emplace_back(dynamics_.mass(i));
  }
  at.jacobian.reserve(spring_count(model_));
  for (const Spring& spring : springs_of(model_)) {
    // Not from a rounded x': the difference of the positions is exact where they are close.
    const Vector<T> v = trial.col(spring.a) - trial.col(spring.b);
    const Vector<T> e = (s.x.col(spring.a) - s.x.col(spring.b)) + h_ * v;
    const auto [on_a, H] = linearised<T>(dynamics_.spring_class(spring), h_, e, v);
    f.col(spring.a) += on_a;
    f.col(spring.b) -= on_a;
    blocks[spring.a].add(H);
    blocks[spring.b].add(H);
    at.jacobian.push_back(H);
  }
  if (const auto& pull = dynamics_.pull()) {  // a spring whose other end neither moves nor gives way
    const Vector<T> v = trial.col(pull->particle);
    const Vector<T> e = (s.x.col(pull->particle) - pull->anchor) + h_ * v;
    const auto [on_particle, H] = linearised<T>(pull->spring, h_, e, v);
    f.col(pull->particle) += on_particle;
    blocks[static_cast<std::size_t>(pull->particle)].add(H);
    at.pull_jacobian = H;
  }
  at.r = at.prescribed = Field<T>::Zero(3, count);
  at.ground.resize(static_cast<std::size_t>(count));
  std::vector<T> largest(static_cast<std::size_t>(count), T(0)),
      squared(static_cast<std::size_t>(count), T(0));
  for (Eigen::Index i = 0; i < count; ++i) {
    DiagonalBlock<T>& block = blocks[static_cast<std::size_t>(i)];
    if (dynamics_.inverse_mass(i) == T(0)) {
      at.preconditioner.push_back(block.inverse());
      continue;
    }
    const Vector<T> total = f.col(i) + held.col(i), change = trial.col(i) - s.v.col(i);
    const Vector<T> gained = h_ * (dynamics_.inverse_mass(i) * total);
    at.r.col(i) = h_ * total - dynamics_.mass(i) * change;
    Vector<T> R = change - gained;
    if (ahead_.acts()) {
      const Vector<T> free = s.v.col(i) + gained;
      const GroundReaction<T> reaction = ahead_.react(i, dynamics_.mass(i), free);
      if (reaction.freedom != Freedom::all) {
        R = trial.col(i) - reaction.v;
        at.prescribed.col(i) = -reaction.held_part(R);
        at.r.col(i) = reaction.right_hand_side(dynamics_.mass(i), R);
        at.ground[static_cast<std::size_t>(i)] = reaction;
        block.add({reaction.stiffness, T(0), reaction.across});
        at.holds = true;
        at.prescribes = at.prescribes || (at.prescribed.col(i).array() != T(0)).any();
      }
    }
    at.preconditioner.push_back(block.inverse());
    const T x = std::abs(R.x()), y = std::abs(R.y()), z = std::abs(R.z());
    const T xy = y > x ? y : x;
    largest[static_cast<std::size_t>(i)] = z > xy ? z : xy;
    squared[static_cast<std::size_t>(i)] = dot3<T>(R, R);
  }
  at.residual = tree_max(std::move(largest));
  at.merit = tree_sum(std::move(squared));
  return at;
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
Field<T> ImplicitEuler<T>::apply(const Evaluation& at, const Field<T>& p) const {
  Field<T> product(3, p.cols());
  for (Eigen::Index i = 0; i < p.cols(); ++i) product.col(i) = dynamics_.mass(i) * p.col(i);
  std::size_t n = 0;
  for (const Spring& spring : springs_of(model_)) {
    const Vector<T> on_a = at.jacobian[n++] * Vector<T>(p.col(spring.a) - p.col(spring.b));
    product.col(spring.a) += on_a;
    product.col(spring.b) -= on_a;
  }
  if (const auto& pull = dynamics_.pull()) {
    product.col(pull->particle) += at.pull_jacobian * Vector<T>(p.col(pull->particle));
  }
  for (Eigen::Index i = 0; i < p.cols(); ++i) {
    const GroundReaction<T>& ground = at.ground[static_cast<std::size_t>(i)];
    if (ground.freedom == Freedom::plane) product.col(i) += ground.turning(p.col(i));
    if (ground.freedom != Freedom::all) product.col(i) = ground.free_part(product.col(i));
    if (dynamics_.inverse_mass(i) == T(0)) product.col(i).setZero();
  }
  return product;
}

/// B⁻¹·r in the directions that the ground leaves free.
template <class T>
Field<T> ImplicitEuler<T>::precondition(const Evaluation& at, const Field<T>& r) const {
  Field<T> z(3, r.cols());
  for (Eigen::Index i = 0; i < r.cols(); ++i) {
    const auto n = static_cast<std::size_t>(i);
    z.col(i) = at.ground[n].free_part(at.preconditioner[n] * Vector<T>(r.col(i)));
  }
  return z;
}

/// A·δ = r by preconditioned conjugate gradients (Hestenes and Stiefel, 1952), from the prescribed part of δ
/// on.
template <class T>
Field<T> ImplicitEuler<T>::solve(const Evaluation& at, T forcing, std::uint32_t& iterations) const {
  Field<T> delta = at.prescribed, r = at.r;
  if (at.prescribes) r -= apply(at, delta);
  Field<T> z = precondition(at, r), p = z;
  T rz = dot(r, z);
  if (at.prescribes && !(rz > T(0))) return delta;
  const T enough = (forcing * forcing) * rz;
  for (std::uint32_t n = 0; n < max_cg_; ++n) {
    const Field<T> q = apply(at, p);
    const T pq = dot(p, q);
    ++iterations;
    if (!(pq > T(0))) break;
    const T alpha = rz / pq;
    delta = n == 0 && !at.prescribes ? Field<T>(alpha * p) : Field<T>(delta + alpha * p);
    r -= alpha * q;
    z = precondition(at, r);
    const T rz_next = dot(r, z);
    if (!(rz_next > enough)) break;
    const T beta = rz_next / rz;
    rz = rz_next;
    p = z + beta * p;
  }
  return delta;
}

/// Eisenstat and Walker's forcing term from the ratio of two successive square sums of residuals.
template <class T>
T next_forcing(T ratio) {
  const T wanted = static_cast<T>(forcing_factor) * ratio;
  if (wanted < static_cast<T>(least_forcing)) return static_cast<T>(least_forcing);
  return wanted > static_cast<T>(most_forcing) ? static_cast<T>(most_forcing) : wanted;
}

template <class T>
Phase<T> ImplicitEuler<T>::step(const Phase<T>& s, SolveReport& report) {
  report = SolveReport{};
  const Field<T> held = dynamics_.held_contact_force(s.x, s.v);
  ahead_.start(s.x);
  Field<T> v = s.v;
  Evaluation at = evaluate(s, held, v);
  T best = at.residual, forcing = static_cast<T>(first_forcing);
  int without_progress = 0;
  bool on_ground = at.holds;
  report.end = SolveEnd::not_converged;
  while (true) {
    if (at.residual <= tolerance_) {
      report.end = SolveEnd::converged;
      break;
    }
    if (without_progress >= (on_ground ? max_without_progress_on_ground : max_without_progress)) {
      report.end = SolveEnd::stagnated;
      break;
    }
    if (report.newton_iterations == max_newton_) break;
    const Field<T> delta = solve(at, forcing, report.cg_iterations);
    ++report.newton_iterations;
    // The longest of the steps δ, δ/2, δ/4, … that brings the residuals down. R bends where a particle meets
    // or leaves the ground or stops to slide, so with the ground in the equation there may be none: then δ
    // itself, for Newton's method finds its way over a larger residual.
    T lambda = 1;
    Field<T> trial = v + lambda * delta;
    Evaluation next = evaluate(s, held, trial);
    on_ground = at.holds || next.holds;
    int halvings = 0;
    while (!(next.merit < at.merit) && halvings < max_halvings + (on_ground ? 1 : 0)) {
      ++halvings;
      lambda = halvings > max_halvings ? T(1) : lambda / 2;
      trial = v + lambda * delta;
      next = evaluate(s, held, trial);
      on_ground = on_ground || next.holds;
    }
    if (!(next.merit < at.merit) &&
        halvings <= max_halvings) {  // any further iteration would only repeat this one
      report.end = SolveEnd::stagnated;
      break;
    }
    forcing = next_forcing(next.merit / at.merit);
    v = trial;
    at = std::move(next);
    const double share = on_ground ? progress_share_on_ground : progress_share;
    without_progress = at.residual < static_cast<T>(share) * best ? 0 : without_progress + 1;
    best = at.residual < best ? at.residual : best;
  }
  // A largest component passes over those that are no numbers; the sum of squares does not.
  report.residual = static_cast<double>(std::isnan(at.merit) ? at.merit : at.residual);
  for (Eigen::Index i = 0; i < v.cols(); ++i) {  // the ground gives way by no tolerance
    if (at.ground[static_cast<std::size_t>(i)].freedom != Freedom::all) v.col(i) += at.prescribed.col(i);
  }
  ground_ = std::move(at.ground);
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
      respond_solved<T>(dynamics_.grounds()[t], dynamics_.contact(), dynamics_.gravity(), dynamics_.mass(i),
                        held, s.x.col(i), s.v.col(i), x, v);
    }
    end.x.col(i) = x;
    end.v.col(i) = v;
  }
}

}  // namespace aspic::reference
