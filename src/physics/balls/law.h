#pragma once
// Contact of balls (docs/balls.md): with terrain, with each other and with particles. Every expression has
// one order of operations, which the kernels follow (shaders/compute/terms/ball_contact.glsl). A pair is
// evaluated from each of its two sides, since exchanging the bodies negates vectors exactly but for the signs
// of zeros.
#include "physics/terrain/coulomb.h"

namespace aspic::physics {

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

/// What contact among balls and particles needs besides the bodies.
template <class T>
struct BallRules {
  ContactConstants<T> contact;
  T restitution;  ///< e of balls and particles
  T friction;     ///< μ_b
  bool spin;
};

/// Gap and normal of a ball and a terrain in that pose.
template <class T>
Gap<T> ball_gap(const Ground<T>& ground, const GroundPose<T>& pose, T radius, const Vector<T>& x) {
  Gap<T> g = gap<T>(ground, pose, x);
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

/// Friction where the surfaces touch, of a terrain whose normal impulse raised the normal speed by `gain`: it
/// changes the tangential velocity v_t and turns the ball.
template <class T>
void apply_ball_friction(const BallBody<T>& ball, T friction, T gain, const Vector<T>& n, Vector<T>& v_t,
                         Vector<T>& omega) {
  const Vector<T> s = v_t - ball.radius * cross3<T>(omega, n);
  Vector<T> t;
  const T J_t = friction_impulse<T>(s, ball.mass * gain, friction, ball.inverse_mass + ball.slip, t);
  v_t = v_t - (ball.inverse_mass * J_t) * t;
  omega = omega + (ball.turn * J_t) * cross3<T>(n, t);
}

/// A ball against one terrain at the end of a step, by the course model: as a particle with its surface in
/// place of its center; with spin, friction is added.
template <class T>
void respond_ball_course(const Ground<T>& ground, const BallRules<T>& rules, const BallBody<T>& ball,
                         const Vector<T>& x, Vector<T>& v, Vector<T>& omega) {
  const Gap<T> g = ball_gap<T>(ground, ground.end, ball.radius, x);
  const Vector<T> v_r = ground.end.relative(v);
  const T u = dot3<T>(v_r, g.n);
  if (!(g.d < rules.contact.distance && u < T(0))) return;
  const T u_after = bounce_speed<T>(ground, ball.mass, u);
  Vector<T> v_t = v_r - u * g.n;
  if (rules.spin) apply_ball_friction<T>(ball, ground.friction, u_after - u, g.n, v_t, omega);
  v = ground.end.absolute(v_t + u_after * g.n);
}

/// f [N] on a ball with the reaction of ground on which it rests at the start (x0, v0) of the step. Without
/// spin it holds friction as on a particle. With spin the normal part alone: friction acts where the surfaces
/// touch, at the step's end.
template <class T>
Vector<T> with_ball_reaction(const Ground<T>& ground, const BallRules<T>& rules, const BallBody<T>& ball,
                             const Vector<T>& x0, const Vector<T>& v0, const Vector<T>& f) {
  const Gap<T> g = ball_gap<T>(ground, ground.start, ball.radius, x0);
  if (!rests<T>(rules.contact, g.d, dot3<T>(ground.start.relative(v0), g.n))) return f;
  return with_reaction<T>(rules.spin ? T(0) : ground.friction, g.n, least_normal_speed<T>(rules.contact, g.d),
                          rules.contact.step * ball.inverse_mass, ground.end.relative(v0), f);
}

/// A ball against one terrain at the end of a step that began at x0, v0, by the Coulomb model: as a particle
/// with its surface in place of its center. With spin, f is the force in the step's evaluations, gravity and
/// the reactions of the terrains before, to which this one's is added: what the reaction gave to the normal
/// speed counts as normal impulse for friction.
template <class T>
void respond_ball_coulomb(const Ground<T>& ground, const BallRules<T>& rules, const BallBody<T>& ball,
                          const Vector<T>& x0, const Vector<T>& v0, Vector<T>& f, Vector<T>& x, Vector<T>& v,
                          Vector<T>& omega) {
  const Gap<T> g0 = ball_gap<T>(ground, ground.start, ball.radius, x0);
  const T u0 = dot3<T>(ground.start.relative(v0), g0.n);
  T given = T(0);
  if (rules.spin) {
    const Vector<T> before = f;
    f = with_ball_reaction<T>(ground, rules, ball, x0, v0, before);
    given = (rules.contact.step * ball.inverse_mass) * dot3<T>(f - before, g0.n);
  }
  Gap<T> g = ball_gap<T>(ground, ground.end, ball.radius, x);
  const Vector<T> v_r = ground.end.relative(v);
  const T u = dot3<T>(v_r, g.n);
  const T u_after = g.d < rules.contact.distance
                        ? speed_after_contact<T>(ground, rules.contact, ball.mass, g0.d, u0, g.d, u)
                        : u;
  const T gain = (u_after - u) + given;
  if (gain > T(0)) {
    Vector<T> v_t = v_r - u * g.n;
    if (rules.spin) {
      apply_ball_friction<T>(ball, ground.friction, gain, g.n, v_t, omega);
    } else {
      v_t = after_friction<T>(v_t, ground.friction * gain);
    }
    v = ground.end.absolute(v_t + u_after * g.n);
  }
  if (!(g.d < rules.contact.distance)) return;
  const T rise = undue_rise<T>(rules.contact, g0.d, u0, g.d, u_after);
  if (rise > T(0)) {
    x = x - rise * g.n;
    g = ball_gap<T>(ground, ground.end, ball.radius, x);
  }
  if (g.d < T(0)) x = x - g.d * g.n;
}

/// Two bodies as one of them sees it: e = its center − the other's, `reach` = the sum of the radii. Where the
/// centers coincide the normal is (0, 1, 0) for one of them, `up`, and (0, −1, 0) for the other.
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
  const T e = approach < rules.contact.resting_speed ? T(0) : rules.restitution;
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

}  // namespace aspic::physics
