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
  for (Walk w = walk(i, bounded(degree(i), KERNEL_GATHER)); w.at < w.end; ++w.at) {
    Link link = link_of(w);
    Particle other = stage_state[link.other];
    f += spring_force(link.spring, p.position.xyz, p.velocity.xyz, other.position.xyz, other.velocity.xyz).xyz;
  }
  finish_stage(i, p, f);
}
