#pragma once
// The damped spring (docs/physics.md, section 1).
#include "model/model.h"
#include "physics/diagonal_block.h"
#include "physics/vectors.h"

namespace aspic::physics {

/// Constants of a spring class in the solver's precision.
template <class T>
struct SpringConstants {
  T k;        ///< stiffness [N/m]
  T c;        ///< damping [N·s/m]
  T r;        ///< rest length [m]
  bool cord;  ///< resists stretch only

  explicit SpringConstants(const SpringClass& s)
      : k(static_cast<T>(s.stiffness)),
        c(static_cast<T>(s.damping)),
        r(static_cast<T>(s.rest_length)),
        cord(s.cord) {}
};

/// Force [N] of the spring on its end a; end b feels the exact opposite.
///   e = xₐ − x_b,  L = |e|,  q = 1/L,  s = k(L − r) + c(((vₐ − v_b)·e)·q),  fₐ = −((s·q)·e)
/// A spring of no length, and a cord that hangs slack, pull nowhere.
template <class T>
Vector<T> spring_force(const SpringConstants<T>& spring, const Vector<T>& xa, const Vector<T>& va,
                       const Vector<T>& xb, const Vector<T>& vb) {
  const Vector<T> e = xa - xb;
  const T L = norm3<T>(e);
  if (L == T(0) || (spring.cord && L < spring.r)) return Vector<T>::Zero();
  const T q = T(1) / L;
  const T s = spring.k * (L - spring.r) + spring.c * (dot3<T>(va - vb, e) * q);
  return -((s * q) * e);
}

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

}  // namespace aspic::physics
