#pragma once
// A widget for any row of the parameter table: range, words, unit and tooltip come from there.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/gui.h"
#include "app/layouts.h"
#include "app/scene_control.h"
#include "model/bodies.h"
#include "scene/parameters.h"

namespace aspic::app {

/// What a widget did to a value, with what makes successive changes one for undo.
struct WidgetChange {
  std::optional<Value> value;  ///< absent: the key is removed
  std::string gesture;
};

/// How a widget differs from the plain one of its parameter.
struct WidgetWords {
  std::string_view label = {};  ///< empty: the key's own words
  std::string_view note = {};   ///< a paragraph more in the tooltip
  std::string_view help = {};   ///< instead of the parameter's tooltip; empty: that
};

/// The widget of a parameter of a scene. One that may be absent has a box before it that sets and clears it.
/// Nothing if it was not changed, or the key has no meaning there.
std::optional<WidgetChange> parameter_widget(Gui& gui, const Parameter& parameter, const Scene& scene,
                                             std::size_t index, const WidgetWords& words = {});
/// The widget of a scene value by path, its changes carried out.
void edit(Gui& gui, SceneControl& scene, std::string_view path, std::size_t index = 0,
          const WidgetWords& words = {});

/// The list of bodies of that key, `voxels`; never null for one that there is.
const SettingsList* list_of_bodies(std::string_view key);
/// aspic::add_body(), as one change for undo.
void add_body(SceneControl& scene, const SettingsList& list);

/// "particle-mass" as "particle mass", and with a capital; not empty.
std::string spaced(std::string_view key);
/// What people call one element of a list of bodies: "goal net", "body of cells".
std::string noun_of(std::string_view key);
std::string capitalized(std::string words);

/// What people read for the words of a parameter, in their order.
std::vector<std::string_view> titles_of(const Parameter& parameter);

/// A tooltip for the widget just made, with the keys of the command of that name if there is one.
void tooltip(std::string_view text, std::string_view command = "");
/// Text broken at blanks alone, so that numbers are not split, into lines of at most `width` [window units].
void wrapped_text(std::string_view text, float width);
/// A path or a file name, in at most `width` [window units]: its end, behind "…", where it is longer.
std::string elided_path(const std::string& path, float width);
/// Names the widget just made, for the watcher, and gives it a tooltip.
void named(Gui& gui, std::string_view name, std::string_view help, std::string_view command = "");
/// A box with its label; or one that puts a word into a list and takes it out. True if it was toggled.
bool check_box(Gui& gui, std::string_view label, std::string_view name, bool& on, std::string_view help);
bool check_box(Gui& gui, std::string_view word, std::string_view name, std::vector<std::string>& ticked,
               std::string_view help);
/// A list to choose from, each item with its name (behind that of the list) and label. True if `index`
/// changed.
bool choice(Gui& gui, std::string_view name, std::span<const std::string_view> names,
            std::span<const std::string_view> labels, std::size_t& index, std::string_view help);
/// A slider with its label on the left. True once it is let go.
bool slider(Gui& gui, std::string_view label, std::string_view name, double& value, double low, double high,
            const char* format, std::string_view help, bool logarithmic = true);
/// Takes the mouse everywhere but in the window of ImGui's of that name, and dims what is behind it.
void shade_all_but(const char* window);
/// A line that folds the rest of a section away or out, named "SECTION: LABEL" like its place in
/// Layout::sections, closed at first. True if it is open.
bool folded(Gui& gui, Layouts& layout, const std::string& section, const char* label, std::string_view help);
/// A heading of some rows of a section.
void group_heading(std::string_view text);
/// Width of one of `count` equal widgets on a line [window units].
float share_of_line(int count);
/// A label on the left; the next widget fills the rest of the line.
void label_column(std::string_view label);
/// A button with a name for the watcher and a tooltip. True if it was pressed.
bool button(Gui& gui, const char* name, const char* label, std::string_view help, bool enabled = true,
            float width = 0.0f, std::string_view command = "");
/// A button that carries out a command; its tooltip names the keys. True if it was pressed.
bool command_button(Gui& gui, const char* name, const char* label, std::string_view help,
                    std::string_view command, bool enabled = true, float width = 0.0f);

}  // namespace aspic::app
