// Implicit Euler: the contacts of a point with a body, where a step begins, and again where its first solve ended; their normal
// force is a function of the velocities at the step's end, of which k·h times the normal one is taken off.
// NVIDIA's compiler takes twice as long otherwise. Others ignore it.
#pragma optionNV(unroll none)
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit_control.glsl"
#include "compute/implicit_state.glsl"
#include "compute/terms/body_contact.glsl"

layout(location = LOCATION_CONTACT_NUMBER) uniform float body_contact_time;

layout(std430, binding = BINDING_TRIAL) restrict readonly buffer Trial { vec4 trial[]; };
layout(std430, binding = BINDING_CONTACT_TRIANGLES) restrict readonly buffer Triangles { uvec4 triangles[]; };
layout(std430, binding = BINDING_CONTACT_WORDS) restrict readonly buffer Words { uint words[]; };

bool second_solve = false;
bool at_end() { return second_solve; }
vec3 start_place(uint i) { return state(i).position.xyz; }
vec3 stage_velocity(uint i) { return trial[i].xyz; }  // v where the step begins
vec3 stage_place(uint i) {
  precise vec3 x = state(i).position.xyz;
  if (second_solve) x = x + time_step * trial[i].xyz;
  return x;
}
#include "compute/contact_points.glsl"

void main() {
  uint n = item_index();
  if (n >= contact_count || enter() != PHASE_CONTACT) return;
  second_solve = solve.again != 0u;
  find(n);
  if (records[first_record(n)].corner.w > 0u) atomicMax(solve.in_contact, 1u);
}
