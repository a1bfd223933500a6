// Implicit Euler, a step ends: x' = x + h·v', the terrain responds, divergence is looked for; then the two state buffers
// change places, unless the step diverged: then everything stays as it was when it began. Balls come in between.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit.glsl"
#include "compute/implicit_end.glsl"
#include "compute/reduction.glsl"
#include "compute/terms/terrain.glsl"
#include "compute/terms/implicit_ground.glsl"

void finish(uint i) {
  Particle start = state(i);
  precise vec3 v = solve.use_trial != 0u ? trial[i].xyz : own(OWN_BASE, i);
  if (own4(OWN_GROUND, i).w != FREE_ALL) v = v + own(OWN_PRESCRIBED, i);  // the ground gives way by no tolerance
  precise vec3 x = start.position.xyz + time_step * v;
  if (contact_model == CONTACT_COULOMB) {
    precise float word = own4(OWN_PRESCRIBED, i).w;
    for (uint t = 0u; t < terrain_count && start.position.w != 0.0; ++t) {
      respond_solved(t, start.velocity.w, word_holds(word, t), start.position.xyz, start.velocity.xyz, x, v);
    }
  } else {
    respond(start, x, v);
  }
  uint bad = ball_count == 0u ? divergence_word(i, x, v) : NO_STEP;
  if (bad != NO_STEP) atomicMin(solve.bad_particle, bad);
  Particle end = Particle(vec4(x, start.position.w), vec4(v, start.velocity.w));
  if (parity == 0u) {
    state_b[i] = end;
  } else {
    state_a[i] = end;
  }
}

void main() {
  if (enter() != PHASE_DONE) return;
  uint i = item_index();
  if (i < particle_count) finish(i);
  precise vec4 total;
  if (!reduce(vec4(0.0), total) || gl_LocalInvocationIndex != 0u) return;
  if (ball_count == 0u) {
    end_step();
  } else {
    solve.phase = PHASE_BALLS;
  }
}
