// Implicit Euler: whether bodies have moved so far since lists of what is near them were made that these may miss something
// in the step that is to begin: then it waits for others.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit_control.glsl"
#include "compute/implicit_state.glsl"

layout(location = LOCATION_CONTACT_COUNT) uniform uint contact_count;
layout(location = LOCATION_CONTACT_NUMBER) uniform float most;  // the square of a way [m²]

layout(std430, binding = BINDING_CONTACT_PLACES) restrict readonly buffer Places { uvec4 places[]; };

void main() {
  uint n = item_index();
  uint phase = enter();
  if (n >= contact_count || (phase != PHASE_BEGIN && phase != PHASE_IDLE)) return;
  precise vec3 way = state(places[n].w).position.xyz - uintBitsToFloat(places[n].xyz);
  if (!(dot3(way, way) <= most)) atomicMax(solve.stale, 1u);
}
