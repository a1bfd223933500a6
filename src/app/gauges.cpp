// The sections that show: performance and energy.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "app/panels.h"
#include "app/parameter_widget.h"
#include "base/printable.h"
#include "model/springs.h"

namespace aspic::app {
namespace {

void figure(const char* label, const std::string& value, std::string_view help) {
  ImGui::TextDisabled("%s", label);
  tooltip(help);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x * 0.52f);
  ImGui::TextUnformatted(value.c_str());
  tooltip(help);
}

/// 1234567 as "1.23 M".
std::string short_number(double value) {
  if (value >= 1e9) return fmt::format("{:.3g} G", value / 1e9);
  if (value >= 1e6) return fmt::format("{:.3g} M", value / 1e6);
  if (value >= 1e4) return fmt::format("{:.3g} k", value / 1e3);
  return fmt::format("{:.3g}", value);
}

struct Curve {
  const char* name;
  ImU32 colour;
  double (*value)(const Measures&);
};
constexpr std::array<Curve, 4> energy_curves = {
    {{"kinetic", IM_COL32(242, 176, 92, 255), [](const Measures& m) { return m.kinetic; }},
     {"elastic", IM_COL32(120, 205, 140, 255), [](const Measures& m) { return m.elastic; }},
     {"gravitational", IM_COL32(110, 165, 240, 255), [](const Measures& m) { return m.gravitational; }},
     {"total", IM_COL32(230, 232, 236, 255), [](const Measures& m) { return m.total(); }}}};

constexpr std::array<Curve, 4> momentum_curves = {
    {{"p, along x", IM_COL32(238, 120, 110, 255), [](const Measures& m) { return m.momentum.x; }},
     {"p, along y", IM_COL32(120, 205, 140, 255), [](const Measures& m) { return m.momentum.y; }},
     {"p, along z", IM_COL32(110, 165, 240, 255), [](const Measures& m) { return m.momentum.z; }},
     {"|p|", IM_COL32(230, 232, 236, 255), [](const Measures& m) { return length(m.momentum); }}}};

void plot(Gui& gui, const char* name, const std::deque<EnergySample>& samples, std::span<const Curve> curves,
          const char* unit, std::string_view help) {
  const double scale = gui.scale();
  const ImVec2 size = {ImGui::GetContentRegionAvail().x, static_cast<float>(130.0 * scale)};
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy(size);
  gui.mark("{}", name);
  tooltip(help);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, IM_COL32(20, 21, 23, 255), 4.0f);
  if (samples.size() < 2) return;
  double low = 0.0, high = 0.0;
  for (const EnergySample& s : samples) {
    for (const Curve& c : curves) {
      low = std::min(low, c.value(s.measures));
      high = std::max(high, c.value(s.measures));
    }
  }
  if (!(high > low) || !std::isfinite(high - low)) return;
  const double start = samples.front().time, span = samples.back().time - start;
  if (!(span > 0.0)) return;
  const float pad = static_cast<float>(6.0 * scale), line = ImGui::GetTextLineHeight();
  const auto place = [&](double t, double e) {
    return ImVec2(corner.x + pad + static_cast<float>((t - start) / span) * (size.x - 2.0f * pad),
                  corner.y + size.y - pad -
                      static_cast<float>((e - low) / (high - low)) * (size.y - 2.0f * (pad + line)) - line);
  };
  draw.AddLine(place(start, 0.0), place(start + span, 0.0), IM_COL32(80, 84, 90, 255));
  // One point for each column is all that can be seen.
  const std::size_t stride =
      std::max<std::size_t>(samples.size() / static_cast<std::size_t>(std::max(size.x, 1.0f)), 1);
  for (const Curve& c : curves) {
    for (std::size_t i = 0; i < samples.size(); i += stride)
      draw.PathLineTo(place(samples[i].time, c.value(samples[i].measures)));
    draw.PathLineTo(place(samples.back().time, c.value(samples.back().measures)));
    draw.PathStroke(c.colour, 0, static_cast<float>(1.5 * scale));
  }
  const std::string top = fmt::format("{:.4g} {}", high, unit), end = fmt::format("{:.3g} s", start + span);
  draw.AddText({corner.x + pad, corner.y + 2.0f}, IM_COL32(140, 145, 152, 255), top.c_str());
  const ImVec2 text = ImGui::CalcTextSize(end.c_str());
  draw.AddText({corner.x + size.x - pad - text.x, corner.y + size.y - text.y - 2.0f},
               IM_COL32(140, 145, 152, 255), end.c_str());
}

