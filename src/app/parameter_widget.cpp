#include "app/parameter_widget.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/app.h"
#include "app/shortcuts.h"

namespace aspic::app {
namespace {

/// Share of a panel's width that labels take.
constexpr float label_share = 0.40f;
constexpr ImGuiSliderFlags as_typed = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat;

std::string words_of(std::string_view path) {
  std::string words(path.substr(path.rfind('.') + 1));
  std::ranges::replace(words, '-', ' ');
  if (!words.empty() && words[0] >= 'a' && words[0] <= 'z')
    words[0] = static_cast<char>(words[0] - 'a' + 'A');
  return words;
}

std::string key_with_index(const Parameter& p, std::size_t index) {
  std::string key(p.path);
  if (const std::size_t at = key.find("[]"); at != std::string::npos)
    key.replace(at, 2, fmt::format("[{}]", index));
  return key;
}

/// How fast a drag changes a number: by a two-hundredth of what it is for each window unit.
float drag_speed(double value, const Parameter& p) {
  const bool bounded = std::isfinite(p.range.max) && p.range.max - p.range.min <= 1000.0;
  const double floor = bounded && p.range.max <= 1.0 ? 1e-5 : 1e-3;
  return static_cast<float>(std::max(std::abs(value) / 200.0, floor));
}

const char* number_format(double value) {
  return std::abs(value) < 1e-3 && value != 0.0 ? "%.4g" : "%.6g";
}

bool is_fraction(const Parameter& p) {
  return p.range.min == 0.0 && p.range.max == 1.0 && !p.range.min_excluded;
}

std::string format_with_unit(const Parameter& p, double value) {
  return p.unit.empty() ? number_format(value) : fmt::format("{} {}", number_format(value), p.unit);
}

std::optional<Value> number_widget(const Parameter& p, double value) {
  bool changed = false;
  if (is_fraction(p)) {
    const double low = p.range.min, high = p.range.max;
    changed = ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &low, &high, "%.3g", as_typed);
  } else {
    const double low = std::max(p.range.min, -1e12), high = std::min(p.range.max, 1e12);
    changed = ImGui::DragScalar("##value", ImGuiDataType_Double, &value, drag_speed(value, p), &low, &high,
                                format_with_unit(p, value).c_str(), as_typed);
  }
  // A drag that runs into an open end stops there instead of complaining.
  if (!changed || (p.range.min_excluded && value <= p.range.min)) return std::nullopt;
  return Value(value);
}

std::optional<Value> integer_widget(const Parameter& p, std::int64_t value) {
  const auto low = static_cast<std::int64_t>(p.range.min), high = static_cast<std::int64_t>(p.range.max);
  const std::int64_t one = 1, ten = 10;
  if (!ImGui::InputScalar("##value", ImGuiDataType_S64, &value, &one, &ten, "%lld",
                          ImGuiInputTextFlags_EnterReturnsTrue))
    return std::nullopt;
  return Value(std::clamp(value, low, high));
}

std::optional<Value> vector_widget(const Parameter& p, const Vec3& value) {
  std::array<double, 3> v = {value.x, value.y, value.z};
  const double low = p.range.min, high = p.range.max;
  const double size = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2]), 2.0});
  if (!ImGui::DragScalarN("##value", ImGuiDataType_Double, v.data(), 3, static_cast<float>(size / 200.0),
                          &low, &high, "%.4g", as_typed))
    return std::nullopt;
  return Value(Vec3{v[0], v[1], v[2]});
}

std::optional<Value> counts_widget(const Parameter& p, std::array<int, 3> value) {
  if (!ImGui::InputInt3("##value", value.data(), ImGuiInputTextFlags_EnterReturnsTrue)) return std::nullopt;
  for (int& n : value) n = std::clamp(n, static_cast<int>(p.range.min), static_cast<int>(p.range.max));
  return Value(value);
}

std::optional<Value> word_widget(Gui& gui, const Parameter& p, const std::string& value,
                                 const std::string& mark) {
  std::optional<Value> chosen;
  const bool open = ImGui::BeginCombo("##value", value.c_str());
  if (!open) return chosen;
  for (const std::string_view word : p.words) {
    const std::string text(word);
    if (ImGui::Selectable(text.c_str(), text == value)) chosen = Value(text);
    gui.mark(mark + "/" + text);
  }
  ImGui::EndCombo();
  return chosen;
}

std::optional<Value> words_widget(Gui& gui, const Parameter& p, std::vector<std::string> value,
                                  const std::string& mark) {
  std::optional<Value> chosen;
  int column = 0;
  for (const std::string_view word : p.words) {
    if (column++ % 2 != 0) ImGui::SameLine(ImGui::GetWindowContentRegionMax().x * 0.52f);
    bool on = std::ranges::find(value, word) != value.end();
    const bool toggled = ImGui::Checkbox(std::string(word).c_str(), &on);
    gui.mark(mark + "/" + std::string(word));
    if (!toggled) continue;
    if (on)
      value.emplace_back(word);
    else
      std::erase(value, word);
    chosen = Value(value);
  }
  return chosen;
}

