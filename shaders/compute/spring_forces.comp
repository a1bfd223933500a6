// Force path `per-spring`, first pass: one invocation per spring writes the force on its end a.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/terms/link_force.glsl"
#define BINDING_LENGTHS BINDING_SPRING_LENGTHS
#include "compute/spring_classes.glsl"

layout(std430, binding = BINDING_STAGE_STATE) restrict readonly buffer StageState { Particle stage_state[]; };
// x: end a; y: end b and the spring class, packed as a gather word
layout(std430, binding = BINDING_SPRINGS) restrict readonly buffer Springs { uvec2 springs[]; };
layout(std430, binding = BINDING_SPRING_FORCES) restrict writeonly buffer SpringForces { vec4 spring_forces[]; };

void main() {
  uint s = item_index();
  if (s >= spring_count || halted()) return;
  count_item(s, spring_count);
  uvec2 ends = springs[s];
  Particle a = stage_state[ends.x];
  Particle b = stage_state[ends.y >> class_bits];
  use_lengths(step_index, stage_index);
  SpringClass spring = spring_class(ends.y & ((1u << class_bits) - 1u));
  spring_forces[s] = link_force(spring, a.position.xyz, a.velocity.xyz, b.position.xyz, b.velocity.xyz);
}
