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

/// Constants of all spring classes, this share of a step after its start.
template <class T>
std::vector<SpringConstants<T>> classes_at(const Model& model, std::uint64_t step, double share,
                                           std::span<const double> channels) {
  std::vector<SpringConstants<T>> classes(model.spring_classes.begin(), model.spring_classes.end());
  std::size_t n = 0;
  for (const double r : rest_lengths(model, step, share, channels)) classes[n++].r = static_cast<T>(r);
  return classes;
}

/// How a spring with e = xₐ − x_b and v = vₐ − v_b pulls:
///   L = |e|,  q = 1/L,  s = k(L − r) + c((v·e)·q)
/// A spring of no length, and a cord that hangs slack, pull nowhere: then q = s = 0.
template <class T>
struct SpringTension {
  T L;         ///< length [m]
  T q = T(0);  ///< [1/m]
  T s = T(0);  ///< tension [N], positive where it pulls its ends together
  bool acts;

  SpringTension(const SpringConstants<T>& spring, const Vector<T>& e, const Vector<T>& v)
      : L(norm3<T>(e)), acts(!(L == T(0) || (spring.cord && L < spring.r))) {
    if (!acts) return;
    q = T(1) / L;
    s = spring.k * (L - spring.r) + spring.c * (dot3<T>(v, e) * q);
  }
};

/// Force on end a [N]: −((s·q)·e). End b feels the exact opposite.
template <class T>
Vector<T> spring_force(const SpringConstants<T>& spring, const Vector<T>& e, const Vector<T>& v) {
  const SpringTension<T> at(spring, e, v);
  if (!at.acts) return Vector<T>::Zero();
  return -((at.s * at.q) * e);
}

/// The same with the Jacobian, where e and v are those at the end of a step h.
template <class T>
std::pair<Vector<T>, SpringJacobian<T>> linearized(const SpringConstants<T>& spring, T h, const Vector<T>& e,
                                                   const Vector<T>& v) {
  const Vector<T> none = Vector<T>::Zero();
  const SpringTension<T> at(spring, e, v);
  if (!at.acts) return {none, {T(0), T(0), none}};
  const T along = (h * h) * spring.k + h * spring.c;
  const T across = at.s > T(0) ? (h * h) * (at.s * at.q) : T(0);
  return {-((at.s * at.q) * e), {along, across, Vector<T>(at.q * e)}};
}

/// L − r [m]; 0 of a slack cord.
template <class T>
T stretch(const SpringConstants<T>& spring, T L) {
  return spring.cord && L < spring.r ? T(0) : L - spring.r;
}

/// ½k(L − r)² [J]
template <class T>
T spring_energy(const SpringConstants<T>& spring, T L) {
  const T by = stretch(spring, L);
  return T(0.5) * spring.k * by * by;
}

}  // namespace aspic::physics
