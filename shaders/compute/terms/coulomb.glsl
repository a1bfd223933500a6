// The Coulomb contact rule: src/physics/terrain/coulomb.h in GLSL. Expects what terrain.glsl has before it.

// |g|h: speed gained by a step of free fall [m/s].
float fall_speed() {
  return gravity.w;
}

// Whether a body at distance d_0 with normal speed u_0 at the start of a step rests on the ground.
bool rests(float d_0, float u_0) {
  return d_0 < contact_distance && abs(u_0) <= resting_speed;
}

// Whether such a body, should it end the step in approach, is set down: it began near the ground, not arriving fast.
bool set_down(float d_0, float u_0) {
  return d_0 < contact_distance && !(-u_0 > resting_speed);
}

// c = −min(max(d_0, 0)/h, most)
float sinking_speed(float d_0, float most) {
  if (!(d_0 > 0.0)) return 0.0;
  precise float needed = exact_div(d_0, time_step);
  precise float c = -(needed < most ? needed : most);
  return c;
}

// Least normal speed a resting body may end a step with.
float least_normal_speed(float d_0) {
  precise float c = sinking_speed(d_0, fall_speed());
  return c;
}

// Tangential velocity after friction has taken up to `loss` [m/s] off it.
vec3 after_friction(vec3 v_t, float loss) {
  precise float slip = norm3(v_t);
  if (!(slip > 0.0)) return v_t;
  precise float kept = 1.0 - exact_div(loss, slip);
  precise vec3 left = kept > 0.0 ? kept * v_t : vec3(0.0);
  return left;
}

// P: the velocity that ground of normal n leaves of v_1, whose normal speed may not be less than c.
vec3 projected(float friction, vec3 n, float c, vec3 v_1) {
  precise float u = dot3(v_1, n);
  if (!(u < c)) return v_1;
  precise vec3 v_t = v_1 - u * n;
  precise float loss = friction * (c - u);
  precise vec3 left = after_friction(v_t, loss) + c * n;
  return left;
}

// The force f [N] with the ground's reaction: kept for a complete step it turns v_0 into P(v_0 + hw·f). hw = h·w; v_0 is
// relative to the ground's velocity at the step's end.
vec3 with_reaction(float friction, vec3 n, float c, float hw, vec3 v_0, vec3 f) {
  precise vec3 v_1 = v_0 + hw * f;
  if (!(dot3(v_1, n) < c)) return f;
  precise float q = exact_div(1.0, hw);
  precise vec3 sum = q * (projected(friction, n, c, v_1) - v_0);
  return sum;
}

// Normal speed after the bounce of a body that fell by `drop` from distance d_0 during the step.
float bounced_speed(uint t, float m, float d_0, float drop, float u_0, float du, float mean) {
  precise float s = 0.0;
  if (drop > 0.0 && d_0 > 0.0) {
    s = exact_div(d_0, drop);
    s = s < 1.0 ? s : 1.0;
  }
  precise float arrival = mean + (s - 0.5) * du;
  precise float lag = (u_0 + 0.5 * du) - mean;
  precise float u = bounce_speed(t, m, arrival < 0.0 ? arrival : 0.0) + lag;
  precise float most = bounce_speed(t, m, u_0);
  most = most > 0.0 ? most + 2.0 * fall_speed() : fall_speed();
  if (!(u > 0.0)) return 0.0;
  return u < most ? u : most;
}

// Normal speed at the end of a step from distance d_0 with normal speed u_0 to d, u: u unless the ground acts.
float speed_after_contact(uint t, float m, float d_0, float u_0, float d, float u) {
  bool down = set_down(d_0, u_0);
  if (!(u < 0.0 && (d < 0.0 || down))) return u;
  precise float c = least_normal_speed(d_0);
  if (!(u < c)) return u;
  if (down) return c;
  if (!(-u_0 > resting_speed)) return 0.0;
  precise float drop = d_0 - d;
  precise float rise = d - d_0;
  precise float du = u - u_0;
  precise float u_after = bounced_speed(t, m, d_0, drop, u_0, du, exact_div(rise, time_step));
  return u_after;
}

// By how much [m] a body that rests on the ground has risen too far in a step to distance d and normal speed u.
float undue_rise(float d_0, float u_0, float d, float u) {
  if (!rests(d_0, u_0)) return 0.0;
  precise float rise = (d - d_0) - time_step * (u > 0.0 ? u : 0.0);
  return rise > 0.0 ? rise : 0.0;
}

// The end of a step that began at x_0, v_0.
void respond_coulomb(uint t, float m, vec3 x_0, vec3 v_0, inout precise vec3 x, inout precise vec3 v) {
  if (!(distance_at_end(t, x) < contact_distance)) return;
  precise vec4 g = gap_at_end(t, x);
  precise vec4 g_0 = gap_at_start(t, x_0);
  precise vec3 v_r = relative_velocity(t, AT_END, v);
  precise float u = dot3(v_r, g.xyz);
  precise float u_0 = dot3(relative_velocity(t, AT_START, v_0), g_0.xyz);
  precise float u_after = speed_after_contact(t, m, g_0.w, u_0, g.w, u);
  if (u_after > u) {
    precise vec3 v_t = v_r - u * g.xyz;
    precise float loss = terrains[t].friction * (u_after - u);
    precise vec3 left = after_friction(v_t, loss) + u_after * g.xyz;
    v = absolute_velocity(t, left);
  }
  precise float rise = undue_rise(g_0.w, u_0, g.w, u_after);
  if (rise > 0.0) {
    x = x - rise * g.xyz;
    g = gap_at_end(t, x);
  }
  if (g.w < 0.0) x = x - g.w * g.xyz;
}
