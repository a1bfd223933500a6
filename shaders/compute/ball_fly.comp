// Balls, first of a step: free flight by all stages of the integrator at once (backward Euler of free flight is
// symplectic Euler, whose stages stand in the table then), and the terrain's response. Start slot to the slot between.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/ball_contact.glsl"
#include "compute/terrain.glsl"

layout(std430, binding = BINDING_BALL_BODIES) restrict readonly buffer BallBodies { BallBody bodies[]; };

vec4 ball_gap(uint t, float radius, vec3 x) {
  precise vec4 g = gap(t, x);
  g.w = g.w - radius;
  return g;
}

void fly(Ball ball, BallBody body, out precise vec3 end_x, out precise vec3 end_v) {
  precise vec3 x_0 = ball.position.xyz, v_0 = ball.velocity.xyz;
  precise vec3 x = x_0, v = v_0;
  precise vec3 sum_x = vec3(0.0), sum_v = vec3(0.0);
  for (uint s = 0u; s < MAX_STAGES; ++s) {
    Stage stage = stages[s];
    precise vec3 f = body.ball_mass * gravity.xyz;
    if (contact_model == CONTACT_COURSE) {
      for (uint t = 0u; t < terrain_count; ++t) f = resisted(t, ball_gap(t, ball.position.w, x), v, f);
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

void respond_ball(uint t, Ball start, BallBody body, inout precise vec3 x, inout precise vec3 v,
                  inout precise vec3 omega) {
  bool coulomb = contact_model == CONTACT_COULOMB;
  precise float R = start.position.w;
  precise vec4 g = ball_gap(t, R, x);
  precise float u = dot3(v, g.xyz);
  if (g.w < epsilon && u < 0.0) {
    precise float approach = -dot3(start.velocity.xyz, g.xyz);
    bool bounces = !coulomb || approach > resting_speed;
    precise float u_after = bounces ? bounce_speed(t, body.ball_mass, u) : 0.0;
    precise float du = u_after - u;
    precise vec3 v_t = v - u * g.xyz;
    if (ball_spin != 0u) {
      precise vec3 s = v_t - R * cross3(omega, g.xyz);
      precise vec4 rub = friction_impulse(s, body.ball_mass * du, terrains[t].friction,
                                          body.ball_inverse_mass + start.start_velocity.w);
      v_t = v_t - (body.ball_inverse_mass * rub.w) * rub.xyz;
      omega = omega + (start.spin.w * rub.w) * cross3(g.xyz, rub.xyz);
    } else if (coulomb) {
      precise float slip = norm3(v_t);
      if (slip > 0.0) {
        precise float kept = 1.0 - exact_div(terrains[t].friction * du, slip);
        v_t = kept > 0.0 ? kept * v_t : vec3(0.0);
      }
    }
    v = v_t + u_after * g.xyz;
    if (coulomb && u_after == 0.0 && v_t.x == 0.0 && v_t.y == 0.0 && v_t.z == 0.0) {
      x = start.position.xyz;
      g = ball_gap(t, R, x);
    }
  }
  if (coulomb && g.w < 0.0) x = x - g.w * g.xyz;
}

void main() {
  uint b = item_index();
  if (b >= ball_count || idle()) return;
  Ball start = ball_in(start_slot(), b);
  BallBody body = bodies[b];
  precise vec3 x = start.position.xyz, v = start.velocity.xyz, omega = start.spin.xyz;
  precise float w = 0.0;
  if (body.launch_step <= steps_done()) {
    w = body.ball_inverse_mass;
    fly(start, body, x, v);
    for (uint t = 0u; t < terrain_count; ++t) respond_ball(t, start, body, x, v, omega);
  }
  balls[BALL_SLOT_BETWEEN * ball_count + b] =
      Ball(vec4(x, start.position.w), vec4(v, w), vec4(omega, start.spin.w),
           vec4(start.velocity.xyz, start.start_velocity.w));
}
