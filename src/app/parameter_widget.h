#pragma once
// A widget for any row of the parameter table: range, words, unit and tooltip come from there.
#include <optional>
#include <string>
#include <string_view>

#include "app/gui.h"
#include "scene/parameters.h"

namespace aspic::app {

class App;

/// A value that a widget changed, with what makes successive changes one for undo.
struct WidgetChange {
  Value value;
  std::string gesture;
};

/// The widget of a parameter of a scene; an empty label becomes the key's own words. Nothing if it was not
/// changed, or the key has no value there.
std::optional<WidgetChange> parameter_widget(Gui& gui, const Parameter& parameter, const Scene& scene,
                                             std::size_t index, std::string_view label = "");

/// The widget of a scene value by path, its changes carried out.
void edit(App& app, std::string_view path, std::size_t index = 0, std::string_view label = "");

/// The words of a tooltip: meaning, what is allowed, default, scene key.
std::string tooltip_of(const Parameter& parameter, std::size_t index);

/// A tooltip for the widget just made, with the shortcut of that meaning if there is one.
void tooltip(std::string_view text, std::string_view shortcut_meaning = "");
/// Text broken at blanks alone, so that numbers stay whole, into lines of at most `width` [window units].
void wrapped_text(std::string_view text, float width);
/// A label on the left; the next widget fills the rest of the line.
void label_column(std::string_view label);
/// A button that is marked by name and explains itself.
bool button(Gui& gui, const char* name, const char* label, std::string_view help,
            std::string_view shortcut_meaning = "", bool enabled = true, float width = 0.0f);

}  // namespace aspic::app
