#pragma once
// Text of values.
#include <string>

#include "aspic/scene.h"
#include "scene/parameters.h"

namespace aspic {

/// A value as TOML writes it.
std::string toml_value(const Value& value);

}  // namespace aspic
