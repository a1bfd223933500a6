// Force path `gather`: one invocation per particle evaluates its own springs, in ascending neighbour index, and goes
// on to the stage of the integrator and the terrain: no force is ever stored.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/bounded.glsl"
#include "compute/incident.glsl"
#include "compute/spring.glsl"
#include "compute/stage.glsl"

void main() {
  uint i = item_index();
  if (i >= particle_count || halted()) return;
  Particle p = stage_state[i];
  precise vec3 f = p.velocity.w * gravity.xyz;
  uint first = incident_start[i];
  uint end = first + bounded(incident_start[i + 1u] - first, KERNEL_GATHER);
  for (uint n = first; n < end; ++n) {
    uint word = incident[n];
    Particle other = stage_state[neighbour_of(word)];
    f += spring_force(class_of(word), p.position.xyz, p.velocity.xyz, other.position.xyz, other.velocity.xyz).xyz;
  }
  finish_stage(i, p, f);
}
