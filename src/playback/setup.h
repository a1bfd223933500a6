#pragma once
// The setup of a run: the physics of a scene, and the balls, pins and pulls added by hand since it began.
#include <cstdint>
#include <map>
#include <vector>

#include "aspic/settings.h"
#include "aspic/state.h"
#include "base/result.h"
#include "model/model.h"

namespace aspic {

struct Setup {
  ModelSettings settings;
  /// Balls thrown by hand. Their indices follow those of the scene's balls; launch_step is the step they were
  /// thrown at.
  std::vector<Ball> thrown;
  /// Particles that were pinned (true) or freed (false) by hand, whatever the scene says of them.
  std::map<std::uint32_t, bool> pinned;
};

/// The model of a setup. Errors: those of build_model(const ModelSettings&). A particle of `pinned` that the
/// model does not have is left out.
Result<Model> build_model(const Setup& setup);

/// A state of a model with fewer balls as one of `model`: balls that are missing at the end start as the
/// model says, pinned particles do not move. The number of particles must be the model's.
State grown_state(const Model& model, State state);

}  // namespace aspic
