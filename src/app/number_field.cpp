#include "app/number_field.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/arithmetic.h"

namespace aspic::app {
namespace {

/// The field that is typed into: only one has the keyboard.
struct Typing {
  ImGuiID field = 0;         // 0: none
  std::string text, before;  // as it is, and as it was
  int image = 0;             // the last that had the field
};
Typing typing;
std::optional<std::string> typing_error;

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
    for (const ImGuiCol color : {ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive})
      ImGui::PushStyleColor(color, ImVec4(1.0f, 1.0f, 1.0f, color == ImGuiCol_FrameBg ? 0.0f : 0.05f));
  }
  ~SliderTrack() { ImGui::PopStyleColor(3); }
  SliderTrack(const SliderTrack&) = delete;
  SliderTrack& operator=(const SliderTrack&) = delete;
};

}  // namespace

TypedCheck between(double low, double high) {
  return [low, high](double value) -> std::optional<std::string> {
    if (value >= low && value <= high) return std::nullopt;
    return fmt::format("{:g} is out of range; allowed: {:g} … {:g}", value, low, high);
  };
}

bool number_field(const char* label, const std::string& shown, double& value, const TypedCheck& check) {
  const ImGuiID id = ImGui::GetID(label);
  const int image = ImGui::GetFrameCount();
  // One that was away for an image is not typed into any more.
  if (typing.image < image - 1) typing = {};
  if (typing.field != id) {
    std::string text = shown;
    ImGui::InputText(label, &text, ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::IsItemActive()) typing = {id, text, shown, image};
    return false;
  }
  typing.image = image;
  ImGui::InputText(label, &typing.text, ImGuiInputTextFlags_AutoSelectAll);
  if (ImGui::IsItemActive()) return false;
  const Typing done = std::exchange(typing, {});
  // A number that nobody touched keeps the digits that its text has no room for.
  if (done.text == done.before) return false;
  const auto entered = evaluate(done.text);
  typing_error = entered ? check(*entered) : entered.error().what;
  if (typing_error) return false;
  value = *entered;
  return true;
}

namespace {

/// A field for arithmetic in the place of ImGui's drag or slider of that label, as long as it is typed into,
/// after Ctrl+click or a double click. Absent: it is not; else whether the value was changed.
std::optional<bool> typed_number(const char* label, double& value, const TypedCheck& check) {
  const ImGuiID id = ImGui::GetID(label);
  if (typing.field != id && !ImGui::TempInputIsActive(id)) return std::nullopt;
  // ImGui has opened the field and read the value; from now on its text is ours, with any character.
  const ImGuiInputTextState* const state = ImGui::GetInputTextState(id);
  return number_field(label, state ? state->InitialTextA.Data : "", value, check);
}

}  // namespace

bool number_drag(const char* label, double& value, float speed, double low, double high, const char* format,
                 ImGuiSliderFlags flags, const TypedCheck& check) {
  if (const auto typed = typed_number(label, value, check)) return *typed;
  return ImGui::DragScalar(label, ImGuiDataType_Double, &value, speed, &low, &high, format, flags);
}

bool number_slider(const char* label, double& value, double low, double high, const char* format,
                   ImGuiSliderFlags flags, const TypedCheck& check) {
  if (const auto typed = typed_number(label, value, check)) return *typed;
  const bool logarithmic = (flags & ImGuiSliderFlags_Logarithmic) != 0;
  const SliderTrack track(logarithmic ? std::log(value / low) / std::log(high / low)
                                      : (value - low) / (high - low));
  return ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &low, &high, format, flags);
}

std::optional<std::string> take_typing_error() {
  return std::exchange(typing_error, std::nullopt);
}

}  // namespace aspic::app
