#include "analysis/dense.h"

#include <Eigen/Eigenvalues>

namespace aspic {

std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXd& a) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(a, false);
  const auto& values = solver.eigenvalues();
  return {values.data(), values.data() + values.size()};
}

}  // namespace aspic
