#pragma once
// A text line by line.
#include <algorithm>
#include <cstddef>
#include <string_view>

namespace aspic {

/// Takes the first line off a text and returns it without its end, a line feed with or without a carriage
/// return.
inline std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// The text without blanks, tabs and carriage returns at its ends.
inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string_view::npos ? ""
                                         : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Line `number` ≥ 1 of a text; empty past its end.
inline std::string_view line_of(std::string_view text, std::size_t number) {
  for (; number > 1; --number) take_line(text);
  return take_line(text);
}

}  // namespace aspic
