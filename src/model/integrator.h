#pragma once
// The integrators: one row each, with all that the rest of the program knows about it. A new explicit method
// is an enumerator (aspic/settings.h) and a row here, its step matrix in integrator.cpp, and its textbook
// formula in src/cpu_reference/integrators.h. A new kind of methods is an alternative of MethodData, and its
// steps in each solver. docs/extending.md has both.
//
// Stage s of a staged method evaluates a_s = a(X_s, V_s) with X_0 = x, V_0 = v and
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
#include <type_traits>
#include <variant>

#include "aspic/settings.h"

namespace aspic {

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

/// An explicit method: its stages are data.
struct Staged {
  std::span<const Stage> stages;  ///< 1 to max_stages
  double divisor = 1.0;           ///< of the weights
  Drift drift = Drift::stage_velocity;
  /// Absent where the stages make a polynomial of hλ, from which the limit follows
  /// (analysis/amplification.h).
  ModeLimit mode_limit = nullptr;
};

/// Backward Euler, whose equation Newton's method solves with the limits of ImplicitSettings.
struct Newton {};

using MethodData = std::variant<Staged, Newton>;
/// Indices of MethodData.
enum class MethodKind : std::size_t { staged, newton };
template <MethodKind kind>
using MethodDataOf = std::variant_alternative_t<static_cast<std::size_t>(kind), MethodData>;
static_assert(std::is_same_v<MethodDataOf<MethodKind::staged>, Staged> &&
              std::is_same_v<MethodDataOf<MethodKind::newton>, Newton>);

/// What a method is like, whatever its kind.
struct MethodTraits {
  /// Whether central forces leave angular momentum alone: where each force is paired with the positions that
  /// it was computed at.
  bool keeps_angular_momentum = false;
  bool stable_at_any_step = false;
  bool reports_solves = false;  ///< Solver::solve_statistics() has figures
  bool long_steps = false;      ///< a step costs tens of force evaluations: checks and probes take fewer
  double nominal_step = 1e-3;   ///< time step that suits the default cube [s]
};

struct IntegratorRow {
  Integrator integrator;
  std::string_view name;   ///< in scene files
  std::string_view title;  ///< in images
  int order;               ///< of convergence
  StepMatrix (*step_matrix)(long double h, long double kappa, long double gamma);
  MethodData method;
  MethodTraits traits;
  std::string_view source;   ///< author and year
  std::string_view formula;  ///< of a step, for people; x', v' are its end

