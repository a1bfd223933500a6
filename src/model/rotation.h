#pragma once
// Turning vectors.
#include "aspic/vec.h"

namespace aspic {

/// Turns vectors about `axis` (any length but zero) by `angle_degrees`, right-handed (Rodrigues, 1840).
class Rotation {
 public:
  Rotation(const Vec3& axis, double angle_degrees);
  Vec3 operator()(const Vec3& v) const;

 private:
  bool none_;
  Vec3 n_;
  double c_ = 1.0, s_ = 0.0;
};

/// One vector turned so.
Vec3 rotated(const Vec3& v, const Vec3& axis, double angle_degrees);

}  // namespace aspic
