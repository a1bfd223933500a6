// Terrain and contact (docs/physics.md, section 5).
#include "shapes/all.glsl"
#include "compute/motion.glsl"

// A loop of one round, which compilers can see, costs software rasterizers a twentieth of a step less.
#ifdef ASPIC_ONE_TERRAIN
#define TERRAIN_COUNT 1u
#else
#define TERRAIN_COUNT terrain_count
#endif

// B(u) = max(0, (m − e·M)/(m + M)·u), −e·u for M = ∞
float bounce_speed(uint t, float m, float u) {
  precise float factor = -terrains[t].restitution;
  if (terrains[t].movable != 0u) {
    precise float M = terrains[t].mass;
    precise float kept = m - terrains[t].restitution * M;
    precise float sum = m + M;
    factor = exact_div(kept, sum);
  }
  precise float bounced = factor * u;
  return bounced > 0.0 ? bounced : 0.0;
}

#include "compute/terms/coulomb.glsl"

// The course model's contact force: f [N] on a body with gap g and velocity v, resisted and after_friction by one terrain, which
// is where it is at the step's start.
vec3 resisted(uint t, vec4 g, vec3 v_in, vec3 f_in) {
  precise vec3 f = f_in;
  precise vec3 v = relative_velocity(t, AT_START, v_in);
  precise float u = dot3(v, g.xyz);
  precise float f_n = dot3(f, g.xyz);
  if (g.w < contact_distance && abs(u) < set_speed && f_n < 0.0) {
    precise float N = -f_n;
    precise vec3 v_t = v - u * g.xyz;
    f = (f + N * g.xyz) - (terrains[t].friction * N) * v_t;
  }
  return f;
}

// By every terrain, on a particle, after gravity and springs.
vec3 with_contact_force(vec3 x, vec3 v, vec3 f_in) {
  precise vec3 f = f_in;
  for (uint t = 0u; t < TERRAIN_COUNT; ++t) f = resisted(t, gap_at_start(t, x), v, f);
  return f;
}

void respond_course(uint t, float m, vec3 x, inout precise vec3 v) {
  precise vec4 g = gap_at_end(t, x);
  precise vec3 v_r = relative_velocity(t, AT_END, v);
  precise float u = dot3(v_r, g.xyz);
  if (g.w < contact_distance && u < 0.0) {
    precise vec3 v_t = v_r - u * g.xyz;
    precise vec3 left = v_t + bounce_speed(t, m, u) * g.xyz;
    v = absolute_velocity(t, left);
  }
}

// The ground's reaction on a particle that rests on it at the start of the step, after all other forces.
vec3 with_ground_reaction(Particle start, vec3 f_in) {
  precise vec3 f = f_in;
  precise float hw = time_step * start.position.w;
  for (uint t = 0u; t < TERRAIN_COUNT; ++t) {
    if (!(distance_at_start(t, start.position.xyz) < contact_distance)) continue;
    precise vec4 g_0 = gap_at_start(t, start.position.xyz);
    if (!rests(g_0.w, dot3(relative_velocity(t, AT_START, start.velocity.xyz), g_0.xyz))) continue;
    precise vec3 v_0 = relative_velocity(t, AT_END, start.velocity.xyz);
    f = with_reaction(terrains[t].friction, g_0.xyz, least_normal_speed(g_0.w), hw, v_0, f);
  }
  return f;
}

// The response of all terrains, in file order, at the end of a step from `start` to x, v.
void respond(Particle start, inout precise vec3 x, inout precise vec3 v) {
  if (start.position.w == 0.0) return;
  for (uint t = 0u; t < TERRAIN_COUNT; ++t) {
    if (contact_model == CONTACT_COULOMB) {
      respond_coulomb(t, start.velocity.w, start.position.xyz, start.velocity.xyz, x, v);
    } else {
      respond_course(t, start.velocity.w, x, v);
    }
  }
}
