// Force path `gather`: one invocation per particle evaluates its own springs, in ascending neighbour index, and goes
// on to the stage of the integrator and the terrain: no force is ever stored.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/spring.glsl"
#include "compute/stage.glsl"

layout(std430, binding = BINDING_INCIDENT_START) restrict readonly buffer IncidentStart { uint incident_start[]; };
layout(std430, binding = BINDING_INCIDENT) restrict readonly buffer Incident { uint incident[]; };

void main() {
  uint i = item_index();
  if (i >= particle_count || halted()) return;
  Particle p = stage_state[i];
  precise vec3 f = p.velocity.w * gravity.xyz;
  uint end = incident_start[i + 1u];
  for (uint n = incident_start[i]; n < end; ++n) {
    uint word = incident[n];
    Particle neighbour = stage_state[word >> class_bits];
    SpringClass spring = spring_classes[word & ((1u << class_bits) - 1u)];
    f += spring_force(spring, p.position.xyz, p.velocity.xyz, neighbour.position.xyz, neighbour.velocity.xyz).xyz;
  }
  finish_stage(i, p, f);
}
