#pragma once
// The State of a run: everything that changes from step to step, and nothing else.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "aspic/export.h"
#include "aspic/vec.h"

namespace aspic {

/// The arithmetic a state was computed in.
enum class Precision { single, double_ };

ASPIC_API std::string_view name_of(Precision precision);  ///< "single", "double"

/// Positions and velocities of all particles and balls after `step` steps. Values are held as doubles
/// whatever the precision: a single-precision value is held exactly.
struct State {
  Precision precision = Precision::single;  ///< of the solver that it came from
  std::uint64_t step = 0;                   ///< steps since the start; time is step · h
  std::vector<Vec3> position;               ///< x [m], by global particle index
  std::vector<Vec3> velocity;               ///< v [m/s]
  // By ball index. A ball that is not launched yet (Ball::launch_step) holds the start it will have.
  std::vector<Vec3> ball_position;          ///< of the center [m]
  std::vector<Vec3> ball_velocity;          ///< [m/s]
  std::vector<Vec3> ball_angular_velocity;  ///< ω [rad/s]

  friend bool operator==(const State&, const State&) = default;
};

/// What a field belongs to.
enum class StateCarrier { particle, ball };

/// A field of a state: a vector for each particle or each ball.
struct StateField {
  std::string_view name;    ///< in checkpoints and comparisons: "ball_velocity"
  std::string_view symbol;  ///< of the quantity; a ball's may be that of a particle: "v"
  std::string_view unit;    ///< "m/s"
  StateCarrier carrier = StateCarrier::particle;  ///< how many vectors there are
  std::vector<Vec3> State::*vectors = nullptr;    ///< where a State has them
  static constexpr std::size_t components = 3;    ///< numbers of a vector
};

/// Every field. Hash, checkpoints, tables of states, keyframes and views walk this table, particles' fields
/// and balls' each in its order.
inline constexpr std::array<StateField, 5> state_fields = {{
    {"position", "x", "m", StateCarrier::particle, &State::position},
    {"velocity", "v", "m/s", StateCarrier::particle, &State::velocity},
    {"ball_position", "x", "m", StateCarrier::ball, &State::ball_position},
    {"ball_velocity", "v", "m/s", StateCarrier::ball, &State::ball_velocity},
    {"ball_angular_velocity", "ω", "rad/s", StateCarrier::ball, &State::ball_angular_velocity},
}};

/// Numbers of all fields of one particle or ball.
constexpr std::size_t numbers_of(StateCarrier carrier) {
  std::size_t sum = 0;
  for (const StateField& field : state_fields)
    if (field.carrier == carrier) sum += StateField::components;
  return sum;
}

/// How many particles or balls a state has.
inline std::size_t count_of(const State& state, StateCarrier carrier) {
  return carrier == StateCarrier::particle ? state.position.size() : state.ball_position.size();
}

/// Gives a state room for so many particles and balls, in every field.
ASPIC_API void resize(State& state, std::size_t particles, std::size_t balls);

/// Calls f with every vector of a state (State or const State) in the order of its hash and its files: the
/// fields of every particle, then those of every ball, in index order.
template <class AnyState, class F>
void for_each_vector(AnyState& state, const F& f) {
  const auto walk = [&]<StateCarrier carrier, std::size_t... n>(std::index_sequence<n...>) {
    const auto visit = [&]<std::size_t field>(std::size_t i) {
      if constexpr (state_fields[field].carrier == carrier) f((state.*state_fields[field].vectors)[i]);
    };
    const std::size_t count = count_of(state, carrier);
    for (std::size_t i = 0; i < count; ++i) (visit.template operator()<n>(i), ...);
  };
  constexpr std::make_index_sequence<state_fields.size()> all;
  walk.template operator()<StateCarrier::particle>(all);
  walk.template operator()<StateCarrier::ball>(all);
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
