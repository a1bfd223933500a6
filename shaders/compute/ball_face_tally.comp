// Which pairs of a ball and a face act in a phase, with their gaps; how many of each body do, and the lists of each particle's.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#define ASPIC_BALL_FACE_KERNEL
#include "compute/ball_blocks.glsl"
#include "compute/ball_face_blocks.glsl"
#include "compute/terms/closest_point.glsl"
layout(location = LOCATION_BALL_PHASE) uniform uint ball_phase;

// xyz: normal towards the ball; w: distance.
vec4 gap_of(BallFacePair pair, Ball ball) {
  precise vec3 P = ball.position.xyz;
  precise vec3 A = end_place(pair.corner[0]), B = end_place(pair.corner[1]), C = end_place(pair.corner[2]);
  precise vec3 ab = B - A, ac = C - A;
  precise vec3 e = ((P - A) - pair.share[1] * ab) - pair.share[2] * ac;
  precise vec3 g = area_normal(A, B, C);
  if ((pair.flags & FACE_WITHIN) != 0u && dot3(g, g) > 0.0) {
    precise float size = norm3(g);
    precise vec3 N = exact_div(1.0, size) * g;
    precise vec3 n = pair.side * N;
    precise float d = dot3(e, n) - ball.position.w;
    return vec4(n, d);
  }
  precise float L = norm3(e);
  if (!(L > 0.0)) return vec4(0.0, 1.0, 0.0, -ball.position.w);
  precise float q = exact_div(1.0, L);
  precise vec3 n = pair.side * (q * e);
  precise float d = pair.side * L - ball.position.w;
  return vec4(n, d);
}

bool acts(BallFacePair pair, Ball ball, vec4 gap) {
  if (ball_phase == BALL_PHASE_FACE_POSITIONS) return gap.w < 0.0;
  precise vec3 v = over_shares(pair, end_velocity(pair.corner[0]), end_velocity(pair.corner[1]),
                               end_velocity(pair.corner[2]));
  precise vec3 dv = ball.velocity.xyz - v;
  return dot3(dv, gap.xyz) < 0.0;
}

void main() {
  uint i = item_index();
  if (idle() || i >= pair_count()) return;
  BallFacePair pair = face_pairs[i];
  if ((pair.flags & FACE_CONTACTS) == 0u) return;
  Ball ball = ball_in(slot_before(ball_phase), ball_of_pair(i));
  precise vec4 gap = gap_of(pair, ball);
  bool acting = acts(pair, ball, gap);
  face_pairs[i].linear = gap;
  face_pairs[i].acts = acting ? 1u : 0u;
  if (!acting) return;
  atomicAdd(face_counts[ball_of_pair(i)].pairs, 1u);
  for (uint n = 0u; n < 3u; ++n) {
    uint p = ball_count + pair.corner[n];
    atomicAdd(face_counts[p].pairs, 1u);
    face_pairs[i].next[n] = atomicExchange(face_counts[p].first_pair, 3u * i + n + 1u);
  }
}
