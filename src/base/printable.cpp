#include "base/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace aspic {
namespace {

/// Directions, and ends of lines that are no line feed.
bool reorders(std::uint32_t code) {
  return code == 0x061c || (code >= 0x200e && code <= 0x200f) || (code >= 0x2028 && code <= 0x202e) ||
         (code >= 0x2066 && code <= 0x2069) || code == 0xfeff;
}

void append_character(std::string& out, std::string_view text, const Utf8Character& c, bool keep_line_feeds) {
  const auto into = std::back_inserter(out);
  if (!c.valid || c.code == 0x7f || (c.code < 0x20 && c.code != '\n' && c.code != '\t')) {
    fmt::format_to(into, "\\x{:02x}", c.code);
  } else if (c.code == '\t') {
    out += "\\t";
  } else if (c.code == '\n' && !keep_line_feeds) {
    out += "\\n";
  } else if ((c.code >= 0x80 && c.code < 0xa0) || reorders(c.code)) {
    fmt::format_to(into, "\\u{{{:x}}}", c.code);
  } else {
    out += text.substr(0, c.size);
  }
}

std::string escaped(std::string_view text, bool keep_line_feeds) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Utf8Character c = first_character(text);
    append_character(out, text, c, keep_line_feeds);
    text.remove_prefix(c.size);
  }
  return out;
}

}  // namespace

/// Unicode Standard, table 3-7: no overlong forms, no surrogates, nothing above U+10FFFF.
Utf8Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return {lead, 1, true};
  const std::size_t size = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < size) return {lead, 1, false};
  std::uint32_t code = lead & (0xffu >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0u) != 0x80u) return {lead, 1, false};
    code = code << 6 | (byte(i) & 0x3fu);
  }
  const std::uint32_t least = size == 4 ? 0x10000 : size == 3 ? 0x800 : 0x80;
  if (code < least || code > 0x10ffff || (code >= 0xd800 && code <= 0xdfff)) return {lead, 1, false};
  return {code, size, true};
}

std::size_t character_count(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

bool acts_on_terminal(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || reorders(code);
}

std::string printable(std::string_view text) {
  return escaped(text, true);
}

std::string printable_line(std::string_view text) {
  return escaped(text, false);
}

std::string excerpt(std::string_view text, std::size_t most) {
  std::string out;
  for (std::size_t n = 0; !text.empty(); ++n) {
    if (n == most) return out + "…";
    const Utf8Character c = first_character(text);
    append_character(out, text, c, false);
    text.remove_prefix(c.size);
  }
  return out;
}

std::string human_bytes(std::uint64_t bytes) {
  constexpr const char* units[] = {"KiB", "MiB", "GiB", "TiB", "PiB"};
  if (bytes < 1024) return fmt::format("{} bytes", bytes);
  double size = static_cast<double>(bytes) / 1024.0;
  std::size_t unit = 0;
  while (size >= 1024.0 && unit + 1 < std::size(units)) size /= 1024.0, ++unit;
  return fmt::format("{:.4g} {}", size, units[unit]);
}

}  // namespace aspic
