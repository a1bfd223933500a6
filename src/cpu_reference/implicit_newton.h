#pragma once
// The course of a step of implicit Euler: Newton's method on v' with a line search, conjugate gradients
// inside it. A System holds the particles and does the work on them; whoever holds them, what is done next
// follows from the same few numbers. The device has its own, shaders/compute/implicit_judge.glsl.
#include <cmath>

#include "model/implicit.h"

namespace aspic::reference {

/// What a trial velocity comes to.
template <class T>
struct Trial {
  T residual;  ///< largest component of |R|, R = (v' − v) − h·a, or v' − P(v + h·a) on the ground [m/s]
  T merit;     ///< Σ |R|² [m²/s²]
  T falling;   ///< Σ |R + h·g|² over what is not pinned: the merit of v' + h·g, were nothing in the way
  bool holds;  ///< whether the ground holds any particle
};

/// What ends the iterations.
template <class T>
struct SolveLimits {
  T tolerance;  ///< on the residual [m/s]
  std::uint32_t newton, cg;

  explicit SolveLimits(const ImplicitSettings& settings)
      : tolerance(static_cast<T>(
            implicit_tolerance(settings, sizeof(T) == 4 ? Precision::single : Precision::double_))),
        newton(static_cast<std::uint32_t>(settings.newton_iterations)),
        cg(static_cast<std::uint32_t>(settings.cg_iterations)) {}
};

/// Eisenstat and Walker's forcing term from the ratio of two successive square sums of residuals.
template <class T>
T next_forcing(T ratio) {
  const T wanted = static_cast<T>(forcing_factor) * ratio;
  if (wanted < static_cast<T>(least_forcing)) return static_cast<T>(least_forcing);
  return wanted > static_cast<T>(most_forcing) ? static_cast<T>(most_forcing) : wanted;
}

/// A·δ = r at the system's trial by preconditioned conjugate gradients (Hestenes and Stiefel, 1952), from the
/// prescribed part of δ on. The system offers
///   T start_solve()   δ = its prescribed part, r −= A·δ, z = B⁻¹·r, p = z; returns r·z
///   bool prescribes() whether that part is not zero
///   T apply()         q = A·p; returns p·q
///   T advance(T α, bool first)  δ += α·p, or δ = α·p if it is the first part of δ; r −= α·q, z = B⁻¹·r;
///                     returns r·z
///   void turn(T β)    p = z + β·p
///   bool interrupted()  whether the step is canceled (Solver::set_stop_flag)
template <class T, class System>
void conjugate_gradients(System& system, T forcing, std::uint32_t most, std::uint32_t& iterations) {
  T rz = system.start_solve();
  if (system.prescribes() && !(rz > T(0))) return;
  const T enough = (forcing * forcing) * rz;
  for (std::uint32_t n = 0; n < most && !system.interrupted(); ++n) {
    const T pq = system.apply();
    ++iterations;
    if (!(pq > T(0))) return;
    const T alpha = rz / pq;
    const T rz_next = system.advance(alpha, n == 0 && !system.prescribes());
    if (!(rz_next > enough)) return;
    const T beta = rz_next / rz;
    rz = rz_next;
    system.turn(beta);
  }
}

/// Newton's method from the trial `at` on. The system offers, besides what conjugate_gradients asks for,
///   Trial<T> try_step(T λ, bool onwards)  the trial becomes base + λ·δ; `onwards`: the base becomes the
///   trial
///                     before that
/// Returns whether the solution is the last trial; else it is the base.
template <class T, class System>
bool iterate(System& system, Trial<T> at, const SolveLimits<T>& limits, SolveReport& report) {
  T best = at.residual, forcing = static_cast<T>(first_forcing);
  int without_progress = 0;
  const std::uint32_t most = report.newton_iterations + limits.newton;
  bool on_ground = at.holds, accepted = true;
  report.end = SolveEnd::not_converged;
  while (true) {
    if (at.residual <= limits.tolerance) {
      report.end = SolveEnd::converged;
      break;
    }
    if (without_progress >= (on_ground ? max_without_progress_on_ground : max_without_progress)) {
      report.end = SolveEnd::stagnated;
      break;
    }
    if (report.newton_iterations == most || system.interrupted()) break;
    conjugate_gradients(system, forcing, limits.cg, report.cg_iterations);
    ++report.newton_iterations;
    // The longest of the steps δ, δ/2, δ/4, … that brings the residuals down. R bends where a particle meets
    // or leaves the ground or stops to slide, so with the ground in the equation there may be none: then δ
    // itself, for Newton's method finds its way over a larger residual.
    T lambda = 1;
    Trial<T> next = system.try_step(lambda, true);
    on_ground = at.holds || next.holds;
    int halvings = 0;
    while (!(next.merit < at.merit) && halvings < max_halvings + (on_ground ? 1 : 0)) {
      ++halvings;
      lambda = halvings > max_halvings ? T(1) : lambda / 2;
      next = system.try_step(lambda, false);
      on_ground = on_ground || next.holds;
    }
    if (!(next.merit < at.merit) &&
        halvings <= max_halvings) {  // any further iteration would only repeat this one
      report.end = SolveEnd::stagnated;
      accepted = false;
      break;
    }
    forcing = next_forcing(next.merit / at.merit);
    at = next;
    const double share = on_ground ? progress_share_on_ground : progress_share;
    without_progress = at.residual < static_cast<T>(share) * best ? 0 : without_progress + 1;
    best = at.residual < best ? at.residual : best;
  }
  // A largest component passes over those that are no numbers; the sum of squares does not.
  report.residual = static_cast<double>(std::isnan(at.merit) ? at.merit : at.residual);
  return accepted;
}

/// Solves for v' from the velocity v on. The system offers, besides what iterate() asks for,
///   Trial<T> start()  the base and the trial are v
///   Trial<T> fall()   the trial becomes v + h·g, but v of pinned particles
///   bool contacts()    whether bodies are near each other in the step
///   Trial<T> update_contacts(bool from_trial)  the trial stays, or becomes the base; contacts as found
///   there
///                     from now on
/// Returns whether the solution is the last trial; else it is the base.
template <class T, class System>
bool solve_step(System& system, const SolveLimits<T>& limits, SolveReport& report) {
  report = SolveReport{};
  Trial<T> at = system.start();
  // In free flight that is the solution: nothing is left to solve.
  if (!(at.residual <= limits.tolerance) && at.falling < at.merit) at = system.fall();
  const bool accepted = iterate(system, at, limits, report);
  if (!system.contacts() || system.interrupted()) return accepted;
  return iterate(system, system.update_contacts(accepted), limits, report);
}

}  // namespace aspic::reference
