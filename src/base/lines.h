#pragma once
// A text line by line.
#include <algorithm>
#include <cstddef>
#include <string_view>

namespace aspic {

/// Takes the first line off a text and returns it without its end: a line feed, a carriage return, or both.
inline std::string_view take_line(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && text[end] != '\n' && text[end] != '\r') ++end;
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end);
  if (text.starts_with("\r\n")) text.remove_prefix(1);
  if (!text.empty()) text.remove_prefix(1);
  return line;
}

/// Takes off the mark that some editors put before UTF-8.
inline void skip_byte_order_mark(std::string_view& text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  if (text.starts_with(mark)) text.remove_prefix(mark.size());
}

/// Whether a text begins as UTF-16 does, which some editors save.
inline bool is_utf16(std::string_view text) {
  return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
}
/// What to say of it, behind "this is ".
inline constexpr std::string_view utf16_words = "UTF-16; save it as UTF-8";

/// The text without blanks, tabs and carriage returns at its ends.
inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string_view::npos ? ""
                                         : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Line `number` ≥ 1 of a text, of those that line feeds end; empty past its end.
inline std::string_view line_of(std::string_view text, std::size_t number) {
  for (; number > 1; --number) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return text.substr(0, text.find_first_of("\r\n"));
}

}  // namespace aspic
