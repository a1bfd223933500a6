#include "app/parameter_widget.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <variant>

namespace aspic::app {
namespace {

/// Share of a panel's width that labels take.
constexpr float label_share = 0.40f, longest_label = 0.6f;
constexpr ImGuiSliderFlags as_typed = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat;

/// How fast a drag changes a number for each window unit: lengths by a centimetre, angles by half a degree,
/// others by a two-hundredth of what they are, or of their default if that is more: a drag begins at 0 too.
float drag_speed(double value, const Parameter& p) {
  if (p.unit == "m") return 0.01f;
  if (p.unit == "°" || p.unit == "degrees") return 0.5f;
  const bool bounded = std::isfinite(p.range.max) && p.range.max - p.range.min <= 1000.0;
  const double floor = bounded && p.range.max <= 1.0 ? 1e-5 : 1e-3;
  const double usual = std::abs(std::strtod(default_text(p).c_str(), nullptr));
  return static_cast<float>(std::max(std::max(std::abs(value), usual) / 200.0, floor));
}

bool is_dragged(const Parameter& p) {
  return p.type == ParameterType::number || p.type == ParameterType::vector ||
         p.type == ParameterType::numbers;
}

std::string format_with_unit(const Parameter& p, double value) {
  const char* const format = std::abs(value) < 1e-3 && value != 0.0 ? "%.4g" : "%.6g";
  return p.unit.empty() ? format : fmt::format("{} {}", format, p.unit);
}

/// The ground of the slider to come, filled up to its knob at `share` of the way: it shows how far it goes,
/// which a number that is dragged does not.
class SliderTrack {
 public:
  explicit SliderTrack(double share) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size = {ImGui::CalcItemWidth(), ImGui::GetFrameHeight()};
    const float rounding = ImGui::GetStyle().FrameRounding;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg),
                       rounding);
    const float end = size.x * static_cast<float>(std::clamp(share, 0.0, 1.0));
    draw.AddRectFilled(corner, {corner.x + end, corner.y + size.y},
                       ImGui::GetColorU32(ImGuiCol_SliderGrab, 0.45f), rounding);
    for (const ImGuiCol colour : {ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive})
      ImGui::PushStyleColor(colour, ImVec4(1.0f, 1.0f, 1.0f, colour == ImGuiCol_FrameBg ? 0.0f : 0.05f));
  }
  ~SliderTrack() { ImGui::PopStyleColor(3); }
  SliderTrack(const SliderTrack&) = delete;
  SliderTrack& operator=(const SliderTrack&) = delete;
};

/// What a widget of a value needs; the overloads of `widget` return the value if it was changed.
struct Field {
  Gui& gui;
  const Parameter& parameter;
  std::string key, help;
};

std::optional<Value> widget(const Field&, bool on) {
  return ImGui::Checkbox("##value", &on) ? std::optional<Value>(on) : std::nullopt;
}

