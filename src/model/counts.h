#pragma once
// What a model has and what it takes: for reports, and for checks before anything is allocated.
#include <cstdint>

#include "aspic/state_view.h"
#include "model/model.h"

namespace aspic {

/// Error (usage): the state has another number of particles or balls than the model.
Status check_sizes(const Model& model, const State& state);
/// Error (usage): a field that is there has another count than the model; with `all`, one is none.
Status check_sizes(const Model& model, const StateView& view);
Status check_sizes(const Model& model, const ConstStateView& view, bool all);

/// Error (usage): a number is not finite once it is rounded to the precision; names the first body with one.
Status check_finite(const ConstStateView& view, Precision precision);

/// Error (scene_rejected): a number of the model is not finite in single precision, or its time step is not
/// positive.
Status check_finite(const Model& model);

/// Springs, pinned particles and balls of a model, for reports.
struct ModelCounts {
  std::uint64_t particles = 0, pinned = 0, structural = 0, shear = 0, bending = 0, balls = 0;
  std::uint64_t listed = 0;  ///< of the springs: those in Model::listed_springs
  std::uint64_t springs() const { return structural + shear + bending; }
  ModelCounts& operator+=(const ModelCounts& other);
};
ModelCounts count(const Model& model);

/// Counts without building: for memory checks before anything is allocated. Pinned particles are not counted.
ModelCounts predict_counts(const ModelSettings& settings);

/// Bytes the model holds.
std::uint64_t model_bytes(const Model& model);

/// Bytes that a State of the model holds.
std::uint64_t state_bytes(const ModelCounts& counts);

/// Bytes that a run with these counts takes at least: listed springs and balls, a state, and in a solver of
/// single precision the start and the end of a step. For memory checks before anything is allocated.
std::uint64_t run_bytes(const ModelCounts& counts);

}  // namespace aspic
