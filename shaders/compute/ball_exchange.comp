// Balls receive the impulses, or the shifts, of a phase; after the last phase the step is at its end.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/ball_contact.glsl"
layout(location = LOCATION_BALL_PHASE) uniform uint ball_phase;
#include "compute/ball_search.glsl"

// c·w and c·R²/I of a body.
vec2 share_of(uint kind, uint index) {
  precise vec2 share = vec2(0.0);
  if (kind == KIND_PARTICLE) {
    share.x = float(acting[ball_count + index]) * end_particle(index).position.w;
  } else {
    Ball ball = ball_in(slot_before(ball_phase), index);
    share.x = float(acting[index]) * ball.velocity.w;
    share.y = float(acting[index]) * ball.start_velocity.w;
  }
  return share;
}

// What ball `own` receives from one partner; in the position phase `linear` is its shift [m·kg].
Impulse received(Seeker own, vec3 own_rolling, uint kind, uint index) {
  Partner other = partner(own, kind, index);
  precise vec2 mine = share_of(KIND_BALL, own.index), its = share_of(kind, index);
  precise float weight = mine.x + its.x;
  if (ball_phase == BALL_PHASE_POSITIONS) {
    precise vec3 shift = exact_div(-other.gap.w, weight) * other.gap.xyz;
    return Impulse(shift, vec3(0.0));
  }
  precise vec3 rolling = own_rolling;
  precise float slip_share = mine.y;
  if (kind == KIND_BALL) {
    Ball ball = ball_in(slot_before(ball_phase), index);
    rolling = own_rolling + ball.position.w * ball.spin.xyz;
    slip_share = mine.y + its.y;
  }
  precise float slip_weight = weight + slip_share;
  return impact(other.gap.xyz, other.dv, other.dv_0, rolling, weight, slip_weight);
}

void add_from(Seeker own, vec3 rolling, uint kind, inout precise vec3 linear, inout precise vec3 turning) {
  uint from = 0u;
  do {
    find(own, kind, from);
    for (uint n = 0u; n < found_count; ++n) {
      Impulse got = received(own, rolling, kind, found[n]);
      linear = linear + got.linear;
      turning = turning + got.turning;
    }
    from = next_after_list();
  } while (from != NO_BODY);
}

void main() {
  uint b = item_index();
  if (b >= ball_count || idle()) return;
  Ball ball = ball_in(slot_before(ball_phase), b);
  if (acting[b] != 0u) {
    Seeker own = seeking_ball(b);
    precise vec3 rolling = ball.position.w * ball.spin.xyz;
    precise vec3 linear = vec3(0.0), turning = vec3(0.0);
    if (phase_has(KIND_BALL)) add_from(own, rolling, KIND_BALL, linear, turning);
    if (phase_has(KIND_PARTICLE)) add_from(own, rolling, KIND_PARTICLE, linear, turning);
    precise vec3 change = ball.velocity.w * linear;
    if (ball_phase == BALL_PHASE_POSITIONS) {
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
  if (ball_phase == BALL_PHASE_POSITIONS) {
    uint bad = divergence_word(particle_count + b, ball.position.xyz, ball.velocity.xyz);
    if (!finite(ball.spin.xyz)) bad = 2u * (particle_count + b);
    if (bad != NO_STEP) mark_divergence(bad);
  }
  balls[slot_after(ball_phase) * ball_count + b] = ball;
}
