#pragma once
// Text for people: that from outside made fit for a terminal, where nothing in it can move the cursor, change
// colors or hide other text.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace aspic {

/// The first character of a text that is not empty, and the bytes it takes; not `valid`: one byte that begins
/// no UTF-8 character.
struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t size = 1;
  bool valid = false;
};
Utf8Character first_character(std::string_view text);

/// Characters of a text: bytes of UTF-8 that do not continue one.
std::size_t character_count(std::string_view text);

/// Whether a character acts on a terminal: controls, and characters that change the direction or the end of a
/// line.
bool acts_on_terminal(std::uint32_t code);

/// The text as valid UTF-8 without characters that act on a terminal. Written as escapes are C0 and C1
/// controls, DEL and bytes that are not UTF-8 (`\t`, `\x1b`), and characters that change the direction or the
/// end of a line
/// (`\u{202e}`). Line feeds stay. Text that holds none of these comes back as it is. Source: Unicode Standard
/// Annex 9 (bidirectional controls); Trojan Source, Boucher and Anderson, USENIX Security 2023.
std::string printable(std::string_view text);

/// The same with line feeds escaped too (`\n`): for names and words that belong on one line.
std::string printable_line(std::string_view text);

/// The first `most` characters of printable_line(text), with … where something was left out.
std::string excerpt(std::string_view text, std::size_t most);

/// "1.5 MiB", "512 bytes": a size for a sentence.
std::string human_bytes(std::uint64_t bytes);

}  // namespace aspic
