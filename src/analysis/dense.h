#pragma once
// Eigen's dense solvers behind two functions: each takes the compiler seconds wherever it is used.
#include <Eigen/Core>
#include <complex>
#include <vector>

namespace aspic {

/// The eigenvalues of a square matrix, in no particular order: O(n³) time.
std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXd& a);

/// x of a·x = b. Precondition: `a` is square and not singular.
Eigen::VectorXd solve(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace aspic
