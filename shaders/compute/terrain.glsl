// Terrain and contact (docs/physics.md, section 5).
#include "shapes/all.glsl"

// B(u) = max(0, (m − e·M)/(m + M)·u), −e·u for M = ∞
float bounce_speed(uint t, float m, float u) {
  precise float factor = -terrains[t].restitution;
  if (terrains[t].movable != 0u) {
    precise float M = terrains[t].mass;
    factor = exact_div(m - terrains[t].restitution * M, m + M);
  }
  precise float bounced = factor * u;
  return bounced > 0.0 ? bounced : 0.0;
}

#include "compute/coulomb.glsl"

// The course model's contact force: f [N] on a body with gap g and velocity v, resisted and rubbed by one terrain.
vec3 resisted(uint t, vec4 g, vec3 v, vec3 f_in) {
  precise vec3 f = f_in;
  precise float u = dot3(v, g.xyz);
  precise float f_n = dot3(f, g.xyz);
  if (g.w < epsilon && abs(u) < epsilon && f_n < 0.0) {
    precise float N = -f_n;
    precise vec3 v_t = v - u * g.xyz;
    f = (f + N * g.xyz) - (terrains[t].friction * N) * v_t;
  }
  return f;
}

// By every terrain, on a particle, after gravity and springs.
vec3 with_contact_force(vec3 x, vec3 v, vec3 f_in) {
  precise vec3 f = f_in;
  for (uint t = 0u; t < terrain_count; ++t) f = resisted(t, gap(t, x), v, f);
  return f;
}

void respond_course(uint t, float m, vec3 x, inout precise vec3 v) {
  precise vec4 g = gap(t, x);
  precise float u = dot3(v, g.xyz);
  if (g.w < epsilon && u < 0.0) {
    precise vec3 v_t = v - u * g.xyz;
    v = v_t + bounce_speed(t, m, u) * g.xyz;
  }
}

// The ground's reaction on a particle that rests on it at the start of the step, after all other forces.
vec3 with_ground_reaction(Particle start, vec3 f_in) {
  precise vec3 f = f_in;
  precise float hw = time_step * start.position.w;
  for (uint t = 0u; t < terrain_count; ++t) {
    if (!(distance_to(t, start.position.xyz) < epsilon)) continue;
    precise vec4 g_0 = gap(t, start.position.xyz);
    if (!rests(g_0.w, dot3(start.velocity.xyz, g_0.xyz))) continue;
    f = with_reaction(terrains[t].friction, g_0.xyz, least_normal_speed(g_0.w), hw, start.velocity.xyz, f);
  }
  return f;
}

// The response of all terrains, in file order, at the end of a step from `start` to x, v.
void respond(Particle start, inout precise vec3 x, inout precise vec3 v) {
  if (start.position.w == 0.0) return;
  for (uint t = 0u; t < terrain_count; ++t) {
    if (contact_model == CONTACT_COULOMB) {
      respond_coulomb(t, start.velocity.w, start.position.xyz, start.velocity.xyz, x, v);
    } else {
      respond_course(t, start.velocity.w, x, v);
    }
  }
}
