#include "analysis/stability.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <utility>
#include <vector>

#include "analysis/amplification.h"
#include "analysis/contact_facts.h"
#include "analysis/spectrum.h"
#include "model/springs.h"
#include "physics/body_force.h"

namespace aspic {
namespace {

struct Effort {
  double tolerance;  // of Lanczos' residual, relative
  int iterations;
  std::size_t dense_dof;
  std::uint64_t evaluations;  // of springs, in all
};
constexpr Effort quick = {1e-4, 250, 81, 40000000};
constexpr Effort thorough = {1e-7, 1000, 600, 400000000};

/// Work of one mode's limit: a scan of 800 points, in spring evaluations.
constexpr std::uint64_t work_of_mode = 500;

/// A body with what several integrators ask of it, computed once. Also what several bodies that must do
/// without a closer look have in common.
class BodyAnalysis {
 public:
  /// `damping` γ [1/s] adds to that of every mode.
  BodyAnalysis(LinearizedBody body, double damping, const Effort& effort, WorkBudget& work)
      : body_(std::move(body)), damping_(damping), effort_(effort), work_(work) {}

  const LinearizedBody& body() const { return body_; }
  double damping() const { return damping_; }
  WorkBudget& work() { return work_; }
  /// Whether all eigenvalues can be afforded: about 10·(2n)³ operations, twenty of which make a spring
  /// evaluation.
  bool small() const {
    const std::uint64_t dof = body_.free_dof();
    return dof <= effort_.dense_dof && body_.springs_kept() && 4 * dof * dof * dof <= work_.left();
  }
  LargestEigenvalue largest(double stiffness_factor, double damping_factor) const {
    return body_.largest_eigenvalue(stiffness_factor, damping_factor, effort_.tolerance, effort_.iterations,
                                    work_);
  }
  const LargestEigenvalue& kappa_max() {
    if (!kappa_) kappa_ = largest(1.0, 0.0);
    return *kappa_;
  }
  const LargestEigenvalue& gamma_max() {
    if (!gamma_) gamma_ = largest(0.0, 1.0);
    return *gamma_;
  }
  const std::vector<std::complex<double>>& eigenvalues() {
    const std::uint64_t dof = body_.free_dof();
    if (!eigenvalues_) {
      eigenvalues_ = body_.eigenvalues();
      work_.spend(4 * dof * dof * dof);
    }
    return *eigenvalues_;
  }

