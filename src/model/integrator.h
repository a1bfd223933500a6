#pragma once
// The integrators: one row each, with all that the rest of the program knows about it. A new explicit method
// is an enumerator and a row here, its step matrix in integrator.cpp, and its textbook formula in
// src/cpu_reference/integrators.h; docs/extending.md has an example.
//
// Stage s evaluates a_s = a(X_s, V_s) with X_0 = x, V_0 = v and
//   V_{s+1} = v + (h·advance_s)·a_s,   X_{s+1} = x + (h·advance_s)·U_s;
// the step ends with
//   v' = v + (h/divisor)·Σ weight_s·a_s,   x' = x + (h/divisor)·Σ weight_s·V_s,
// where sums run in stage order over the stages whose weight is not zero. U_s is V_s unless `drift` says
// otherwise. Source: Butcher, Numerical Methods for Ordinary Differential Equations, 2016, §230, for methods
// whose stages each need only the one before (Kutta's third-order method, which needs two, does not fit).
#include <algorithm>
#include <array>
#include <span>
#include <string_view>

namespace aspic {

/// Time integration methods.
enum class Integrator {
  explicit_euler,
  symplectic_euler,
  midpoint,
  runge_kutta_4,
  implicit_euler,
  implicit_euler_one_pass,
  heun_3,
  velocity_verlet
};

struct Stage {
  double advance = 0.0;  ///< fraction of h from the start of the step to the next stage; unused in the last
  double weight = 0.0;   ///< small integer, exact in any precision
};

/// The velocity that moves positions.
enum class Drift {
  stage_velocity,  ///< V_s: Runge–Kutta methods
  new_velocity,    ///< x' = x + h·v': symplectic Euler
  mean_velocity    ///< U_s = (V_s + V_{s+1})/2, that is x + h·v + h²/2·a: velocity Verlet
};

/// Row by row: what one step makes of (q, q̇) of a mode q̈ = −κq − γq̇.
using StepMatrix = std::array<long double, 4>;

/// Largest stable step [s] of a mode with κ [1/s²] ≥ 0 and γ [1/s] ≥ 0, infinite where nothing limits it.
using ModeLimit = double (*)(double kappa, double gamma);

struct IntegratorRow {
  Integrator integrator;
  std::string_view name;          ///< in scene files
  std::string_view title;         ///< in pictures
  int order;                      ///< of convergence
  std::span<const Stage> stages;  ///< none: backward Euler, which is solved, not staged
  double divisor;                 ///< of the weights
  Drift drift;
  /// Whether central forces leave angular momentum alone: where each force is paired with the positions that
  /// it was computed at.
  bool keeps_angular_momentum;
  StepMatrix (*step_matrix)(long double h, long double kappa, long double gamma);
  /// Absent where the stages make a polynomial of hλ, from which the limit follows
  /// (analysis/amplification.h).
  ModeLimit mode_limit;
  std::string_view source;  ///< author and year

