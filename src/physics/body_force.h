#pragma once
// Forces on every particle and ball by itself: gravity and the medium's resistance (docs/physics.md, section
// 1).
#include "model/model.h"
#include "physics/vectors.h"

namespace aspic::physics {

template <class T>
struct BodyForce {
  Vector<T> gravity = Vector<T>::Zero();  ///< g [m/s²]
  T drag = T(0);                          ///< γ [1/s]

  BodyForce() = default;
  explicit BodyForce(const Model& model)
      : gravity(rounded<T>(model.simulation.gravity)), drag(static_cast<T>(model.simulation.drag)) {}

  /// (γ·m)·v [N], against the motion.
  Vector<T> resistance(T m, const Vector<T>& v) const { return (drag * m) * v; }
  /// m + h·∂resistance/∂v = m + h·(γ·m) [kg]: the mass in the matrix of implicit Euler with time step h.
  T implicit_mass(T m, const Vector<T>& /*v*/, T h) const { return m + h * (drag * m); }
  /// ∂resistance/∂v over m at rest [1/s], for stable steps.
  T damping() const { return drag; }

  /// f = m·g − resistance [N]
  Vector<T> at(T m, const Vector<T>& v) const { return m * gravity - resistance(m, v); }
};

}  // namespace aspic::physics
