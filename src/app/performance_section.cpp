// The section that measures.
#include <fmt/format.h>
#include <imgui.h>

#include <string>
#include <vector>

#include "app/figure.h"
#include "app/panels.h"
#include "base/printable.h"
#include "model/springs.h"

namespace aspic::app {
namespace {

/// 1234567 as "1.23 M".
std::string short_number(double value) {
  if (value >= 1e9) return fmt::format("{:.3g} G", value / 1e9);
  if (value >= 1e6) return fmt::format("{:.3g} M", value / 1e6);
  if (value >= 1e3) return fmt::format("{:.3g} k", value / 1e3);
  return fmt::format("{:.3g}", value);
}

/// Device time by pass.
void pass_times(Gui& gui, GpuSolver& solver) {
  // Measured only while it is shown: a measured step takes a little longer.
  solver.set_profiling(true);
  group_heading("Passes of a step");
  named(gui, "performance/passes", "Shows mean device time [ms] and dispatches of each pass.");
  const std::vector<gl::PassTime> passes = solver.pass_times();
  if (passes.empty()) {
    ImGui::TextDisabled("   not measured yet");
    return;
  }
  double sum = 0.0;
  const float column = ImGui::GetWindowContentRegionMax().x * figure_column;
  for (const gl::PassTime& pass : passes) {
    ImGui::TextDisabled("   %s", pass.name.c_str());
    // A long name has a separate line.
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

void performance_section(Gui& gui, PlaybackSession& s, const Comparison& comparison,
                         const SceneImage& image) {
  const gl::DeviceInfo& device = image.context().info();
  // After a divergence of the window's own run, figures of the one that sets the clock.
  const PlaybackSession& setter = comparison.clock().setter();
  const bool runs = comparison.clock().runs();
  figure("Steps", runs ? short_number(setter.pacer().steps_per_second()) + "/s" : "paused",
         "Time steps per second.");
  gui.mark("performance/steps");
  const auto evaluations = spring_evaluations_per_second(setter);
  figure("Spring evaluations",
         !runs         ? "paused"
         : evaluations ? short_number(*evaluations) + "/s"
                       : "varies",
         "Springs × force evaluations of a step × steps per second. Implicit Euler has no fixed number per "
         "step.");
  figure("Real-time factor", runs ? fmt::format("{:.3g}", comparison.clock().real_time_factor()) : "paused",
         "Simulated seconds per second.");
  figure("Images",
         image.at_rest ? fmt::format("at rest, {:.0f} ms", 1e3 * image.rate.draw_seconds)
                       : fmt::format("{:.0f}/s, {:.1f} ms each", image.rate.per_second(),
                                     1e3 * image.rate.draw_seconds),
         "Window frames per second, and the time of the scene's last one.");
  if (const FramePolicy* const policy = image.policy()) {
    const double share = image.full_quality ? 1.0 : policy->resolution.share();
    figure("Resolution", fmt::format("{:.0f} % in motion", 100.0 * share),
           "A software rasterizer draws. Frames are coarser during motion; still and saved images have full "
           "size.");
  }
  GpuSolver* const gpu = gpu_of(s.present().engines().leader());
  if (gpu && device.is_software) {
    figure("Passes of a step", "not timed",
           "The time stamps of a software device do not measure its passes.");
    gui.mark("performance/not-timed");
  } else if (gpu) {
    pass_times(gui, *gpu);
  }
  const Model& model = s.model();
  figure("Particles", fmt::format("{}", model.particle_count()), "Particles of all bodies.");
  figure("Springs", fmt::format("{}", spring_count(model)), "Springs of all types.");
  if (model.ball_count() > 0)
    figure("Balls", fmt::format("{}", model.ball_count()), "Balls, launched or waiting.");
  figure("Solver",
         fmt::format("{}, {}", s.present().solver().backend(), human_bytes(s.present().solver().bytes())),
         s.present().solver().description());
  ImGui::TextDisabled("%s", device.renderer.substr(0, 40).c_str());
  tooltip(fmt::format("Renders the window: {}, OpenGL {}", device.renderer, device.version));
}

}  // namespace aspic::app
