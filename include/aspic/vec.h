#pragma once
// Three numbers with names. Solvers have their own types; formulas that they share with the model use these.
#include <cmath>

// What rounds is inlined always: a program compiled to fuse multiplications and additions must not lend the
// library its own copy.
#define ASPIC_INLINE [[gnu::always_inline]]

namespace aspic {

/// A vector of three numbers; unit by context.
template <class T>
struct Vec {
  T x = 0, y = 0, z = 0;  ///< by axis

  T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  friend bool operator==(const Vec&, const Vec&) = default;

  ASPIC_INLINE friend Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  ASPIC_INLINE friend Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  ASPIC_INLINE friend Vec operator-(const Vec& a) { return {-a.x, -a.y, -a.z}; }
  ASPIC_INLINE friend Vec operator*(T s, const Vec& a) { return {s * a.x, s * a.y, s * a.z}; }
  ASPIC_INLINE friend Vec operator/(const Vec& a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  ASPIC_INLINE friend T dot(const Vec& a, const Vec& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
  ASPIC_INLINE friend Vec cross(const Vec& a, const Vec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  ASPIC_INLINE friend T length(const Vec& a) { return std::sqrt(dot(a, a)); }
};

/// What the model, files and analysis hold vectors in.
using Vec3 = Vec<double>;
static_assert(sizeof(Vec3) == 3 * sizeof(double));

ASPIC_INLINE inline bool is_finite(const Vec3& a) {  ///< whether all three are
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

}  // namespace aspic

#undef ASPIC_INLINE
