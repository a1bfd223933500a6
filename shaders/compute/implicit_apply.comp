// Implicit Euler, conjugate gradients: A·p with A = m − h·∂f/∂v' at the trial, spring by spring, and p·A·p. On the ground
// that is the part of it which the ground leaves free, with friction's resistance to turning.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit.glsl"
#include "compute/incident.glsl"
#include "compute/terms/implicit_springs.glsl"
#include "compute/reduction.glsl"

vec3 direction(uint j) { return prescribing ? own(OWN_PRESCRIBED, j) : search[j].xyz; }

// Returns 0, p·A·p, 0, 0.
vec4 apply(uint i) {
  Particle particle = state(i);
  precise vec3 p = direction(i);
  precise vec3 v = trial[i].xyz;
  precise vec3 product = implicit_mass(particle.velocity.w, v) * p;
  Walk w = walk(i);
  for (w.end = bounded(w.end, KERNEL_IMPLICIT_APPLY); w.at < w.end; ++w.at) {
    Link link;
    if (!link_at(w, link)) continue;
    precise vec3 dv = v - trial[link.other].xyz;
    precise vec3 e = (particle.position.xyz - state(link.other).position.xyz) + time_step * dv;
    SpringJacobian H;
    linearized(link.spring, e, dv, H);
    precise vec3 d = p - direction(link.other);
    product += times(H, d);
  }
  for (uint k = 0u; k < pull_count; ++k) {
    if (i != pulls[k].particle) continue;
    SpringJacobian H;
    linearized(pulls[k], particle.position.xyz, v, H);
    product += times(H, p);
  }
#ifdef ASPIC_BODY_CONTACT
  if (solve.in_contact != 0u) product += contact_of(CONTACT_PRODUCT, i);
#endif
  precise vec4 ground = own4(OWN_GROUND, i);
  if (ground.w == FREE_PLANE) product += turning(own4(OWN_ACROSS, i), p);
  product = free_part(ground, product);
  if (particle.position.w == 0.0) product = vec3(0.0);
  set_own(OWN_PRODUCT, i, product);
  return vec4(0.0, dot3(p, product), 0.0, 0.0);
}

void main() {
  if (enter() != PHASE_CG) return;
  uint i = item_index();
  precise vec4 element = vec4(0.0);
  use_lengths(ended_steps, LENGTHS_AT_END);
  if (i < particle_count) element = apply(i);
  precise vec4 total;
  if (!reduce(element, total) || gl_LocalInvocationIndex != 0u) return;
  if (prescribing) return;
  ++solve.cg;
  ++solve.cg_total;
  if (total.y > 0.0) {
    precise float alpha = exact_div(float(solve.rz), total.y);
    solve.alpha = alpha;
  } else {
    solve.phase = PHASE_EVALUATE;
  }
}
