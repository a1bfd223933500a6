#pragma once
// What counts as divergence, once for every precision and every way to hold particles.
#include <cmath>
#include <optional>

#include "aspic/solver.h"
#include "physics/balls/phase.h"

namespace aspic::physics {

/// Lowest ball that is not finite or too fast at the end of step number `step`, if any.
template <class T>
std::optional<Divergence> find_divergence(const Model& model, const BallPhase<T>& balls, std::uint64_t step) {
  const T limit = static_cast<T>(divergence_speed * divergence_speed);
  for (Eigen::Index b = 0; b < balls.x.cols(); ++b) {
    const Vector<T> v = balls.v.col(b);
    // An energy is measured in double precision, where the square of any ω in single precision is finite.
    const double spinning = balls.omega.col(b).template cast<double>().squaredNorm() *
                            model.balls[static_cast<std::size_t>(b)].inertia();
    const bool finite = balls.x.col(b).allFinite() && v.allFinite() && balls.omega.col(b).allFinite() &&
                        std::isfinite(spinning);
    if (!finite || dot3<T>(v, v) > limit)
      return Divergence{step, static_cast<std::uint32_t>(b), finite, true};
  }
  return std::nullopt;
}

/// Lowest particle, else lowest ball, that is not finite or too fast at the end of step number `step`, if
/// any; position(i) and velocity(i) are those of particle i.
template <class T, class Position, class Velocity>
std::optional<Divergence> find_divergence(const Model& model, Position position, Velocity velocity,
                                          const BallPhase<T>& balls, std::uint64_t step) {
  const T limit = static_cast<T>(divergence_speed * divergence_speed);
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    const Vector<T> v = velocity(static_cast<Eigen::Index>(i));
    const bool finite = position(static_cast<Eigen::Index>(i)).allFinite() && v.allFinite();
    if (!finite || dot3<T>(v, v) > limit) return Divergence{step, i, finite, false};
  }
  return find_divergence(model, balls, step);
}

}  // namespace aspic::physics
