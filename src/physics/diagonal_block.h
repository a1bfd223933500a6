#pragma once
// The matrix of implicit Euler as seen from one particle: a spring's part of it, and the block on its
// diagonal.
#include "physics/vectors.h"

namespace aspic::physics {

/// −h·∂f/∂v' of a spring as seen from one end: H·d = across·d + (along − across)·n(n·d).
template <class T>
struct SpringJacobian {
  T along, across;  ///< [kg]
  Vector<T> n;      ///< unit vector along the spring

  Vector<T> operator*(const Vector<T>& d) const {
    return across * d + ((along - across) * dot3<T>(n, d)) * n;
  }
};

/// The symmetric 3×3 block of one particle on the matrix's diagonal, and the solution of B·z = r by Cramer's
/// rule.
template <class T>
struct DiagonalBlock {
  T xx, yy, zz, xy, xz, yz;

  explicit DiagonalBlock(T m) : xx(m), yy(m), zz(m), xy(0), xz(0), yz(0) {}

  void add(const SpringJacobian<T>& H) {
    const Vector<T>& n = H.n;
    const T w = H.along - H.across;
    xx += H.across + w * (n.x() * n.x());
    yy += H.across + w * (n.y() * n.y());
    zz += H.across + w * (n.z() * n.z());
    xy += w * (n.x() * n.y());
    xz += w * (n.x() * n.z());
    yz += w * (n.y() * n.z());
  }

  void add(const DiagonalBlock& other) {
    xx += other.xx, yy += other.yy, zz += other.zz;
    xy += other.xy, xz += other.xz, yz += other.yz;
  }

  /// The inverse, symmetric as well.
  DiagonalBlock inverse() const {
    DiagonalBlock c(T(0));
    c.xx = yy * zz - yz * yz;
    c.xy = xz * yz - xy * zz;
    c.xz = xy * yz - xz * yy;
    c.yy = xx * zz - xz * xz;
    c.yz = xy * xz - xx * yz;
    c.zz = xx * yy - xy * xy;
    const T d = T(1) / ((xx * c.xx + xy * c.xy) + xz * c.xz);
    c.xx *= d, c.yy *= d, c.zz *= d, c.xy *= d, c.xz *= d, c.yz *= d;
    return c;
  }

  Vector<T> operator*(const Vector<T>& r) const {
    return {(xx * r.x() + xy * r.y()) + xz * r.z(), (xy * r.x() + yy * r.y()) + yz * r.z(),
            (xz * r.x() + yz * r.y()) + zz * r.z()};
  }
};

}  // namespace aspic::physics
