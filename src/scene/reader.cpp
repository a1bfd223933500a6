#include "scene/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "scene/diagnostics.h"
#include "scene/parameters.h"
#include "scene/scene_checks.h"

namespace aspic::reader {
namespace {

using document::Kind;
using document::Member;
using document::Node;
using document::Problem;

std::optional<double> number_of(const Node& node) {
  if (node.kind == Kind::floating) return node.number;
  if (node.kind == Kind::integer) return static_cast<double>(node.integer);
  return std::nullopt;
}

class Reader {
 public:
  explicit Reader(std::vector<Problem>& problems) : problems_(problems) {}

  Scene read(const Node& root) {
    read_table(root, "", 0);
    return std::move(scene_);
  }

 private:
  void read_table(const Node& table, const std::string& path, std::size_t index) {
    for (const Member& member : table.members) {
      const std::string child = path.empty() ? member.key : path + "." + member.key;
      // A key with brackets or dots inside quotes must not be taken for a path.
      const bool plain = member.key.find_first_of("[].") == std::string::npos && !member.key.empty();
      switch (plain ? path_kind(child) : PathKind::unknown) {
        case PathKind::unknown:
          problems_.push_back({member.position, diagnostics::unknown_key(path, member.key)});
          break;
        case PathKind::parameter:
          read_parameter(*find_parameter(child), member.value, index);
          break;
        case PathKind::table:
          read_inner_table(member, child, index);
          break;
        case PathKind::list:
          read_list(member, child);
          break;
      }
    }
  }

  void read_inner_table(const Member& member, const std::string& path, std::size_t index) {
    if (member.value.kind != Kind::table) {
      const std::vector<std::string_view> keys = child_keys(path);
      problems_.push_back({member.value.position, fmt::format("'{}' must be a table with the keys {}, not {}",
                                                              member.key, diagnostics::list_text(keys, false),
                                                              document::kind_text(member.value.kind))});
      return;
    }
    // Even an empty `material = {}` makes the cube one of a material.
    if (path == "cube[].material") scene_.model.cubes[index].material.emplace();
    read_table(member.value, path, index);
  }

  void read_list(const Member& member, const std::string& path) {
    const auto wrong = [&](const Node& culprit) {
      problems_.push_back(
          {culprit.position, fmt::format("'{}' must be a list of tables: write [[{}]], not {}", path, path,
                                         document::kind_text(culprit.kind))});
    };
    if (member.value.kind != Kind::array) return wrong(member.value);
    for (std::size_t i = 0; i < member.value.elements.size(); ++i) {
      // One entry in the scene for each element, right or wrong, so that indices stay those of the file.
      append_element(scene_, path);
      const Node& element = member.value.elements[i];
      if (element.kind != Kind::table) {
        wrong(element);
      } else {
        read_table(element, path + "[]", i);
      }
    }
  }

  void read_parameter(const Parameter& p, const Node& node, std::size_t index) {
    const std::optional<Value> value = converted(p, node);
    if (!value) return;
    if (const auto complaint = check_value(p, *value)) {
      problems_.push_back({culprit(p, node, *complaint).position, complaint->message});
      return;
    }
    p.set(scene_, index, *value);
  }

  /// The node a complaint is about: the value itself, or the element of an array.
  static const Node& culprit(const Parameter& p, const Node& node, const Complaint& complaint) {
    if (!complaint.element) return node;
    std::size_t seen = 0;
    for (const Node& element : node.elements) {
      if (p.type == ParameterType::pinned && element.kind != Kind::string) continue;
      if (seen++ == *complaint.element) return element;
    }
    return node;
  }

  std::nullopt_t wrong_type(const Parameter& p, const Node& culprit) {
    problems_.push_back({culprit.position, fmt::format("'{}' must be {}, not {}", key_text(p),
                                                       allowed_text(p), document::kind_text(culprit.kind))});
    return std::nullopt;
  }

  /// The node's value in the parameter's type; nothing, and a problem, if it has another type.
  std::optional<Value> converted(const Parameter& p, const Node& node) {
    switch (p.type) {
      case ParameterType::boolean:
        if (node.kind != Kind::boolean) return wrong_type(p, node);
        return Value(node.boolean);
      case ParameterType::integer:
        if (node.kind != Kind::integer) return wrong_type(p, node);
        return Value(node.integer);
      case ParameterType::number: {
        const auto number = number_of(node);
        if (!number) return wrong_type(p, node);
        return Value(*number);
      }
      case ParameterType::text:
      case ParameterType::word:
        if (node.kind != Kind::string) return wrong_type(p, node);
        return Value(node.text);
      case ParameterType::words:
        return converted_words(p, node);
      case ParameterType::vector:
        return converted_vector(p, node);
      case ParameterType::counts:
        return converted_counts(p, node);
      case ParameterType::pinned:
        return converted_pinned(p, node);
    }
    return std::nullopt;
  }

  std::optional<Value> converted_words(const Parameter& p, const Node& node) {
    if (node.kind != Kind::array) return wrong_type(p, node);
    std::vector<std::string> words;
    for (const Node& element : node.elements) {
      if (element.kind != Kind::string) return wrong_type(p, element);
      words.push_back(element.text);
    }
    return Value(words);
  }

  /// Whether the node is an array of three, and a problem if it is not.
  bool has_three(const Parameter& p, const Node& node) {
    if (node.kind != Kind::array) {
      wrong_type(p, node);
      return false;
    }
    if (node.elements.size() == 3) return true;
    problems_.push_back({node.position, fmt::format("'{}' must be {}, not {} of them", key_text(p),
                                                    allowed_text(p), node.elements.size())});
    return false;
  }

  std::optional<Value> converted_counts(const Parameter& p, const Node& node) {
    if (!has_three(p, node)) return std::nullopt;
    std::array<int, 3> counts = {};
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const Node& element = node.elements[i];
      if (element.kind != Kind::integer) return wrong_type(p, element);
      // Far numbers are out of every range: the nearest int says so as well.
      counts[i] = static_cast<int>(std::clamp<std::int64_t>(element.integer, -2147483647, 2147483647));
    }
    return Value(counts);
  }

  std::optional<Value> converted_vector(const Parameter& p, const Node& node) {
    if (!has_three(p, node)) return std::nullopt;
    Vec3 v;
    for (int axis = 0; axis < 3; ++axis) {
      const Node& element = node.elements[static_cast<std::size_t>(axis)];
      const auto number = number_of(element);
      if (!number) return wrong_type(p, element);
      v[axis] = *number;
    }
    return Value(v);
  }

  std::optional<Value> converted_pinned(const Parameter& p, const Node& node) {
    if (node.kind != Kind::array) return wrong_type(p, node);
    PinnedSettings pinned;
    for (const Node& element : node.elements) {
      if (element.kind == Kind::string) {
        pinned.names.push_back(element.text);
      } else if (element.kind != Kind::integer) {
        return wrong_type(p, element);
      } else if (element.integer >= 0 && element.integer <= std::int64_t{0xffffffff}) {
        pinned.indices.push_back(static_cast<std::uint32_t>(element.integer));
      }
      // Other integers are past every cube's end; scene_checks says so for all of them.
    }
    return Value(pinned);
  }

  std::vector<Problem>& problems_;
  Scene scene_;
};

}  // namespace

Scene read(const Node& root, std::optional<std::uint64_t> memory_bytes, std::vector<Problem>& problems) {
  Scene scene = Reader(problems).read(root);
  check_whole_scene(root, scene, memory_bytes, problems);
  return scene;
}

}  // namespace aspic::reader
