// The closest point of a triangle and its contact with a point: src/physics/contact/geometry.h in single precision.

// The nearest place A + b·(B − A) + c·(C − A): b, c, and 1 within the face or 0 on its rim.
vec3 nearest_place(vec3 P, vec3 A, vec3 B, vec3 C) {
  precise vec3 ab = B - A, ac = C - A, ap = P - A, bp = P - B, cp = P - C;
  precise float d1 = dot3(ab, ap), d2 = dot3(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return vec3(0.0);
  precise float d3 = dot3(ab, bp), d4 = dot3(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return vec3(1.0, 0.0, 0.0);
  precise float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    precise float along_ab = d1 - d3;
    return vec3(exact_div(d1, along_ab), 0.0, 0.0);
  }
  precise float d5 = dot3(ab, cp), d6 = dot3(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return vec3(0.0, 1.0, 0.0);
  precise float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    precise float along_ac = d2 - d6;
    return vec3(0.0, exact_div(d2, along_ac), 0.0);
  }
  precise float va = d3 * d6 - d5 * d4, to_b = d4 - d3, to_c = d5 - d6;
  if (va <= 0.0 && to_b >= 0.0 && to_c >= 0.0) {
    precise float along_bc = to_b + to_c;
    precise float c_rim = exact_div(to_b, along_bc);
    precise float b_rim = 1.0 - c_rim;
    return vec3(b_rim, c_rim, 0.0);
  }
  precise float all_parts = (va + vb) + vc;
  precise float q = exact_div(1.0, all_parts);
  precise float b = vb * q, c = vc * q;
  return vec3(b, c, 1.0);
}

vec3 area_normal(vec3 A, vec3 B, vec3 C) {
  precise vec3 ab = B - A, ac = C - A;
  return cross3(ab, ac);
}

struct ClosestPoint {
  vec3 place;  // b, c; z: 1 within the face
  vec3 e;      // from the nearest place to the point [m]
  float L;     // its length [m]
  vec3 N;      // the triangle's unit normal
  float z;     // e·N [m]
};

ClosestPoint closest_point(vec3 P, vec3 A, vec3 B, vec3 C, vec3 g) {
  precise vec3 at = nearest_place(P, A, B, C);
  precise vec3 ab = B - A, ac = C - A;
  precise vec3 e = ((P - A) - at.x * ab) - at.y * ac;
  precise float L = norm3(e);
  precise float size = norm3(g);
  precise vec3 N = exact_div(1.0, size) * g;
  precise float z = dot3(e, N);
  return ClosestPoint(at, e, L, N, z);
}

// How straight in front of a triangle a point is: |z|/L, 1 in front of the face.
float straightness(ClosestPoint seen) {
  if (seen.place.z != 0.0) return 1.0;
  if (!(seen.L > 0.0)) return 0.0;
  precise float size = abs(seen.z);
  precise float share = exact_div(size, seen.L);
  return share;
}

bool straight_in_front(ClosestPoint seen, float reach) {
  precise float least = 0.9 * seen.L;
  return seen.z >= 0.0 && seen.L < reach && seen.z >= least;
}

// n and d of a point that touches; false where it does not.
bool closed_gap(ClosestPoint seen, float reach, float depth, out precise vec4 gap) {
  gap = vec4(0.0);
  bool inside = seen.z < 0.0;
  precise float behind = -seen.z, least = 0.7 * seen.L;
  if (inside ? !(seen.L <= depth && behind >= least) : !(seen.L < reach)) return false;
  precise float d = inside ? -seen.L : seen.L;
  if (seen.place.z != 0.0) {
    gap = vec4(seen.N, seen.z);
  } else if (!(seen.L > 0.0)) {
    gap = vec4(seen.N, d);
  } else {
    precise vec3 n = exact_div(1.0, d) * seen.e;
    gap = vec4(n, d);
  }
  return true;
}

bool open_gap(ClosestPoint seen, float reach, out precise vec4 gap) {
  gap = vec4(0.0);
  if (!(seen.L < reach)) return false;
  if (seen.place.z != 0.0) {
    gap = seen.z < 0.0 ? vec4(-seen.N, -seen.z) : vec4(seen.N, seen.z);
  } else if (!(seen.L > 0.0)) {
    gap = vec4(seen.N, seen.L);
  } else {
    precise vec3 n = exact_div(1.0, seen.L) * seen.e;
    gap = vec4(n, seen.L);
  }
  return true;
}
