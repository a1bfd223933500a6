#pragma once
// Energies, momentum and extremes of a state, in double precision whatever the state's own.
#include <optional>
#include <string_view>

#include "model/model.h"
#include "model/state.h"

namespace aspic {

/// What a series row holds of one state.
struct Measures {
  double kinetic = 0.0;        ///< Σ ½ m v², of balls also ½ I ω² [J]
  double elastic = 0.0;        ///< Σ ½ k (L − r)² [J]; a slack cord holds none
  double gravitational = 0.0;  ///< −Σ m g·x [J], zero at the origin
  Vec3 momentum;               ///< Σ m v [N·s]
  double max_speed = 0.0;      ///< [m/s]
  double min_height = 0.0;     ///< lowest y of all particles and balls' centres [m]; 0 without any

  double total() const { return kinetic + elastic + gravitational; }
};

/// The first figure that is not finite, in words such as `the kinetic energy`; nothing if all are.
std::optional<std::string_view> first_not_finite(const Measures& measures);

/// Measures a state of the model. Pinned particles count for the potential energies and the height; they do
/// not move, so they have no part in kinetic energy, momentum and speed. Balls count
/// once they are launched. The state must have the model's numbers of particles and balls.
Measures measure(const Model& model, const State& state);

}  // namespace aspic
