#include "scene/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/lines.h"

namespace aspic::document {
namespace {

/// toml++ says "Error while parsing WHERE: WHAT"; users read "WHAT (in WHERE)".
std::string reworded(std::string_view description) {
  constexpr std::string_view opening = "Error while parsing ";
  std::string what(description);
  if (what.starts_with(opening)) {
    if (const std::size_t colon = what.find(": "); colon != std::string::npos) {
      const std::string where = what.substr(opening.size(), colon - opening.size());
      what = fmt::format("{} (in a {})", what.substr(colon + 2), where);
    }
  }
  constexpr std::string_view newline = "'\\n'";
  if (const std::size_t at = what.find(newline); at != std::string::npos) {
    what.replace(at, newline.size(), "the end of the line");
  }
  return "this is not valid TOML: " + what;
}

/// toml++ points at the value of a repeated key; the key itself is the culprit.
Position start_of_key_before(std::string_view text, Position at) {
  const std::string_view line = line_of(text, at.line).substr(0, at.column - 1);
  const std::size_t equals = line.find_last_of('=');
  if (equals == std::string_view::npos || equals == 0) return at;
  const std::size_t key_end = line.find_last_not_of(" \t", equals - 1);
  if (key_end == std::string_view::npos) return at;
  const std::size_t before = line.find_last_of(" \t{,", key_end);
  at.column = static_cast<std::uint32_t>(before == std::string_view::npos ? 1 : before + 2);
  return at;
}

Problem problem_of(const toml::parse_error& error, std::string_view text, std::uint32_t source) {
  Position at = position_of(error.source(), source);
  const std::string_view description = error.description();
  if (description.find("key-value pair: cannot redefine") != std::string_view::npos) {
    at = start_of_key_before(text, at);
  }
  return {at, reworded(description)};
}

std::variant<toml::table, Problem> parse_once(std::string_view text, std::uint32_t source) {
#if TOML_EXCEPTIONS
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    return problem_of(error, text, source);
  }
#else  // in browsers
  toml::parse_result parsed = toml::parse(text);
  if (!parsed) return problem_of(parsed.error(), text, source);
  return std::move(parsed).table();
#endif
}

}  // namespace

Position position_of(const toml::source_region& at, std::uint32_t source) {
  return {source, std::max<std::uint32_t>(at.begin.line, 1), std::max<std::uint32_t>(at.begin.column, 1)};
}

std::variant<toml::table, Problem> parse(std::string_view text, std::uint32_t source) {
  if (is_utf16(text)) return Problem{{source, 1, 1}, fmt::format("this is {}", utf16_words)};
  if (auto problem = too_deep(text, source)) return *std::move(problem);
  // The streams that toml++ reads numbers with swallow std::bad_alloc, and a good number is blamed: what is
  // wrong with the text is so a second time.
  auto parsed = parse_once(text, source);
  if (std::holds_alternative<Problem>(parsed)) return parse_once(text, source);
  return parsed;
}

std::string_view kind_text(const toml::node& node) {
  // By toml::node_type; what follows are dates and times.
  constexpr std::string_view kinds[] = {
      "", "a table", "an array", "a string", "an integer", "a number with a decimal point", "true or false"};
  static_assert(static_cast<int>(toml::node_type::boolean) == 6 &&
                static_cast<int>(toml::node_type::table) == 1 &&
                static_cast<int>(toml::node_type::string) == 3);
  const auto kind = static_cast<std::size_t>(node.type());
  return kind < std::size(kinds) ? kinds[kind] : "a date or time";
}

}  // namespace aspic::document
