#pragma once
// The uniform block every kernel reads: a Model's constants rounded to single precision.
#include "base/result.h"
#include "gpu_solver/layout.h"
#include "model/model.h"

namespace aspic {

/// Fills the block. Errors (scene_rejected): more spring classes or
/// terrains than the block holds.
Result<layout::Simulation> simulation_block(const Model& model);

}  // namespace aspic
