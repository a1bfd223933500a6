#include "model/rotation.h"

namespace aspic {

Rotation::Rotation(const Vec3& axis, double angle_degrees) : none_(angle_degrees == 0.0) {
  if (none_) return;
  n_ = axis / length(axis);
  const double angle = angle_degrees * (3.14159265358979323846 / 180.0);
  c_ = std::cos(angle);
  s_ = std::sin(angle);
}

Vec3 Rotation::operator()(const Vec3& v) const {
  if (none_) return v;
  return c_ * v + s_ * cross(n_, v) + ((1.0 - c_) * dot(n_, v)) * n_;
}

Vec3 rotated(const Vec3& v, const Vec3& axis, double angle_degrees) {
  return Rotation(axis, angle_degrees)(v);
}

}  // namespace aspic
