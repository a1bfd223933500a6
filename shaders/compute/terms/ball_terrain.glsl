// A ball and a terrain: src/physics/balls/law.h in GLSL.
#include "compute/terms/terrain.glsl"

// At the step's start or end: AT_START, AT_END.
vec4 ball_gap(uint t, uint end, float radius, vec3 x) {
  precise vec4 g = gap(t, place(t, end, x));
  g.w = g.w - radius;
  return g;
}

// Friction where the surfaces touch, of a terrain whose normal impulse raised the normal speed by `gain`.
void apply_ball_friction(uint t, Ball start, BallBody body, float gain, vec3 n, inout precise vec3 v_t,
              inout precise vec3 omega) {
  precise vec3 s = v_t - start.position.w * cross3(omega, n);
  precise float normal_impulse = body.ball_mass * gain;
  precise float weight = body.ball_inverse_mass + start.start_velocity.w;
  precise vec4 friction = friction_impulse(s, normal_impulse, terrains[t].friction, weight);
  v_t = v_t - (body.ball_inverse_mass * friction.w) * friction.xyz;
  omega = omega + (start.spin.w * friction.w) * cross3(n, friction.xyz);
}

void respond_ball_course(uint t, Ball start, BallBody body, vec3 x, inout precise vec3 v, inout precise vec3 omega) {
  precise vec4 g = ball_gap(t, AT_END, start.position.w, x);
  precise vec3 v_r = relative_velocity(t, AT_END, v);
  precise float u = dot3(v_r, g.xyz);
  if (!(g.w < contact_distance && u < 0.0)) return;
  precise float u_after = bounce_speed(t, body.ball_mass, u);
  precise vec3 v_t = v_r - u * g.xyz;
  precise float gain = u_after - u;
  if (ball_spin != 0u) apply_ball_friction(t, start, body, gain, g.xyz, v_t, omega);
  precise vec3 left = v_t + u_after * g.xyz;
  v = absolute_velocity(t, left);
}

// f [N] with the reaction of ground on which the ball rests at the start of the step; with spin its normal part alone.
vec3 with_ball_reaction(uint t, Ball start, BallBody body, vec3 f) {
  precise vec4 g = ball_gap(t, AT_START, start.position.w, start.position.xyz);
  if (!rests(g.w, dot3(relative_velocity(t, AT_START, start.velocity.xyz), g.xyz))) return f;
  precise vec3 v_0 = relative_velocity(t, AT_END, start.velocity.xyz);
  precise float friction = ball_spin != 0u ? 0.0 : terrains[t].friction;
  precise float hw = time_step * body.ball_inverse_mass;
  precise vec3 sum = with_reaction(friction, g.xyz, least_normal_speed(g.w), hw, v_0, f);
  return sum;
}

// The end of a step. With spin, f is the force in the step's evaluations so far: gravity, reactions of terrains before.
void respond_ball_coulomb(uint t, Ball start, BallBody body, inout precise vec3 f, inout precise vec3 x,
                          inout precise vec3 v, inout precise vec3 omega) {
  precise float R = start.position.w;
  precise vec4 g_0 = ball_gap(t, AT_START, R, start.position.xyz);
  precise float u_0 = dot3(relative_velocity(t, AT_START, start.velocity.xyz), g_0.xyz);
  precise float given = 0.0;
  if (ball_spin != 0u) {
    precise vec3 before = f;
    f = with_ball_reaction(t, start, body, before);
    precise vec3 reaction = f - before;
    given = (time_step * body.ball_inverse_mass) * dot3(reaction, g_0.xyz);
  }
  precise vec4 g = ball_gap(t, AT_END, R, x);
  precise vec3 v_r = relative_velocity(t, AT_END, v);
  precise float u = dot3(v_r, g.xyz);
  precise float u_after = u;
  if (g.w < contact_distance) u_after = speed_after_contact(t, body.ball_mass, g_0.w, u_0, g.w, u);
  precise float gain = (u_after - u) + given;
  if (gain > 0.0) {
    precise vec3 v_t = v_r - u * g.xyz;
    if (ball_spin != 0u) {
      apply_ball_friction(t, start, body, gain, g.xyz, v_t, omega);
    } else {
      precise float loss = terrains[t].friction * gain;
      v_t = after_friction(v_t, loss);
    }
    precise vec3 left = v_t + u_after * g.xyz;
    v = absolute_velocity(t, left);
  }
  if (!(g.w < contact_distance)) return;
  precise float rise = undue_rise(g_0.w, u_0, g.w, u_after);
  if (rise > 0.0) {
    x = x - rise * g.xyz;
    g = ball_gap(t, AT_END, R, x);
  }
  if (g.w < 0.0) x = x - g.w * g.xyz;
}
