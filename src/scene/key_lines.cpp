#include "scene/key_lines.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <vector>

#include "base/printable.h"
#include "model/bodies.h"
#include "scene/parameters.h"
#include "scene/scene_checks.h"
#include "scene/short_keys.h"
#include "scene/write.h"

namespace aspic {
namespace {

template <class T>
std::optional<T> number_in(std::string_view text) {
  T number = {};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// Names in quotation marks, without escapes: those of the table have none.
std::optional<std::string> word_in(std::string_view text) {
  if (text.size() < 2 || text.front() != '"' || text.back() != '"') return std::nullopt;
  text = text.substr(1, text.size() - 2);
  if (text.find_first_of("\"\\") != std::string_view::npos) return std::nullopt;
  return std::string(text);
}

/// The elements of `[a, b]`.
std::optional<std::vector<std::string_view>> elements_of(std::string_view text) {
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') return std::nullopt;
  text = text.substr(1, text.size() - 2);
  std::vector<std::string_view> elements;
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    elements.push_back(text.substr(0, comma));
    text = comma == std::string_view::npos ? "" : text.substr(comma + 1);
    while (text.starts_with(' ')) text.remove_prefix(1);
  }
  return elements;
}

template <class T>
std::optional<std::vector<T>> numbers_in(std::string_view text, std::optional<std::size_t> count) {
  const auto elements = elements_of(text);
  if (!elements || (count && elements->size() != *count)) return std::nullopt;
  std::vector<T> numbers;
  for (const std::string_view element : *elements) {
    const auto number = number_in<T>(element);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<Value> pinned_in(std::string_view text) {
  const auto elements = elements_of(text);
  if (!elements) return std::nullopt;
  PinnedSettings pinned;
  for (const std::string_view element : *elements) {
    const auto name = word_in(element);
    const auto index = number_in<std::int64_t>(element);
    if (!name && !index) return std::nullopt;
    if (name)
      pinned.names.push_back(*name);
    else
      pinned.indices.push_back(*index);
  }
  return Value(pinned);
}

/// Takes a text in quotation marks, without escapes, from the front.
std::optional<std::string> take_quoted(std::string_view& text) {
  const std::size_t end = text.find('"', 1);
  if (!text.starts_with('"') || end == std::string_view::npos) return std::nullopt;
  auto word = word_in(text.substr(0, end + 1));
  text.remove_prefix(end + 1);
  return word;
}

/// Takes what a list goes on with, or its end; nothing: it is neither.
std::optional<bool> take_end(std::string_view& text, char end) {
  if (text.starts_with(", ")) return text.remove_prefix(2), false;
  if (text.starts_with(end)) return text.remove_prefix(1), true;
  return std::nullopt;
}

std::optional<Value> layers_in(std::string_view text) {
  CellLayers layers;
  if (!text.starts_with("[[")) return std::nullopt;
  text.remove_prefix(1);
  for (std::optional<bool> last = false; !*last;) {
    if (!text.starts_with('[')) return std::nullopt;
    text.remove_prefix(1);
    layers.emplace_back();
    for (std::optional<bool> end = false; !*end;) {
      const auto row = take_quoted(text);
      if (!row || !(end = take_end(text, ']'))) return std::nullopt;
      layers.back().push_back(*row);
    }
    if (!(last = take_end(text, ']'))) return std::nullopt;
  }
  return text.empty() ? std::optional<Value>(layers) : std::nullopt;
}

std::optional<Value> palette_in(std::string_view text) {
  CellPalette palette;
  if (text == "{}") return Value(palette);
  if (!text.starts_with("{ ") || !text.ends_with(" }")) return std::nullopt;
  text = text.substr(2, text.size() - 4);
  while (!text.empty()) {
    const std::size_t equals = text.find(" = ", 1);
    if (equals == std::string_view::npos) return std::nullopt;
    const std::string_view cell = text.substr(0, equals);
    const auto quoted = word_in(cell);
    text.remove_prefix(equals + 3);
    const auto name = take_quoted(text);
    if (!name) return std::nullopt;
    palette[quoted ? *quoted : std::string(cell)] = *name;
    if (text.starts_with(", ")) text.remove_prefix(2);
  }
  return Value(palette);
}

std::optional<std::vector<std::string>> words_in(std::string_view text) {
  const auto elements = elements_of(text);
  if (!elements) return std::nullopt;
  std::vector<std::string> words;
  for (const std::string_view element : *elements) {
    auto word = word_in(element);
    if (!word) return std::nullopt;
    words.push_back(*std::move(word));
  }
  return words;
}

std::optional<Value> points_in(std::string_view text) {
  SignalTable points;
  if (!text.starts_with('[') || !text.ends_with(']')) return std::nullopt;
  text = text.substr(1, text.size() - 2);
  while (!text.empty()) {
    const std::size_t end = text.find(']');
    const auto point =
        end == std::string_view::npos ? std::nullopt : numbers_in<double>(text.substr(0, end + 1), 2);
    if (!point) return std::nullopt;
    points.push_back({(*point)[0], (*point)[1]});
    text.remove_prefix(end + 1);
    if (text.starts_with(", ")) text.remove_prefix(2);
  }
  return Value(points);
}

template <class T>
std::optional<Value> value_or_none(const std::optional<T>& found) {
  return found ? std::optional<Value>(*found) : std::nullopt;
}

/// What toml_value() wrote; nothing if it is no value of the parameter's type.
std::optional<Value> value_in(const Parameter& p, std::string_view text) {
  switch (p.type) {
    case ParameterType::boolean:
      return text == "true" || text == "false" ? std::optional(Value(text == "true")) : std::nullopt;
    case ParameterType::integer:
      return value_or_none(number_in<std::int64_t>(text));
    case ParameterType::number:
      return value_or_none(number_in<double>(text));
    case ParameterType::word:
    case ParameterType::text:
      return value_or_none(word_in(text));
    case ParameterType::vector: {
      const auto numbers = numbers_in<double>(text, 3);
      if (!numbers) return std::nullopt;
      return Value(Vec3{(*numbers)[0], (*numbers)[1], (*numbers)[2]});
    }
    case ParameterType::counts:
      return value_or_none(numbers_in<int>(text, p.components));
    case ParameterType::numbers:
      return value_or_none(numbers_in<double>(text, p.components));
    case ParameterType::pinned:
      return pinned_in(text);
    case ParameterType::layers:
      return layers_in(text);
    case ParameterType::palette:
      return palette_in(text);
    case ParameterType::words:
    case ParameterType::names:
      return value_or_none(words_in(text));
    case ParameterType::points:
      return points_in(text);
  }
  return std::nullopt;
}

Status set_line(Scene& scene, std::string_view line) {
  const std::size_t equals = line.find('=');
  const auto place = equals == std::string_view::npos ? std::nullopt : place_of(line.substr(0, equals));
  if (!place || place->path != place->parameter->path)
    return fail(ErrorCode::scene_rejected, "{} names no key.", excerpt(line, 60));
  const Parameter* const p = place->parameter;
  const auto value = value_in(*p, line.substr(equals + 1));
  if (!value)
    return fail(ErrorCode::scene_rejected, "{}: allowed is {}.", excerpt(line, 60), allowed_text(*p));
  if (const auto complaint = check_value(*p, *value))
    return fail(ErrorCode::scene_rejected, "{}.", complaint->message);
  for (const SettingsList& list : settings_lists())
    if (p->section() == fmt::format("{}[]", list.key) && place->index == list.size(scene.model))
      list.append(scene.model);
  if (place->index >= index_count(*p, scene))
    return fail(ErrorCode::scene_rejected, "{} names an element that the scene does not have.",
                excerpt(line, 60));
  p->set(scene, place->index, *value);
  return {};
}

}  // namespace

std::string to_key_lines(const Scene& scene) {
  std::string text;
  for (const Parameter& p : parameters()) {
    if (p.only_shown() || p.path == "schema") continue;
    for (std::size_t i = 0; i < index_count(p, scene); ++i)
      if (const auto value = p.get(scene, i))
        text += fmt::format("{}={}\n", path_text(p.path, i), toml_value(*value));
  }
  return text;
}

Result<Scene> with_key_lines(Scene scene, std::string_view lines) {
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    ASPIC_CHECK(set_line(scene, lines.substr(0, end)));
    lines = end == std::string_view::npos ? "" : lines.substr(end + 1);
  }
  if (const auto complaints = check_scene(scene); !complaints.empty())
    return fail(ErrorCode::scene_rejected, "{}.", complaints.front().message);
  return scene;
}

}  // namespace aspic