/// Device time by pass.
void pass_times(Gui& gui, GpuSolver& solver) {
  // Measured only while it is shown: a measured step takes a little longer.
  solver.set_profiling(true);
  ImGui::TextDisabled("Passes of a step");
  gui.mark("performance/passes");
  tooltip(
      "Device time of each kind of pass in a step [ms], and how many dispatches it takes; means over the "
      "last steps measured, from time stamps.");
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

}  // namespace

void performance_section(Gui& gui, Simulation& s, const ScenePicture& picture) {
  const gl::DeviceInfo& device = picture.context().info();
  figure("Steps", s.running() ? short_number(s.pacer().steps_per_second()) + "/s" : "paused",
         "Time steps per second.");
  const auto evaluations = s.spring_evaluations_per_second();
  figure("Spring evaluations",
         !s.running()  ? "paused"
         : evaluations ? short_number(*evaluations) + "/s"
                       : "varies",
         "Springs × force evaluations of a step × steps per second. Implicit Euler has no fixed number per "
         "step.");
  figure("Real-time factor", s.running() ? fmt::format("{:.3g}", s.real_time_factor()) : "paused",
         "Simulated seconds per second.");
  figure("Pictures",
         fmt::format("{:.0f}/s, {:.1f} ms each", picture.pictures_per_second(), 1e3 * picture.draw_seconds()),
         "Pictures per second, and the time for the last one.");
  if (device.is_software) {
    figure("Resolution", fmt::format("{:.0f} % in motion", 100.0 * picture.resolution()),
           "A software rasteriser draws: pictures are coarser while something moves.");
  }
  if (s.gpu()) pass_times(gui, *s.gpu());
  const Model& model = s.model();
  figure("Particles", fmt::format("{}", model.particle_count()), "Particles of all bodies.");
  figure("Springs", fmt::format("{}", spring_count(model)), "Springs of all types.");
  if (model.ball_count() > 0)
    figure("Balls", fmt::format("{}", model.ball_count()), "Balls, launched or waiting.");
  figure("Solver", fmt::format("{}, {}", s.solver().backend(), human_bytes(s.solver().bytes())),
         s.solver().description());
  ImGui::TextDisabled("%s", device.renderer.substr(0, 40).c_str());
  tooltip(fmt::format("Draws the window: {}, OpenGL {}", device.renderer, device.version));
}

void energy_section(Gui& gui, const std::deque<EnergySample>& samples) {
  const auto show = [&](const char* name, std::span<const Curve> curves, const char* unit,
                        std::string_view help) {
    plot(gui, name, samples, curves, unit, help);
    if (samples.empty()) return;
    for (const Curve& c : curves) {
      ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(c.colour), "%s", c.name);
      tooltip(help);
      ImGui::SameLine(ImGui::GetWindowContentRegionMax().x * 0.52f);
      ImGui::Text("%.5g %s", c.value(samples.back().measures), unit);
    }
  };
  show("energy/plot", energy_curves, "J",
       "Energies of the run over time [J]. The gravitational one is zero at the origin.");
  show("energy/momentum", momentum_curves, "N·s",
       "Momentum Σ m·v of everything that moves over time [N·s], by axis and in magnitude.");
}

}  // namespace aspic::app
