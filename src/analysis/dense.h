#pragma once
// Eigen's dense eigenvalue solver behind a function: it takes the compiler seconds wherever it is used.
#include <Eigen/Core>
#include <complex>
#include <vector>

namespace aspic {

/// The eigenvalues of a square matrix, in no particular order: O(n³) time.
std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXd& a);

}  // namespace aspic
