// Friction of the contacts of a candidate group.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/terms/body_contact.glsl"

layout(std430, binding = BINDING_START_STATE) restrict readonly buffer StartState { Particle start_state[]; };
layout(std430, binding = BINDING_CONTACT_VALUES) restrict readonly buffer Values { vec4 values[]; };

// w·S of a particle in every component.
vec3 part(uint i) {
  precise float share = start_state[i].position.w * values[i].w;
  return vec3(share);
}
vec3 end_velocity(uint i) { return values[i].xyz; }

#include "compute/terms/contact_friction.glsl"

void main() {
  uint n = item_index();
  if (n >= contact_count || halted()) return;
  CandidateGroup of = candidate_groups[n];
  uint first = first_record(n), end = first + records[first].corner.w;
  for (uint r = first; r < end; ++r) {
    ContactRecord contact = records[r];
    if (contact.normal.w > 0.0) records[r].friction.xyz = friction_of(of, contact);
  }
}
