#pragma once
// The windows of ImGui's that panels are.
#include <imgui.h>

#include "app/gui.h"

namespace aspic::app {

inline constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                          ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoTitleBar |
                                          ImGuiWindowFlags_NoSavedSettings;

inline ImVec2 at(double x, double y) {
  return {static_cast<float>(x), static_cast<float>(y)};
}

/// A window of ImGui's, between Begin and End.
class Panel {
 public:
  /// Stays at a place.
  Panel(const char* name, const Box& box, const ImVec2& padding, ImGuiWindowFlags flags) {
    ImGui::SetNextWindowPos(at(box.left, box.top));
    ImGui::SetNextWindowSize(at(box.right - box.left, box.bottom - box.top));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
    ImGui::Begin(name, nullptr, fixed | flags);
  }
  /// Floats over the image with round corners, where SetNextWindowPos says.
  Panel(const char* name, double rounding, const ImVec4& color, ImGuiWindowFlags flags = 0,
        ImGuiWindowFlags without = 0)
      : colors_(1) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, static_cast<float>(rounding));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, color);
    ImGui::Begin(name, nullptr, (fixed | flags) & ~without);
  }
  ~Panel() {
    ImGui::End();
    ImGui::PopStyleColor(colors_);
    ImGui::PopStyleVar();
  }
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;

 private:
  int colors_ = 0;
};

}  // namespace aspic::app