std::optional<Value> widget(const Field& f, double value) {
  const Parameter& p = f.parameter;
  bool changed = false;
  if (p.range.min == 0.0 && p.range.max == 1.0 && !p.range.min_excluded) {
    const double low = p.range.min, high = p.range.max;
    const SliderTrack track(value);
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

std::optional<Value> widget(const Field& f, std::int64_t value) {
  const Range& range = f.parameter.range;
  const auto low = static_cast<std::int64_t>(range.min), high = static_cast<std::int64_t>(range.max);
  const std::int64_t one = 1, ten = 10;
  if (!ImGui::InputScalar("##value", ImGuiDataType_S64, &value, &one, &ten, "%lld",
                          ImGuiInputTextFlags_EnterReturnsTrue))
    return std::nullopt;
  return Value(std::clamp(value, low, high));
}

std::optional<Value> widget(const Field& f, std::vector<double> value) {
  const Range& range = f.parameter.range;
  double size = 2.0;
  for (const double x : value) size = std::max(size, std::abs(x));
  const bool changed =
      ImGui::DragScalarN("##value", ImGuiDataType_Double, value.data(), static_cast<int>(value.size()),
                         drag_speed(size, f.parameter), &range.min, &range.max, "%.4g", as_typed);
  // A drag that runs into an open end stops there instead of complaining.
  if (!changed || (range.min_excluded && std::ranges::min(value) <= range.min)) return std::nullopt;
  return Value(value);
}

std::optional<Value> widget(const Field& f, const Vec3& value) {
  const auto changed = widget(f, std::vector<double>{value.x, value.y, value.z});
  if (!changed) return std::nullopt;
  const auto& v = std::get<std::vector<double>>(*changed);
  return Value(Vec3{v[0], v[1], v[2]});
}

std::optional<Value> widget(const Field& f, std::vector<int> value) {
  if (!ImGui::InputScalarN("##value", ImGuiDataType_S32, value.data(), static_cast<int>(value.size()),
                           nullptr, nullptr, "%d", ImGuiInputTextFlags_EnterReturnsTrue))
    return std::nullopt;
  const Range& range = f.parameter.range;
  for (int& n : value) n = std::clamp(n, static_cast<int>(range.min), static_cast<int>(range.max));
  return Value(value);
}

/// A choice of words, or a text that is only shown.
std::optional<Value> widget(const Field& f, const std::string& value) {
  if (f.parameter.type == ParameterType::text) {
    ImGui::TextUnformatted(value.c_str());
    return std::nullopt;
  }
  const std::vector<std::string_view>& words = f.parameter.words;
  auto index = static_cast<std::size_t>(std::ranges::find(words, value) - words.begin());
  if (!choice(f.gui, f.key, words, words, index, f.help)) return std::nullopt;
  return Value(std::string(words[index]));
}

/// Boxes, in two columns where they fit, one for each word; those ticked stay in the order of the list.
bool check_boxes(const Field& f, std::vector<std::string>& ticked) {
  float widest = 0.0f;
  for (const std::string_view word : f.parameter.words)
    widest = std::max(widest, ImGui::CalcTextSize(word.data(), word.data() + word.size()).x);
  widest += ImGui::GetFrameHeight() + 2.0f * ImGui::GetStyle().ItemInnerSpacing.x;
  const float middle = ImGui::GetWindowContentRegionMax().x * 0.52f;
  const bool two = ImGui::GetCursorPosX() + widest < middle;
  bool changed = false;
  int column = 0;
  for (const std::string_view word : f.parameter.words) {
    if (two && column++ % 2 != 0) ImGui::SameLine(middle);
    changed = check_box(f.gui, word, fmt::format("{}/{}", f.key, word), ticked, f.help) || changed;
  }
  return changed;
}

std::optional<Value> widget(const Field& f, std::vector<std::string> value) {
  return check_boxes(f, value) ? std::optional<Value>(value) : std::nullopt;
}

/// Sides by name; corners and indices that the file gives stay as they are.
std::optional<Value> widget(const Field& f, PinnedSettings value) {
  return check_boxes(f, value.names) ? std::optional<Value>(value) : std::nullopt;
}

/// What a key starts with when it is set: the value that its absence stood for, where that is a number.
Value first_value(const Parameter& p, const Scene& scene) {
  if (p.path == "terrain[].restitution") return scene.model.contact.restitution;
  if (p.path == "terrain[].friction") return scene.model.contact.friction;
  if (p.path == "terrain[].mass") return 10.0;  // the assignments' sphere and bowl
  if (p.path == "view.arrow-scale") return 100.0;
  return std::clamp(1e-4, p.range.min, p.range.max);
}

std::string tooltip_of(const Parameter& p, std::size_t index) {
  std::string text = fmt::format("{}\n\nAllowed: {}", p.meaning, allowed_text(p));
  const std::string by_default = default_text(p);
  if (!by_default.empty()) text += fmt::format("\nDefault: {}", by_default);
  text += fmt::format("\nScene key: {}", path_text(p.path, index));
  if (!p.live) text += "\nA change restarts the simulation.";
  if (is_dragged(p)) text += "\nDrag to change, Ctrl+click to type.";
  return text;
}

/// Where a value would stand: what its absence means, if there is room for that.
void absent_text(std::string_view meaning) {
  if (meaning == "that of [contact]") meaning = "as above";
  const float width = ImGui::CalcTextSize(meaning.data(), meaning.data() + meaning.size()).x;
  if (width > ImGui::GetContentRegionAvail().x) meaning = "–";
  ImGui::TextDisabled("%.*s", static_cast<int>(meaning.size()), meaning.data());
}

/// The box before a key that may be absent; true if it was toggled.
bool presence_box(const Field& f, bool& present) {
  const bool toggled = ImGui::Checkbox("##set", &present);
  named(f.gui, f.key + "/set",
        fmt::format("Checked: use this value. Unchecked: {}.\n\n{}", f.parameter.when_absent, f.help));
  ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
  ImGui::SetNextItemWidth(-1.0f);
  return toggled;
}

}  // namespace

std::string spaced(std::string_view key) {
  std::string words(key);
  for (const char c : {'-', '.'}) std::ranges::replace(words, c, ' ');
  return words;
}

std::string capitalized(std::string words) {
  words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  return words;
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

namespace {

/// Beside the panel of the widget just made, so that it covers none of its neighbours; else below or above.
void place_tooltip(float text_width) {
  const ImVec2 display = ImGui::GetIO().DisplaySize, pad = ImGui::GetStyle().WindowPadding;
  const ImVec2 corner = ImGui::GetWindowPos(), low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float end = corner.x + ImGui::GetWindowSize().x, width = text_width + 2.0f * pad.x, gap = 6.0f;
  const bool lower_half = low.y > 0.5f * display.y;
  const float pivot = lower_half ? 1.0f : 0.0f;
  if (end + gap + width < display.x)
    ImGui::SetNextWindowPos({end + gap, lower_half ? high.y : low.y}, ImGuiCond_Always, {0.0f, pivot});
  else if (corner.x - gap - width > 0.0f)
    ImGui::SetNextWindowPos({corner.x - gap, lower_half ? high.y : low.y}, ImGuiCond_Always, {1.0f, pivot});
  else
    ImGui::SetNextWindowPos(
        {std::min(low.x, std::max(display.x - width, 0.0f)), lower_half ? low.y - gap : high.y + gap},
        ImGuiCond_Always, {0.0f, pivot});
}

}  // namespace

void tooltip(std::string_view text, std::string_view command) {
  const std::string keys(Gui::current().commands().keys_of(command));
  if (!Gui::current().explain(text, keys)) return;
  const float width = ImGui::GetFontSize() * 26.0f;
  place_tooltip(width);
  ImGui::BeginTooltip();
  wrapped_text(text, width);
  if (!keys.empty()) ImGui::TextDisabled("Key: %s", keys.c_str());
  ImGui::EndTooltip();
}

void named(Gui& gui, std::string_view name, std::string_view help, std::string_view command) {
  gui.mark("{}", name);
  tooltip(help, command);
}

bool check_box(Gui& gui, std::string_view label, std::string_view name, bool& on, std::string_view help) {
  const bool toggled = ImGui::Checkbox(std::string(label).c_str(), &on);
  named(gui, name, help);
  return toggled;
}

bool check_box(Gui& gui, std::string_view word, std::string_view name, std::vector<std::string>& ticked,
               std::string_view help) {
  bool on = std::ranges::find(ticked, word) != ticked.end();
  if (!check_box(gui, word, name, on, help)) return false;
  if (on)
    ticked.emplace_back(word);
  else
    std::erase(ticked, word);
  return true;
}

bool choice(Gui& gui, std::string_view name, std::span<const std::string_view> names,
            std::span<const std::string_view> labels, std::size_t& index, std::string_view help) {
  ImGui::PushID(name.data(), name.data() + name.size());
  const bool open = ImGui::BeginCombo("##choice", std::string(labels[index]).c_str());
  named(gui, name, help);
  const std::size_t before = index;
  for (std::size_t i = 0; open && i < names.size(); ++i) {
    if (ImGui::Selectable(std::string(labels[i]).c_str(), i == before)) index = i;
    named(gui, fmt::format("{}/{}", name, names[i]), help);
  }
  if (open) ImGui::EndCombo();
  ImGui::PopID();
  return index != before;
}

bool slider(Gui& gui, std::string_view label, std::string_view name, double& value, double low, double high,
            const char* format, std::string_view help, bool logarithmic) {
  label_column(label);
  ImGui::PushID(name.data(), name.data() + name.size());
  const SliderTrack track(logarithmic ? std::log(value / low) / std::log(high / low)
                                      : (value - low) / (high - low));
  ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &low, &high, format,
                      ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0));
  const bool done = ImGui::IsItemDeactivated();
  ImGui::PopID();
  named(gui, name, help);
  return done;
}

