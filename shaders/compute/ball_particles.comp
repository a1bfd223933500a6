// Particles receive the impulses, or the shifts, of the balls they meet, after the balls have received theirs elsewhere.
// Who touches no ball has been at the end of its step since ball_find.comp.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/terms/ball_contact.glsl"
#include "compute/ball_sums.glsl"

void main() {
  uint p = item_index();
  if (p >= particle_count || idle()) return;
  uint body = ball_count + p;
  if (contacts[body].listed == 0u) return;
  Particle particle = end_particle(p);
  if (contacts[body].pairs[ball_phase] != 0u && particle.position.w != 0.0) {
    Impulse sum = sum_all(seeking_particle(p), body, KERNEL_BALL_PARTICLES);
    precise vec3 change = particle.position.w * sum.linear;
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
#ifndef ASPIC_BALL_FACES  // else the step goes on
  if (ball_phase != BALL_PHASE_POSITIONS) return;
  uint bad = divergence_word(p, particle.position.xyz, particle.velocity.xyz);
  if (bad != NO_STEP) mark_divergence(bad);
#endif
}
