#pragma once
// A parsed TOML text as plain nodes that know where they were written. Keeps toml++ in one translation unit.
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace aspic::document {

/// Where something was written.
struct Position {
  std::uint32_t source = 0;  ///< 0: the file; i > 0: the i-th --set argument
  std::uint32_t line = 1;    ///< from 1
  std::uint32_t column = 1;  ///< from 1, in characters
};

enum class Kind { string, integer, floating, boolean, date, array, table };

struct Member;

/// A value with its position. Only the fields of its kind are meaningful.
struct Node {
  Kind kind = Kind::table;
  Position position;
  std::string text;
  std::int64_t integer = 0;
  double number = 0.0;
  bool boolean = false;
  std::vector<Node> elements;   ///< array
  std::vector<Member> members;  ///< table; keys are unique
};

/// A key of a table with its value.
struct Member {
  std::string key;
  Position position;  ///< of the key
  Node value;
};

/// What is wrong, and where.
struct Problem {
  Position at;
  std::string message;
};

/// Parses TOML. The first syntax error ends it; so does text that nests deeper than scenes do
/// (scene/nesting.h).
std::variant<Node, Problem> parse(std::string_view text, std::uint32_t source);

/// The member of a table with that key, or nullptr (also if the node is no table).
Member* find(Node& table, std::string_view key);
const Member* find(const Node& table, std::string_view key);

/// "a string", "a whole number", …
std::string_view kind_text(Kind kind);

}  // namespace aspic::document
