// Implicit Euler, the end of a round: within a linear system the next search direction p = z + β·p; after one, or after a
// trial was refused, the next trial v' = base + λ·δ. The accepted trial has become the base by then. A step's second
// trial may be v + h·g.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit.glsl"

void main() {
  uint i = item_index();
  if (i >= particle_count) return;
  uint phase = enter();
  // No reduction tells whether this kernel was carried out; the next round looks at the count.
  bool works = phase == PHASE_CG || phase == PHASE_EVALUATE || phase == PHASE_CONTACT;
  if (works && is_counted(i, particle_count)) atomicAdd(solve.moved, 1u);
  if (phase == PHASE_CG) {
    precise vec3 p = own(OWN_Z, i);
    if (!prescribing) p = p + solve.beta * search[i].xyz;
    search[i] = vec4(p, 0.0);
  } else if (phase == PHASE_EVALUATE) {
    precise vec3 base = solve.halvings == 0u ? trial[i].xyz : own(OWN_BASE, i);
    precise vec3 delta = solve.updates == 0u ? vec3(0.0) : own(OWN_DELTA, i);
    precise vec3 next = base + solve.lambda * delta;
    if (solve.first == 2u) {
      Particle start = state(i);
      next = start.position.w == 0.0 ? base : start.velocity.xyz + time_step * gravity.xyz;
    }
    set_own(OWN_BASE, i, base);
    trial[i] = vec4(next, 0.0);
  } else if (phase == PHASE_CONTACT) {
    if (solve.use_trial == 0u) trial[i] = vec4(own(OWN_BASE, i), 0.0);
  }
}
