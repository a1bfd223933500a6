#pragma once
// What does not hold of a run before its first step: bodies within terrain, and lengths, places and speeds
// beyond what its particles, its time step and its numbers resolve (docs/commands.md, "Warnings").
#include <vector>

#include "aspic/run.h"

namespace aspic {

/// Of a model, which is that of the settings, in this precision. Of many bodies few are named.
std::vector<Diagnostic> start_diagnostics(const ModelSettings& settings, const Model& model,
                                          Precision precision);

}  // namespace aspic