  constexpr MethodKind kind() const { return static_cast<MethodKind>(method.index()); }
  /// Null: the method is of another kind.
  constexpr const Staged* staged() const { return std::get_if<Staged>(&method); }
};

namespace integrator_rows {

inline constexpr std::array<Stage, 1> one_stage = {{{0.0, 1.0}}};
inline constexpr std::array<Stage, 2> midpoint = {{{0.5, 0.0}, {0.0, 1.0}}};
inline constexpr std::array<Stage, 2> one_pass = {{{1.0, 0.0}, {0.0, 1.0}}};
inline constexpr std::array<Stage, 2> verlet = {{{1.0, 1.0}, {0.0, 1.0}}};
inline constexpr std::array<Stage, 3> heun = {{{1.0 / 3, 1.0}, {2.0 / 3, 0.0}, {0.0, 3.0}}};
inline constexpr std::array<Stage, 4> kutta = {{{0.5, 1.0}, {0.5, 2.0}, {1.0, 2.0}, {0.0, 1.0}}};

/// 1 + Z + … + Zⁿ/n!, Z = h·A, n = `order` ≤ 4: the step of every method of n stages and order n.
template <int order>
StepMatrix exponential(long double h, long double kappa, long double gamma);
StepMatrix symplectic_euler(long double h, long double kappa, long double gamma);
StepMatrix implicit_euler(long double h, long double kappa, long double gamma);
StepMatrix implicit_euler_one_pass(long double h, long double kappa, long double gamma);
StepMatrix velocity_verlet(long double h, long double kappa, long double gamma);
double symplectic_euler_limit(double kappa, double gamma);
double velocity_verlet_limit(double kappa, double gamma);

}  // namespace integrator_rows

/// In the order in which lists show them.
inline constexpr std::array integrator_table = {
    IntegratorRow{Integrator::explicit_euler, "explicit-euler", "explicit Euler", 1,
                  integrator_rows::exponential<1>, Staged{integrator_rows::one_stage}, MethodTraits{},
                  "Euler, 1768", "x' = x + h·v, v' = v + h·a(x, v)"},
    IntegratorRow{
        Integrator::symplectic_euler, "symplectic-euler", "symplectic Euler", 1,
        integrator_rows::symplectic_euler,
        Staged{integrator_rows::one_stage, 1.0, Drift::new_velocity, integrator_rows::symplectic_euler_limit},
        MethodTraits{.keeps_angular_momentum = true}, "Hairer, Lubich, Wanner, 2006",
        "v' = v + h·a(x, v), x' = x + h·v'"},
    IntegratorRow{
        Integrator::midpoint, "midpoint", "midpoint", 2, integrator_rows::exponential<2>,
        Staged{integrator_rows::midpoint}, MethodTraits{}, "Runge, 1895",
        "x' = x + h·vₘ, v' = v + h·a(xₘ, vₘ), where xₘ, vₘ are half a step of explicit Euler ahead"},
    IntegratorRow{Integrator::runge_kutta_4, "runge-kutta-4", "Runge–Kutta 4", 4,
                  integrator_rows::exponential<4>, Staged{integrator_rows::kutta, 6.0}, MethodTraits{},
                  "Kutta, 1901",
                  "x' = x + h/6·(k₁ + 2k₂ + 2k₃ + k₄), v likewise; k₁ at 0, k₂ and k₃ at h/2, k₄ at h"},
    IntegratorRow{
        Integrator::implicit_euler, "implicit-euler", "implicit Euler", 1, integrator_rows::implicit_euler,
        Newton{},
        MethodTraits{
            .stable_at_any_step = true, .reports_solves = true, .long_steps = true, .nominal_step = 1.0 / 60},
        "Baraff and Witkin, 1998", "x' = x + h·v', v' = v + h·a(x', v'), solved by Newton's method"},
    IntegratorRow{Integrator::implicit_euler_one_pass, "implicit-euler-one-pass", "implicit Euler, one pass",
                  1, integrator_rows::implicit_euler_one_pass, Staged{integrator_rows::one_pass},
                  MethodTraits{}, "the 2021 assignment",
                  "x' = x + h·vₚ, v' = v + h·a(xₚ, vₚ), where xₚ, vₚ are a step of explicit Euler ahead"},
    IntegratorRow{Integrator::heun_3, "heun-3", "Heun 3", 3, integrator_rows::exponential<3>,
                  Staged{integrator_rows::heun, 4.0}, MethodTraits{}, "Heun, 1900",
                  "x' = x + h/4·(k₁ + 3k₃), v likewise; k₂ at h/3, k₃ at 2h/3"},
    IntegratorRow{
        Integrator::velocity_verlet, "velocity-verlet", "velocity Verlet", 2,
        integrator_rows::velocity_verlet,
        Staged{integrator_rows::verlet, 2.0, Drift::mean_velocity, integrator_rows::velocity_verlet_limit},
        MethodTraits{.keeps_angular_momentum = true}, "Groot and Warren, 1997",
        "x' = x + h·v + h²/2·a(x, v), v' = v + h/2·(a(x, v) + a(x', v + h·a(x, v)))"},
};

/// The row of an integrator, which must be one of the enumeration.
const IntegratorRow& row_of(Integrator integrator);

/// Largest number of stages in the table; the kernels' stage table has as many places.
inline constexpr std::size_t max_stages = 4;
static_assert(std::all_of(integrator_table.begin(), integrator_table.end(), [](const IntegratorRow& row) {
  return !row.staged() || (!row.staged()->stages.empty() && row.staged()->stages.size() <= max_stages);
}));
/// The limit of a step is found from its stages.
static_assert(std::all_of(integrator_table.begin(), integrator_table.end(), [](const IntegratorRow& row) {
  return row.staged() || row.traits.stable_at_any_step;
}));

namespace integrator_rows {

template <bool staged_only>
consteval auto list() {
  constexpr auto wanted = [](const IntegratorRow& row) { return !staged_only || row.staged(); };
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

inline constexpr std::array all_integrators = integrator_rows::list<false>();
/// The staged ones.
inline constexpr std::array explicit_integrators = integrator_rows::list<true>();

/// Force evaluations one step takes (explicit methods); 0 where they differ from step to step.
int force_evaluations_per_step(Integrator integrator);

/// x' = x + h·v + lead·h²·a under a constant acceleration a; ½ is exact.
double free_fall_lead(Integrator integrator);

/// The staged method that moves a body no spring holds: the method itself, or symplectic Euler, which
/// backward Euler of free flight is.
const IntegratorRow& free_flight_row(Integrator integrator);

}  // namespace aspic
