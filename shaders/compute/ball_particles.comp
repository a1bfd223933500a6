// Particles receive the impulses, or the shifts, of the balls they meet, after the balls have received theirs elsewhere.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/ball_contact.glsl"
layout(location = LOCATION_BALL_PHASE) uniform uint ball_phase;
#include "compute/ball_search.glsl"

vec3 received(Seeker own, float own_share, uint b) {
  Partner other = partner(own, KIND_BALL, b);
  Ball ball = ball_in(slot_before(ball_phase), b);
  precise float c = float(acting[b]);
  precise float weight = c * ball.velocity.w + own_share;
  if (ball_phase == BALL_PHASE_POSITIONS) {
    precise vec3 shift = exact_div(-other.gap.w, weight) * other.gap.xyz;
    return shift;
  }
  precise vec3 rolling = ball.position.w * ball.spin.xyz;
  precise float slip_weight = weight + c * ball.start_velocity.w;
  return impact(other.gap.xyz, other.dv, other.dv_0, rolling, weight, slip_weight).linear;
}

void main() {
  uint p = item_index();
  if (p >= particle_count || idle()) return;
  Particle particle = end_particle(p);
  uint count = acting[ball_count + p];
  if (count != 0u && particle.position.w != 0.0) {
    Seeker own = seeking_particle(p);
    precise float own_share = float(count) * particle.position.w;
    precise vec3 sum = vec3(0.0);
    uint from = 0u;
    do {
      find(own, KIND_BALL, from);
      for (uint n = 0u; n < found_count; ++n) sum = sum + received(own, own_share, found[n]);
      from = next_after_list();
    } while (from != NO_BODY);
    precise vec3 change = particle.position.w * sum;
    precise vec3 x = particle.position.xyz, v = particle.velocity.xyz;
    if (ball_phase == BALL_PHASE_POSITIONS) {
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
  if (ball_phase != BALL_PHASE_POSITIONS) return;
  uint bad = divergence_word(p, particle.position.xyz, particle.velocity.xyz);
  if (bad != NO_STEP) mark_divergence(bad);
}
