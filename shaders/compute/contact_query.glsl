// Which of the triangles near a point is the nearest. Expects what compute/contact_points.glsl names.
#include "compute/terms/closest_point.glsl"

#define ANY_SIDE 0xffffffffu
#define NO_TRIANGLE 0xffffffffu
#define NOTHING_NEAR 3.0e38

// A point that looks at triangles of one body.
struct Looker {
  CandidateGroup of;
  vec3 start;   // P at the start of the step
  vec3 place;   // P
  vec3 normal;  // N_P
};

uvec4 triangle_of(Looker p, uint k) { return triangles[words[p.of.near_first + k]]; }

// Σ g of triangles at a particle.
vec3 normal_of(uint first, uint count) {
  precise vec3 sum = vec3(0.0);
  for (uint k = 0u; k < count; ++k) {
    uvec4 t = triangles[words[first + k]];
    precise vec3 g = area_normal(stage_place(t.x), stage_place(t.y), stage_place(t.z));
    if (k == 0u) {
      sum = g;
    } else {
      sum = sum + g;
    }
  }
  return sum;
}

bool may_contact(Looker p, uvec4 t) {
  precise vec3 A = start_place(t.x), B = start_place(t.y), C = start_place(t.z);
  precise vec3 low = min(min(A, B), C) - p.of.margin, high = max(max(A, B), C) + p.of.margin;
  return all(greaterThanEqual(p.start, low)) && all(lessThanEqual(p.start, high));
}

// Whether the box of a triangle is farther than what may touch.
bool beyond(Looker p, vec3 A, vec3 B, vec3 C) {
  precise vec3 below = min(min(A, B), C) - p.place, above = p.place - max(max(A, B), C);
  precise vec3 away = max(max(below, above), vec3(0.0));
  precise float far = max(p.of.range, p.of.eased_depth) + 0.01 * p.of.spacing;
  precise float limit = far * far;
  return dot3(away, away) > limit;
}

// What the point sees of triangle k of its list, if it counts.
bool look(Looker p, uint k, uint side, out ClosestPoint seen) {
  seen = ClosestPoint(vec3(0.0), vec3(0.0), 0.0, vec3(0.0), 0.0);
  uvec4 t = triangle_of(p, k);
  if ((side != ANY_SIDE && t.w != side) || !may_contact(p, t)) return false;
  precise vec3 A = stage_place(t.x), B = stage_place(t.y), C = stage_place(t.z);
  if (beyond(p, A, B, C)) return false;
  precise vec3 g = area_normal(A, B, C);
  if (!(dot3(g, g) > 0.0)) return false;
  if ((p.of.flags & CONTACT_OPPOSING) != 0u && !(dot3(p.normal, g) < 0.0)) return false;
  seen = closest_point(p.place, A, B, C, g);
  return true;
}

// The nearest triangle of a side, with the point's view of it. Among triangles as near, the one straightest in front counts;
// among equals, the nearest. `fronts` gets a bit for each side straight in front of the point.
uint nearest_of(Looker p, uint side, inout uint fronts, out ClosestPoint best_seen) {
  precise float least = NOTHING_NEAR;
  ClosestPoint seen;
  best_seen = ClosestPoint(vec3(0.0), vec3(0.0), 0.0, vec3(0.0), 0.0);
  for (uint k = 0u; k < p.of.near_count; ++k) {
    if (!look(p, k, side, seen)) continue;
    if (seen.L < least) least = seen.L;
    if (straight_in_front(seen, p.of.range)) fronts |= 1u << triangle_of(p, k).w;
  }
  if (!(least < NOTHING_NEAR)) return NO_TRIANGLE;
  precise float far = least + p.of.tie, straight = -1.0, nearest = least;
  uint best = NO_TRIANGLE;
  for (uint k = 0u; k < p.of.near_count; ++k) {
    if (!look(p, k, side, seen) || !(seen.L <= far)) continue;
    precise float share = straightness(seen);
    if (share > straight || (share == straight && seen.L < nearest)) {
      best = k;
      best_seen = seen;
      straight = share;
      nearest = seen.L;
    }
  }
  return best;
}
