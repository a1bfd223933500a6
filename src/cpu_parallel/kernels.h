#pragma once
// The inner loops, compiled for every instruction set of the processor's family and chosen at run time
// (Highway). All of them give the same bits: each lane does what the reference does for
// one particle, in the same order, without fused multiply-add.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "aspic/solver.h"
#include "cpu_parallel/particles.h"
#include "cpu_parallel/springs.h"
#include "model/integrator.h"
#include "physics/body_force.h"

namespace aspic::parallel {

/// Force on each particle of a range [N], by component.
struct Forces {
  float* component[3];
};

/// What body forces and springs need.
struct ForceInput {
  const Particles* at;  ///< the stage at which forces are taken
  const float* mass;    ///< [kg]
  const physics::BodyForce<float>* body_force;
};

/// Gravity, drag and the springs of particles of a body with lists; `range` is relative to the body, its
/// first a multiple of `slice`. Writes up to `slice` − 1 values more than there are particles.
void listed_forces(const SpringLists& lists, const ForceInput& input, Range range, const Forces& forces);

/// One stage of an explicit method (model/integrator.h has the formulas).
struct StageMove {
  const Particles* start;     ///< of the step
  const Particles* at;        ///< at which the forces were taken
  Particles* next;            ///< next stage, or the end of the step
  Particles* sums;            ///< weighted sums of V_s and a_s so far; unused by methods of one weight
  const float* inverse_mass;  ///< [1/kg]
  float advance;              ///< h·advance_s [s]
  float weight;
  float step_scale;  ///< h/divisor [s]
  bool accumulate;   ///< the sums hold something already
  bool last;
  Drift drift;
};

/// Smallest box around positions [m].
struct Box {
  float min[3], max[3];
};

/// What moves of particles came to, by lane.
struct Moved {
  alignas(64) float low[3][slice], high[3][slice];  ///< of the new positions [m]
  float limit;                                      ///< on the square of speeds [m²/s²]
  bool sound = true;  ///< all new positions are finite and no new speed is above the limit

  explicit Moved(float limit_of_square);
  Box box() const;
};

/// Moves the particles of a range, whose forces are given.
void move(const StageMove& stage, Range range, const Forces& forces, Moved& moved);

/// Smallest box around the positions of a range [m].
Box box_of(const VectorArray& x, Range range);

/// On the square of a speed: above it a step has diverged [m²/s²].
inline constexpr auto speed_limit = static_cast<float>(divergence_speed * divergence_speed);

/// Whether all positions are finite and no speed is above the square root of `limit` [m²/s²].
bool all_sound(const Particles& particles, Range range, float limit);

/// Writes the vectors of a range as rows of three floats.
void write_rows(const VectorArray& from, Range range, float* rows);

/// Name of the instruction set in use: "AVX3", "AVX2", "SSE4", "SCALAR", …
std::string_view instruction_set();

}  // namespace aspic::parallel