  constexpr bool solved() const { return stages.empty(); }
};

namespace integrator_rows {

inline constexpr std::array<Stage, 0> no_stages = {};
inline constexpr std::array<Stage, 1> one_stage = {{{0.0, 1.0}}};
inline constexpr std::array<Stage, 2> midpoint = {{{0.5, 0.0}, {0.0, 1.0}}};
inline constexpr std::array<Stage, 2> one_pass = {{{1.0, 0.0}, {0.0, 1.0}}};
inline constexpr std::array<Stage, 2> verlet = {{{1.0, 1.0}, {0.0, 1.0}}};
inline constexpr std::array<Stage, 3> heun = {{{1.0 / 3, 1.0}, {2.0 / 3, 0.0}, {0.0, 3.0}}};
inline constexpr std::array<Stage, 4> kutta = {{{0.5, 1.0}, {0.5, 2.0}, {1.0, 2.0}, {0.0, 1.0}}};

StepMatrix explicit_euler(long double h, long double kappa, long double gamma);
StepMatrix symplectic_euler(long double h, long double kappa, long double gamma);
StepMatrix midpoint_rule(long double h, long double kappa, long double gamma);
StepMatrix runge_kutta_4(long double h, long double kappa, long double gamma);
StepMatrix implicit_euler(long double h, long double kappa, long double gamma);
StepMatrix implicit_euler_one_pass(long double h, long double kappa, long double gamma);
StepMatrix heun_3(long double h, long double kappa, long double gamma);
StepMatrix velocity_verlet(long double h, long double kappa, long double gamma);
double symplectic_euler_limit(double kappa, double gamma);
double velocity_verlet_limit(double kappa, double gamma);
double no_limit(double kappa, double gamma);

}  // namespace integrator_rows

/// In the order in which lists show them.
inline constexpr std::array integrator_table = {
    IntegratorRow{Integrator::explicit_euler, "explicit-euler", "explicit Euler", 1,
                  integrator_rows::one_stage, 1.0, Drift::stage_velocity, false,
                  integrator_rows::explicit_euler, nullptr, "Euler, 1768"},
    IntegratorRow{Integrator::symplectic_euler, "symplectic-euler", "symplectic Euler", 1,
                  integrator_rows::one_stage, 1.0, Drift::new_velocity, true,
                  integrator_rows::symplectic_euler, integrator_rows::symplectic_euler_limit,
                  "Hairer, Lubich, Wanner, 2006"},
    IntegratorRow{Integrator::midpoint, "midpoint", "midpoint", 2, integrator_rows::midpoint, 1.0,
                  Drift::stage_velocity, false, integrator_rows::midpoint_rule, nullptr, "Runge, 1895"},
    IntegratorRow{Integrator::runge_kutta_4, "runge-kutta-4", "Runge–Kutta 4", 4, integrator_rows::kutta, 6.0,
                  Drift::stage_velocity, false, integrator_rows::runge_kutta_4, nullptr, "Kutta, 1901"},
    IntegratorRow{Integrator::implicit_euler, "implicit-euler", "implicit Euler", 1,
                  integrator_rows::no_stages, 1.0, Drift::new_velocity, false,
                  integrator_rows::implicit_euler, integrator_rows::no_limit, "Baraff and Witkin, 1998"},
    IntegratorRow{Integrator::implicit_euler_one_pass, "implicit-euler-one-pass", "implicit Euler, one pass",
                  1, integrator_rows::one_pass, 1.0, Drift::stage_velocity, false,
                  integrator_rows::implicit_euler_one_pass, nullptr, "the 2021 assignment"},
    IntegratorRow{Integrator::heun_3, "heun-3", "Heun 3", 3, integrator_rows::heun, 4.0,
                  Drift::stage_velocity, false, integrator_rows::heun_3, nullptr, "Heun, 1900"},
    IntegratorRow{Integrator::velocity_verlet, "velocity-verlet", "velocity Verlet", 2,
                  integrator_rows::verlet, 2.0, Drift::mean_velocity, true, integrator_rows::velocity_verlet,
                  integrator_rows::velocity_verlet_limit, "Groot and Warren, 1997"},
};

/// The row of an integrator, which must be one of the enumeration.
const IntegratorRow& row_of(Integrator integrator);

/// Largest number of stages in the table; the kernels' stage table has as many places.
inline constexpr std::size_t max_stages = 4;
static_assert(std::all_of(integrator_table.begin(), integrator_table.end(),
                          [](const IntegratorRow& row) { return row.stages.size() <= max_stages; }));

namespace integrator_rows {

template <bool solved_too>
consteval auto list() {
  constexpr auto wanted = [](const IntegratorRow& row) { return solved_too || !row.solved(); };
  constexpr std::size_t size = [&] {
    std::size_t n = 0;
    for (const IntegratorRow& row : integrator_table) n += wanted(row) ? 1 : 0;
    return n;
  }();
  std::array<Integrator, size> result{};
  std::size_t at = 0;
  for (const IntegratorRow& row : integrator_table) {
    if (wanted(row)) result[at++] = row.integrator;
  }
  return result;
}

}  // namespace integrator_rows

inline constexpr std::array all_integrators = integrator_rows::list<true>();
inline constexpr std::array explicit_integrators = integrator_rows::list<false>();

/// Name as it is written in scene files and reports.
std::string_view name_of(Integrator integrator);

/// Force evaluations one step takes (explicit methods); 0 for a solved one.
int force_evaluations_per_step(Integrator integrator);

/// x' = x + h·v + lead·h²·a under a constant acceleration a; ½ is exact.
double free_fall_lead(Integrator integrator);

/// The staged method that moves a body no spring holds: backward Euler of free flight is symplectic Euler.
const IntegratorRow& free_flight_row(Integrator integrator);

}  // namespace aspic
