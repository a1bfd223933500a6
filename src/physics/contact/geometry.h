#pragma once
// What a point sees of triangles, and where it touches them (docs/contact.md, "Which faces a point touches").
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "physics/vectors.h"

namespace aspic::physics {

/// The nearest place of a triangle, A + b·(B − A) + c·(C − A).
template <class T>
struct NearestPlace {
  T b, c;
  bool face;  ///< within the face, not on its rim
};

/// By the seven regions of Ericson (Real-Time Collision Detection, 2005, 5.1.5), tested in this order: A, B,
/// AB, C, AC, BC, face.
template <class T>
NearestPlace<T> nearest_place(const Vector<T>& P, const Vector<T>& A, const Vector<T>& B,
                              const Vector<T>& C) {
  const Vector<T> ab = B - A, ac = C - A, ap = P - A, bp = P - B, cp = P - C;
  const T d1 = dot3<T>(ab, ap), d2 = dot3<T>(ac, ap);
  if (d1 <= T(0) && d2 <= T(0)) return {T(0), T(0), false};
  const T d3 = dot3<T>(ab, bp), d4 = dot3<T>(ac, bp);
  if (d3 >= T(0) && d4 <= d3) return {T(1), T(0), false};
  const T vc = d1 * d4 - d3 * d2;
  if (vc <= T(0) && d1 >= T(0) && d3 <= T(0)) return {d1 / (d1 - d3), T(0), false};
  const T d5 = dot3<T>(ab, cp), d6 = dot3<T>(ac, cp);
  if (d6 >= T(0) && d5 <= d6) return {T(0), T(1), false};
  const T vb = d5 * d2 - d1 * d6;
  if (vb <= T(0) && d2 >= T(0) && d6 <= T(0)) return {T(0), d2 / (d2 - d6), false};
  const T va = d3 * d6 - d5 * d4, to_b = d4 - d3, to_c = d5 - d6;
  if (va <= T(0) && to_b >= T(0) && to_c >= T(0)) {
    const T c = to_b / (to_b + to_c);
    return {T(1) - c, c, false};
  }
  const T q = T(1) / ((va + vb) + vc);
  return {vb * q, vc * q, true};
}

/// g = (B − A) × (C − A): along the normal of the triangle, twice its area long [m²]
template <class T>
Vector<T> area_normal(const Vector<T>& A, const Vector<T>& B, const Vector<T>& C) {
  return cross3<T>(B - A, C - A);
}

/// A triangle of a surface in space, with what all points that look at it ask for.
template <class T>
struct Face {
  Vector<T> A, B, C;
  Vector<T> g;        ///< area normal [m²]
  Vector<T> N;        ///< unit normal, where `real`
  bool real = false;  ///< it has an area
};

template <class T>
Face<T> face_of(const Vector<T>& A, const Vector<T>& B, const Vector<T>& C) {
  Face<T> face = {A, B, C, area_normal<T>(A, B, C), {}, false};
  const T square = dot3<T>(face.g, face.g);
  face.real = square > T(0);
  if (face.real) face.N = (T(1) / std::sqrt(square)) * face.g;
  return face;
}

/// An axis-aligned box [m].
template <class T>
struct Box {
  Vector<T> low, high;

