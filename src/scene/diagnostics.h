#pragma once
// Messages about scene text: the place, the line with a caret, the allowed values, a suggestion.
#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/suggestion.h"

namespace aspic::diagnostics {

/// Where something was written.
struct Position {
  std::uint32_t source = 0;  ///< 0: the file; i > 0: the i-th argument
  std::uint32_t line = 1;    ///< from 1
  std::uint32_t column = 1;  ///< from 1, in characters
  // clang-tidy 14 takes the 0 that a rewritten < compares with for a pointer.
  friend auto operator<=>(const Position&, const Position&) = default;  // NOLINT(modernize-use-nullptr)
};

/// What is wrong, and where.
struct Problem {
  Position at;
  std::string message;
  friend bool operator==(const Problem&, const Problem&) = default;
};

/// A text that problems point into.
struct Source {
  std::string label;  ///< the file's name; for an argument `KEY=VALUE` after its origin
  std::string text;
  enum Kind { file, argument, none } kind = file;  ///< none: a scene that was not read from text
};

/// The first 20 texts with `between` between them; of more, at the end "and 5 more".
std::string joined(std::span<const std::string> texts, std::string_view between);

/// Problems as one scene_rejected error, the first 20 and the number of the others: those of the file by line
/// and column, then those of the arguments in their order, a blank line between. A problem that was found
/// twice in one place is reported once.
Error rejection(std::span<const Source> sources, std::vector<Problem> problems);

/// Words as a list: `a, b or c`, each in quotation marks if `quoted`.
std::string list_text(std::span<const std::string_view> words, bool quoted);

/// The message for a key that a table ("" is the file itself) does not have.
std::string unknown_key(std::string_view table_path, std::string_view key);

/// A table's path as people read it: "cube[]" is `[[cube]]`, "simulation" is `[simulation]`.
std::string table_text(std::string_view table_path);

}  // namespace aspic::diagnostics