 private:
  LinearizedBody body_;
  double damping_;
  Effort effort_;
  WorkBudget& work_;
  std::optional<LargestEigenvalue> kappa_, gamma_;
  std::optional<std::vector<std::complex<double>>> eigenvalues_;
};

/// none (nothing) is smaller than any step.
StabilityLimit smaller(const StabilityLimit& a, const StabilityLimit& b) {
  if (!a.step || !b.step)
    return {std::nullopt, !a.step && !b.step ? a.exact || b.exact : (a.step ? b.exact : a.exact)};
  return *b.step < *a.step ? b : a;
}

StabilityLimit of_mode(Integrator integrator, double kappa, double gamma) {
  return {mode_limit(integrator, kappa, gamma), true};
}

/// Calls f(share) for shares of (0, 1]: logarithmically down to 1e-6, where every method's limit has long
/// left what the largest eigenvalue sets, and densely near 1.
template <class F>
void scan_unit_interval(int steps, const F& f) {
  for (int i = 0; i <= steps; ++i) f(std::pow(10.0, -6.0 * i / steps));
  for (int i = 1; i < steps; ++i) f(static_cast<double>(i) / steps);
}

StabilityLimit proportional_limit(BodyAnalysis& analysis, Integrator integrator) {
  const LinearizedBody& body = analysis.body();
  const bool by_damping = body.smallest_ratio() == infinity;  // k = 0 everywhere
  const LargestEigenvalue top = by_damping ? analysis.gamma_max() : analysis.kappa_max();
  const auto at = [&](double share) {
    const double value = share * top.value;
    return by_damping ? of_mode(integrator, 0.0, value + analysis.damping())
                      : of_mode(integrator, value, body.smallest_ratio() * value + analysis.damping());
  };
  const StabilityLimit end = at(1.0);
  StabilityLimit least = smaller(end, of_mode(integrator, 0.0, analysis.damping()));
  scan_unit_interval(300, [&](double share) { least = smaller(least, at(share)); });
  analysis.work().spend(600 * work_of_mode);
  // The interval holds all eigenvalues, but not each of its points is one: only its upper end is sure to be.
  const bool at_end =
      end.step && least.step ? *end.step <= *least.step * (1.0 + 1e-9) : end.step == least.step;
  return {least.step, at_end && top.converged};
}

/// λ_max(h²K + 2hC) = 4: for larger h the step matrix has an eigenvalue below −1, for smaller h none outside
/// the unit circle (docs/physics.md).
StabilityLimit symplectic_limit(BodyAnalysis& analysis) {
  bool converged = true;
  const auto excess = [&](double h) {
    const LargestEigenvalue top = analysis.largest(h * h, 2.0 * h);
    converged = converged && top.converged;
    return top.value + 2.0 * h * analysis.damping() - 4.0;
  };
  const double kappa = analysis.kappa_max().value;
  const double gamma = analysis.gamma_max().value + analysis.damping();
  double low =
      *mode_limit(Integrator::symplectic_euler, kappa, gamma);  // both extremes at once: never too large
  double high = std::min(*mode_limit(Integrator::symplectic_euler, kappa, 0.0),
                         *mode_limit(Integrator::symplectic_euler, 0.0, gamma));
  double f_low = excess(low), f_high = excess(high);
  const auto narrow = [&](double h) {
    const double f = excess(h);
    (f > 0.0 ? high : low) = h;
    (f > 0.0 ? f_high : f_low) = f;
  };
  for (int i = 0; i < 12 && high - low > 1e-7 * low && f_low < 0.0 && f_high > 0.0; ++i) {
    // The function is convex, so the secant never passes the root from below; the middle tames the upper end.
    const double secant = low - f_low * (high - low) / (f_high - f_low);
    narrow(secant);
    const double middle = low + std::min(0.5 * (high - low), 2.0 * std::abs(secant - low) + 1e-7 * low);
    narrow(middle);
  }
  return {low, converged};
}

StabilityLimit dense_limit(BodyAnalysis& analysis, Integrator integrator) {
  const std::vector<std::complex<double>>& eigenvalues = analysis.eigenvalues();
  double largest = 0.0;
  for (const auto& lambda : eigenvalues) largest = std::max(largest, std::abs(lambda));
  StabilityLimit limit = {infinity, true};
  for (const auto& lambda : eigenvalues) {
    // Rigid motions have λ = 0 twice, a defective pair that rounding spreads by about √ε of the largest.
    if (std::abs(lambda) < 1e-6 * largest) continue;
    // No mode gains energy: a positive real part of rounding's size is an undamped mode.
    const double real = lambda.real() > -1e-11 * largest ? 0.0 : lambda.real();
    limit = smaller(limit, {eigenvalue_limit(integrator, {real, lambda.imag()}), true});
  }
  return limit;
}

/// Bounds on all (κ, γ) of a body: largest values, and ratios γ/κ [s].
struct ModeBounds {
  double kappa_max, gamma_max, smallest_ratio, largest_ratio, damping;
};

/// The minimum over every (κ, γ) with κ ≤ κ_max, γ ≤ γ_max and γ/κ between the springs' own ratios: for an
/// eigenvector u these are u*Ku and u*Cu, sums over springs whose terms each keep the spring's ratio.
StabilityLimit bounded_limit(const ModeBounds& body, WorkBudget& work, Integrator integrator) {
  StabilityLimit least = {infinity, false};
  // Without stiffness there is no ratio to it: κ = 0 represents every γ.
  const auto gamma_of = [&](double ratio, double kappa) {
    return kappa > 0.0 ? std::min(ratio * kappa, body.gamma_max) : 0.0;
  };
  const auto visit = [&](double kappa) {
    const double from = gamma_of(body.smallest_ratio, kappa), to = gamma_of(body.largest_ratio, kappa);
    constexpr int steps = 40;
    for (int i = 0; i <= steps; ++i) {
      least = smaller(least, of_mode(integrator, kappa, body.damping + (from + (to - from) * i / steps)));
    }
  };
  scan_unit_interval(60, [&](double share) { visit(share * body.kappa_max); });
  work.spend(std::uint64_t{120} * 41 * work_of_mode);
  least = smaller(least, of_mode(integrator, 0.0, body.gamma_max + body.damping));
  least.exact = false;
  return least;
}

ModeBounds bounds_of(BodyAnalysis& analysis) {
  const LinearizedBody& body = analysis.body();
  return {analysis.kappa_max().value, analysis.gamma_max().value, body.smallest_ratio(), body.largest_ratio(),
          analysis.damping()};
}

StabilityLimit body_limit(BodyAnalysis& analysis, Integrator integrator) {
  const LinearizedBody& body = analysis.body();
  const IntegratorRow& row = row_of(integrator);
  if (row.traits.stable_at_any_step) return {infinity, true};
  if (!body.has_springs()) return of_mode(integrator, 0.0, analysis.damping());
  if (!std::isfinite(body.eigenvalue_bound(1.0, 0.0)) || !std::isfinite(body.eigenvalue_bound(0.0, 1.0)))
    return {0.0, false};
  if (body.proportional()) return proportional_limit(analysis, integrator);
  if (integrator == Integrator::symplectic_euler) return symplectic_limit(analysis);
  if (analysis.small() && analysis.damping() == 0.0 && !row.staged()->mode_limit)
    return dense_limit(analysis, integrator);
  return bounded_limit(bounds_of(analysis), analysis.work(), integrator);
}

/// The limit where actuators have made rest lengths r as short as they do and the body is still as it was at
/// rest: a spring of length L then also resists motion across it, with the stiffness k(1 − r/L). That adds at
/// most the share 1 − r/L of the springs' Gershgorin bound to κ_max, and no limit falls by more than κ_max
/// grows.
StabilityLimit at_shortest(BodyAnalysis& analysis, StabilityLimit limit) {
  const double shortening = analysis.body().shortening();
  if (!(shortening > 0.0) || !limit.step || !std::isfinite(*limit.step)) return limit;
  const double kappa = analysis.kappa_max().value,
               more = shortening * analysis.body().eigenvalue_bound(1.0, 0.0);
  if (kappa > 0.0) *limit.step *= kappa / (kappa + more);
  return {limit.step, false};
}

/// The model's bodies as runs of particles; one run of all particles if some are outside any body.
std::vector<std::pair<std::uint32_t, std::uint32_t>> runs_of(const Model& model) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> runs;
  std::uint32_t covered = 0;
  for (const Body& body : model.bodies) {
    covered += body.particle_count;
    runs.emplace_back(body.first_particle, body.particle_count);
  }
  if (covered != model.particle_count()) runs = {{0, model.particle_count()}};
  return runs;
}

/// What contact adds to a body's largest κ [1/s²] and γ [1/s].
struct Added {
  double kappa = 0.0, gamma = 0.0;
  void raise(const Added& other) {
    kappa = std::max(kappa, other.kappa);
    gamma = std::max(gamma, other.gamma);
  }
  friend bool operator==(const Added&, const Added&) = default;
};

/// By the first particle of each body that may touch another, or itself.
std::map<std::uint32_t, Added> added_by_contact(const Model& model, Meeting meeting) {
  const double share = meeting == Meeting::edges ? 12.0 : 4.0;
  const ContactFacts facts = contact_facts(model);
  std::map<std::uint32_t, Added> added;
  for (const ContactPairing& pairing : facts.pairings)
    for (const std::size_t kind : {pairing.a, pairing.b})
      for (const std::uint32_t b : facts.kinds[kind].bodies) {
        const double w = share / facts.kinds[kind].body.mass;
        added[model.bodies[b].first_particle].raise({w * pairing.pair.stiffness, w * pairing.pair.damping});
      }
  return added;
}

/// Whether two bodies have the same springs and particles, so that one of them says all of both.
bool same_springs(const Model& model, const Body& a, const Body& b) {
  const auto same_class = [](const SpringClass& p, const SpringClass& q) {
    return p.stiffness == q.stiffness && p.damping == q.damping && p.rest_length == q.rest_length;
  };
  if (!a.box() || !b.box() || a.lattice != b.lattice || a.class_count != b.class_count) return false;
  for (std::uint32_t c = 0; c < a.class_count; ++c)
    if (!same_class(model.spring_classes[a.first_class + c], model.spring_classes[b.first_class + c]))
      return false;
  for (std::uint32_t i = 0; i < a.particle_count; ++i)
    if (model.inverse_mass[a.first_particle + i] != model.inverse_mass[b.first_particle + i]) return false;
  return true;
}

StabilityLimit contact_limit(BodyAnalysis& analysis, const Added& added, Integrator integrator) {
  const StabilityLimit free = body_limit(analysis, integrator);
  if (!(added.kappa > 0.0) || row_of(integrator).traits.stable_at_any_step || !free.step || *free.step == 0.0)
    return free;
  ModeBounds bounds = bounds_of(analysis);
  const double ratio = added.gamma / added.kappa;
  bounds.kappa_max += added.kappa;
  bounds.gamma_max += added.gamma;
  bounds.smallest_ratio = std::min(bounds.smallest_ratio, ratio);
  bounds.largest_ratio = std::max(bounds.largest_ratio, ratio);
  return smaller(free, bounded_limit(bounds, analysis.work(), integrator));
}

/// Of each integrator the least `limit` of all bodies, `added` to those that may touch.
template <class Limit>
std::vector<StabilityLimit> limits_of_bodies(const Model& model, std::span<const Integrator> integrators,
                                             StabilityEffort effort, const StabilityWatch& watch,
                                             const std::map<std::uint32_t, Added>& added,
                                             const Limit& limit) {
  std::vector<StabilityLimit> limits(integrators.size(), StabilityLimit{infinity, true});
  const Effort& means = effort == StabilityEffort::quick ? quick : thorough;
  WorkBudget work(means.evaluations, watch);
  LinearizedBody rest;
  Added rest_added;
  std::vector<std::pair<const Body*, Added>> looked_at;
  const auto take = [&](LinearizedBody body, const Added& with) {
    BodyAnalysis analysis(std::move(body), physics::BodyForce<double>(model).damping(), means, work);
    for (std::size_t i = 0; i < integrators.size(); ++i)
      limits[i] = smaller(limits[i], limit(analysis, with, integrators[i]));
  };
  for (const auto& [first, count] : runs_of(model)) {
    const Added with = added.contains(first) ? added.at(first) : Added();
    const auto body = std::ranges::find(model.bodies, first, &Body::first_particle);
    const auto known = [&](const std::pair<const Body*, Added>& other) {
      return other.second == with && same_springs(model, *other.first, *body);
    };
    if (!added.empty() && body != model.bodies.end()) {
      if (std::ranges::any_of(looked_at, known)) continue;
      looked_at.emplace_back(&*body, with);
    }
    LinearizedBody light(model, first, count, false);
    // Fewer iterations than twenty would say little, and they take memory.
    if (!work.spent() && 20 * light.spring_count() <= work.left()) {
      take(LinearizedBody(model, first, count), with);
    } else {
      rest.join(light);
      rest_added.raise(with);
    }
  }
  if (rest.has_springs()) take(std::move(rest), rest_added);
  return limits;
}

}  // namespace

