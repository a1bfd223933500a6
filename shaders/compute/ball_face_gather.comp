// Balls and particles receive what their pairs with faces gave them; after the last phase the step is at its end.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#define ASPIC_BALL_FACE_KERNEL
#include "compute/ball_blocks.glsl"
#include "compute/ball_face_blocks.glsl"
layout(location = LOCATION_BALL_PHASE) uniform uint ball_phase;

void end_ball(uint b) {
  Ball ball = ball_in(slot_before(ball_phase), b);
  if (face_counts[b].pairs != 0u) {
    precise vec3 linear = vec3(0.0), turning = vec3(0.0);
    uint bodies = bounded(face_body_count(), KERNEL_BALL_FACES);
    for (uint body = 0u; body < bodies; ++body) {
      uint i = b * face_body_count() + body;
      if ((face_pairs[i].flags & FACE_CONTACTS) == 0u || face_pairs[i].acts == 0u) continue;
      linear = linear + face_pairs[i].linear.xyz;
      turning = turning + face_pairs[i].turning.xyz;
    }
    precise vec3 change = ball.velocity.w * linear;
    if (ball_phase == BALL_PHASE_FACE_POSITIONS) {
      precise vec3 x = ball.position.xyz + change;
      ball.position.xyz = x;
    } else {
      precise vec3 v = ball.velocity.xyz + change;
      precise vec3 omega = ball.spin.xyz;
      if (ball_spin != 0u) omega = omega + ball.spin.w * turning;
      ball.velocity.xyz = v;
      ball.spin.xyz = omega;
    }
  }
  if (ball_phase == BALL_PHASE_FACE_POSITIONS) {
    uint bad = divergence_word(particle_count + b, ball.position.xyz, ball.velocity.xyz);
    if (!finite(ball.spin.xyz)) bad = 2u * (particle_count + b);
    if (bad != NO_STEP) mark_divergence(bad);
  }
  balls[slot_after(ball_phase) * ball_count + b] = ball;
}

// Takes the share of corner n of a pair from a sum.
vec3 without(vec3 sum, uint i, uint n) {
  precise vec3 left = sum - face_pairs[i].share[n] * face_pairs[i].linear.xyz;
  return left;
}

// Of a particle with few pairs: sorted as they are taken from its list.
vec3 sum_of_few(uint node, uint count) {
  uint sorted[FACE_LIST_SIZE];
  for (uint n = 0u; n < count; ++n) {
    uint at = n;
    for (; at > 0u && sorted[at - 1u] > node; --at) sorted[at] = sorted[at - 1u];
    sorted[at] = node;
    node = face_pairs[(node - 1u) / 3u].next[(node - 1u) % 3u];
  }
  precise vec3 sum = vec3(0.0);
  for (uint n = 0u; n < count; ++n) sum = without(sum, (sorted[n] - 1u) / 3u, (sorted[n] - 1u) % 3u);
  return sum;
}

// Of one with many: all balls are asked whether they touch a face at it.
vec3 sum_of_many(uint p, uint body) {
  precise vec3 sum = vec3(0.0);
  uint rounds = bounded(ball_count, KERNEL_BALL_FACES);
  for (uint b = 0u; b < rounds; ++b) {
    uint i = b * face_body_count() + body;
    BallFacePair pair = face_pairs[i];
    if ((pair.flags & FACE_CONTACTS) == 0u || pair.acts == 0u) continue;
    for (uint n = 0u; n < 3u; ++n)
      if (pair.corner[n] == p) sum = without(sum, i, n);
  }
  return sum;
}

void end_of_particle(uint p) {
  BallFaceCount own = face_counts[ball_count + p];
  Particle particle = end_particle(p);
  if (own.pairs != 0u && particle.position.w != 0.0) {
    precise vec3 sum = vec3(0.0);
    if (own.pairs <= FACE_LIST_SIZE) {
      sum = sum_of_few(own.first_pair, own.pairs);
    } else {
      sum = sum_of_many(p, body_of_pair((own.first_pair - 1u) / 3u));
    }
    precise vec3 change = particle.position.w * sum;
    precise vec3 x = particle.position.xyz, v = particle.velocity.xyz;
    if (ball_phase == BALL_PHASE_FACE_POSITIONS) {
      x = x + change;
    } else {
      v = v + change;
    }
    particle = Particle(vec4(x, particle.position.w), vec4(v, particle.velocity.w));
    if (particle_parity() == 0u) {
      state_b[p] = particle;
    } else {
      state_a[p] = particle;
    }
  }
  if (ball_phase != BALL_PHASE_FACE_POSITIONS) return;
  uint bad = divergence_word(p, particle.position.xyz, particle.velocity.xyz);
  if (bad != NO_STEP) mark_divergence(bad);
}

void main() {
  uint i = item_index();
  if (idle() || i >= ball_count + particle_count) return;
  if (i < ball_count) {
    end_ball(i);
  } else {
    end_of_particle(i - ball_count);
  }
  // The next phase counts from zero.
  face_counts[i] = BallFaceCount(0u, 0u);
}
