#pragma once
// Three doubles with a name: what the model, files and analysis hold vectors in. Solvers have their own
// types.
#include <cmath>

namespace aspic {

/// A vector of three doubles; unit by context.
struct Vec3 {
  double x = 0.0, y = 0.0, z = 0.0;

  double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator*(double s, const Vec3& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline Vec3 operator/(const Vec3& a, double s) {
  return {a.x / s, a.y / s, a.z / s};
}
inline double dot(const Vec3& a, const Vec3& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}
inline bool is_finite(const Vec3& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Turns vectors about `axis` (any length but zero) by `angle_degrees`, right-handed (Rodrigues, 1840).
class Rotation {
 public:
  Rotation(const Vec3& axis, double angle_degrees) : none_(angle_degrees == 0.0) {
    if (none_) return;
    n_ = axis / length(axis);
    const double angle = angle_degrees * (3.14159265358979323846 / 180.0);
    c_ = std::cos(angle);
    s_ = std::sin(angle);
  }
  Vec3 operator()(const Vec3& v) const {
    if (none_) return v;
    return c_ * v + s_ * cross(n_, v) + ((1.0 - c_) * dot(n_, v)) * n_;
  }

 private:
  bool none_;
  Vec3 n_;
  double c_ = 1.0, s_ = 0.0;
};

/// One vector turned so.
inline Vec3 rotated(const Vec3& v, const Vec3& axis, double angle_degrees) {
  return Rotation(axis, angle_degrees)(v);
}

}  // namespace aspic