std::vector<StabilityLimit> contact_limits(const Model& model, std::span<const Integrator> integrators,
                                           Meeting meeting, StabilityEffort effort,
                                           const StabilityWatch& watch) {
  return limits_of_bodies(model, integrators, effort, watch, added_by_contact(model, meeting), contact_limit);
}

std::vector<StabilityLimit> stability_limits(const Model& model, std::span<const Integrator> integrators,
                                             StabilityEffort effort, const StabilityWatch& watch) {
  return limits_of_bodies(model, integrators, effort, watch, {},
                          [](BodyAnalysis& analysis, const Added&, Integrator integrator) {
                            return at_shortest(analysis, body_limit(analysis, integrator));
                          });
}

/// Different kinds of bodies that are looked at in no time; more of them are left to stability_limit.
constexpr int most_looks = 50;

bool certainly_stable(const Model& model, Integrator integrator, double timestep) {
  if (row_of(integrator).traits.stable_at_any_step) return true;
  if (!model.actuation.empty()) return false;
  const double gamma = physics::BodyForce<double>(model).damping();
  std::uint32_t covered = 0;
  double known_kappa = 0.0, known_ratio = 0.0;  // of the body before: cubes are often alike
  StabilityLimit least;
  int looks = 0;
  for (const Body& body : model.bodies) {
    covered += body.particle_count;
    double stiffness = 0.0, ratio = 0.0, inverse_mass = 0.0;
    for (std::uint32_t c = body.first_class; c < body.first_class + body.class_count; ++c) {
      const SpringClass& spring = model.spring_classes[c];
      if (spring.stiffness == 0.0) return false;
      if (stiffness != 0.0 && spring.damping / spring.stiffness != ratio) return false;
      ratio = spring.damping / spring.stiffness;
      stiffness = std::max(stiffness, spring.stiffness);
    }
    for (std::uint32_t i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
      inverse_mass = std::max(inverse_mass, model.inverse_mass[i]);
    }
    const double kappa = infinite_lattice_eigenvalue * stiffness * inverse_mass;
    if (looks == 0 || kappa != known_kappa || ratio != known_ratio) {
      if (++looks > most_looks) return false;
      least = of_mode(integrator, 0.0, gamma);
      scan_unit_interval(300, [&](double share) {
        least = smaller(least, of_mode(integrator, share * kappa, gamma + ratio * share * kappa));
      });
      known_kappa = kappa;
      known_ratio = ratio;
    }
    if (!body.lattice || !least.step || timestep > *least.step) return false;
  }
  return covered == model.particle_count();
}

StabilityLimit stability_limit(const Model& model, Integrator integrator, StabilityEffort effort,
                               const StabilityWatch& watch) {
  if (row_of(integrator).traits.stable_at_any_step) return {infinity, true};
  return stability_limits(model, {&integrator, 1}, effort, watch).front();
}

double largest_stiffness_eigenvalue(const Model& model) {
  double largest = 0.0;
  WorkBudget work(std::numeric_limits<std::uint64_t>::max());
  for (const auto& [first, count] : runs_of(model)) {
    const LinearizedBody body(model, first, count);
    largest = std::max(
        largest, body.largest_eigenvalue(1.0, 0.0, thorough.tolerance, thorough.iterations, work).value);
  }
  return largest;
}

double usual_timestep(const StabilityLimit& limit, double otherwise) {
  if (!limit.step || !(*limit.step > 0.0) || !std::isfinite(*limit.step)) return otherwise;
  const double most = 0.5 * *limit.step, power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double digit : {5.0, 2.0})
    if (digit * power <= most) return digit * power;
  return power;
}

}  // namespace aspic
