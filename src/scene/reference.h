#pragma once
// docs/scene-reference.md, written from the parameter table.
#include <string>

namespace aspic {

/// The page as Markdown.
std::string scene_reference();

}  // namespace aspic
