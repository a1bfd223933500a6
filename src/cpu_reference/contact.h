#pragma once
// Terrain and contact (docs/physics.md, section 5) for one particle and one terrain.
#include "cpu_reference/vectors.h"
#include "model/model.h"

namespace aspic::reference {

/// A terrain in the solver's precision.
template <class T>
struct Ground {
  TerrainShape shape;
  Vector<T> point;   ///< of the plane, or the centre [m]
  Vector<T> normal;  ///< planes only
  T radius;          ///< R [m], sphere and bowl only
  bool movable;      ///< M is finite: only enters the bounce speed, a terrain never moves
  T mass;            ///< M [kg], if movable
  T restitution;     ///< e
  T friction;        ///< μ

  explicit Ground(const Terrain& t)
      : shape(t.shape),
        point(rounded<T>(t.point)),
        normal(rounded<T>(t.normal)),
        radius(static_cast<T>(t.radius)),
        movable(std::isfinite(t.mass)),
        mass(movable ? static_cast<T>(t.mass) : T(0)),
        restitution(static_cast<T>(t.restitution)),
        friction(static_cast<T>(t.friction)) {}
};

/// Signed distance d [m], positive on the free side, and unit normal n towards the free side.
template <class T>
struct Gap {
  T d;
  Vector<T> n;
};

/// d alone, the same bits as gap's: most bodies are far from the ground.
template <class T>
T distance(const Ground<T>& ground, const Vector<T>& x) {
  const Vector<T> e = x - ground.point;
  if (ground.shape == TerrainShape::plane || ground.shape == TerrainShape::tilted_plane)
    return dot3<T>(ground.normal, e);
  const T L = norm3<T>(e);
  return ground.shape == TerrainShape::bowl ? ground.radius - L : L - ground.radius;
}

template <class T>
Gap<T> gap(const Ground<T>& ground, const Vector<T>& x) {
  const Vector<T> e = x - ground.point;
  if (ground.shape == TerrainShape::plane || ground.shape == TerrainShape::tilted_plane) {
    return {dot3<T>(ground.normal, e), ground.normal};
  }
  const T L = norm3<T>(e);
  const bool bowl = ground.shape == TerrainShape::bowl;
  const T d = bowl ? ground.radius - L : L - ground.radius;
  if (L == T(0)) return {d, Vector<T>(0, 1, 0)};
  const T q = T(1) / L;
  const Vector<T> outward = q * e;
  return {d, bowl ? Vector<T>(-outward) : outward};
}

/// Normal speed after an impact at normal speed u < 0: B(u) = max(0, (m − e·M)/(m + M)·u), −e·u for M = ∞.
template <class T>
T bounce_speed(const Ground<T>& ground, T m, T u) {
  const T factor =
      ground.movable ? (m - ground.restitution * ground.mass) / (m + ground.mass) : -ground.restitution;
  const T bounced = factor * u;
  return bounced > T(0) ? bounced : T(0);
}

/// What the contact models need in addition to the terrain.
template <class T>
struct ContactConstants {
  T epsilon;        ///< ε: m for distances, m/s for speeds
  T resting_speed;  ///< v_rest = max(ε, 2|g|h) [m/s]
  T step;           ///< h [s]
  T fall;           ///< |g|h: what a step of free fall gains [m/s]

  explicit ContactConstants(const Model& model)
      : epsilon(static_cast<T>(model.contact.epsilon)),
        resting_speed(static_cast<T>(aspic::resting_speed(model))),
        step(static_cast<T>(model.simulation.timestep)),
        fall(static_cast<T>(fall_speed(model))) {}
};

/// The course model's contact force: f [N] on a body with this gap and velocity after gravity and springs,
/// resisted and rubbed.
template <class T>
Vector<T> with_contact_force(const Ground<T>& ground, T epsilon, const Gap<T>& at, const Vector<T>& v,
                             const Vector<T>& f) {
  const auto& [d, n] = at;
  const T u = dot3<T>(v, n);
  const T f_n = dot3<T>(f, n);
  if (!(d < epsilon && std::abs(u) < epsilon && f_n < T(0))) return f;
  const T N = -f_n;
  const Vector<T> v_t = v - u * n;
  return (f + N * n) - (ground.friction * N) * v_t;
}

/// The same for a particle at x.
template <class T>
Vector<T> with_contact_force(const Ground<T>& ground, T epsilon, const Vector<T>& x, const Vector<T>& v,
                             const Vector<T>& f) {
  return with_contact_force<T>(ground, epsilon, gap<T>(ground, x), v, f);
}

/// The course model's response at the end of a step: v' = v_t + B(u)·n.
template <class T>
void respond_course(const Ground<T>& ground, T epsilon, T m, const Vector<T>& x, Vector<T>& v) {
  const auto [d, n] = gap<T>(ground, x);
  const T u = dot3<T>(v, n);
  if (!(d < epsilon && u < T(0))) return;
  const Vector<T> v_t = v - u * n;
  v = v_t + bounce_speed<T>(ground, m, u) * n;
}

}  // namespace aspic::reference
