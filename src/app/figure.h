#pragma once
// A value that a section shows.
#include <imgui.h>

#include <string>
#include <string_view>

#include "app/parameter_widget.h"

namespace aspic::app {

/// Where values begin, as a share of the panel's width.
inline constexpr float figure_column = 0.52f;

/// A row of a section: a name and its value.
inline void figure(const char* label, const std::string& value, std::string_view help,
                   const ImVec4& color = ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled)) {
  ImGui::TextColored(color, "%s", label);
  tooltip(help);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x * figure_column);
  ImGui::TextUnformatted(value.c_str());
  tooltip(help);
}

}  // namespace aspic::app
