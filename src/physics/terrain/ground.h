#pragma once
// Terrain and contact (docs/physics.md, section 5) for one particle and one terrain. The shapes' formulas are
// in src/model/shapes.
#include <optional>

#include "model/terrain.h"
#include "physics/vectors.h"

namespace aspic::physics {

template <class T>
Vec<T> vec(const Vector<T>& v) {
  return {v.x(), v.y(), v.z()};
}

/// Where a terrain is at one end of a step. Terrain that does not move keeps every bit.
template <class T>
struct GroundPose {
  bool moves = false;
  Vector<T> offset = Vector<T>::Zero();    ///< displacement [m]
  Vector<T> velocity = Vector<T>::Zero();  ///< V [m/s]

  GroundPose() = default;
  explicit GroundPose(const Pose& pose)
      : moves(true), offset(rounded<T>(pose.offset)), velocity(rounded<T>(pose.velocity)) {}

  /// A place as the displaced terrain sees it.
  Vector<T> place(const Vector<T>& x) const { return moves ? Vector<T>(x - offset) : x; }
  /// A velocity as it sees it, v − V, and the way back.
  Vector<T> relative(const Vector<T>& v) const { return moves ? Vector<T>(v - velocity) : v; }
  Vector<T> absolute(const Vector<T>& v) const { return moves ? Vector<T>(v + velocity) : v; }
};

/// A terrain in the solver's precision.
template <class T>
struct Ground {
  const ShapeFormulas<T>* formulas;
  Geometry<T> geometry;
  bool movable;   ///< M is finite: only enters the bounce speed, a bounce never moves a terrain
  T mass;         ///< M [kg], if movable
  T restitution;  ///< e
  T friction;     ///< μ
  std::optional<TerrainMotion> motion;
  GroundPose<T> start, end;  ///< of the step under way

  explicit Ground(const Terrain& t)
      : formulas(&terrain_row(t.shape).formulas<T>()),
        movable(std::isfinite(t.mass)),
        mass(movable ? static_cast<T>(t.mass) : T(0)),
        restitution(static_cast<T>(t.restitution)),
        friction(static_cast<T>(t.friction)),
        motion(t.motion) {
    for (std::size_t k = 0; k < geometry_size; ++k) {
      geometry.vectors[k] = vec<T>(rounded<T>(t.geometry.vectors[k]));
      geometry.numbers[k] = static_cast<T>(t.geometry.numbers[k]);
    }
  }

  /// The step from the state of this number begins.
  void begin_step(double timestep, std::uint64_t step) {
    if (!motion) return;
    start = GroundPose<T>(pose_at(*motion, timestep, step));
    end = GroundPose<T>(pose_at(*motion, timestep, step + 1));
  }
};

/// Signed distance d [m], positive on the free side, and unit normal n towards the free side.
template <class T>
struct Gap {
  T d;
  Vector<T> n;
};

/// d alone, the same bits as gap's: most bodies are far from the ground. At the step's end unless another
/// pose is named.
template <class T>
T distance(const Ground<T>& ground, const GroundPose<T>& pose, const Vector<T>& x) {
  return ground.formulas->distance(ground.geometry, vec<T>(pose.place(x)));
}
template <class T>
T distance(const Ground<T>& ground, const Vector<T>& x) {
  return distance<T>(ground, ground.end, x);
}

template <class T>
Gap<T> gap(const Ground<T>& ground, const GroundPose<T>& pose, const Vector<T>& x) {
  const TerrainGap<T> at = ground.formulas->gap(ground.geometry, vec<T>(pose.place(x)));
  return {at.d, {at.n.x, at.n.y, at.n.z}};
}
template <class T>
Gap<T> gap(const Ground<T>& ground, const Vector<T>& x) {
  return gap<T>(ground, ground.end, x);
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
  T distance;       ///< ε [m]
  T set_speed;      ///< v_s [m/s], the setting
  T resting_speed;  ///< v_rest = max(v_s, 2|g|h) [m/s]
  T step;           ///< h [s]
  T fall;           ///< |g|h: speed gained by a step of free fall [m/s]

  explicit ContactConstants(const Model& model)
      : distance(static_cast<T>(model.contact.distance)),
        set_speed(static_cast<T>(model.contact.resting_speed)),
        resting_speed(static_cast<T>(aspic::resting_speed(model))),
        step(static_cast<T>(model.simulation.timestep)),
        fall(static_cast<T>(fall_speed(model))) {}
};

/// The course model's contact force: f [N] on a body with this gap and velocity after gravity and springs,
/// resisted and after_friction. Ground that moves is where it is at the step's start, in all of its
/// evaluations.
template <class T>
Vector<T> with_contact_force(const Ground<T>& ground, const ContactConstants<T>& contact, const Gap<T>& at,
                             const Vector<T>& v, const Vector<T>& f) {
  const auto& [d, n] = at;
  const Vector<T> slip = ground.start.relative(v);
  const T u = dot3<T>(slip, n);
  const T f_n = dot3<T>(f, n);
  if (!(d < contact.distance && std::abs(u) < contact.set_speed && f_n < T(0))) return f;
  const T N = -f_n;
  const Vector<T> v_t = slip - u * n;
  return (f + N * n) - (ground.friction * N) * v_t;
}

/// The same for a particle at x.
template <class T>
Vector<T> with_contact_force(const Ground<T>& ground, const ContactConstants<T>& contact, const Vector<T>& x,
                             const Vector<T>& v, const Vector<T>& f) {
  return with_contact_force<T>(ground, contact, gap<T>(ground, ground.start, x), v, f);
}

/// The course model's response at the end of a step: v' = v_t + B(u)·n.
template <class T>
void respond_course(const Ground<T>& ground, T epsilon, T m, const Vector<T>& x, Vector<T>& v) {
  const auto [d, n] = gap<T>(ground, x);
  const Vector<T> v_r = ground.end.relative(v);
  const T u = dot3<T>(v_r, n);
  if (!(d < epsilon && u < T(0))) return;
  const Vector<T> v_t = v_r - u * n;
  v = ground.end.absolute(v_t + bounce_speed<T>(ground, m, u) * n);
}

}  // namespace aspic::physics
