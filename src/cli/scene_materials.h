#pragma once
// The material that raw constants of a cube amount to, and what becomes of it with more particles.
#include <string>

#include "aspic/settings.h"
#include "cli/json.h"

namespace aspic::cli {

/// A line for each kind of cubes with one stiffness for all springs; empty without any.
std::string materials_text(const ModelSettings& settings);
Json materials_json(const ModelSettings& settings);

}  // namespace aspic::cli
