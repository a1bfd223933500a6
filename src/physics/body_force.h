#pragma once
// Forces on every particle and ball by itself: gravity and linear drag (docs/physics.md, section 1).
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

  /// f = m·g − (γ·m)·v [N]
  Vector<T> at(T m, const Vector<T>& v) const { return m * gravity - (drag * m) * v; }
  /// m − h·∂f/∂v = m + h·(γ·m) [kg]: the mass in the matrix of implicit Euler with time step h.
  T implicit_mass(T m, T h) const { return m + h * (drag * m); }
};

}  // namespace aspic::physics
