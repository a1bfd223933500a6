#pragma once
// --set: KEY=VALUE arguments worked into a document before it is read.
#include <span>
#include <string>
#include <vector>

#include "scene/diagnostics.h"
#include "scene/document.h"

namespace aspic::overrides {

/// Writes each argument into the document, in order, and adds one source for each. What the arguments
/// themselves get wrong is added to `problems`; whether the values are legal is the reader's business, as for
/// the file.
///
/// A `material` key takes the place of the file's masses and springs; masses and springs take the place of
/// the file's material only if all seven are given. A new terrain shape takes the place of geometry keys it
/// does not have.
void apply(std::span<const std::string> arguments, document::Node& root,
           std::vector<diagnostics::Source>& sources, std::vector<document::Problem>& problems);

}  // namespace aspic::overrides
