// The contacts of a point with a body where a stage evaluates its forces: the first, then second sides, each with its normal force.
// The candidates are those triangles near the point whose boxes, widened by a margin, hold it at the start of the step. The
// host sees to it that lists are short enough for thirteen walks over one.
// NVIDIA's compiler takes twice as long otherwise. Others ignore it.
#pragma optionNV(unroll none)
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/terms/body_contact.glsl"

layout(location = LOCATION_CONTACT_NUMBER) uniform float body_contact_time;

layout(std430, binding = BINDING_START_STATE) restrict readonly buffer StartState { Particle start_state[]; };
layout(std430, binding = BINDING_STAGE_STATE) restrict readonly buffer StageState { Particle stage_state[]; };
layout(std430, binding = BINDING_CONTACT_TRIANGLES) restrict readonly buffer Triangles { uvec4 triangles[]; };
layout(std430, binding = BINDING_CONTACT_WORDS) restrict readonly buffer Words { uint words[]; };

vec3 start_place(uint i) { return start_state[i].position.xyz; }
vec3 stage_place(uint i) { return stage_state[i].position.xyz; }
vec3 stage_velocity(uint i) { return stage_state[i].velocity.xyz; }
bool at_end() { return false; }
#include "compute/contact_points.glsl"

void main() {
  uint n = item_index();
  if (n < contact_count && !halted()) find(n);
}
