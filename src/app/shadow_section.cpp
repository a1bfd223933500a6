// The section of shadow mode: two backends side by side, and how far they are apart.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/panels.h"
#include "app/parameter_widget.h"

namespace aspic::app {
namespace {

constexpr ImU32 same = IM_COL32(120, 205, 140, 255), other = IM_COL32(240, 120, 95, 255);

/// Places 0 at the bottom and powers of ten above, from 1 ULP on.
double height_of(const DifferenceSample& sample) {
  if (!std::isfinite(sample.metres)) return 1.0;
  return std::min(std::log10(1.0 + static_cast<double>(sample.ulp)) / 10.0, 1.0);
}

void plot(const std::deque<DifferenceSample>& samples, double scale) {
  const ImVec2 size = {ImGui::GetContentRegionAvail().x, static_cast<float>(70.0 * scale)};
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy(size);
  tooltip(
      "Largest difference of any component of the state over time, in units in the last place: the bottom is "
      "0, the top ten thousand million, each tenth of the height ten times as much. Green where every bit is "
      "the same.");
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, IM_COL32(20, 21, 23, 255), 4.0f);
  if (samples.size() < 2) return;
  const double start = samples.front().time, span = samples.back().time - start;
  if (!(span > 0.0)) return;
  const float pad = static_cast<float>(6.0 * scale);
  const auto place = [&](const DifferenceSample& s) {
    return ImVec2(corner.x + pad + static_cast<float>((s.time - start) / span) * (size.x - 2.0f * pad),
                  corner.y + size.y - pad - static_cast<float>(height_of(s)) * (size.y - 2.0f * pad));
  };
  for (std::size_t i = 1; i < samples.size(); ++i) {
    draw.AddLine(place(samples[i - 1]), place(samples[i]), samples[i].identical ? same : other,
                 static_cast<float>(2.0 * scale));
  }
}

/// What the run can be compared with: the reference first.
std::vector<const BackendRow*> others_than(const BackendRow& leader) {
  std::vector<const BackendRow*> rows;
  for (const BackendRow& row : backends()) {
    if (&row != &leader) rows.insert(rows.begin(), &row);
  }
  return rows;
}

}  // namespace

void shadow_section(Gui& gui, const Simulation& s, RunControl& run) {
  const std::vector<const BackendRow*> others = others_than(s.backend());
  bool on = s.shadowed();
  if (ImGui::Checkbox("second backend", &on)) run.set_shadow(on ? others.front() : nullptr);
  gui.mark("shadow/on");
  tooltip(
      "Another backend does the same steps, and after each job of steps the two states are compared. The "
      "picture shows the leading backend; speed is limited by the slower one.");
  if (!s.shadowed()) return;
  // A machine with two backends has no choice to offer.
  for (std::size_t i = 0; others.size() > 1 && i < others.size(); ++i) {
    const std::string label(others[i]->title);
    if (ImGui::RadioButton(label.c_str(), others[i] == s.shadow_backend())) run.set_shadow(others[i]);
    tooltip(others[i]->summary);
  }
  ImGui::TextDisabled("%s ∥ %s", std::string(s.solver().backend()).c_str(),
                      std::string(s.shadow()->backend()).c_str());
  tooltip(fmt::format("Leads: {}. Alongside: {}.", s.solver().description(), s.shadow()->description()));
  plot(s.samples().differences(), gui.scale());
  if (s.samples().differences().empty()) {
    ImGui::TextDisabled("not compared yet");
    return;
  }
  const DifferenceSample& last = s.samples().differences().back();
  const ImVec4 colour = ImGui::ColorConvertU32ToFloat4(last.identical ? same : other);
  if (!std::isfinite(last.metres))
    ImGui::TextColored(colour, "one of the two diverged");
  else if (last.identical)
    ImGui::TextColored(colour, "0 ULP, 0 m: every bit is the same");
  else
    ImGui::TextColored(colour, "%llu ULP, %.3g m", static_cast<unsigned long long>(last.ulp), last.metres);
  gui.mark("shadow/difference");
  if (last.identical && s.samples().ever_differed())
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(other), "there were differences before");
}

}  // namespace aspic::app
