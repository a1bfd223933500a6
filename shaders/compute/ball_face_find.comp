// The nearest face of a body that each ball touches: of the triangles closer than ε the least distance, then, of those as
// near, the one straightest in front. Before anything is counted, no pair counts.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#define ASPIC_BALL_FACE_KERNEL
#include "compute/ball_blocks.glsl"
#include "compute/ball_face_blocks.glsl"
#include "compute/terms/closest_point.glsl"

#define NO_TRIANGLE 0xffffffffu
#define NOTHING_NEAR 3.0e38

// A ball at P that looks at the triangles of a body nearer than `limit`.
struct Looker {
  vec3 P;
  float limit;
  float far;  // somewhat more
  uvec4 body;
};

bool look(Looker ball, uint t, out ClosestPoint seen) {
  seen = ClosestPoint(vec3(0.0), vec3(0.0), 0.0, vec3(0.0), 0.0);
  uvec3 corner = corners_of(t);
  precise vec3 A = end_place(corner.x), B = end_place(corner.y), C = end_place(corner.z);
  if (box_beyond(min(min(A, B), C), max(max(A, B), C), ball.far, ball.P)) return false;
  precise vec3 g = area_normal(A, B, C);
  if (!(dot3(g, g) > 0.0)) return false;
  seen = closest_point(ball.P, A, B, C, g);
  return seen.L < ball.limit;
}

// The triangle of a body after t that is to be looked at, passing over blocks that are far; its end if there is none.
uint next_of(Looker ball, uint t, uint end) {
  if (t % FACE_BLOCK != 0u || t >= end) return t;
  uint block = t / FACE_BLOCK;
  bool far = box_beyond(face_boxes[2u * block].xyz, face_boxes[2u * block + 1u].xyz, ball.far, ball.P);
  return far ? t + FACE_BLOCK : t;
}

uint nearest_of(Looker ball) {
  uint first = ball.body.x * FACE_BLOCK, end = first + ball.body.y * FACE_BLOCK;
  precise float least = NOTHING_NEAR;
  ClosestPoint seen;
  uint t = first;
  for (uint n = 0u; t < end; ++n) {
    if (bounded(n + 1u, KERNEL_BALL_FACES) == n) break;
    uint at = next_of(ball, t, end);
    t = at == t ? t + 1u : at;
    if (at + 1u == t && look(ball, at, seen) && seen.L < least) least = seen.L;
  }
  if (!(least < NOTHING_NEAR)) return NO_TRIANGLE;
  precise float tie = 2e-6 * ball.limit;
  precise float far = least + tie, straight = -1.0, nearest = least;
  uint best = NO_TRIANGLE;
  t = first;
  for (uint n = 0u; t < end; ++n) {
    if (bounded(n + 1u, KERNEL_BALL_FACES) == n) break;
    uint at = next_of(ball, t, end);
    t = at == t ? t + 1u : at;
    if (at + 1u != t || !look(ball, at, seen) || !(seen.L <= far)) continue;
    precise float share = straightness(seen);
    if (share > straight || (share == straight && seen.L < nearest)) {
      best = at;
      straight = share;
      nearest = seen.L;
    }
  }
  return best;
}

BallFacePair none() {
  return BallFacePair(uint[3](0u, 0u, 0u), 0u, float[3](0.0, 0.0, 0.0), 1.0, vec4(0.0), vec4(0.0), uint[3](0u, 0u, 0u), 0u);
}

BallFacePair pair_with(Looker ball, uint t) {
  ClosestPoint seen;
  look(ball, t, seen);
  precise float b = seen.place.x, c = seen.place.y;
  precise float a = (1.0 - b) - c;
  // A corner is a particle, which the ball meets as such.
  if (a == 1.0 || b == 1.0 || c == 1.0) return none();
  bool closed = ball.body.z != 0u, within = seen.place.z != 0.0;
  precise vec4 gap;
  if (closed && !closed_gap(seen, ball.limit, ball.limit, gap)) return none();
  // Of a closed surface N leads outside; the nearest place of an open one is on the ball's side.
  precise float side = seen.z < 0.0 && within != closed ? -1.0 : 1.0;
  BallFacePair pair = none();
  uvec3 corner = corners_of(t);
  pair.corner = uint[3](corner.x, corner.y, corner.z);
  pair.flags = FACE_CONTACTS | (within ? FACE_WITHIN : 0u);
  pair.share = float[3](a, b, c);
  pair.side = side;
  return pair;
}

void main() {
  uint i = item_index();
  if (idle()) return;
  if (i < ball_count + particle_count) face_counts[i] = BallFaceCount(0u, 0u);
  if (i >= pair_count()) return;
  Ball ball = ball_in(BALL_SLOT_BETWEEN, ball_of_pair(i));
  face_pairs[i] = none();
  if (ball.velocity.w == 0.0 || !finite(ball.position.xyz)) return;
  precise float limit = ball.position.w + contact_distance;
  precise float far = 1.01 * limit;
  Looker looker = Looker(ball.position.xyz, limit, far, row_of_faces(body_of_pair(i)));
  uint t = nearest_of(looker);
  if (t != NO_TRIANGLE) face_pairs[i] = pair_with(looker, t);
}
