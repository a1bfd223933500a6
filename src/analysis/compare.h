#pragma once
// How far two states of the same model differ.
#include <algorithm>
#include <cstdint>

#include "base/result.h"
#include "model/state.h"

namespace aspic {

/// The largest differences in one quantity. With no difference all members are 0.
struct QuantityDifference {
  double absolute = 0.0;             ///< largest |a − b| of any component, in the quantity's unit
  std::uint32_t absolute_index = 0;  ///< the particle or ball it was found at, the lowest if several
  std::uint64_t ulp = 0;             ///< largest distance of any component in units in the last place
  std::uint32_t ulp_index = 0;
};

struct StateDifference {
  QuantityDifference position;                                             ///< [m]
  QuantityDifference velocity;                                             ///< [m/s]
  QuantityDifference ball_position, ball_velocity, ball_angular_velocity;  ///< [m], [m/s], [rad/s]

  /// Whether every bit is the same: −0 and +0 differ.
  bool identical() const { return largest_ulp() == 0; }
  std::uint64_t largest_ulp() const {
    return std::max(
        {position.ulp, velocity.ulp, ball_position.ulp, ball_velocity.ulp, ball_angular_velocity.ulp});
  }
  double largest_absolute() const {
    return std::max({position.absolute, velocity.absolute, ball_position.absolute, ball_velocity.absolute,
                     ball_angular_velocity.absolute});
  }
};

/// Compares component by component. ULPs are counted in the states' own precision; where the two differ, in
/// single precision, to which the other is rounded. Error (usage): another number of particles or balls.
Result<StateDifference> compare_states(const State& a, const State& b);

/// Steps from one representable number to the other; −0 and +0 are one step apart. Finite numbers only.
std::uint64_t ulp_distance(float a, float b);
std::uint64_t ulp_distance(double a, double b);

}  // namespace aspic
