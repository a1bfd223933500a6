// What the ball of an acting pair receives from the face: an impulse, or in the phase of positions a shift [m·kg].
#include "compute/layout.glsl"
#include "compute/common.glsl"
#define ASPIC_BALL_FACE_KERNEL
#include "compute/ball_blocks.glsl"
#include "compute/terms/ball_contact.glsl"
#include "compute/ball_face_blocks.glsl"
layout(location = LOCATION_BALL_PHASE) uniform uint ball_phase;

float pairs_of(uint body) { return float(face_counts[body].pairs); }

// share·(c·w) of a corner.
vec3 part(uint p, float share) {
  precise float parts = share * (pairs_of(ball_count + p) * end_particle(p).position.w);
  return vec3(parts);
}

void main() {
  uint i = item_index();
  if (idle() || i >= pair_count()) return;
  BallFacePair pair = face_pairs[i];
  if ((pair.flags & FACE_CONTACTS) == 0u || pair.acts == 0u) return;
  uint b = ball_of_pair(i);
  uint p_0 = pair.corner[0], p_1 = pair.corner[1], p_2 = pair.corner[2];
  Ball ball = ball_in(slot_before(ball_phase), b);
  precise vec3 parts =
      over_shares(pair, part(p_0, pair.share[0]), part(p_1, pair.share[1]), part(p_2, pair.share[2]));
  precise float weight = pairs_of(b) * ball.velocity.w + parts.x;
  precise vec3 n = pair.linear.xyz;
  if (ball_phase == BALL_PHASE_FACE_POSITIONS) {
    precise vec3 shift = exact_div(-pair.linear.w, weight) * n;
    face_pairs[i].linear.xyz = shift;
    return;
  }
  precise vec3 v = over_shares(pair, end_velocity(p_0), end_velocity(p_1), end_velocity(p_2));
  precise vec3 v_0 = over_shares(pair, start_velocity(p_0), start_velocity(p_1), start_velocity(p_2));
  precise vec3 dv = ball.velocity.xyz - v, dv_0 = ball.start_velocity.xyz - v_0;
  precise vec3 rolling = ball.position.w * ball.spin.xyz;
  precise float slip_weight = weight + pairs_of(b) * ball.start_velocity.w;
  Impulse received = impact(n, dv, dv_0, rolling, weight, slip_weight);
  face_pairs[i].linear.xyz = received.linear;
  face_pairs[i].turning.xyz = received.turning;
}
