#pragma once
// The Coulomb contact rule, for one body and one terrain (docs/physics.md derives it).
//
// A particle that rests on the ground when a step begins feels a reaction inside every force evaluation: with
// it, the step would end without approach and within the friction cone. Particles that arrive bounce at the
// step's end. Every expression has one order of operations, which the kernels follow
// (shaders/compute/terms/coulomb.glsl).
#include "physics/terrain/ground.h"

namespace aspic::physics {

/// Whether a body at distance d0 [m] with normal speed u0 [m/s] at the start of a step rests on the ground.
template <class T>
bool rests(const ContactConstants<T>& contact, T d0, T u0) {
  return d0 < contact.distance && std::abs(u0) <= contact.resting_speed;
}

/// Whether such a body, should it end the step in approach, is set down: it began near the ground and did not
/// arrive fast. Also a body that rose faster than a resting one does, and that the load above it turned
/// around within the step; left to its approach it would come back fast, and bounce for ever.
template <class T>
bool set_down(const ContactConstants<T>& contact, T d0, T u0) {
  return d0 < contact.distance && !(-u0 > contact.resting_speed);
}

/// Normal speed c ≤ 0 [m/s] that brings a body at distance d0 [m] to the surface within a step, but no faster
/// than `most` [m/s] lets it sink: c = −min(max(d0, 0)/h, most).
template <class T>
T sinking_speed(T d0, T h, T most) {
  if (!(d0 > T(0))) return T(0);
  const T needed = d0 / h;
  return -(needed < most ? needed : most);
}

/// Least normal speed c [m/s] a resting body may end a step with: −min(max(d0, 0)/h, |g|h).
template <class T>
T least_normal_speed(const ContactConstants<T>& contact, T d0) {
  return sinking_speed<T>(d0, contact.step, contact.fall);
}

/// Tangential velocity after friction has taken up to `loss` [m/s] off it. It never turns around.
template <class T>
Vector<T> after_friction(const Vector<T>& v_t, T loss) {
  const T slip = norm3<T>(v_t);
  if (!(slip > T(0))) return v_t;
  const T kept = T(1) - loss / slip;
  return kept > T(0) ? Vector<T>(kept * v_t) : Vector<T>(Vector<T>::Zero());
}

/// P: the velocity that ground of normal n leaves of v1, whose normal speed may not be less than c: v1 itself
/// where it is not, else the normal part is c and friction μ takes μ·(c − u) off the rest.
template <class T>
Vector<T> projected(T friction, const Vector<T>& n, T c, const Vector<T>& v1) {
  const T u = dot3<T>(v1, n);
  if (!(u < c)) return v1;
  const Vector<T> v_t = v1 - u * n;
  return after_friction<T>(v_t, friction * (c - u)) + c * n;
}

/// The force f [N] with the ground's reaction: kept for a complete step it turns v0 into P(v0 + (h·w)·f).
/// hw = h·w. Of ground that moves, v0 is relative to its velocity at the step's end.
template <class T>
Vector<T> with_reaction(T friction, const Vector<T>& n, T c, T hw, const Vector<T>& v0, const Vector<T>& f) {
  const Vector<T> v1 = v0 + hw * f;
  if (!(dot3<T>(v1, n) < c)) return f;
  const T q = T(1) / hw;
  return q * (projected<T>(friction, n, c, v1) - v0);
}

/// Normal speed after the bounce of a body that came with normal speed u0 and fell by `drop` from distance d0
/// during the step: B of its speed when it met the surface, and the change of speed after that. `du` is how
/// much the step changed the normal speed, `mean` its mean over the step as the position shows it. How far an
/// integrator's position lags behind its velocity, (u0 + du/2) − mean, is taken off before B and added after
/// it. The result is at most B(u0) + 2|g|h; where B(u0) = 0 it is at most |g|h, half of v_rest or less, since
/// rounding would decide whether a body at v_rest itself rests.
template <class T>
T bounced_speed(const Ground<T>& ground, const ContactConstants<T>& contact, T m, T d0, T drop, T u0, T du,
                T mean) {
  T s = T(0);  // fraction of the step before the impact
  if (drop > T(0) && d0 > T(0)) {
    s = d0 / drop;
    s = s < T(1) ? s : T(1);
  }
  const T arrival = mean + (s - T(0.5)) * du;
  const T lag = (u0 + T(0.5) * du) - mean;
  const T u = bounce_speed<T>(ground, m, arrival < T(0) ? arrival : T(0)) + lag;
  const T given_back = bounce_speed<T>(ground, m, u0);
  const T most = given_back > T(0) ? given_back + T(2) * contact.fall : contact.fall;
  if (!(u > T(0))) return T(0);
  return u < most ? u : most;
}

/// Normal speed at the end of a step from distance d0 with normal speed u0 to distance d with normal speed u:
/// u itself unless the ground acts, which only ever raises it.
template <class T>
T speed_after_contact(const Ground<T>& ground, const ContactConstants<T>& contact, T m, T d0, T u0, T d,
                      T u) {
  const bool down = set_down<T>(contact, d0, u0);
  if (!(u < T(0) && (d < T(0) || down))) return u;
  const T c = least_normal_speed<T>(contact, d0);
  if (!(u < c)) return u;
  if (down) return c;
  if (!(-u0 > contact.resting_speed)) return T(0);
  return bounced_speed<T>(ground, contact, m, d0, d0 - d, u0, u - u0, (d - d0) / contact.step);
}

/// By how much [m] a body that rests on the ground has risen too far in a step to distance d and normal speed
/// u: beyond d0 + h·max(u, 0). So a stopped body stays where it was, also where the integrator's position
/// lags behind its velocity. Continuous in u: no rounding decides whether a body rises.
template <class T>
T undue_rise(const ContactConstants<T>& contact, T d0, T u0, T d, T u) {
  if (!rests<T>(contact, d0, u0)) return T(0);
  const T rise = (d - d0) - contact.step * (u > T(0) ? u : T(0));
  return rise > T(0) ? rise : T(0);
}

/// The end of a step that began at x0, v0: a body that rests or arrives gets the speed above, friction is
/// bounded by the normal impulse, a resting body rises no faster than it moves, and nothing stays below the
/// surface.
template <class T>
void respond_coulomb(const Ground<T>& ground, const ContactConstants<T>& contact, T m, const Vector<T>& x0,
                     const Vector<T>& v0, Vector<T>& x, Vector<T>& v) {
  if (!(distance<T>(ground, x) < contact.distance)) return;
  Gap<T> g = gap<T>(ground, x);
  const Gap<T> g0 = gap<T>(ground, ground.start, x0);
  const Vector<T> v_r = ground.end.relative(v);
  const T u = dot3<T>(v_r, g.n), u0 = dot3<T>(ground.start.relative(v0), g0.n);
  const T u_after = speed_after_contact<T>(ground, contact, m, g0.d, u0, g.d, u);
  if (u_after > u) {
    const Vector<T> v_t = v_r - u * g.n;
    v = ground.end.absolute(after_friction<T>(v_t, ground.friction * (u_after - u)) + u_after * g.n);
  }
  const T rise = undue_rise<T>(contact, g0.d, u0, g.d, u_after);
  if (rise > T(0)) {
    x = x - rise * g.n;
    g = gap<T>(ground, x);
  }
  if (g.d < T(0)) x = x - g.d * g.n;
}

/// A particle on the ground at the start of a step.
template <class T>
struct RestingContact {
  Eigen::Index particle;
  T friction;     ///< μ of the ground
  T least_speed;  ///< c: normal speed it may not fall below [m/s]
  T hw;           ///< h·w [s/kg]
  Vector<T> n;    ///< the ground's normal at the start of the step
  Vector<T> v0;   ///< the velocity there, relative to the ground's at the step's end [m/s]
};

/// The force f [N] on the particle with the ground's reaction.
template <class T>
Vector<T> with_reaction(const RestingContact<T>& at, const Vector<T>& f) {
  return with_reaction<T>(at.friction, at.n, at.least_speed, at.hw, at.v0, f);
}

}  // namespace aspic::physics
