#pragma once
// How deep a TOML text nests, found before it is parsed: parsers descend by recursion, and so do the nodes
// they make.
#include <cstdint>
#include <optional>
#include <string_view>

#include "scene/document.h"

namespace aspic::document {

/// Most parts of a dotted key, and most arrays and inline tables inside each other. Scenes use three of
/// either.
inline constexpr int deepest_nesting = 32;

/// The first place where a text nests deeper, or nothing. Strings and comments are passed over by TOML's
/// rules (version 1.0.0); what is no valid TOML up to that place is the parser's business.
std::optional<Problem> too_deep(std::string_view text, std::uint32_t source);

}  // namespace aspic::document
