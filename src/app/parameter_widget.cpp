#include "app/parameter_widget.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <variant>

#include "app/number_field.h"
#include "base/printable.h"
#include "model/integrator.h"
#include "scene/new_body.h"

namespace aspic::app {
namespace {

constexpr ImGuiSliderFlags as_typed = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat;

/// How fast a drag changes a number for each window unit: lengths by a centimeter, angles by half a degree,
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

double within(const Range& range, double value) {
  return std::clamp(value, range.min, range.max);
}

/// Several numbers on a line, each by `field`, which tells whether it was changed. True if one was.
template <class Number>
bool on_one_line(std::vector<Number>& values, const std::function<bool(Number&)>& field) {
  bool changed = false;
  ImGui::BeginGroup();
  ImGui::PushMultiItemsWidths(static_cast<int>(values.size()), ImGui::CalcItemWidth());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
    ImGui::PushID(static_cast<int>(i));
    changed = field(values[i]) || changed;
    ImGui::PopID();
    ImGui::PopItemWidth();
  }
  ImGui::EndGroup();
  return changed;
}

/// What the scene's check says of a number of the parameter. A direction is checked as one value once it is
/// set.
TypedCheck check_of(const Parameter& p) {
  return [&p](double typed) -> std::optional<std::string> {
    const auto wrong = p.direction ? std::nullopt : check_value(p, Value(typed));
    return wrong ? std::optional(wrong->message) : std::nullopt;
  };
}

/// A whole number, rounded where arithmetic makes a fraction of it.
template <class Whole>
bool whole_field(const Parameter& p, Whole& value) {
  double typed = static_cast<double>(value);
  if (!number_field("##value", fmt::format("{}", value), typed, check_of(p))) return false;
  value = static_cast<Whole>(std::llround(within(p.range, typed)));
  return true;
}

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
    changed = number_slider("##value", value, p.range.min, p.range.max, "%.3g", as_typed, check_of(p));
  } else {
    const double low = std::max(p.range.min, -1e12), high = std::min(p.range.max, 1e12);
    changed = number_drag("##value", value, drag_speed(value, p), low, high,
                          format_with_unit(p, value).c_str(), as_typed, check_of(p));
  }
  // A drag that runs into an open end stops there instead of complaining.
  if (!changed || (p.range.min_excluded && value <= p.range.min)) return std::nullopt;
  return Value(value);
}

std::optional<Value> widget(const Field& f, std::int64_t value) {
  const float side = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
  ImGui::BeginGroup();
  ImGui::SetNextItemWidth(std::max(ImGui::CalcItemWidth() - 2.0f * (side + gap), 1.0f));
  bool changed = whole_field(f.parameter, value);
  ImGui::PushButtonRepeat(true);
  for (const int direction : {-1, 1}) {
    ImGui::SameLine(0.0f, gap);
    if (!ImGui::Button(direction < 0 ? "-" : "+", {side, side})) continue;
    value += std::int64_t{direction} * (ImGui::GetIO().KeyCtrl ? 10 : 1);
    changed = true;
  }
  ImGui::PopButtonRepeat();
  ImGui::EndGroup();
  if (!changed) return std::nullopt;
  return Value(static_cast<std::int64_t>(within(f.parameter.range, static_cast<double>(value))));
}

/// Of one component of a camera's place, of which nobody sees a ten-thousandth: three decimals or so, and 0
/// for what rounds to it. What a camera follows leaves rounding noise in it.
std::string camera_format(double value, double size) {
  const int decimals = std::clamp(3 - static_cast<int>(std::floor(std::log10(size))), 0, 3);
  return std::abs(value) < 0.5 * std::pow(10.0, -decimals) ? "0" : fmt::format("%.{}f", decimals);
}

std::optional<Value> widget(const Field& f, std::vector<double> value) {
  const Range& range = f.parameter.range;
  double size = 2.0;
  for (const double x : value) size = std::max(size, std::abs(x));
  const bool camera = f.parameter.path.starts_with("view.camera.");
  const bool changed = on_one_line<double>(value, [&](double& x) {
    const std::string format = camera ? camera_format(x, size) : "%.4g";
    return number_drag("##value", x, drag_speed(size, f.parameter), range.min, range.max, format.c_str(),
                       as_typed, check_of(f.parameter));
  });
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
  const auto field = [&](int& n) { return whole_field(f.parameter, n); };
  return on_one_line<int>(value, field) ? std::optional<Value>(value) : std::nullopt;
}

