#pragma once
// The State of a run: everything that changes from step to step, and nothing else.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/export.h"
#include "aspic/vec.h"

namespace aspic {

/// The arithmetic a state was computed in.
enum class Precision { single, double_ };

ASPIC_API std::string_view name_of(Precision precision);

/// Positions and velocities of all particles and balls after `step` steps. Values are held as doubles
/// whatever the precision: a single-precision value is held exactly.
struct State {
  Precision precision = Precision::single;
  std::uint64_t step = 0;      ///< steps since the start; time is step · h
  std::vector<Vec3> position;  ///< x [m], by global particle index
  std::vector<Vec3> velocity;  ///< v [m/s]
  // By ball index. A ball that is not launched yet (Ball::launch_step) holds the start it will have.
  std::vector<Vec3> ball_position;          ///< of the centre [m]
  std::vector<Vec3> ball_velocity;          ///< [m/s]
  std::vector<Vec3> ball_angular_velocity;  ///< ω [rad/s]

  friend bool operator==(const State&, const State&) = default;
};

/// Calls f with every vector of a state (State or const State) in the order of its hash and its files: x, v
/// of every particle, then x, v, ω of every ball, in index order.
template <class AnyState, class F>
void for_each_vector(AnyState& state, const F& f) {
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    f(state.position[i]);
    f(state.velocity[i]);
  }
  for (std::size_t b = 0; b < state.ball_position.size(); ++b) {
    f(state.ball_position[b]);
    f(state.ball_velocity[b]);
    f(state.ball_angular_velocity[b]);
  }
}

/// The first body with a number that is not finite, in words: `particle 7`, `ball 2`; nothing if all are.
ASPIC_API std::optional<std::string> first_not_finite(const State& state);

/// 64-bit FNV-1a (docs/files.md) of the little-endian values in the state's own precision:
/// x, v of every particle,
/// then x, v, ω of every ball, in index order.
ASPIC_API std::uint64_t state_hash(const State& state);

/// The hash as 16 lower-case hexadecimal digits.
ASPIC_API std::string state_hash_text(const State& state);

}  // namespace aspic
