#include "scene/document.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

#include "scene/nesting.h"

namespace aspic::document {
namespace {

Position position_of(const toml::source_position& at, std::uint32_t source) {
  return {source, std::max<std::uint32_t>(at.line, 1), std::max<std::uint32_t>(at.column, 1)};
}

Node converted(const toml::node& from, std::uint32_t source) {
  Node node;
  node.position = position_of(from.source().begin, source);
  switch (from.type()) {
    case toml::node_type::string:
      node.kind = Kind::string;
      node.text = from.as_string()->get();
      break;
    case toml::node_type::integer:
      node.kind = Kind::integer;
      node.integer = from.as_integer()->get();
      break;
    case toml::node_type::floating_point:
      node.kind = Kind::floating;
      node.number = from.as_floating_point()->get();
      break;
    case toml::node_type::boolean:
      node.kind = Kind::boolean;
      node.boolean = from.as_boolean()->get();
      break;
    case toml::node_type::array:
      node.kind = Kind::array;
      for (const toml::node& element : *from.as_array()) node.elements.push_back(converted(element, source));
      break;
    case toml::node_type::table:
      node.kind = Kind::table;
      for (const auto& [key, value] : *from.as_table()) {
        node.members.push_back(
            {std::string(key.str()), position_of(key.source().begin, source), converted(value, source)});
      }
      break;
    default:
      node.kind = Kind::date;
      break;
  }
  return node;
}

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
  std::size_t line_start = 0;
  for (std::uint32_t line = 1; line < at.line; ++line) {
    const std::size_t end = text.find('\n', line_start);
    if (end == std::string_view::npos) return at;
    line_start = end + 1;
  }
  const std::string_view line = text.substr(line_start, at.column - 1);
  const std::size_t equals = line.find_last_of('=');
  if (equals == std::string_view::npos || equals == 0) return at;
  const std::size_t key_end = line.find_last_not_of(" \t", equals - 1);
  if (key_end == std::string_view::npos) return at;
  const std::size_t before = line.find_last_of(" \t{,", key_end);
  at.column = static_cast<std::uint32_t>(before == std::string_view::npos ? 1 : before + 2);
  return at;
}

std::variant<Node, Problem> parse_once(std::string_view text, std::uint32_t source) {
  try {
    return converted(toml::parse(text), source);
  } catch (const toml::parse_error& error) {
    Position at = position_of(error.source().begin, source);
    const std::string_view description = error.description();
    if (description.find("key-value pair: cannot redefine") != std::string_view::npos) {
      at = start_of_key_before(text, at);
    }
    return Problem{at, reworded(description)};
  }
}

}  // namespace

std::variant<Node, Problem> parse(std::string_view text, std::uint32_t source) {
  if (auto problem = too_deep(text, source)) return *std::move(problem);
  // The streams that toml++ reads numbers with swallow std::bad_alloc, and a good number is blamed: what is
  // wrong with the text is so a second time.
  auto parsed = parse_once(text, source);
  return std::holds_alternative<Problem>(parsed) ? parse_once(text, source) : parsed;
}

const Member* find(const Node& table, std::string_view key) {
  const auto found =
      std::find_if(table.members.begin(), table.members.end(), [&](const Member& m) { return m.key == key; });
  return found == table.members.end() ? nullptr : &*found;
}

Member* find(Node& table, std::string_view key) {
  return const_cast<Member*>(find(static_cast<const Node&>(table), key));
}

std::string_view kind_text(Kind kind) {
  switch (kind) {
    case Kind::string:
      return "a string";
    case Kind::integer:
      return "a whole number";
    case Kind::floating:
      return "a number with a decimal point";
    case Kind::boolean:
      return "true or false";
    case Kind::date:
      return "a date or time";
    case Kind::array:
      return "an array";
    case Kind::table:
      return "a table";
  }
  return "";
}

}  // namespace aspic::document
