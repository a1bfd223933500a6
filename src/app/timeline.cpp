// The bar of the history, under the picture: any step since the start.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "app/panels.h"
#include "app/parameter_widget.h"
#include "base/printable.h"

namespace aspic::app {

void draw_timeline(Gui& gui, const Simulation& s, RunControl& run, const Box& box) {
  const History& history = s.history();
  const double scale = gui.scale();
  const auto at = [](double x, double y) { return ImVec2(static_cast<float>(x), static_cast<float>(y)); };
  ImGui::SetNextWindowPos(at(box.left, box.top));
  ImGui::SetNextWindowSize(at(box.right - box.left, box.bottom - box.top));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(12.0 * scale, 4.0 * scale));
  ImGui::Begin("##timeline", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  const double first = history.time(history.begin_moment()), last = history.time(history.end_moment());
  double now = std::clamp(s.time(), first, last);
  const std::string text = fmt::format("{:.3f} / {:.3f} s{}", s.time(), last, s.seeking() ? "  …" : "");
  ImGui::SetNextItemWidth(-1.0f);
  const bool moved = ImGui::SliderScalar("##history", ImGuiDataType_Double, &now, &first, &last, text.c_str(),
                                         ImGuiSliderFlags_NoInput | ImGuiSliderFlags_AlwaysClamp);
  gui.mark("timeline");
  const ImVec2 corner = ImGui::GetItemRectMin(), end = ImGui::GetItemRectMax();
  tooltip(fmt::format("The run so far, {} of at most 512 MiB. Drag to go to any step; this pauses the run. "
                      "Steps between the "
                      "{} stored states are simulated again and give the same bits, pulls and pins included. "
                      "Marks are changes of the scene, which are reverted and restored as well. Continuing "
                      "from the past discards what came after.",
                      human_bytes(history.bytes()), history.keyframe_count()),
          "step back");
  if (last > first) {
    for (const double t : history.changes()) {
      const float x = corner.x + static_cast<float>((t - first) / (last - first)) * (end.x - corner.x);
      ImGui::GetWindowDrawList()->AddLine({x, end.y - static_cast<float>(5.0 * scale)}, {x, end.y},
                                          IM_COL32(242, 176, 92, 255), static_cast<float>(1.5 * scale));
    }
  }
  ImGui::End();
  ImGui::PopStyleVar();
  if (moved && last > first) run.go_to(now);
}

}  // namespace aspic::app
