#pragma once
// TOML text to toml++'s tables, with errors as users read them. Only for what reads text: this header brings
// toml++ with it.
#include <toml++/toml.h>

#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

#include "scene/diagnostics.h"

namespace aspic::document {

using diagnostics::Position;
using diagnostics::Problem;

/// Parses TOML. The first syntax error ends it; so does text that nests deeper than scenes do (too_deep).
std::variant<toml::table, Problem> parse(std::string_view text, std::uint32_t source);

/// Where a key or a value begins.
Position position_of(const toml::source_region& at, std::uint32_t source);

/// "a string", "a whole number", …
std::string_view kind_text(const toml::node& node);

/// Most parts of a dotted key, and most arrays and inline tables inside each other. Scenes use three of
/// either.
inline constexpr int deepest_nesting = 32;

/// The first place where a text nests deeper, or nothing. Strings and comments are passed over by TOML's
/// rules (version 1.0.0); invalid TOML up to that place is left to the parser.
std::optional<Problem> too_deep(std::string_view text, std::uint32_t source);

}  // namespace aspic::document
