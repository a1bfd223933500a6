// Implicit Euler: the friction that contacts of an encounter begin with.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit_control.glsl"
#include "compute/touch.glsl"

layout(std430, binding = BINDING_SEARCH) restrict readonly buffer Search { vec4 search[]; };

vec3 part(uint i) { return vec3(search[i].w); }
vec3 end_velocity(uint i) { return search[i].xyz; }
#include "compute/touch_friction.glsl"

void main() {
  uint n = item_index();
  if (n >= touch_count || enter() != PHASE_TOUCH) return;
  TouchEncounter of = encounters[n];
  uint first = first_record(n), end = first + records[first].corner.w;
  for (uint r = first; r < end; ++r) {
    TouchRecord contact = records[r];
    if (contact.normal.w > 0.0) records[r].rub.xyz = friction_of(of, contact);
  }
}
