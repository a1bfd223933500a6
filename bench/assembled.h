#pragma once
// Implicit Euler as a textbook has it: the matrix of each linear system assembled, and solved by Eigen's
// conjugate gradients with its diagonal preconditioner. Newton's method around them, its tolerance and
// forcing terms are Aspic's own, so that only the linear algebra differs. For free bodies: no terrain, no
// pins, no pull, no other body.
#include <Eigen/SparseCore>

#include "cpu_reference/implicit_euler.h"

namespace aspic::bench {

class AssembledSystem {
 public:
  explicit AssembledSystem(const Model& model);

  /// A step from `s` on.
  physics::Phase<float> step(const physics::Phase<float>& s, SolveReport& report);

  // What solve_step() asks of a system.
  reference::Trial<float> start();
  reference::Trial<float> fall();
  reference::Trial<float> try_step(float lambda, bool onwards);
  static bool interrupted() { return false; }
  static bool contacts() { return false; }
  reference::Trial<float> update_contacts(bool) { return evaluate(); }

  /// A·δ = r to ‖r‖ ≤ η·‖r₀‖.
  void solve(float forcing, std::uint32_t most, std::uint32_t& iterations);

 private:
  using Field = physics::Field<float>;
  using Matrix = Eigen::SparseMatrix<float, Eigen::RowMajor>;

  reference::Trial<float> evaluate();
  void add(const Spring& spring, const physics::SpringJacobian<float>& H, std::size_t number);
  std::size_t place(std::uint32_t row, std::uint32_t column) const;

  const Model& model_;
  std::vector<Spring> springs_;
  reference::Dynamics<float> dynamics_;
  reference::SolveLimits<float> limits_;
  float h_;
  const physics::Phase<float>* s_ = nullptr;
  Field base_, trial_, delta_, r_;
  Matrix matrix_;
  /// Where row 0 of each spring's 3×3 blocks begins among the matrix's values: (a, a), (a, b), (b, a), (b,
  /// b).
  std::vector<std::array<std::size_t, 4>> places_;
  std::vector<std::size_t> row_size_;  ///< entries in each of a particle's three rows
};

/// Found for AssembledSystem in place of Aspic's own.
inline void conjugate_gradients(AssembledSystem& system, float forcing, std::uint32_t most,
                                std::uint32_t& iterations) {
  system.solve(forcing, most, iterations);
}

}  // namespace aspic::bench
