#pragma once
// TOML text to toml++'s tables, with errors as users read them. Only for what reads text: this header brings
// toml++ with it.
#include <toml++/toml.h>

#include <cstdint>
#include <string_view>
#include <variant>

#include "scene/diagnostics.h"

namespace aspic::document {

using diagnostics::Position;
using diagnostics::Problem;

/// Parses TOML. The first syntax error ends it; so does text that nests deeper than scenes do
/// (scene/nesting.h).
std::variant<toml::table, Problem> parse(std::string_view text, std::uint32_t source);

/// Where a key or a value begins.
Position position_of(const toml::source_region& at, std::uint32_t source);

/// "a string", "a whole number", …
std::string_view kind_text(const toml::node& node);

}  // namespace aspic::document
