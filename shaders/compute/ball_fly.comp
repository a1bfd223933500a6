// Balls, first of a step: flight by all stages of the integrator at once, under gravity, drag and pulls (backward
// Euler of free flight is symplectic Euler, whose stages are in the table then), and the terrain's response. Start
// slot to the slot between.
// NVIDIA's compiler takes twice as long otherwise. Others ignore it.
#pragma optionNV(unroll none)
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/terms/ball_contact.glsl"
#include "compute/terms/ball_terrain.glsl"
#include "compute/terms/pulls.glsl"

layout(std430, binding = BINDING_BALL_BODIES) restrict readonly buffer BallBodies { BallBody bodies[]; };

// f_held [N] acts throughout the step.
void fly(Ball ball, BallBody body, vec3 f_held, out precise vec3 end_x, out precise vec3 end_v) {
  precise vec3 x_0 = ball.position.xyz, v_0 = ball.velocity.xyz;
  precise vec3 x = x_0, v = v_0;
  precise vec3 sum_x = vec3(0.0), sum_v = vec3(0.0);
  for (uint s = 0u; s < MAX_STAGES; ++s) {
    Stage stage = stages[s];
    precise vec3 f = f_held;
    for (uint t = 0u; t < terrain_count; ++t) {
      if (contact_model == CONTACT_COURSE) {
        f = resisted(t, ball_gap(t, AT_START, ball.position.w, x), v, f);
      } else {
        f = with_ball_reaction(t, ball, body, f);
      }
    }
    precise vec3 a = body.ball_inverse_mass * f;
    precise vec3 slope_x = stage.weight * v, slope_v = stage.weight * a;
    if (stage.accumulate != 0u) {
      slope_x = sum_x + slope_x;
      slope_v = sum_v + slope_v;
    }
    if (stage.weight != 0.0) {
      sum_x = slope_x;
      sum_v = slope_v;
    }
    if (stage.last != 0u) break;
    precise vec3 next_v = v_0 + stage.advance * a;
    x = x_0 + stage.advance * (drift == DRIFT_MEAN_VELOCITY ? 0.5 * (v + next_v) : v);
    v = next_v;
  }
  end_v = v_0 + step_scale * sum_v;
  end_x = x_0 + step_scale * (drift == DRIFT_NEW_VELOCITY ? end_v : sum_x);
}

void main() {
  uint b = item_index();
  if (b >= ball_count || idle()) return;
  count_item(b, ball_count);
  Ball start = ball_in(start_slot(), b);
  BallBody body = bodies[b];
  precise vec3 x = start.position.xyz, v = start.velocity.xyz, omega = start.spin.xyz;
  precise float w = 0.0;
  if (body.launch_step <= steps_done()) {
    w = body.ball_inverse_mass;
    precise vec3 weight = body_force(body.ball_mass, v);
    uint number = particle_count + b;
    precise vec3 f = with_pulls(number, x, v, weight);
    fly(start, body, f, x, v);
    for (uint t = 0u; t < terrain_count; ++t) {
      if (contact_model == CONTACT_COURSE) {
        respond_ball_course(t, start, body, x, v, omega);
      } else {
        respond_ball_coulomb(t, start, body, f, x, v, omega);
      }
    }
  }
  balls[BALL_SLOT_BETWEEN * ball_count + b] =
      Ball(vec4(x, start.position.w), vec4(v, w), vec4(omega, start.spin.w),
           vec4(start.velocity.xyz, start.start_velocity.w));
}
