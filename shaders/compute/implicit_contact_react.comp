// Implicit Euler: what the contacts of a candidate group do at the trial velocities, and their part of the matrix:
// src/physics/contact/implicit.h.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit_control.glsl"
#include "compute/terms/body_contact.glsl"

layout(std430, binding = BINDING_TRIAL) restrict readonly buffer Trial { vec4 trial[]; };

vec3 velocity(uint i) { return trial[i].xyz; }

bool react(CandidateGroup of, uint record) {
  ContactRecord contact = records[record];
  uvec4 t = contact.corner;
  precise vec3 own = over_carriers(of, velocity(of.carrier0), velocity(of.carrier1));
  precise vec3 other = over_corners(contact.share.xyz, velocity(t.x), velocity(t.y), velocity(t.z));
  precise vec3 relative = own - other;
  precise vec3 n = contact.normal.xyz;
  precise float stiffness = time_step * of.contact_damping;
  precise float u = dot3(n, relative);
  precise float normal_force = normal_force_of(of, contact.friction.w, u);
  precise vec3 slip = relative - u * n;
  precise vec3 p = contact.friction.xyz - of.contact_damping * slip;
  precise float size = norm3(p);
  precise float cone = of.contact_friction * contact.normal.w;
  precise float across = stiffness;
  precise vec3 turn = vec3(0.0);
  if (!(cone > 0.0)) {
    p = vec3(0.0);
    across = 0.0;
  } else if (size > cone) {
    precise float share = exact_div(cone, size);
    turn = exact_div(1.0, size) * p;
    p = share * p;
    across = share * stiffness;
  }
  precise vec3 force = p + normal_force * n;
  precise float along = normal_force > 0.0 ? stiffness : 0.0;
  records[record].answer = vec4(force, along);
  records[record].turn = vec4(turn, across);
  return along > 0.0 || across > 0.0;
}

void main() {
  uint n = item_index();
  uint phase = enter();
  if (n >= contact_count || (phase != PHASE_CONTACT && phase != PHASE_EVALUATE) || solve.in_contact == 0u) return;
  uint first = first_record(n), end = first + records[first].corner.w;
  CandidateGroup of = candidate_groups[n];
  bool acts = false;
  for (uint r = first; r < end; ++r) acts = react(of, r) || acts;
  if (acts) atomicMax(solve.ground, 1u);
}
