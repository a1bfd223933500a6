#include <fmt/format.h>

#include <algorithm>

#include "base/printable.h"
#include "scene/document.h"

namespace aspic::document {
namespace {

/// Any character that some parser might take for the end of a line: nothing hides behind one.
bool ends_line(char c) {
  return c == '\n' || c == '\r' || c == '\v' || c == '\f';
}

/// Bytes of the string that begins a text.
std::size_t string_size(std::string_view text) {
  const char quote = text.front();
  const std::string three(3, quote);
  const bool long_one = text.starts_with(three);
  for (std::size_t at = long_one ? 3 : 1; at < text.size(); ++at) {
    if (quote == '"' && text[at] == '\\') {
      ++at;
    } else if (long_one && text.substr(at).starts_with(three)) {
      // Up to two more quotation marks belong to the string.
      const std::size_t end = std::min(text.find_first_not_of(quote, at), text.size());
      return std::min(end, at + 5);
    } else if (!long_one && (text[at] == quote || ends_line(text[at]))) {
      return at + 1;
    }
  }
  return text.size();
}

}  // namespace

std::optional<Problem> too_deep(std::string_view text, std::uint32_t source) {
  const auto problem = [&](std::size_t at, std::string message) {
    const std::string_view before = text.substr(0, at);
    const auto line = std::ranges::count(before, '\n');
    const std::size_t column = character_count(before.substr(before.rfind('\n') + 1));
    return Problem{{source, static_cast<std::uint32_t>(line) + 1, static_cast<std::uint32_t>(column) + 1},
                   std::move(message)};
  };
  int dots = 0, depth = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at += string_size(text.substr(at));
      continue;
    }
    if (c == '#') {
      while (at < text.size() && !ends_line(text[at])) ++at;
      continue;
    }
    if (c == '.' && ++dots == deepest_nesting)
      return problem(
          at, fmt::format("a key has more than {} parts here: no scene is that deep", deepest_nesting));
    // Brackets of table headers count as arrays do: they hold no values.
    if ((c == '[' || c == '{') && ++depth > deepest_nesting)
      return problem(
          at, fmt::format("more than {} arrays and tables are inside each other here: no scene is that deep",
                          deepest_nesting));
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (std::string_view("[]{},=\n").find(c) != std::string_view::npos) dots = 0;
    ++at;
  }
  return std::nullopt;
}

}  // namespace aspic::document
