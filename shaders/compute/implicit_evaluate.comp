// Implicit Euler: residual (v' − v) − h·a(x + h·v', v') at the trial, and all that a linear system there needs:
// right-hand side, inverse diagonal blocks, first search direction. The last group judges the trial.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit.glsl"
#include "compute/incident.glsl"
#include "compute/implicit_spring.glsl"
#include "compute/implicit_block.glsl"
#include "compute/reduction.glsl"

// Returns largest |residual| component, its square sum, r·z, and 0.
vec4 evaluate(uint i) {
  Particle p = state(i);
  precise vec3 v = trial[i].xyz;
  precise vec3 f = p.velocity.w * gravity.xyz;
  DiagonalBlock block = block_of_mass(p.velocity.w);
  uint first = incident_start[i];
  uint end = first + bounded(incident_start[i + 1u] - first, KERNEL_IMPLICIT_EVALUATE);
  for (uint n = first; n < end; ++n) {
    uint word = incident[n], j = neighbour_of(word);
    precise vec3 dv = v - trial[j].xyz;
    precise vec3 e = (p.position.xyz - state(j).position.xyz) + time_step * dv;
    SpringJacobian H;
    f += linearised(class_of(word), e, dv, H);
    block = with_spring(block, H);
  }
  if (i == pull.particle) {
    SpringJacobian H;
    f += linearised_pull(p.position.xyz, v, H);
    block = with_spring(block, H);
  }
  DiagonalBlock inverted = inverse_of(block);
  precise vec3 r = vec3(0.0);
  precise vec3 R = vec3(0.0);
  if (p.position.w != 0.0) {
    precise vec3 all_forces = f + own(OWN_HELD, i);
    precise vec3 change = v - p.velocity.xyz;
    r = time_step * all_forces - p.velocity.w * change;
    R = change - time_step * (p.position.w * all_forces);
  }
  precise vec3 z = times(inverted, r);
  set_own(OWN_RESIDUAL, i, r);
  set_own(OWN_Z, i, z);
  set_own(OWN_INVERSE_A, i, inverted.diagonal);
  set_own(OWN_INVERSE_B, i, inverted.mixed);
  search[i] = vec4(z, 0.0);
  precise float xy = abs(R.y) > abs(R.x) ? abs(R.y) : abs(R.x);
  return vec4(abs(R.z) > xy ? abs(R.z) : xy, dot3(R, R), dot3(r, z), 0.0);
}

void end_solve(uint how, uint use_trial) {
  solve.end = how;
  solve.use_trial = use_trial;
  solve.phase = PHASE_DONE;
}

// Eisenstat and Walker's forcing term from the ratio of two successive square sums of residuals.
float next_forcing(float ratio) {
  precise float wanted = forcing_factor * ratio;
  if (wanted < least_forcing) return least_forcing;
  return wanted > most_forcing ? most_forcing : wanted;
}

void judge(float residual, float merit, float rz) {
  if (solve.first == 0u && !(merit < solve.merit)) {
    if (solve.halvings == max_halvings) {
      end_solve(SOLVE_STAGNATED, 0u);
    } else {
      ++solve.halvings;
      solve.lambda = solve.lambda * 0.5;
    }
    return;
  }
  precise float enough_progress = progress_share * solve.best;
  precise float forcing = first_forcing;
  if (solve.first == 0u) {
    solve.without_progress = residual < enough_progress ? 0u : solve.without_progress + 1u;
    precise float ratio = exact_div(merit, solve.merit);
    forcing = next_forcing(ratio);
  }
  if (solve.first != 0u || residual < solve.best) solve.best = residual;
  solve.first = 0u;
  solve.forcing = forcing;
  solve.merit = merit;
  solve.residual = residual;
  if (residual <= tolerance) {
    end_solve(SOLVE_CONVERGED, 1u);
  } else if (solve.without_progress == max_without_progress) {
    end_solve(SOLVE_STAGNATED, 1u);
  } else if (solve.newton == max_newton) {
    end_solve(SOLVE_NOT_CONVERGED, 1u);
  } else {
    ++solve.newton;
    solve.cg = 0u;
    solve.updates = 0u;
    solve.halvings = 0u;
    solve.lambda = 1.0;
    solve.rz = rz;
    precise float enough = (forcing * forcing) * rz;
    solve.enough = enough;
    solve.phase = PHASE_CG;
  }
}

void main() {
  uint phase = solve.phase;
  uint i = item_index();
  if (i == 0u && (phase == PHASE_EVALUATE || phase == PHASE_CG)) ++solve.ticks;
  if (phase != PHASE_EVALUATE) return;
  precise vec4 element = vec4(0.0);
  if (i < particle_count) element = evaluate(i);
  precise vec4 total;
  if (reduce(element, total) && gl_LocalInvocationIndex == 0u) judge(total.x, total.y, total.z);
}