  static Box around(const Vector<T>& A, const Vector<T>& B, const Vector<T>& C) {
    return {A.cwiseMin(B).cwiseMin(C), A.cwiseMax(B).cwiseMax(C)};
  }
  void extend(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  /// Whether the box, widened by `margin` [m], holds P.
  bool holds(T margin, const Vector<T>& P) const {
    for (Eigen::Index c = 0; c < 3; ++c)
      if (!(P[c] >= low[c] - margin && P[c] <= high[c] + margin)) return false;
    return true;
  }
  /// Whether the box is farther than `far` [m] from P.
  bool beyond(T far, const Vector<T>& P) const {
    Vector<T> away;
    for (Eigen::Index c = 0; c < 3; ++c) away[c] = std::max({low[c] - P[c], P[c] - high[c], T(0)});
    return dot3<T>(away, away) > far * far;
  }
};

/// A triangle as a point P sees it.
template <class T>
struct ClosestPoint {
  std::uint32_t triangle, side;
  NearestPlace<T> at;
  Vector<T> e;  ///< from the nearest place to P [m]
  T L;          ///< its length [m]
  Vector<T> N;  ///< the triangle's unit normal
  T z;          ///< e·N [m]
};

/// Of a face that has an area.
template <class T>
ClosestPoint<T> closest_point(std::uint32_t triangle, std::uint32_t side, const Face<T>& face,
                              const Vector<T>& P) {
  ClosestPoint<T> seen;
  seen.triangle = triangle;
  seen.side = side;
  seen.at = nearest_place<T>(P, face.A, face.B, face.C);
  // From A, near P: so far from the origin places lose no digits against each other.
  seen.e = ((P - face.A) - seen.at.b * (face.B - face.A)) - seen.at.c * (face.C - face.A);
  seen.L = norm3<T>(seen.e);
  seen.N = face.N;
  seen.z = dot3<T>(seen.e, seen.N);
  return seen;
}

/// How straight in front of a triangle a point is: |z|/L, 1 in front of the face.
template <class T>
T straightness(const ClosestPoint<T>& seen) {
  if (seen.at.face) return T(1);
  return seen.L > T(0) ? std::abs(seen.z) / seen.L : T(0);
}

/// Of the triangles for which `among(seen)` holds, that which counts as the nearest, or nullptr: of those no
/// farther than the least distance and `tie` [m] the one straightest in front, of equals the nearest. Two
/// triangles that share the nearest edge have the same distance but for rounding; the one that faces the
/// point knows its inside from its outside.
template <class T, class Sights, class Among>
const ClosestPoint<T>* nearest_of(const Sights& closest, T tie, const Among& among) {
  const ClosestPoint<T>* least = nullptr;
  for (const ClosestPoint<T>& seen : closest)
    if (among(seen) && (!least || seen.L < least->L)) least = &seen;
  if (!least) return nullptr;
  const T far = least->L + tie;
  const ClosestPoint<T>* best = nullptr;
  T straight = T(-1);
  for (const ClosestPoint<T>& seen : closest) {
    if (!(among(seen) && seen.L <= far)) continue;
    const T here = straightness<T>(seen);
    if (here > straight || (here == straight && seen.L < best->L)) {
      best = &seen;
      straight = here;
    }
  }
  return best;
}

/// Signed distance d [m] and unit normal n towards the side on which a point belongs.
template <class T>
struct ContactGap {
  T d;
  Vector<T> n;
};

/// Of a point that touches a face of a closed surface: outside within `reach` ρ, or inside within `depth` D
/// and in front of the face's back.
template <class T>
std::optional<ContactGap<T>> closed_gap(const ClosestPoint<T>& seen, T reach, T depth) {
  const bool inside = seen.z < T(0);
  if (inside ? !(seen.L <= depth && -seen.z >= T(0.7) * seen.L) : !(seen.L < reach)) return std::nullopt;
  const T d = inside ? -seen.L : seen.L;
  if (seen.at.face) return ContactGap<T>{seen.z, seen.N};
  if (!(seen.L > T(0))) return ContactGap<T>{d, seen.N};
  return ContactGap<T>{d, (T(1) / d) * seen.e};
}

/// Of a point that touches a face of an open surface, within `reach` on either side.
template <class T>
std::optional<ContactGap<T>> open_gap(const ClosestPoint<T>& seen, T reach) {
  if (!(seen.L < reach)) return std::nullopt;
  if (seen.at.face && seen.z < T(0)) return ContactGap<T>{-seen.z, -seen.N};
  if (seen.at.face) return ContactGap<T>{seen.z, seen.N};
  if (!(seen.L > T(0))) return ContactGap<T>{seen.L, seen.N};
  return ContactGap<T>{seen.L, (T(1) / seen.L) * seen.e};
}

/// Whether a point in front of a second side touches that, too.
template <class T>
bool straight_in_front(const ClosestPoint<T>& seen, T reach) {
  return seen.z >= T(0) && seen.L < reach && seen.z >= T(0.9) * seen.L;
}

}  // namespace aspic::physics