float share_of_line(int count) {
  const float gaps = static_cast<float>(count - 1) * ImGui::GetStyle().ItemSpacing.x;
  return (ImGui::GetContentRegionAvail().x - gaps) / static_cast<float>(count);
}

void label_column(std::string_view label) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(label.data(), label.data() + label.size());
  const float width = ImGui::GetWindowContentRegionMax().x;
  const float end =
      ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + ImGui::GetStyle().ItemInnerSpacing.x;
  // A long label has its widget in a second column, one that leaves too little of the line goes above it.
  if (end < longest_label * width)
    ImGui::SameLine((end < label_share * width ? label_share : longest_label) * width);
  ImGui::SetNextItemWidth(-1.0f);
}

bool button(Gui& gui, const char* name, const char* label, std::string_view help, bool enabled, float width,
            std::string_view command) {
  ImGui::PushID(name);
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(label, {width, 0.0f});
  ImGui::EndDisabled();
  named(gui, name, help, command);
  ImGui::PopID();
  return pressed;
}

bool command_button(Gui& gui, const char* name, const char* label, std::string_view help,
                    std::string_view command, bool enabled, float width) {
  const bool pressed = button(gui, name, label, help, enabled, width, command);
  if (pressed) gui.commands().run(command);
  return pressed;
}

