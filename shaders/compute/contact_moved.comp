// Whether bodies have moved so far since lists of what is near them were made that these may miss something: then the step
// is repeated with others.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"

layout(location = LOCATION_CONTACT_COUNT) uniform uint contact_count;
layout(location = LOCATION_CONTACT_NUMBER) uniform float most;  // the square of a way [m²]

layout(std430, binding = BINDING_START_STATE) restrict readonly buffer StartState { Particle start_state[]; };
layout(std430, binding = BINDING_CONTACT_PLACES) restrict readonly buffer Places { uvec4 places[]; };

void main() {
  uint n = item_index();
  if (n >= contact_count || halted()) return;
  precise vec3 way = start_state[places[n].w].position.xyz - uintBitsToFloat(places[n].xyz);
  if (dot3(way, way) <= most) return;
  atomicMin(control.full_step, step_index);
  control.stale = 1u;
}
