#pragma once
// From Scene to text.
#include <string>

#include "scene/parameters.h"
#include "scene/scene.h"

namespace aspic {

/// A complete scene file with every value the scene has, units as comments. Reading it back gives the same
/// values bit for bit: numbers are the shortest that do. What is absent (an infinite terrain mass,
/// restitution taken over from `contact`) stays absent and is given in a comment.
std::string to_toml(const Scene& scene);

/// A value as TOML writes it.
std::string toml_value(const Value& value);

}  // namespace aspic
