// Implicit Euler, the end of a complete step, by one invocation: the solve's figures, and the states change places.
void report() {
  solve.last_newton = solve.newton;
  solve.last_cg = solve.cg_total;
  solve.last_residual = solve.residual;
  solve.last_end = solve.end;
  if (solve.residual > solve.worst_residual) solve.worst_residual = solve.residual;
  if (solve.end == SOLVE_CONVERGED) ++solve.converged;
  if (solve.end == SOLVE_STAGNATED) ++solve.stagnated;
  if (solve.end == SOLVE_NOT_CONVERGED) ++solve.not_converged;
  solve.newton_sum += solve.newton;
  solve.cg_sum += solve.cg_total;
}

// A largest component passes over those that are no numbers; the sum of squares does not, though it may overflow.
bool residual_is_finite() {
  bool merit_is_number = (floatBitsToUint(solve.merit) & 0x7fffffffu) <= 0x7f800000u;
  return finite(vec3(solve.residual)) && merit_is_number;
}

// Unless the step diverged: then nothing moves any more.
void end_step() {
  if (!residual_is_finite()) atomicMin(solve.bad_particle, BAD_RESIDUAL);
  if (atomicAdd(solve.bad_particle, 0u) != NO_STEP) {
    solve.phase = PHASE_HALTED;
    return;
  }
  report();
  solve.parity = 1u - solve.parity;
  ++solve.step;
  solve.phase = solve.step == solve.target_step ? PHASE_IDLE : PHASE_BEGIN;
}
