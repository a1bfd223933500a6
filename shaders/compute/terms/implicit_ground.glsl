// The ground inside the equation of implicit Euler: src/physics/terrain/implicit.h in GLSL. Expects terrain.glsl.

// P at one velocity, and the part of its derivative that the linear system takes.
struct Reaction {
  vec3 v;           // P(v) [m/s]
  float freedom;    // FREE_…
  vec3 axis;        // plane: its normal; line: its direction
  vec3 across;      // plane: unit vector in it across the slip; zero without slip
  float stiffness;  // m·(1/turn − 1) across the slip [kg]
  uint held[3];     // terrains that hold the particle
  uint count;       // so many of them
};

Reaction no_reaction(vec3 v) { return Reaction(v, FREE_ALL, vec3(0.0), vec3(0.0), 0.0, uint[3](0u, 0u, 0u), 0u); }

bool holds(Reaction r, uint t) {
  for (uint k = 0u; k < r.count; ++k) {
    if (r.held[k] == t) return true;
  }
  return false;
}

// The terrains that hold a particle in one number, which a float holds exactly.
float held_word(Reaction r) {
  uint word = 0u;
  for (uint k = r.count; k > 0u; --k) word = word * (MAX_TERRAINS + 1u) + r.held[k - 1u] + 1u;
  return float(word);
}

bool word_holds(float word, uint t) {
  for (uint left = uint(word); left > 0u; left /= MAX_TERRAINS + 1u) {
    if (left % (MAX_TERRAINS + 1u) == t + 1u) return true;
  }
  return false;
}

// Normal speed [m/s] that brings a particle with gap g to the surface by the step's end, c, against still ground.
float least_speed(vec4 g) {
  precise float c = -exact_div(g.w > 0.0 ? g.w : 0.0, time_step);
  return c;
}

// The same against terrain t, which may move.
float least_speed_of(uint t, vec4 g) {
  precise float c = least_speed(g);
  if (moves(t)) c = c + speed_along(t, g.xyz);
  return c;
}

// Share of a slip [m/s] that friction leaves when it may take up to `loss` [m/s] off it; 0 holds the particle.
float slip_kept(float slip, float loss) {
  precise float kept = loss > 0.0 ? 0.0 : 1.0;
  if (slip > 0.0) kept = 1.0 - exact_div(loss, slip);
  return kept;
}

// Whether velocity r.v would take a particle at x through terrain t, which does not hold it.
bool crosses(uint t, vec3 x, Reaction r) {
  if (holds(r, t)) return false;
  precise vec4 g = gap_at_start(t, x);
  return dot3(r.v, g.xyz) < least_speed_of(t, g);
}

#include "compute/terms/implicit_hold.glsl"
#include "compute/terms/implicit_join.glsl"

// P of a particle of mass m at x, with free velocity v.
Reaction react(vec3 x, float m, vec3 v) {
  Reaction reaction = no_reaction(v);
#ifdef ASPIC_ONE_TERRAIN
  if (crosses(0u, x, reaction)) {
    Reaction next = no_reaction(v);
    next.held[next.count++] = 0u;
    if (on_one(x, m, v, next)) reaction = next;
  }
#else
  for (uint round = 0u; round < 2u; ++round) {
    for (uint t = 0u; t < terrain_count; ++t) {
      if (holds(reaction, t)) continue;
      uint twin = twin_of(t, x, reaction);
      bool joins = twin == NO_TWIN ? crosses(t, x, reaction) : outranks(t, twin);
      if (joins) reaction = joined(x, m, v, reaction, t, twin);
    }
    if (reaction.count == 0u || terrain_count == 1u) break;
  }
#endif
  return reaction;
}

// The end of a solved step that began at x_0, v_0: a particle that came fast and that terrain t held bounces.
void respond_solved(uint t, float m, bool held, vec3 x_0, vec3 v_0, inout precise vec3 x, inout precise vec3 v) {
  precise vec4 g = gap_at_end(t, x);
  if (held) {
    precise vec4 g_0 = gap_at_start(t, x_0);
    precise vec3 v_r = relative_velocity(t, AT_END, v);
    precise float u_0 = dot3(relative_velocity(t, AT_START, v_0), g_0.xyz);
    precise float u = dot3(v_r, g.xyz);
    if (-u_0 > resting_speed) {
      precise float du = time_step * dot3(gravity.xyz, g.xyz);
      precise float mean = u_0 + du;
      precise float fall = -(time_step * mean);
      precise float u_after = bounced_speed(t, m, g_0.w, fall, u_0, du, mean);
      if (u_after > u) {
        precise vec3 v_t = v_r - u * g.xyz;
        precise float loss = terrains[t].friction * (u_after - u);
        precise vec3 left = after_friction(v_t, loss) + u_after * g.xyz;
        v = absolute_velocity(t, left);
      }
    }
  }
  if (g.w < 0.0) x = x - g.w * g.xyz;
}
