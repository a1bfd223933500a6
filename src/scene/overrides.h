#pragma once
// --set: KEY=VALUE arguments read into a scene.
#include <span>
#include <string>
#include <vector>

#include "scene/diagnostics.h"
#include "scene/reader.h"

namespace aspic::overrides {

/// Reads each argument into the reader's scene, in order, and adds one source for each.
///
/// A `material` key takes the place of the scene's masses and springs; masses and springs take the place of
/// the scene's material only if all seven are given. A new terrain shape takes the place of geometry keys it
/// does not have.
void apply(std::span<const std::string> arguments, reader::Reader& reader,
           std::vector<diagnostics::Source>& sources);

}  // namespace aspic::overrides
