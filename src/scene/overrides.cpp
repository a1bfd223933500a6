#include "scene/overrides.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "model/model.h"
#include "scene/parameters.h"

namespace aspic::overrides {
namespace {

using document::find;
using document::Kind;
using document::Member;
using document::Node;
using document::Position;
using document::Problem;

/// One part of a key: `cube[0]` is name cube, index 0.
struct Segment {
  std::string name;
  std::optional<std::size_t> index;
  std::uint32_t column = 1;
};

std::uint32_t characters(std::string_view text) {
  return static_cast<std::uint32_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

bool is_bare_word(std::string_view text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  if (text.empty() || !letter(text.front())) return false;
  if (text == "true" || text == "false" || text == "nan" || text == "inf") return false;
  return std::all_of(text.begin(), text.end(),
                     [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-'; });
}

/// Merges `value` into the member: tables key by key, anything else in its place.
void merge(Node& table, const std::string& key, const Position& position, const Node& value) {
  Member* member = find(table, key);
  if (!member) {
    table.members.push_back({key, position, value});
  } else if (member->value.kind == Kind::table && value.kind == Kind::table) {
    for (const Member& inner : value.members) merge(member->value, inner.key, inner.position, inner.value);
  } else {
    member->position = position;
    member->value = value;
  }
}

/// One argument on its way into the document.
class Argument {
 public:
  Argument(const std::string& text, std::uint32_t source, std::vector<Problem>& problems)
      : text_(text), source_(source), problems_(problems) {}

  void apply(Node& root) {
    const std::size_t equals = text_.find('=');
    if (equals == std::string::npos) {
      return fail(1, "an argument of --set is KEY=VALUE, such as simulation.timestep=0.002");
    }
    if (!parse_key(std::string_view(text_).substr(0, equals))) return;
    if (!parse_value(equals)) return;
    insert(root);
  }

 private:
  void fail(std::uint32_t column, std::string message) {
    problems_.push_back({{source_, 1, column}, std::move(message)});
  }

  bool parse_key(std::string_view key) {
    while (!key.empty() && key.back() == ' ') key.remove_suffix(1);
    std::size_t start = 0;
    while (start <= key.size()) {
      const std::size_t end = std::min(key.find('.', start), key.size());
      const std::string_view part = key.substr(start, end - start);
      Segment segment;
      segment.column = characters(key.substr(0, start)) + 1;
      segment.name = part.substr(0, part.find('['));
      if (const std::size_t bracket = part.find('['); bracket != std::string_view::npos) {
        const std::string_view digits = part.substr(bracket + 1);
        std::size_t index = 0;
        const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
        if (error != std::errc() ||
            std::string_view(stop, static_cast<std::size_t>(digits.data() + digits.size() - stop)) != "]") {
          fail(segment.column + characters(part.substr(0, bracket)) + 1,
               "an index is a whole number from 0 in brackets, such as cube[0]");
          return false;
        }
        segment.index = index;
      }
      if (segment.name.empty()) {
        fail(segment.column, "a part of the key is missing here");
        return false;
      }
      segments_.push_back(segment);
      start = end + 1;
    }
    return true;
  }

  bool parse_value(std::size_t equals) {
    const std::string_view value = std::string_view(text_).substr(equals + 1);
    const std::uint32_t column = characters(std::string_view(text_).substr(0, equals)) + 2;
    if (is_bare_word(value)) {
      value_.kind = Kind::string;
      value_.text = value;
      value_.position = {source_, 1, column};
      return true;
    }
    // A stand-in key of the same width keeps the parser's columns those of the argument.
    const std::string stand_in(std::max<std::size_t>(column - 2, 1), 'k');
    auto parsed = document::parse(fmt::format("{}={}", stand_in, value), source_);
    if (const auto* problem = std::get_if<Problem>(&parsed)) {
      fail(
          column,
          fmt::format("the value is neither a TOML value nor a single word; text with spaces needs quotation "
                      "marks inside the argument: '{}=\"…\"' ({})",
                      text_.substr(0, equals), problem->message));
      return false;
    }
    Node& root = std::get<Node>(parsed);
    if (root.members.size() != 1 || root.members[0].key != stand_in) {
      fail(column, "the value ends with its first line");
      return false;
    }
    value_ = std::move(root.members[0].value);
    return true;
  }

  /// The key with `[0]` where a list lacks its index, for suggestions.
  std::string key_with_index(std::size_t list) const {
    std::string key;
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      key += (s > 0 ? "." : "") + segments_[s].name;
      if (s == list) key += "[0]";
    }
    return key;
  }

  void insert(Node& root) {
    Node* table = &root;
    std::string path;
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      const Segment& segment = segments_[s];
      const bool last = s + 1 == segments_.size();
      const std::string parent = path;
      path += (path.empty() ? "" : ".") + segment.name;
      const PathKind kind = path_kind(path);
      if (kind == PathKind::unknown)
        return fail(segment.column, diagnostics::unknown_key(parent, segment.name));
      if (kind != PathKind::list && segment.index) {
        return fail(segment.column,
                    fmt::format("'{}' is not a list of tables and takes no index", segment.name));
      }
      if (kind == PathKind::parameter && !last) {
        return fail(segments_[s + 1].column, fmt::format("'{}' is a value and has no keys", segment.name));
      }
      if (kind == PathKind::list) {
        table = list_element(*table, segment, s);
        if (!table) return;
        path += "[]";
        if (!last) continue;
        if (value_.kind != Kind::table) {
          return fail(
              value_.position.column,
              fmt::format("'{}' is a table: give {{ key = value }} or name one of its keys", segment.name));
        }
        for (const Member& member : value_.members) merge(*table, member.key, member.position, member.value);
        return;
      }
      if (last) return merge(*table, segment.name, {source_, 1, segment.column}, value_);
      Member* member = find(*table, segment.name);
      if (!member) {
        table->members.push_back({segment.name, {source_, 1, segment.column}, Node{}});
        member = &table->members.back();
        member->value.position = member->position;
      }
      // What is no table in the file is reported there.
      if (member->value.kind != Kind::table) return;
      table = &member->value;
    }
  }

  Node* list_element(Node& table, const Segment& segment, std::size_t position) {
    if (!segment.index) {
      fail(segment.column, fmt::format("'{}' is a list and needs an index; did you mean '{}'?", segment.name,
                                       key_with_index(position)));
      return nullptr;
    }
    Member* member = find(table, segment.name);
    if (member && member->value.kind != Kind::array) return nullptr;  // reported where the file says so
    const std::size_t count = member ? member->value.elements.size() : 0;
    if (*segment.index >= count) {
      fail(segment.column, count == 0   ? fmt::format("the scene has no [[{}]]", segment.name)
                           : count == 1 ? fmt::format("the scene has only one [[{0}]]: {0}[0]", segment.name)
                                        : fmt::format("the scene has {0} [[{1}]]: {1}[0] to {1}[{2}]", count,
                                                      segment.name, count - 1));
      return nullptr;
    }
    Node& element = member->value.elements[*segment.index];
    return element.kind == Kind::table ? &element : nullptr;
  }

  const std::string& text_;
  std::uint32_t source_;
  std::vector<Problem>& problems_;
  std::vector<Segment> segments_;
  Node value_;
};

bool is_key_of(std::string_view key, Belonging belonging) {
  for (const Parameter& p : parameters()) {
    if (p.belonging != belonging || !p.path.starts_with("cube[].")) continue;
    const std::string_view rest = p.path.substr(7);
    if (rest.substr(0, rest.find('.')) == key) return true;
  }
  return false;
}

/// Position of the first value in a member that an argument wrote; nothing if the file wrote all of it.
std::optional<Position> first_override(const Member& member) {
  if (member.value.kind == Kind::table) {
    for (const Member& inner : member.value.members) {
      if (const auto found = first_override(inner)) return found;
    }
    if (!member.value.members.empty()) return std::nullopt;
  }
  return member.position.source > 0 ? std::optional(member.position) : std::nullopt;
}

/// How many values of the table's parameters arguments wrote.
std::size_t overridden_values(const Member& member) {
  if (member.value.kind != Kind::table) return member.position.source > 0 ? 1 : 0;
  std::size_t sum = 0;
  for (const Member& inner : member.value.members) sum += overridden_values(inner);
  return sum;
}

/// Decides between material and explicit springs where arguments changed what the file had chosen.
void resolve_material(Node& cube, std::vector<Problem>& problems) {
  Member* material = find(cube, "material");
  if (!material) return;
  const bool file_material = material->position.source == 0;
  const std::optional<Position> set_material = first_override(*material);
  const auto is_explicit = [](const Member& m) { return is_key_of(m.key, Belonging::explicit_springs); };
  bool file_explicit = false;
  std::optional<Position> set_explicit;
  std::size_t values_set = 0;
  for (const Member& m : cube.members) {
    if (!is_explicit(m)) continue;
    file_explicit = file_explicit || m.position.source == 0;
    values_set += overridden_values(m);
    if (const auto at = first_override(m); at && !set_explicit) set_explicit = at;
  }
  if (file_material && file_explicit) return;  // the file is wrong by itself
  const auto needed = static_cast<std::size_t>(
      std::count_if(parameters().begin(), parameters().end(),
                    [](const Parameter& p) { return p.belonging == Belonging::explicit_springs; }));
  if (set_material && set_explicit) {
    problems.push_back({std::max(*set_material, *set_explicit,
                                 [](const Position& a, const Position& b) { return a.source < b.source; }),
                        "a cube has either a material or masses and springs: --set gives both"});
    std::erase_if(cube.members, is_explicit);
  } else if (set_material) {
    std::erase_if(cube.members, is_explicit);
  } else if (set_explicit && values_set == needed) {
    std::erase_if(cube.members, [](const Member& m) { return m.key == "material"; });
  } else if (set_explicit) {
    problems.push_back(
        {*set_explicit,
         "this cube is made of a material, which decides its masses and springs; set material.density, "
         "material.youngs-modulus or material.damping-ratio, or all of particle-mass, structural, shear and "
         "bending with stiffness and damping"});
    std::erase_if(cube.members, is_explicit);
  }
}

/// Takes out the file's geometry where an argument chose a shape that does not have it.
void resolve_shape(Node& terrain) {
  const Member* shape = find(terrain, "shape");
  if (!shape || shape->position.source == 0 || shape->value.kind != Kind::string) return;
  const std::vector<std::string_view>& words = find_parameter("terrain[].shape")->words;
  const auto word = std::find(words.begin(), words.end(), shape->value.text);
  if (word == words.end()) return;
  const auto chosen = static_cast<TerrainShape>(word - words.begin());
  std::erase_if(terrain.members, [&](const Member& m) {
    const Parameter* p = find_parameter("terrain[]." + m.key);
    return p && m.position.source == 0 && !belongs_to_shape(*p, chosen);
  });
}

}  // namespace

void apply(std::span<const std::string> arguments, Node& root, std::vector<diagnostics::Source>& sources,
           std::vector<Problem>& problems) {
  for (const std::string& argument : arguments) {
    const auto source = static_cast<std::uint32_t>(sources.size());
    sources.push_back({"--set " + argument, argument, false});
    Argument(argument, source, problems).apply(root);
  }
  for (const std::string_view list : {"cube", "terrain"}) {
    Member* member = find(root, list);
    if (!member) continue;
    for (Node& element : member->value.elements) {
      if (list == "cube") {
        resolve_material(element, problems);
      } else {
        resolve_shape(element);
      }
    }
  }
}

}  // namespace aspic::overrides
