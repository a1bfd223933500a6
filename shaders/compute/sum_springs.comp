// Force path `per-spring`, second pass: one invocation per particle sums the forces of its springs in ascending
// neighbor index, then continues with the stage of the integrator and the terrain.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/bounded.glsl"
#include "compute/incident.glsl"
#include "compute/stage.glsl"

layout(std430, binding = BINDING_SPRING_FORCES) restrict readonly buffer SpringForces { vec4 spring_forces[]; };

void main() {
  uint i = item_index();
  if (i >= particle_count || halted()) return;
  Particle p = stage_state[i];
  precise vec3 f = body_force(p.velocity.w, p.velocity.xyz);
  Walk w = walk_words(i);
  for (w.end = bounded(w.end, KERNEL_SUM_SPRINGS); w.at < w.end; ++w.at) {
    uint word = word_at(w);  // spring << 1 | 1 at its end b
    if (word == NO_SPRING) continue;
    precise vec3 on_a = spring_forces[word >> 1u].xyz;
    f += (word & 1u) == 0u ? on_a : -on_a;
  }
  finish_stage(i, p, f);
}
