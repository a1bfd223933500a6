#pragma once
// Numbers that are typed, with the arithmetic of app/arithmetic.h.
#include <imgui.h>

#include <functional>
#include <optional>
#include <string>

namespace aspic::app {

/// What is wrong with a number that was typed, if it may not be entered.
using TypedCheck = std::function<std::optional<std::string>(double)>;
/// The check that a number lies in low … high.
TypedCheck between(double low, double high);

/// A number as text that is always there to be typed into. True once it was entered, by Enter or a click
/// elsewhere, as another one; what is no number, or a wrong one, changes nothing, see take_typing_error().
/// `label` is ImGui's, `shown` the text there otherwise.
bool number_field(const char* label, const std::string& shown, double& value, const TypedCheck& check);

/// ImGui's drag and slider, which stay in low … high and are typed into in the same way after Ctrl+click or a
/// double click. A slider is filled up to its knob. True where the value was changed.
bool number_drag(const char* label, double& value, float speed, double low, double high, const char* format,
                 ImGuiSliderFlags flags, const TypedCheck& check);
bool number_slider(const char* label, double& value, double low, double high, const char* format,
                   ImGuiSliderFlags flags, const TypedCheck& check);

/// Why the last number that was typed changed nothing, once.
std::optional<std::string> take_typing_error();

}  // namespace aspic::app
