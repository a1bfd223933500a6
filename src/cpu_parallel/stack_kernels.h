#pragma once
// Inner loops of a stack: up to 16 models with the same springs, one a lane. Every array has a row of 16
// numbers for each particle, so that a vector register holds one particle of all models. No lane waits for
// another's neighbors, and each lane does what the reference does, spring by spring in the same order.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cpu_parallel/kernels.h"

namespace aspic::parallel {

/// Models of a stack at most: lanes of the largest vector register.
inline constexpr std::size_t stack_lanes = slice;

/// The springs of a model by their lower ends, for all stacks of models with the same springs.
struct UpperEnds {
  struct End {
    std::uint32_t particle, spring_class;
  };
  std::vector<std::uint32_t> start;  ///< of each particle's ends, and behind the last
  std::vector<End> ends;             ///< ascending

  explicit UpperEnds(const Model& model);
  std::uint64_t bytes() const { return bytes_of(start) + bytes_of(ends); }
};

/// Rows of a spring class in StackInput::constants.
enum class ConstantRow : std::size_t { stiffness, damping, rest_length, slack, count };

/// What body forces and springs need.
struct StackInput {
  const UpperEnds* springs;
  const float* constants;  ///< a row for each ConstantRow of each class (Constants has their meaning)
  const float* mass;       ///< [kg]
  const physics::BodyForce<float>* body_forces;  ///< of each lane
};

/// Gravity, drag and the springs of all particles.
void stack_forces(const StackInput& input, const Particles& at, const Forces& forces);

/// By component and lane, boxes around each model's particles [m].
struct LaneBoxes {
  alignas(64) float low[3][stack_lanes], high[3][stack_lanes];
};
void lane_boxes(const VectorArray& x, std::size_t particles, LaneBoxes& boxes);

/// In front of a terrain: places x with normal·x > limit are far from it.
struct Front {
  alignas(64) float normal[3][stack_lanes] = {}, limit[stack_lanes] = {};
};
/// Models whose particle of this index is not in front of all terrains: a bit for each.
struct NearRow {
  std::uint32_t particle;
  std::uint32_t lanes;
};
/// Appends the rows with such models among `lanes`.
void find_near_rows(const VectorArray& x, std::size_t particles, std::span<const Front> terrain,
                    std::uint32_t lanes, std::vector<NearRow>& rows);

}  // namespace aspic::parallel
