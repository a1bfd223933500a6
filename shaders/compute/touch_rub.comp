// Friction of the contacts of an encounter: the impulse that ends the slip of v₁, or as much of it as the cone allows.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/touch.glsl"

layout(location = LOCATION_TOUCH_NUMBER) uniform float friction;  // μ

layout(std430, binding = BINDING_START_STATE) restrict readonly buffer StartState { Particle start_state[]; };
layout(std430, binding = BINDING_TOUCH_VALUES) restrict readonly buffer Values { vec4 values[]; };

// w·S of a particle in every component.
vec3 part(uint i) {
  precise float share = start_state[i].position.w * values[i].w;
  return vec3(share);
}
vec3 end_velocity(uint i) { return values[i].xyz; }

vec3 friction_of(TouchEncounter of, TouchRecord contact) {
  uvec4 t = contact.corner;
  precise float push = contact.normal.w;
  precise vec3 own = over_carriers(of, part(of.carrier0), part(of.carrier1));
  precise vec3 other = over_corners(contact.share.xyz, part(t.x), part(t.y), part(t.z));
  precise float both = own.x + other.x;
  precise float W = exact_div(both, push);
  if (!(W > 0.0)) return vec3(0.0);
  precise vec3 own_v = over_carriers(of, end_velocity(of.carrier0), end_velocity(of.carrier1));
  precise vec3 other_v = over_corners(contact.share.xyz, end_velocity(t.x), end_velocity(t.y), end_velocity(t.z));
  precise vec3 relative = own_v - other_v;
  precise vec3 n = contact.normal.xyz;
  precise vec3 slip = relative - dot3(n, relative) * n;
  precise vec3 J = exact_div(1.0, W) * slip;
  precise float size = norm3(J), cone = friction * (time_step * push);
  if (size > cone) J = exact_div(cone, size) * J;
  precise vec3 rub = exact_div(1.0, time_step) * -J;
  return rub;
}

void main() {
  uint n = item_index();
  if (n >= touch_count || halted()) return;
  uint first = first_record(n), end = first + records[first].corner.w;
  for (uint r = first; r < end; ++r)
    if (records[r].normal.w > 0.0) records[r].rub.xyz = friction_of(encounters[n], records[r]);
}