/// Faces by name; corners and indices that the file gives stay as they are.
std::optional<Value> pinned_widget(Gui& gui, PinnedSettings value, const std::string& mark) {
  std::optional<Value> chosen;
  int column = 0;
  for (const char* face : {"top", "bottom", "left", "right", "front", "back"}) {
    if (column++ % 2 != 0) ImGui::SameLine(ImGui::GetWindowContentRegionMax().x * 0.52f);
    bool on = std::ranges::find(value.names, face) != value.names.end();
    const bool toggled = ImGui::Checkbox(face, &on);
    gui.mark(mark + "/" + face);
    if (!toggled) continue;
    if (on)
      value.names.emplace_back(face);
    else
      std::erase(value.names, face);
    chosen = Value(value);
  }
  return chosen;
}

}  // namespace

std::string tooltip_of(const Parameter& p, std::size_t index) {
  std::string text = fmt::format("{}\n\nAllowed: {}", p.meaning, allowed_text(p));
  const std::string by_default = default_text(p);
  if (!by_default.empty()) text += fmt::format("\nDefault: {}", by_default);
  text += fmt::format("\nScene key: {}", key_with_index(p, index));
  if (!p.live) text += "\nA change starts the simulation anew.";
  if (p.type == ParameterType::number || p.type == ParameterType::vector)
    text += "\nDrag to change, Ctrl+click to type.";
  return text;
}

void wrapped_text(std::string_view text, float width) {
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    std::size_t end = 0;
    while (end < line.size()) {
      const std::size_t next = std::min(line.find(' ', end + 1), line.size());
      if (end > 0 && ImGui::CalcTextSize(line.data(), line.data() + next).x > width) break;
      end = next;
    }
    ImGui::TextUnformatted(line.data(), line.data() + end);
    text.remove_prefix(end);
    if (!text.empty()) text.remove_prefix(1);
  }
}

void tooltip(std::string_view text, std::string_view shortcut_meaning) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  wrapped_text(text, ImGui::GetFontSize() * 26.0f);
  if (const std::string keys(keys_of(shortcut_meaning)); !keys.empty())
    ImGui::TextDisabled("Key: %s", keys.c_str());
  ImGui::EndTooltip();
}

void label_column(std::string_view label) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(label.data(), label.data() + label.size());
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x * label_share);
  ImGui::SetNextItemWidth(-1.0f);
}

bool button(Gui& gui, const char* name, const char* label, std::string_view help,
            std::string_view shortcut_meaning, bool enabled, float width) {
  ImGui::PushID(name);
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(label, {width, 0.0f});
  ImGui::EndDisabled();
  gui.mark(name);
  tooltip(help, shortcut_meaning);
  ImGui::PopID();
  return pressed;
}

std::optional<WidgetChange> parameter_widget(Gui& gui, const Parameter& p, const Scene& scene,
                                             std::size_t index, std::string_view label) {
  const auto value = p.get(scene, index);
  if (!value) return std::nullopt;
  const std::string key = key_with_index(p, index);
  const std::string words = label.empty() ? words_of(p.path) : std::string(label);
  ImGui::PushID(key.c_str());
  const bool many = p.type == ParameterType::words || p.type == ParameterType::pinned;
  if (many) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(words.c_str());
  } else {
    label_column(words);
  }
  if (many) tooltip(tooltip_of(p, index));
  std::optional<Value> changed;
  switch (p.type) {
    case ParameterType::boolean: {
      bool on = std::get<bool>(*value);
      if (ImGui::Checkbox("##value", &on)) changed = Value(on);
      break;
    }
    case ParameterType::integer:
      changed = integer_widget(p, std::get<std::int64_t>(*value));
      break;
    case ParameterType::number:
      changed = number_widget(p, std::get<double>(*value));
      break;
    case ParameterType::vector:
      changed = vector_widget(p, std::get<Vec3>(*value));
      break;
    case ParameterType::counts:
      changed = counts_widget(p, std::get<std::array<int, 3>>(*value));
      break;
    case ParameterType::word:
      changed = word_widget(gui, p, std::get<std::string>(*value), key);
      break;
    case ParameterType::words:
      changed = words_widget(gui, p, std::get<std::vector<std::string>>(*value), key);
      break;
    case ParameterType::pinned:
      changed = pinned_widget(gui, std::get<PinnedSettings>(*value), key);
      break;
    case ParameterType::text:
      ImGui::TextUnformatted(std::get<std::string>(*value).c_str());
      break;
  }
  if (!many && !(p.type == ParameterType::word && changed)) gui.mark(key);
  if (!many) tooltip(tooltip_of(p, index));
  ImGui::PopID();
  if (!changed) return std::nullopt;
  const bool continuous = p.type == ParameterType::number || p.type == ParameterType::vector;
  return WidgetChange{std::move(*changed), continuous ? key : ""};
}

void edit(App& app, std::string_view path, std::size_t index, std::string_view label) {
  const Parameter& p = *find_parameter(path);
  if (const auto change = parameter_widget(app.gui(), p, app.editor().scene(), index, label))
    app.set_value(p, index, change->value, change->gesture);
}

}  // namespace aspic::app
