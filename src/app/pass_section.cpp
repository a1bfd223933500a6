// Device time by pass, in the performance section.
#include <fmt/format.h>
#include <imgui.h>

#include "app/panels.h"
#include "app/parameter_widget.h"

namespace aspic::app {

void pass_times(Gui& gui, GpuSolver& solver) {
  // Off as long as nobody looks: a measured step takes a little longer.
  solver.set_profiling(true);
  ImGui::TextDisabled("Passes of a step");
  gui.mark("performance/passes");
  tooltip(
      "Device time of each kind of pass in a step [ms], and how many dispatches it takes; means over the "
      "last "
      "steps measured, from time stamps.");
  const std::vector<gl::PassTime> passes = solver.pass_times();
  if (passes.empty()) {
    ImGui::TextDisabled("   not measured yet");
    return;
  }
  double sum = 0.0;
  const float column = ImGui::GetWindowContentRegionMax().x * 0.52f;
  for (const gl::PassTime& pass : passes) {
    ImGui::TextDisabled("   %s", pass.name.c_str());
    // A long name has a line of its own.
    if (ImGui::GetItemRectSize().x + 4.0f < column)
      ImGui::SameLine(column);
    else
      ImGui::SetCursorPosX(column);
    ImGui::Text("%.3f ms  ×%.3g", pass.milliseconds, pass.dispatches);
    sum += pass.milliseconds;
  }
  ImGui::TextDisabled("   together");
  ImGui::SameLine(column);
  ImGui::Text("%.3f ms", sum);
}

}  // namespace aspic::app
