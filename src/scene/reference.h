#pragma once
// docs/scene-reference.md, written from the parameter table.
#include <string>
#include <string_view>

namespace aspic {

/// The page as Markdown. `option`: of the command line, by which a key is set.
std::string scene_reference(std::string_view option);

}  // namespace aspic
