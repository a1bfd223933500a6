// Implicit Euler, a step begins: the first trial is v itself, and the course model's contact force at (x, v) is
// evaluated once and held.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit.glsl"
#include "compute/incident.glsl"
#include "compute/terms/pulls.glsl"
#include "compute/reduction.glsl"
#include "compute/terms/springs.glsl"
#include "compute/terms/terrain.glsl"

#ifdef ASPIC_BODY_CONTACT
layout(location = LOCATION_CONTACT_COUNT) uniform uint contact_count;  // candidate groups
#endif

// Gravity, springs and pulls.
vec3 force(uint i, Particle p) {
  precise vec3 f = body_force(p.velocity.w, p.velocity.xyz);
  Walk w = walk(i);
  for (w.end = bounded(w.end, KERNEL_IMPLICIT_BEGIN); w.at < w.end; ++w.at) {
    Link link;
    if (!link_at(w, link)) continue;
    Particle other = state(link.other);
    f += spring_force(link.spring, p.position.xyz, p.velocity.xyz, other.position.xyz, other.velocity.xyz).xyz;
  }
  f = with_pulls(i, p.position.xyz, p.velocity.xyz, f);
  return f;
}

vec3 held_contact_force(uint i, Particle p) {
  if (contact_model == CONTACT_COULOMB || p.position.w == 0.0) return vec3(0.0);
  precise vec3 f = force(i, p);
  precise vec3 held = with_contact_force(p.position.xyz, p.velocity.xyz, f) - f;
  return held;
}

void main() {
  uint phase = enter();
  // The host may have set a new target since the last one was reached.
  if (phase != PHASE_BEGIN && !(phase == PHASE_IDLE && ended_steps != solve.target_step)) return;
#ifdef ASPIC_BODY_CONTACT
  if (solve.stale != 0u) return;
#endif
  uint i = item_index();
  if (i < particle_count) {
    use_lengths(ended_steps, LENGTHS_AT_START);
    Particle p = state(i);
    set_own(OWN_HELD, i, held_contact_force(i, p));
    trial[i] = vec4(p.velocity.xyz, 0.0);
#ifdef ASPIC_BODY_CONTACT
    if (contact_count > 0u) keep_start(i, p, force(i, p));
#endif
  }
  precise vec4 total;
  if (!reduce(vec4(0.0), total) || gl_LocalInvocationIndex != 0u) return;
  solve.newton = 0u;
  solve.first_newton = 0u;
  solve.cg_total = 0u;
  solve.without_progress = 0u;
  solve.halvings = 0u;
  solve.ticks = 0u;
  solve.moved = 0u;
  solve.lambda = 1.0;
  solve.first = 1u;
  solve.phase = PHASE_EVALUATE;
#ifdef ASPIC_BODY_CONTACT
  solve.in_contact = 0u;
  solve.again = 0u;
  if (contact_count > 0u) solve.phase = PHASE_CONTACT;
#endif
}
