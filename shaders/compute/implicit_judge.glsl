// Implicit Euler: the last group judges the trial, and decides what comes next.

// Of bodies that are near each other a second solve finds where they touch at its end.
void end_solve(uint how, uint use_trial) {
  solve.end = how;
  solve.use_trial = use_trial;
  solve.phase = PHASE_DONE;
  if (solve.in_contact == 0u || solve.again != 0u) return;
  solve.in_contact = 0u;
  solve.again = 1u;
  solve.first = 3u;
  solve.first_newton = solve.newton;
  solve.without_progress = 0u;
  solve.phase = PHASE_CONTACT;
}

// Eisenstat and Walker's forcing term from the ratio of two successive square sums of residuals.
float next_forcing(float ratio) {
  precise float wanted = forcing_factor * ratio;
  if (wanted < least_forcing) return least_forcing;
  return wanted > most_forcing ? most_forcing : wanted;
}

// total: largest |residual| component, its square sum, r·z, and the square sum after a fall.
void judge(vec4 total) {
  precise float residual = total.x;
  precise float merit = total.y;
  solve.phase = PHASE_EVALUATE;
  uint ground = atomicExchange(solve.ground, 0u);
  bool held = ground > 0u;
  if (solve.first == 1u && !(residual <= tolerance) && total.w < merit) {
    solve.first = 2u;
    return;
  }
  bool on_ground = held || (solve.first == 0u && solve.on_ground != 0u);
  if (solve.first == 0u && !(merit < solve.merit) && solve.halvings <= max_halvings) {
    solve.on_ground = on_ground ? 1u : 0u;
    if (solve.halvings == max_halvings && !on_ground) {
      end_solve(SOLVE_STAGNATED, 0u);
    } else {
      ++solve.halvings;
      solve.lambda = solve.halvings > max_halvings ? 1.0 : solve.lambda * 0.5;
    }
    return;
  }
  precise float enough_progress = (on_ground ? progress_share_on_ground : progress_share) * solve.best;
  precise float forcing = first_forcing;
  if (solve.first == 0u) {
    solve.without_progress = residual < enough_progress ? 0u : solve.without_progress + 1u;
    precise float ratio = exact_div(merit, float(solve.merit));
    forcing = next_forcing(ratio);
  }
  if (solve.first != 0u || residual < solve.best) solve.best = residual;
  solve.first = 0u;
  solve.forcing = forcing;
  solve.merit = merit;
  solve.residual = residual;
  if (residual <= tolerance) {
    end_solve(SOLVE_CONVERGED, 1u);
  } else if (solve.without_progress >= (on_ground ? max_without_progress_on_ground : max_without_progress)) {
    end_solve(SOLVE_STAGNATED, 1u);
  } else if (solve.newton - solve.first_newton == max_newton) {
    end_solve(SOLVE_NOT_CONVERGED, 1u);
  } else {
    ++solve.newton;
    solve.cg = 0u;
    solve.updates = 0u;
    solve.halvings = 0u;
    solve.lambda = 1.0;
    solve.on_ground = held ? 1u : 0u;
    solve.prescribing = ground > 1u ? 1u : 0u;
    solve.rz = total.z;
    precise float enough = (forcing * forcing) * total.z;
    solve.enough = enough;
    solve.phase = PHASE_CG;
  }
}
