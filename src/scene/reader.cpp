#include "scene/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/bodies.h"

namespace aspic::reader {
namespace {

using document::position_of;

/// A value in its parameter's type, or the node that is of another type and its fault.
struct WrongType {
  const toml::node* culprit;
  std::string message;
};
using Converted = std::variant<Value, WrongType>;

std::optional<double> number_of(const toml::node& node) {
  if (const auto* x = node.as_floating_point()) return x->get();
  if (const auto* x = node.as_integer()) return static_cast<double>(x->get());
  return std::nullopt;
}

/// What was found in place of the parameter's type. 1e1 has no decimal point, and is no whole number all the
/// same.
std::string found_text(const Parameter& p, const toml::node& node) {
  const auto* number = node.as_floating_point();
  if (!number) return std::string(document::kind_text(node));
  if (!std::isfinite(number->get())) return fmt::format("{}", number->get());
  const bool whole = p.type == ParameterType::integer || p.type == ParameterType::counts;
  return whole ? "a number with a decimal point or an exponent" : "a number";
}

WrongType wrong_type(const Parameter& p, const toml::node& culprit) {
  return {&culprit,
          fmt::format("'{}' must be {}, not {}", key_text(p), allowed_text(p), found_text(p, culprit))};
}

/// An array whose elements `take` takes into `result`, or refuses with false.
template <class T, class Take>
Converted gathered(const Parameter& p, const toml::array& array, T result, const Take& take) {
  for (const toml::node& element : array)
    if (!take(result, element)) return wrong_type(p, element);
  return Value(std::move(result));
}

bool take_word(std::vector<std::string>& words, const toml::node& element) {
  if (const auto* word = element.as_string()) return words.push_back(word->get()), true;
  return false;
}

bool take_number(std::vector<double>& numbers, const toml::node& element) {
  if (const auto number = number_of(element)) return numbers.push_back(*number), true;
  return false;
}

bool take_count(std::vector<int>& counts, const toml::node& element) {
  const auto* count = element.as_integer();
  // Far numbers are out of every range: the nearest int says so as well.
  if (count)
    counts.push_back(static_cast<int>(std::clamp<std::int64_t>(count->get(), -2147483647, 2147483647)));
  return count != nullptr;
}

bool take_pinned(PinnedSettings& pinned, const toml::node& element) {
  const auto* index = element.as_integer();
  if (index) pinned.indices.push_back(index->get());
  return index || take_word(pinned.names, element);
}

bool take_layer(CellLayers& layers, const toml::node& element) {
  const toml::array* const rows = element.as_array();
  if (!rows) return false;
  auto& layer = layers.emplace_back();
  for (const toml::node& row : *rows)
    if (!take_word(layer, row)) return false;
  return true;
}

bool take_point(SignalTable& points, const toml::node& element) {
  const toml::array* const pair = element.as_array();
  if (!pair || pair->size() != 2) return false;
  const auto t = number_of((*pair)[0]), w = number_of((*pair)[1]);
  if (t && w) points.push_back({*t, *w});
  return t && w;
}

Converted palette_of(const Parameter& p, const toml::table& table) {
  CellPalette palette;
  for (const auto& [cell, name] : table) {
    if (!name.is_string()) return wrong_type(p, name);
    palette[std::string(cell.str())] = name.as_string()->get();
  }
  return Value(std::move(palette));
}

Converted converted(const Parameter& p, const toml::node& node) {
  const toml::array* array = node.as_array();
  switch (p.type) {
    case ParameterType::boolean:
      if (const auto* x = node.as_boolean()) return Value(x->get());
      break;
    case ParameterType::integer:
      if (const auto* x = node.as_integer()) return Value(x->get());
      break;
    case ParameterType::number:
      if (const auto x = number_of(node)) return Value(*x);
      break;
    case ParameterType::text:
    case ParameterType::word:
      if (const auto* x = node.as_string()) return Value(std::string(present_word(p.path, x->get())));
      break;
    case ParameterType::words:
      if (array) return gathered(p, *array, std::vector<std::string>(), take_word);
      break;
    case ParameterType::pinned:
      if (array) return gathered(p, *array, PinnedSettings(), take_pinned);
      break;
    case ParameterType::layers:
      if (array) return gathered(p, *array, CellLayers(), take_layer);
      break;
    case ParameterType::palette:
      if (const auto* const table = node.as_table()) return palette_of(p, *table);
      break;
    case ParameterType::names:
      if (const auto* x = node.as_string()) return Value(std::vector<std::string>{x->get()});
      if (array) return gathered(p, *array, std::vector<std::string>(), take_word);
      break;
    case ParameterType::points:
      if (array) return gathered(p, *array, SignalTable(), take_point);
      break;
    case ParameterType::vector:
    case ParameterType::counts:
    case ParameterType::numbers: {
      if (!array) break;
      if (array->size() != p.components) {
        return WrongType{&node, fmt::format("'{}' must be {}, not {} of them", key_text(p), allowed_text(p),
                                            array->size())};
      }
      if (p.type == ParameterType::counts) return gathered(p, *array, std::vector<int>(), take_count);
      Converted numbers = gathered(p, *array, std::vector<double>(), take_number);
      if (p.type == ParameterType::numbers || !std::holds_alternative<Value>(numbers)) return numbers;
      const auto& xyz = std::get<std::vector<double>>(std::get<Value>(numbers));
      return Value(Vec3{xyz[0], xyz[1], xyz[2]});
    }
  }
  return wrong_type(p, node);
}

std::vector<Position> elements_of(const toml::node& node, std::uint32_t source) {
  std::vector<Position> elements;
  const toml::array* array = node.as_array();
  for (const bool strings : {true, false}) {
    for (std::size_t i = 0; array && i < array->size(); ++i) {
      if ((*array)[i].is_string() == strings) elements.push_back(position_of((*array)[i].source(), source));
    }
  }
  return elements;
}

std::string both_names(const FormerKey& former) {
  std::vector<std::string> successors;
  for (const std::string_view path : former.successors) successors.push_back(key_text(*find_parameter(path)));
  const std::string_view key = former.path.substr(former.path.find('.') + 1);
  return fmt::format("'{}' is the former name of {}, and both are given; remove '{}'", key,
                     fmt::join(successors, " and "), key);
}

/// A legal value of a key of terrain geometry.
Value some_geometry(const Parameter& p) {
  return p.type == ParameterType::number ? Value(1.0) : Value(Vec3{0.0, 1.0, 0.0});
}

}  // namespace

void Reader::read_table(const toml::table& table, std::string_view path, std::size_t index,
                        std::uint32_t source) {
  for (const auto& [key, value] : table)
    read_member(path, index, key.str(), position_of(key.source(), source), value, source);
}

void Reader::read_member(std::string_view path, std::size_t index, std::string_view key, const Position& at,
                         const toml::node& value, std::uint32_t source, const FormerKey* former) {
  const std::string child = fmt::format("{}{}{}", path, path.empty() ? "" : ".", key);
  // A key with brackets or dots inside quotes must not be taken for a path.
  const bool plain = key.find_first_of("[].") == std::string::npos && !key.empty();
  if (!plain) return fail(at, diagnostics::unknown_key(path, key));
  if (const FormerKey* const row = find_former_key(child)) {
    for (const std::string_view successor : row->successors) {
      read_member(path, index, successor.substr(path.size() + 1), at, value, source, row);
      if (written_.at(path_text(successor, index)).problem) return;
    }
    return;
  }
  const PathKind kind = path_kind(child);
  if (child == "actuator[].phase" && (value.is_number() || value.is_string())) {
    // A number, or a file of one for each cell, in the place of the table.
    forget(path_text(child, index));
    scene_.model.actuators[index].phase = {};
    return read_member(child, index, value.is_number() ? "offset" : "file", at, value, source);
  }
  if (child == "actuator[].select.voxels" && value.is_string())
    return read_member(path, index, "file", at, value, source);
  Written here = {at, position_of(value.source(), source), elements_of(value, source), {}, former};
  if (kind == PathKind::unknown) here.problem = {at, diagnostics::unknown_key(path, key)};
  // A value takes the place of a table and all its keys.
  if (kind == PathKind::table && !value.is_table()) forget(path_text(child, index));
  const auto [entry, fresh] = written_.try_emplace(path_text(child, index), here);
  Written& written = entry->second;
  // An argument may replace what the file has by another name.
  if (!fresh && written.former != former && (written.key.source == 0) == (source == 0)) {
    written.problem = {at, both_names(former ? *former : *written.former)};
    return;
  }
  // A table adds its keys to one that is there already; anything else replaces it.
  if (!fresh && (kind != PathKind::table || !value.is_table() || written.problem)) written = std::move(here);
  if (kind == PathKind::unknown) return;
  if (kind == PathKind::parameter) {
    read_parameter(*find_parameter(child), value, index, written);
  } else if (kind == PathKind::list) {
    read_list(value, child, written, source);
  } else if (value.is_string() && path_kind(child + ".name") == PathKind::parameter) {
    // A material's name in the place of its table.
    read_member(child, index, "name", at, value, source);
  } else if (!value.is_table()) {
    const std::vector<std::string_view> keys = child_keys(child);
    written.problem = {written.value,
                       fmt::format("'{}' must be a table with the keys {}, not {}", key,
                                   diagnostics::list_text(keys, false), document::kind_text(value))};
  } else {
    // Even an empty `material = {}` makes the body one of a material.
    auto* const material = child.ends_with(".material") ? material_place(scene_.model, path, index) : nullptr;
    if (material && !*material) material->emplace();
    if (child == "terrain[].motion" && !scene_.model.terrain[index].motion)
      scene_.model.terrain[index].motion.emplace();
    read_table(*value.as_table(), child, index, source);
  }
}

/// Elements of a list whose names are the keys of one table.
void Reader::read_named(const toml::table& table, std::string_view path, std::uint32_t source) {
  const SettingsList& list = *std::ranges::find(settings_lists(), path, &SettingsList::key);
  for (const auto& [name, element] : table) {
    const std::size_t index = list.size(scene_.model);
    const std::string section = fmt::format("{}[]", path);
    list.append(scene_.model);
    const Position at = position_of(name.source(), source);
    Written& here = written_[path_text(section, index)] = {at, position_of(element.source(), source), {}, {}};
    find_parameter(section + ".name")->set(scene_, index, Value(std::string(name.str())));
    if (const auto* const keys = element.as_table())
      read_table(*keys, section, index, source);
    else
      here.problem = {here.value, fmt::format("'{}.{}' must be a table with the keys {}, not {}", path,
                                              name.str(), diagnostics::list_text(child_keys(section), false),
                                              document::kind_text(element))};
  }
}

void Reader::read_list(const toml::node& value, std::string_view path, Written& written,
                       std::uint32_t source) {
  const SettingsList& list = *std::ranges::find(settings_lists(), path, &SettingsList::key);
  const auto wrong = [&](const toml::node& culprit) {
    return Problem{position_of(culprit.source(), source),
                   fmt::format("'{}' must be a list of tables: write [[{}]], not {}", path, path,
                               document::kind_text(culprit))};
  };
  if (path == "material" && value.is_table()) return read_named(*value.as_table(), path, source);
  if (!value.is_array()) {
    written.problem = wrong(value);
    list.append(scene_.model);  // something was meant: the scene is not empty
    return;
  }
  for (const toml::node& element : *value.as_array()) {
    // One entry in the scene for each element, right or wrong, so that indices stay those of the file.
    const std::size_t index = list.size(scene_.model);
    list.append(scene_.model);
    const Position at = position_of(element.source(), source);
    Written& here = written_[fmt::format("{}[{}]", path, index)] = {at, at, {}, {}};
    if (const auto* table = element.as_table()) {
      read_table(*table, fmt::format("{}[]", path), index, source);
    } else {
      here.problem = wrong(element);
    }
  }
}

void Reader::read_parameter(const Parameter& p, const toml::node& node, std::size_t index, Written& written) {
  const Converted result = converted(p, node);
  if (const auto* wrong = std::get_if<WrongType>(&result)) {
    written.problem = {position_of(wrong->culprit->source(), written.value.source), wrong->message};
    // One number for three, or three for one.
    if (p.belonging == Belonging::box && node.is_integer())
      written.problem->message += "; did you mean 'particles-per-edge'?";
    if (p.belonging == Belonging::equal_edges && node.is_array())
      written.problem->message += "; did you mean 'particles'?";
  } else {
    const Value& value = std::get<Value>(result);
    // Pinned particles are checked with the size of their body.
    const auto complaint = p.type == ParameterType::pinned ? std::nullopt : check_value(p, value);
    if (complaint) {
      written.problem = {complaint->element ? written.elements[*complaint->element] : written.value,
                         complaint->message};
    } else {
      p.set(scene_, index, value);
      if (is_cell_source(p.path) || is_actuator_source(p.path))
        cell_sources_[path_text(p.path, index)] = value;
    }
  }
  // What was written wrong was written: a shape that has no such key complains about that too.
  if (written.problem && p.belonging == Belonging::geometry) p.set(scene_, index, some_geometry(p));
}

void Reader::enter(std::string_view path, std::size_t index, const Position& at) {
  written_.try_emplace(path_text(path, index), Written{at, at, {}, {}});
}

void Reader::forget(const std::string& path) {
  for (const std::string& gone : written_in(path)) written_.erase(gone);
}

void Reader::prefer_argument(const std::string& path, const std::string& other) {
  const auto chosen = written_.find(path), old = written_.find(other);
  if (chosen == written_.end() || old == written_.end()) return;
  if (chosen->second.key.source > 0 && old->second.key.source == 0) forget(other);
}

std::vector<std::string> Reader::written_in(const std::string& path) const {
  std::vector<std::string> paths;
  for (auto at = written_.lower_bound(path); at != written_.end() && at->first.starts_with(path); ++at) {
    const bool here = at->first.size() == path.size();
    if (here || at->first[path.size()] == '.' || at->first[path.size()] == '[') paths.push_back(at->first);
  }
  return paths;
}

void Reader::blame(const std::string& path, std::string message) {
  Written& written = written_.at(path);
  written.problem = {written.value, std::move(message)};
}

bool Reader::has_problem(const std::string& path) const {
  return !path.empty() && std::ranges::any_of(written_in(path), [&](const std::string& entry) {
    return written_.at(entry).problem.has_value();
  });
}

Problem Reader::located(const SceneComplaint& complaint) const {
  const auto at = [&](std::string_view path) {
    const auto entry = written_.find(std::string(path));
    return entry == written_.end() ? nullptr : &entry->second;
  };
  if (const Written* here = at(complaint.path)) {
    const Position& whole = complaint.of_key ? here->key : here->value;
    const bool element = complaint.element && *complaint.element < here->elements.size();
    return {element ? here->elements[*complaint.element] : whole, complaint.message};
  }
  if (const Written* other = at(complaint.other)) return {other->value, complaint.message};
  // A default is to blame: the nearest table around it, or the scene.
  for (std::string_view path = complaint.path; !path.empty();) {
    const std::size_t end = path.find_last_of(".[");
    path = path.substr(0, end == std::string_view::npos ? 0 : end);
    if (const Written* around = at(path)) return {around->value, complaint.message};
  }
  if (has_text_ || complaint.path.empty()) return {{}, complaint.message};
  return {{}, fmt::format("{}: {}", complaint.path, complaint.message)};
}

}  // namespace aspic::reader
