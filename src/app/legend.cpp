// What the colors of the image mean, in window pixels whatever the image's own.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <utility>

#include "app/panels.h"
#include "render/color_map.h"

namespace aspic::app {
namespace {

/// The scale of colors from its lower to its upper end, with its marks below.
void scale_bar(const Legend& legend) {
  static ScaleMap kept = legend.map;
  static std::vector<std::byte> texels = color_map_texels(kept);
  if (std::exchange(kept, legend.map) != legend.map) texels = color_map_texels(legend.map);
  const float line = ImGui::GetTextLineHeight(), height = 0.7f * line;
  float marks = 2.0f * line;
  for (const std::string& mark : legend.marks) marks += ImGui::CalcTextSize(mark.c_str()).x;
  const float width = std::max({marks, 12.0f * line, ImGui::CalcTextSize(legend.title.c_str()).x});
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  constexpr int pieces = 64;
  const auto color = [](int i) {
    const auto at = 4 * static_cast<std::size_t>(i * 255 / pieces);
    const auto channel = [&](std::size_t c) { return std::to_integer<int>(texels[at + c]); };
    return IM_COL32(channel(0), channel(1), channel(2), 255);
  };
  for (int i = 0; i < pieces; ++i) {
    const auto x = [&](int n) { return corner.x + width * static_cast<float>(n) / pieces; };
    ImGui::GetWindowDrawList()->AddRectFilledMultiColor({x(i), corner.y}, {x(i + 1), corner.y + height},
                                                        color(i), color(i + 1), color(i + 1), color(i));
  }
  ImGui::Dummy({width, height});
  const float left = ImGui::GetCursorPosX();
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0) ImGui::SameLine();
    const float rest = width - ImGui::CalcTextSize(legend.marks[i].c_str()).x;
    ImGui::SetCursorPosX(left + 0.5f * static_cast<float>(i) * rest);
    ImGui::TextUnformatted(legend.marks[i].c_str());
  }
}

}  // namespace

ImU32 display_color(const Color& linear) {
  std::array<float, 3> c;
  for (std::size_t i = 0; i < 3; ++i)
    c[i] = static_cast<float>(linear_to_srgb(static_cast<double>(linear[i])));
  return ImGui::ColorConvertFloat4ToU32({c[0], c[1], c[2], 1.0f});
}

Box draw_legend(const Gui& gui, const char* name, const Legend& legend, const Box& view) {
  if (legend.empty()) return {view.right, view.bottom, view.right, view.bottom};
  const auto gap = static_cast<float>(16.0 * gui.scale());
  ImGui::SetNextWindowPos({static_cast<float>(view.right) - gap, static_cast<float>(view.bottom) - gap},
                          ImGuiCond_Always, {1.0f, 1.0f});
  ImGui::SetNextWindowBgAlpha(0.72f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * gap);
  ImGui::Begin(fmt::format("##{}", name).c_str(), nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::BeginGroup();
  ImGui::TextUnformatted(legend.title.c_str());
  for (const Legend::Entry& entry : legend.entries) {
    const float line = ImGui::GetTextLineHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + 0.1f * line},
                                              {at.x + 0.8f * line, at.y + 0.9f * line},
                                              display_color(entry.color), 0.2f * line);
    ImGui::Dummy({0.8f * line, line});
    ImGui::SameLine();
    ImGui::TextUnformatted(entry.name.c_str());
  }
  if (legend.entries.empty()) scale_bar(legend);
  ImGui::EndGroup();
  gui.mark("{}", name);
  const ImVec2 corner = ImGui::GetWindowPos();
  ImGui::End();
  ImGui::PopStyleVar();
  return {static_cast<double>(corner.x), static_cast<double>(corner.y), view.right, view.bottom};
}

}  // namespace aspic::app
