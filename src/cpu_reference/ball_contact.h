#pragma once
// Contact of balls, spec §2.7: with terrain, with each other and with particles. Every expression has one
// order of operations, which the kernels follow (shaders/compute/ball_contact.glsl). A pair is evaluated from
// each of its two sides, since exchanging the bodies negates vectors exactly but for the signs of zeros.
#include "cpu_reference/contact.h"

namespace aspic::reference {

/// A ball's constants in the solver's precision.
template <class T>
struct BallBody {
  T mass, inverse_mass;  ///< m, w = 1/m
  T radius;              ///< R [m]
  T turn;                ///< R/I [1/(kg·m)]: angular velocity from an impulse at the surface
  T slip;                ///< R²/I [1/kg]: surface velocity from it

  explicit BallBody(const Ball& b)
      : mass(static_cast<T>(b.mass)),
        inverse_mass(static_cast<T>(1.0 / b.mass)),
        radius(static_cast<T>(b.radius)),
        turn(static_cast<T>(b.radius / b.inertia())),
        slip(static_cast<T>(b.radius * b.radius / b.inertia())) {}
};

/// What contact among balls and particles needs beside the bodies.
template <class T>
struct BallRules {
  T epsilon;        ///< ε [m]
  T resting_speed;  ///< max(ε, 2|g|h) [m/s]
  T restitution;    ///< e of balls and particles
  T friction;       ///< μ_b
  bool spin;
};

/// Gap and normal of a ball and a terrain.
template <class T>
Gap<T> ball_gap(const Ground<T>& ground, T radius, const Vector<T>& x) {
  Gap<T> g = gap<T>(ground, x);
  g.d = g.d - radius;
  return g;
}

/// The friction impulse against slip s that `normal_impulse` allows, for bodies that give way by `compliance`
/// [1/kg]: its size along `t` = s/|s|. Zero without slip.
template <class T>
T friction_impulse(const Vector<T>& s, T normal_impulse, T friction, T compliance, Vector<T>& t) {
  t = Vector<T>::Zero();
  const T slip = norm3<T>(s);
  if (!(slip > T(0))) return T(0);
  const T limit = friction * normal_impulse, stop = slip / compliance, q = T(1) / slip;
  t = q * s;
  return limit < stop ? limit : stop;
}

/// A ball against one terrain at the end of a step that began at x0, v0. As a particle with its surface in
/// place of its centre; with spin, friction acts where the surfaces touch and turns the ball.
template <class T>
void respond_ball(const Ground<T>& ground, ContactModel model, const BallRules<T>& rules,
                  const BallBody<T>& ball, const Vector<T>& x0, const Vector<T>& v0, Vector<T>& x,
                  Vector<T>& v, Vector<T>& omega) {
  const bool coulomb = model == ContactModel::coulomb;
  Gap<T> g = ball_gap<T>(ground, ball.radius, x);
  const T u = dot3<T>(v, g.n);
  if (g.d < rules.epsilon && u < T(0)) {
    const T approach = -dot3<T>(v0, g.n);
    const bool bounces = !coulomb || approach > rules.resting_speed;
    const T u_after = bounces ? bounce_speed<T>(ground, ball.mass, u) : T(0);
    const T du = u_after - u;
    Vector<T> v_t = v - u * g.n;
    if (rules.spin) {
      const Vector<T> s = v_t - ball.radius * cross3<T>(omega, g.n);
      Vector<T> t;
      const T J_t = friction_impulse<T>(s, ball.mass * du, ground.friction, ball.inverse_mass + ball.slip, t);
      v_t = v_t - (ball.inverse_mass * J_t) * t;
      omega = omega + (ball.turn * J_t) * cross3<T>(g.n, t);
    } else if (coulomb) {
      const T slip = norm3<T>(v_t);
      if (slip > T(0)) {
        const T kept = T(1) - (ground.friction * du) / slip;
        v_t = kept > T(0) ? Vector<T>(kept * v_t) : Vector<T>(Vector<T>::Zero());
      }
    }
    v = v_t + u_after * g.n;
    if (coulomb && u_after == T(0) && v_t.x() == T(0) && v_t.y() == T(0) && v_t.z() == T(0)) {
      x = x0;
      g = ball_gap<T>(ground, ball.radius, x);
    }
  }
  if (coulomb && g.d < T(0)) x = x - g.d * g.n;
}

/// Two bodies as one of them sees it: e = its centre − the other's, `reach` = the sum of the radii. Where the
/// centres coincide the normal is (0, 1, 0) for one of them, `up`, and (0, −1, 0) for the other.
template <class T>
Gap<T> pair_gap(const Vector<T>& e, T reach, bool up) {
  const T L = norm3<T>(e);
  if (L == T(0)) return {L - reach, Vector<T>(0, up ? T(1) : T(-1), 0)};
  const T q = T(1) / L;
  return {L - reach, q * e};
}

/// What a body receives from a partner: impulse [N·s], and the part of it at the surface times the normal,
/// which turns a ball (Δω = R/I times it).
template <class T>
struct Impulse {
  Vector<T> linear, turning;
};

/// An acting pair as one body sees it. n: towards it; dv: its velocity less the partner's, dv0 the same at
/// the start of the step; rolling: Σ R·ω of the balls; weight: c₁w₁ + c₂w₂; slip_weight: the same and Σ
/// c·R²/I.
template <class T>
Impulse<T> impact(const BallRules<T>& rules, const Vector<T>& n, const Vector<T>& dv, const Vector<T>& dv0,
                  const Vector<T>& rolling, T weight, T slip_weight) {
  const T u = dot3<T>(dv, n);
  const T approach = -dot3<T>(dv0, n);
  const T e = approach < rules.resting_speed ? T(0) : rules.restitution;
  const T J = ((T(1) + e) * -u) / weight;
  Impulse<T> result = {J * n, Vector<T>::Zero()};
  if (!rules.spin) return result;
  const Vector<T> s = (dv - u * n) - cross3<T>(rolling, n);
  Vector<T> t;
  const T J_t = friction_impulse<T>(s, J, rules.friction, slip_weight, t);
  result.linear = result.linear - J_t * t;
  result.turning = J_t * cross3<T>(n, t);
  return result;
}

}  // namespace aspic::reference
