#pragma once
// The reference's vector types, and the two reductions whose order of operations docs/determinism.md fixes.
#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "aspic/vec.h"

#ifdef __FMA__
#error \
    "The reference must be compiled without FMA instructions: Eigen's packet operations would use them and change bits."
#endif

namespace aspic::physics {

template <class T>
using Vector = Eigen::Matrix<T, 3, 1>;

/// One column per particle.
template <class T>
using Field = Eigen::Matrix<T, 3, Eigen::Dynamic>;

/// (aₓbₓ + a_y b_y) + a_z b_z. Eigen's own dot product adds in another order.
template <class T>
T dot3(const Vector<T>& a, const Vector<T>& b) {
  return (a.x() * b.x() + a.y() * b.y()) + a.z() * b.z();
}

/// √((aₓ² + a_y²) + a_z²)
template <class T>
T norm3(const Vector<T>& a) {
  return std::sqrt(dot3<T>(a, a));
}

/// max(|x|, |y|, |z|)
template <class T>
T largest_component(const Vector<T>& R) {
  const T x = std::abs(R.x()), y = std::abs(R.y()), z = std::abs(R.z());
  const T xy = y > x ? y : x;
  return z > xy ? z : xy;
}

/// a × b
template <class T>
Vector<T> cross3(const Vector<T>& a, const Vector<T>& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

template <class T>
Vector<T> rounded(const Vec3& v) {
  return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
}

inline Vec3 vec3_of(const Vector<double>& v) {
  return {v.x(), v.y(), v.z()};
}

/// Columns from vectors, each component rounded.
template <class T>
Field<T> field(const std::vector<Vec3>& vectors) {
  Field<T> f(3, static_cast<Eigen::Index>(vectors.size()));
  for (Eigen::Index i = 0; i < f.cols(); ++i) f.col(i) = rounded<T>(vectors[static_cast<std::size_t>(i)]);
  return f;
}

/// Vectors from columns, exactly.
template <class T>
std::vector<Vec3> columns(const Field<T>& f) {
  std::vector<Vec3> vectors;
  vectors.reserve(static_cast<std::size_t>(f.cols()));
  for (Eigen::Index i = 0; i < f.cols(); ++i) vectors.push_back({f(0, i), f(1, i), f(2, i)});
  return vectors;
}

}  // namespace aspic::physics