/// A choice of words, or a text that is only shown.
std::optional<Value> widget(const Field& f, const std::string& value) {
  if (f.parameter.type == ParameterType::text) {
    // A mesh is thousands of signs that say nothing.
    ImGui::TextUnformatted(f.parameter.path == "voxels[].skin" ? "a mesh" : value.c_str());
    return std::nullopt;
  }
  const std::vector<std::string_view>& words = f.parameter.words;
  auto index = static_cast<std::size_t>(std::ranges::find(words, value) - words.begin());
  if (!choice(f.gui, f.key, words, titles_of(f.parameter), index, f.help)) return std::nullopt;
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
  if (f.parameter.type == ParameterType::names) {  // as the file has them
    ImGui::TextUnformatted(fmt::format("{}", fmt::join(value, ", ")).c_str());
    return std::nullopt;
  }
  return check_boxes(f, value) ? std::optional<Value>(value) : std::nullopt;
}

/// How many cells there are; a file changes them.
std::optional<Value> widget(const Field&, const CellLayers& layers) {
  const bool any = !layers.empty() && !layers.front().empty();
  ImGui::TextUnformatted(fmt::format("{} × {} × {} cells", any ? layers.front().front().size() : 0,
                                     layers.size(), any ? layers.front().size() : 0)
                             .c_str());
  return std::nullopt;
}

/// How many points there are; a file changes them.
std::optional<Value> widget(const Field&, const SignalTable& points) {
  ImGui::TextUnformatted(fmt::format("{} points", points.size()).c_str());
  return std::nullopt;
}

/// Materials as a file has them.
std::optional<Value> widget(const Field&, const CellPalette& palette) {
  std::string text;
  for (const auto& [cell, name] : palette)
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", cell, name);
  ImGui::TextUnformatted(text.empty() ? "none" : text.c_str());
  return std::nullopt;
}

/// Sides by name; corners and indices that the file gives stay as they are.
std::optional<Value> widget(const Field& f, PinnedSettings value) {
  return check_boxes(f, value.names) ? std::optional<Value>(value) : std::nullopt;
}

/// The first value of a key when it is set: the one that its absence meant, where that is a number.
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
  if (is_dragged(p)) text += "\nDrag to change, Ctrl+click to type: 2*9.8, 1/60.";
  return text;
}

/// In the place of a value: the meaning of its absence, if there is room for that.
void absent_text(std::string_view meaning) {
  if (meaning == "that of [contact]") meaning = "as above";
  if (meaning == "contact.body-friction") meaning = "common";  // to all bodies
  const float width = ImGui::CalcTextSize(meaning.data(), meaning.data() + meaning.size()).x;
  if (width > ImGui::GetContentRegionAvail().x) meaning = "–";
  ImGui::TextDisabled("%.*s", static_cast<int>(meaning.size()), meaning.data());
}

/// The box before a key that may be absent; true if it was toggled.
bool presence_box(const Field& f, bool& present) {
  const bool toggled = ImGui::Checkbox("##set", &present);
  named(f.gui, f.key + "/set",
        fmt::format("Check to use this value. Unchecked: {}.\n\n{}", f.parameter.when_absent, f.help));
  ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
  ImGui::SetNextItemWidth(-1.0f);
  return toggled;
}

}  // namespace

std::string elided_path(const std::string& path, float width) {
  const auto wide = [](std::string_view text) {
    return ImGui::CalcTextSize(text.data(), text.data() + text.size()).x;
  };
  float taken = wide(path);
  if (taken <= width) return path;
  constexpr std::string_view dots = "…";
  taken += wide(dots);
  std::string_view end = path;
  while (!end.empty() && taken > width) {
    const std::size_t bytes = first_character(end).size;
    taken -= wide(end.substr(0, bytes));
    end.remove_prefix(bytes);
  }
  return std::string(dots) + std::string(end);
}

const SettingsList* list_of_bodies(std::string_view key) {
  const auto found = std::ranges::find(body_rows(), key, [](const BodyRow& row) { return row.list.key; });
  return found == body_rows().end() ? nullptr : &found->list;
}

void add_body(SceneControl& scene, const SettingsList& list) {
  scene.change("add " + noun_of(list.key), [&](Scene& s) { aspic::add_body(s, list); });
}

std::string spaced(std::string_view key) {
  std::string words(key);
  for (const char c : {'-', '.'}) std::ranges::replace(words, c, ' ');
  return words;
}

std::string noun_of(std::string_view key) {
  return key == "voxels" ? "body of cells" : spaced(key);
}

std::string capitalized(std::string words) {
  words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  return words;
}

std::vector<std::string_view> titles_of(const Parameter& p) {
  if (p.path != "simulation.integrator") return p.words;
  // As labels of runs, plots and the status line call them.
  std::vector<std::string_view> titles;
  for (const std::string_view word : p.words) {
    const auto* const row = std::ranges::find(integrator_table, word, &IntegratorRow::name);
    titles.push_back(row == integrator_table.end() ? word : row->title);
  }
  return titles;
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
    group_heading(label);
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
