// Controls with a label, a tooltip and a name: see parameter_widget.h.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <string>

#include "app/number_field.h"
#include "app/parameter_widget.h"

namespace aspic::app {
namespace {

/// Share of a panel's width that labels take.
constexpr float label_share = 0.40f, longest_label = 0.6f;

}  // namespace

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

/// Next to the panel of the widget just made, so that it covers none of its neighbors; else below or above.
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
  number_slider("##value", value, low, high, format,
                ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0),
                between(low, high));
  const bool done = ImGui::IsItemDeactivated();
  ImGui::PopID();
  named(gui, name, help);
  return done;
}

void shade_all_but(const char* window) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  ImGui::SetNextWindowSize(display);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0.03f, 0.03f, 0.03f, 0.45f));
  ImGui::Begin("##shade", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
  ImGui::End();
  ImGui::PopStyleColor();
  // One that is about to be made comes to the front by itself.
  if (ImGuiWindow* const above = ImGui::FindWindowByName(window)) ImGui::BringWindowToDisplayFront(above);
}

bool folded(Gui& gui, Layouts& layout, const std::string& section, const char* label, std::string_view help) {
  const std::string key = fmt::format("{}: {}", section, label);
  const auto known = layout.sections.find(key);
  const bool was_open = known != layout.sections.end() && known->second;
  ImGui::SetNextItemOpen(was_open);
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_CheckMark));
  const bool open =
      ImGui::TreeNodeEx(label, ImGuiTreeNodeFlags_NoTreePushOnOpen | ImGuiTreeNodeFlags_SpanAvailWidth);
  ImGui::PopStyleColor();
  named(gui, "fold/" + key, help);
  if (open != was_open) layout.sections[key] = open;
  return open;
}

void group_heading(std::string_view text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(ImGui::GetStyleColorVec4(ImGuiCol_CheckMark), "%.*s", static_cast<int>(text.size()),
                     text.data());
  const ImVec2 end = ImGui::GetItemRectMax(), begin = ImGui::GetItemRectMin();
  const float middle = 0.5f * (begin.y + end.y);
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  ImGui::GetWindowDrawList()->AddLine({end.x + ImGui::GetStyle().ItemSpacing.x, middle}, {right, middle},
                                      ImGui::GetColorU32(ImGuiCol_Separator));
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

}  // namespace aspic::app