std::optional<WidgetChange> parameter_widget(Gui& gui, const Parameter& p, const Scene& scene,
                                             std::size_t index, const WidgetWords& words) {
  // Geometry of terrain always has a value, if only its shape's.
  const bool optional = p.can_be_absent() && p.belonging == Belonging::always;
  const auto value = p.get(scene, index);
  if (!value && !optional) return std::nullopt;
  std::string label = words.label.empty() ? capitalized(spaced(p.path.substr(p.path.rfind('.') + 1)))
                                          : std::string(words.label);
  // A number has its unit behind it; three have no room for it.
  if (is_dragged(p) && p.type != ParameterType::number && !p.unit.empty())
    label += fmt::format(" [{}]", p.unit);
  Field field = {gui, p, path_text(p.path, index),
                 words.help.empty() ? tooltip_of(p, index) : std::string(words.help)};
  if (!words.note.empty()) field.help += fmt::format("\n\n{}", words.note);
  ImGui::PushID(field.key.c_str());
  const bool many = p.type == ParameterType::words || p.type == ParameterType::pinned;
  if (many) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(label.c_str());
    tooltip(field.help);
  } else {
    label_column(label);
  }
  std::optional<WidgetChange> change;
  bool present = value.has_value();
  if (optional && presence_box(field, present)) {
    change.emplace();
    if (present) change->value = first_value(p, scene);
  }
  std::optional<Value> changed;
  if (value)
    changed = std::visit([&](const auto& v) { return widget(field, v); }, *value);
  else
    absent_text(p.when_absent);
  if (!many && (p.type != ParameterType::word || !value)) named(gui, field.key, field.help);
  ImGui::PopID();
  if (changed) {
    change = WidgetChange{std::move(changed), is_dragged(p) ? field.key : std::string()};
  }
  return change;
}

void edit(Gui& gui, SceneControl& scene, std::string_view path, std::size_t index, const WidgetWords& words) {
  const Parameter& p = *find_parameter(path);
  const auto change = parameter_widget(gui, p, scene.scene(), index, words);
  if (!change) return;
  if (change->value) return scene.set_value(p, index, *change->value, change->gesture);
  scene.change(key_text(p), [&](Scene& changed) { p.clear(changed, index); });
}

}  // namespace aspic::app
