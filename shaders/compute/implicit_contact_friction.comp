// Implicit Euler: the friction that contacts of a candidate group begin with.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit_control.glsl"
#include "compute/terms/body_contact.glsl"

layout(std430, binding = BINDING_SEARCH) restrict readonly buffer Search { vec4 search[]; };

vec3 part(uint i) { return vec3(search[i].w); }
vec3 end_velocity(uint i) { return search[i].xyz; }
#include "compute/terms/contact_friction.glsl"

void main() {
  uint n = item_index();
  if (n >= contact_count || enter() != PHASE_CONTACT) return;
  CandidateGroup of = candidate_groups[n];
  uint first = first_record(n), end = first + records[first].corner.w;
  for (uint r = first; r < end; ++r) {
    ContactRecord contact = records[r];
    if (contact.normal.w > 0.0) records[r].friction.xyz = friction_of(of, contact);
  }
}
