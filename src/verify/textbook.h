#pragma once
// The physics once more, dense and slow, written for comparison alone: nothing here is shared with the
// solvers.
#include <Eigen/Core>
#include <functional>

#include "aspic/state.h"
#include "model/model.h"

namespace aspic::verify {

/// Positions and velocities of all particles, one after another.
template <class T>
struct Motion {
  Eigen::Matrix<T, Eigen::Dynamic, 1> x, v;
};

template <class T>
Motion<T> motion_of(const State& state);

/// Spring forces and gravity [N] on all particles (docs/physics.md, section 1); no contact. `rest`: what rest
/// lengths are multiplied by.
template <class T>
Eigen::Matrix<T, Eigen::Dynamic, 1> force(const Model& model, const Motion<T>& at, T rest = T(1));

/// Σ ½k(L − r)² [J] of the springs at one particle, or of all (negative index).
double elastic_energy(const Model& model, const State& state, std::int64_t particle = -1);

/// The motion after `steps` steps of the classical Runge–Kutta method in extended precision: the truth that
/// orders are measured against. `stretch`: what rest lengths are multiplied by at a time [s]; empty: 1.
Motion<long double> exact_motion(const Model& model, const State& start, double duration, int steps,
                                 const std::function<long double(long double)>& stretch = {});

/// v' of one backward Euler step, v' = v + h·a(x + h·v', v'), by Newton's method with the complete dense
/// Jacobian and LU factors. No particle may be pinned.
Eigen::VectorXd dense_backward_euler(const Model& model, const State& start);

/// Largest eigenvalue of M^(-1/2) K M^(-1/2) at rest [1/s²] and its mode (unit vector), by power iteration.
struct WorstMode {
  double kappa = 0.0;
  Eigen::VectorXd shape;
};
WorstMode power_iteration(const Model& model, int iterations);

}  // namespace aspic::verify
