// Balls receive the impulses, or the shifts, of a phase; after the last phase the step is at its end.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/terms/ball_contact.glsl"
#include "compute/ball_sums.glsl"

void main() {
  uint b = item_index();
  if (b >= ball_count || idle()) return;
  Ball ball = ball_in(slot_before(ball_phase), b);
  if (contacts[b].pairs[ball_phase] != 0u) {
    Impulse sum = sum_all(seeking_ball(b), b, KERNEL_BALL_EXCHANGE);
    precise vec3 change = ball.velocity.w * sum.linear;
    if (ball_phase == BALL_PHASE_POSITIONS) {
      precise vec3 x = ball.position.xyz + change;
      ball.position.xyz = x;
    } else {
      precise vec3 v = ball.velocity.xyz + change;
      precise vec3 omega = ball.spin.xyz;
      if (ball_spin != 0u) omega = omega + ball.spin.w * sum.turning;
      ball.velocity.xyz = v;
      ball.spin.xyz = omega;
    }
  }
#ifndef ASPIC_BALL_FACES  // else the step goes on
  if (ball_phase == BALL_PHASE_POSITIONS) {
    uint bad = divergence_word(particle_count + b, ball.position.xyz, ball.velocity.xyz);
    if (!finite(ball.spin.xyz)) bad = 2u * (particle_count + b);
    if (bad != NO_STEP) mark_divergence(bad);
  }
#endif
  balls[slot_after(ball_phase) * ball_count + b] = ball;
}
