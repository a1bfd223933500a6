#pragma once
// The linearised springs of one body at rest: M^(-1/2) K M^(-1/2) and M^(-1/2) C M^(-1/2), matrix-free, and
// their largest eigenvalues.
#include <complex>
#include <cstdint>
#include <vector>

#include "model/model.h"

namespace aspic {

/// An eigenvalue and whether the iteration met its tolerance.
struct LargestEigenvalue {
  double value = 0.0;
  bool converged = true;
};

/// A body's springs as Σ nnᵀ terms between its free particles. Springs are linearised at the start positions
/// and rest lengths; a cord counts as a stretched spring; a pinned particle does not move; terrain takes no
/// part.
class LinearisedBody {
 public:
  LinearisedBody(const Model& model, std::uint32_t first_particle, std::uint32_t particle_count);

  /// Degrees of freedom that can move.
  std::size_t free_dof() const;

  /// Smallest and largest damping c/k [s] of the springs that act, infinite where k = 0. Empty body: both 0.
  double smallest_ratio() const { return smallest_ratio_; }
  double largest_ratio() const { return largest_ratio_; }

  /// Whether all springs have the same ratio of damping to stiffness, so that one operator's modes are the
  /// body's modes.
  bool proportional() const;
  bool has_springs() const { return !springs_.empty(); }

  /// Largest eigenvalue of (stiffness_factor·K + damping_factor·C) scaled by mass: for (1, 0) κ_max [1/s²],
  /// for (0, 1) γ_max [1/s]. Lanczos iteration to a relative residual of `tolerance`; the error of the value
  /// is about its square. Source: Golub and Van Loan, Matrix Computations, 2013, §10.1.
  LargestEigenvalue largest_eigenvalue(double stiffness_factor, double damping_factor, double tolerance,
                                       int max_iterations) const;

  /// All 2·free_dof() eigenvalues λ [1/s] of λ² + λC + K, by a dense solve: O(free_dof()³) time.
  std::vector<std::complex<double>> eigenvalues() const;

 private:
  struct LinearSpring {
    std::uint32_t a, b;  // local indices
    Vec3 direction;      // unit
    double stiffness, damping;
  };
  std::vector<LinearSpring> springs_;
  std::vector<double> root_inverse_mass_;  // √w of each particle of the body
  double smallest_ratio_ = 0.0, largest_ratio_ = 0.0;
};

}  // namespace aspic
