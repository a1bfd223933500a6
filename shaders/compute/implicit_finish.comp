// Implicit Euler, a step ends: x' = x + h·v', the terrain responds, divergence is looked for; then the two state buffers
// change places, unless the step diverged: then everything stays as it was when it began.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit.glsl"
#include "compute/reduction.glsl"
#include "compute/terrain.glsl"

void finish(uint i) {
  Particle start = state(i);
  precise vec3 v = solve.use_trial != 0u ? trial[i].xyz : own(OWN_BASE, i);
  precise vec3 x = start.position.xyz + time_step * v;
  respond(start, x, v);
  uint bad = divergence_word(i, x, v);
  if (bad != NO_STEP) atomicMin(solve.bad_particle, bad);
  Particle end = Particle(vec4(x, start.position.w), vec4(v, start.velocity.w));
  if (solve.parity == 0u) {
    state_b[i] = end;
  } else {
    state_a[i] = end;
  }
}

void report() {
  solve.last_newton = solve.newton;
  solve.last_cg = solve.cg_total;
  solve.last_residual = solve.residual;
  solve.last_end = solve.end;
  solve.last_ticks = solve.ticks;
  if (solve.residual > solve.worst_residual) solve.worst_residual = solve.residual;
  if (solve.end == SOLVE_CONVERGED) ++solve.converged;
  if (solve.end == SOLVE_STAGNATED) ++solve.stagnated;
  if (solve.end == SOLVE_NOT_CONVERGED) ++solve.not_converged;
  solve.newton_sum += solve.newton;
  solve.cg_sum += solve.cg_total;
}

void main() {
  if (solve.phase != PHASE_DONE) return;
  uint i = item_index();
  if (i < particle_count) finish(i);
  precise vec4 total;
  if (!reduce(vec4(0.0), total) || gl_LocalInvocationIndex != 0u) return;
  if (atomicAdd(solve.bad_particle, 0u) != NO_STEP) {
    solve.phase = PHASE_HALTED;
    return;
  }
  report();
  solve.parity = 1u - solve.parity;
  ++solve.step;
  solve.phase = solve.step == solve.target_step ? PHASE_IDLE : PHASE_BEGIN;
}
