#pragma once
// The forces that follow from positions and velocities alone: gravity and resistance, springs, pulls. One
// class for each, in the order in which every backend adds them.
#include <memory>
#include <utility>
#include <vector>

#include "cpu_reference/dynamics.h"
#include "physics/diagonal_block.h"
#include "physics/phase.h"

namespace aspic::reference {

/// One force in f(x, v), with its part of the matrix A = m − h·∂f/∂v' of implicit Euler. A new force on
/// particles is a class that derives from it and a line in the constructor of Terms.
template <class T>
class Term {
 public:
  using Blocks = std::vector<DiagonalBlock<T>>;

  explicit Term(const Dynamics<T>& dynamics) : dynamics_(dynamics) {}
  virtual ~Term() = default;

  /// Adds the force on every particle at (x, v), at this share of the step, to f [N].
  virtual void add_force(const Field<T>& x, const Field<T>& v, double share, Field<T>& f) const = 0;
  /// The same at the end of a step from x with the velocity v, and adds the diagonal blocks of A [kg].
  virtual void linearize(const Field<T>& x, const Field<T>& v, Field<T>& f, Blocks& blocks) = 0;
  /// Adds A·p as linearized [kg·m/s].
  virtual void multiply(const Field<T>& p, Field<T>& product) const = 0;

 protected:
  const Dynamics<T>& dynamics_;
};

/// All terms, one after another in the order of their sum.
template <class T>
class Terms {
 public:
  using Blocks = typename Term<T>::Blocks;

  /// `dynamics` must outlive it.
  explicit Terms(const Dynamics<T>& dynamics);

  /// Their sum at (x, v), this share of the step after its start [N]; incomplete in a step that is canceled.
  Field<T> force(const Field<T>& x, const Field<T>& v, double share = 0.0) const;
  /// Their sum at the end of a step from x with the velocity v [N], and the diagonal blocks of A [kg].
  std::pair<Field<T>, Blocks> linearize(const Field<T>& x, const Field<T>& v);
  /// A·p as linearized [kg·m/s].
  Field<T> product(const Field<T>& p) const;

 private:
  const Dynamics<T>& dynamics_;
  std::vector<std::unique_ptr<Term<T>>> terms_;
};

// Compiled once, in terms.cpp.
extern template class Terms<float>;
extern template class Terms<double>;

}  // namespace aspic::reference
