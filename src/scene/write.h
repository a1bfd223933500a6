#pragma once
// Text of values.
#include <string>

#include "aspic/scene.h"
#include "scene/parameters.h"

namespace aspic {

/// A value as TOML writes it.
std::string toml_value(const Value& value);

/// The scene as a person would write it, whose keys have their default values where they are not named: what
/// is there is read as the same scene. Cells have a line for each row.
std::string to_short_toml(const Scene& scene);

}  // namespace aspic
