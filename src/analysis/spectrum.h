#pragma once
// The linearized springs of one body at rest: M^(-1/2) K M^(-1/2) and M^(-1/2) C M^(-1/2), matrix-free, and
// their largest eigenvalues.
#include <complex>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "model/model.h"

namespace aspic {

/// Work that may be done, in spring evaluations: a bound on effort that is the same on every machine.
class WorkBudget {
 public:
  /// `watch` is called about every millionth evaluation with the share of the budget that is spent; once it
  /// returns false the rest of the budget is gone.
  explicit WorkBudget(std::uint64_t evaluations, std::function<bool(double)> watch = {})
      : all_(evaluations), left_(evaluations), watch_(std::move(watch)) {}

  /// Takes from the budget. False: it is spent, and what can be left out should be.
  bool spend(std::uint64_t evaluations);
  bool spent() const { return left_ == 0; }
  std::uint64_t left() const { return left_; }

 private:
  std::uint64_t all_, left_, since_look_ = 0;
  std::function<bool(double)> watch_;
};

/// An eigenvalue and whether the iteration met its tolerance. If not, `value` is no estimate but above the
/// eigenvalue: the last Ritz value with its residual added, and at most the Gershgorin bound, which holds
/// without any iteration.
struct LargestEigenvalue {
  double value = 0.0;
  bool converged = true;
};

/// A body's springs as Σ nnᵀ terms between its free particles. Springs are linearized at the start positions
/// and rest lengths; a cord counts as a stretched spring; a pinned particle does not move; terrain takes no
/// part.
class LinearizedBody {
 public:
  /// `springs`: false keeps bounds and ratios only, in a pass over the model's springs and no memory for
  /// them.
  LinearizedBody(const Model& model, std::uint32_t first_particle, std::uint32_t particle_count,
                 bool springs = true);

  /// Nothing at all: the beginning of a join.
  LinearizedBody() = default;

  /// Takes another body's springs into the bounds and ratios. Neither keeps springs.
  void join(const LinearizedBody& other);
  /// Largest share by which actuators shorten a spring, 1 − r/r₀ at its shortest; 0 without any.
  double shortening() const { return shortening_; }
  bool springs_kept() const { return !springs_.empty(); }

  /// Degrees of freedom that can move.
  std::size_t free_dof() const;

  /// Smallest and largest damping c/k [s] of the springs that act, infinite where k = 0. Empty body: both 0.
  double smallest_ratio() const { return smallest_ratio_; }
  double largest_ratio() const { return largest_ratio_; }

  /// Whether all springs have the same ratio of damping to stiffness, so that one operator's modes are the
  /// body's modes.
  bool proportional() const;
  bool has_springs() const { return spring_count_ > 0; }
  std::uint64_t spring_count() const { return spring_count_; }

  /// Not less than the largest eigenvalue of (stiffness_factor·K + damping_factor·C) scaled by mass, from
  /// Gershgorin's discs of 3×3 blocks (Feingold and Varga, Pacific J. Math. 12, 1962). Infinite or NaN where
  /// k/m overflows.
  double eigenvalue_bound(double stiffness_factor, double damping_factor) const {
    return stiffness_factor * stiffness_bound_ + damping_factor * damping_bound_;
  }

  /// Largest eigenvalue of (stiffness_factor·K + damping_factor·C) scaled by mass: for (1, 0) κ_max [1/s²],
  /// for (0, 1) γ_max [1/s]. Lanczos iteration to a relative residual of `tolerance`; the error of the value
  /// is about its square. Source: Golub and Van Loan, Matrix Computations, 2013, §10.1. Ends earlier where
  /// the budget does; a body made without springs gives its bound.
  LargestEigenvalue largest_eigenvalue(double stiffness_factor, double damping_factor, double tolerance,
                                       int max_iterations, WorkBudget& work) const;

  /// Displacements [m] of all particles in about the mode of the largest eigenvalue, the largest of them 1:
  /// that many rounds of power iteration. Zero where no springs are kept.
  std::vector<Vec3> stiffest_mode(double stiffness_factor, double damping_factor, int rounds) const;

  /// All 2·free_dof() eigenvalues λ [1/s] of λ² + λC + K, by a dense solve: O(free_dof()³) time.
  std::vector<std::complex<double>> eigenvalues() const;

 private:
  struct LinearSpring {
    std::uint32_t a, b;  // local indices
    Vec3 direction;      // unit
    double stiffness, damping;
  };
  /// out = M^(-1/2) (stiffness_factor·K + damping_factor·C) M^(-1/2)·in, three numbers by particle.
  void multiply(double stiffness_factor, double damping_factor, const double* in, double* out) const;

  std::vector<LinearSpring> springs_;
  std::uint64_t spring_count_ = 0;
  double stiffness_bound_ = 0.0, damping_bound_ = 0.0;
  std::vector<double> root_inverse_mass_;  // √w of each particle of the body
  double smallest_ratio_ = 0.0, largest_ratio_ = 0.0;
  double shortening_ = 0.0;
};

}  // namespace aspic
