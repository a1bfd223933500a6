// Force path `gather`: one invocation per particle evaluates its own springs, in ascending neighbor index, and goes
// on to the stage of the integrator and the terrain: no force is ever stored. With ASPIC_LATTICES it does so for the
// particles outside lattices alone.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/bounded.glsl"
#include "compute/incident.glsl"
#include "compute/terms/link_force.glsl"
#include "compute/stage.glsl"
#include "compute/neighbor.glsl"

void main() {
  uint place = item_index();
#ifdef ASPIC_LATTICES
  if (place >= listed_count || halted()) return;
  uint i = listed_particle(place);
#else
  if (place >= particle_count || halted()) return;
  uint i = place;
#endif
  use_lengths(step_index, stage_index);
  Particle p = stage_state[i];
  precise vec3 f = body_force(p.velocity.w, p.velocity.xyz);
  Walk w = walk_words(place);
  for (w.end = bounded(w.end, KERNEL_GATHER); w.at < w.end; ++w.at) {
    Link link;
    if (!listed_link_at(w, link)) continue;
    precise vec3 x, v;
    read_neighbor(link.other, x, v);
    f += link_force(link.spring, p.position.xyz, p.velocity.xyz, x, v).xyz;
  }
  finish_stage(i, p, f);
}
