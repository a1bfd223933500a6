#include "app/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "app/number_field.h"
#include "app/panel.h"
#include "app/parameter_widget.h"
#include "base/printable.h"
#include "render/tiles.h"

namespace aspic::app {
namespace {

constexpr double status_height = 30.0, timeline_height = 34.0;
/// Where both sides would leave the scene less, one takes all sections; and the most that one takes.
constexpr double least_view = 376.0, most_of_width = 0.5;
constexpr double edge = 6.0;  // width of the strip by which a panel is dragged
constexpr ImGuiWindowFlags behind = ImGuiWindowFlags_NoBringToFrontOnFocus;
constexpr ImGuiWindowFlags bar = behind | ImGuiWindowFlags_NoScrollbar;

struct Heading {
  const char* name;
  void (*section)(const PanelParts&);
  const char* help;
};
using Parts = const PanelParts&;
constexpr Heading left_sections[] = {
    {"Simulation", [](Parts p) { simulation_section(p.gui, p.simulation, p.scene, p.comparison); },
     "Motion, integrator, time step, pace and gravity."},
    {"Springs", [](Parts p) { springs_section(p.gui, p.scene, p.layout); },
     "Stiffness and damping, for all types, by type, or by material."},
    {"Scene", [](Parts p) { scene_section(p.gui, p.scene); },
     "Scenes and terrain; opening, saving and reloading."},
    {"Bodies", [](Parts p) { bodies_section(p.gui, p.scene, p.simulation, p.cells, p.layout); },
     "Add a body, and set the place, size, mass and pins of each."},
    {"Cells", [](Parts p) { cells_section(p.gui, p.scene, p.cells); },
     "Paint the layers of a body of cells with the mouse."},
    {"Materials", [](Parts p) { materials_section(p.gui, p.scene, p.messages); },
     "Named materials: density, Young's modulus and damping ratio."},
    {"Contact", [](Parts p) { contact_section(p.gui, p.scene); },
     "Contact model, restitution, friction, and values of each terrain."},
    {"Balls", [](Parts p) { balls_section(p.gui, p.simulation, p.hands); },
     "Throwing balls, and the strength of mouse pulls."}};
constexpr Heading right_sections[] = {
    {"Energy", [](Parts p) { energy_section(p.gui, p.comparison_view, p.run, p.layout); },
     "Energies and momentum over time."},
    {"View",
     [](Parts p) { view_section(p.gui, p.scene, p.view.camera, p.image.range(), p.image.shadows, p.layout); },
     "Bodies, colors, the camera, and the size of text."},
    {"Side by side", [](Parts p) { comparison_section(p.gui, p.scene, p.comparison_view); },
     "Up to three more runs, each with one difference."},
    {"Recording",
     [](Parts p) {
       recording_section(p.gui, p.scene.editor().source(), p.video);
       ImGui::Separator();
       image_files(p.gui, p.image.saved);
       ImGui::Separator();
       state_files(p.gui, p.scene.editor().source(), p.simulation, p.comparison_view, p.messages, p.files);
     },
     "Videos; states, energies and checkpoints as files."},
    {"Stability", [](Parts p) { stability_section(p.gui, p.scene, p.stability); },
     "Stable time steps and stiffnesses, and the place of the scene among them."},
    {"Performance", [](Parts p) { performance_section(p.gui, p.simulation, p.comparison, p.image); },
     "Speed of simulation and rendering, and the devices used."},
    {"Compare backends", [](Parts p) { shadow_section(p.gui, p.simulation, p.run); },
     "A second backend on the same run, and the largest difference."}};

/// `wanted`: the one to scroll to.
void sections(Parts parts, std::span<const Heading> headings, std::string_view wanted) {
  const LayoutRow& row = parts.layout.row();
  std::map<std::string, bool>& kept = parts.layout.sections;
  for (const Heading& heading : headings) {
    if (!row.sections.empty() && std::ranges::find(row.sections, heading.name) == row.sections.end())
      continue;
    const auto known = kept.find(heading.name);
    const bool was_open =
        known == kept.end() ? std::ranges::find(row.open, heading.name) != row.open.end() : known->second;
    ImGui::SetNextItemOpen(was_open);
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.97f, 0.98f, 1.0f, 1.0f));
    const bool open = ImGui::CollapsingHeader(heading.name);
    ImGui::PopStyleColor();
    if (open != was_open) kept[heading.name] = open;
    named(parts.gui, fmt::format("section/{}", heading.name), heading.help);
    if (heading.name == wanted) ImGui::SetScrollHereY(0.0f);
    if (!open) continue;
    ImGui::PushID(heading.name);
    heading.section(parts);
    ImGui::PopID();
    ImGui::Dummy(at(0.0, 2.0 * parts.gui.scale()));
  }
}

int longest_edge(const PlaybackSession& s) {
  int particles = 0;
  for (const CubeSettings& cube : s.present().setup().settings.cubes)
    particles = std::max(particles, std::ranges::max(cube.lattice()));
  return particles;
}

/// The facts of the run, as many as there is room for: the first are never left out.
void status_line(Parts parts, const Box& box) {
  const double scale = parts.gui.scale();
  const PlaybackSession& s = parts.simulation;
  const Recording* const video = parts.video.recording();
  const Panel panel("##status", box, at(12.0 * scale, 6.0 * scale), bar);
  const ImVec4 bright = ImGui::GetStyleColorVec4(ImGuiCol_CheckMark);
  const Comparison& comparison = parts.comparison;
  const bool others = comparison.clock().others_go_on();
  const char* const motion = s.divergence() && !others   ? "Diverged"
                             : comparison.clock().runs() ? "Running"
                                                         : "Paused";
  ImGui::TextColored(s.divergence() ? ImVec4(0.95f, 0.55f, 0.40f, 1.0f) : bright, "%s", motion);
  const bool software = parts.image.context().info().is_software && s.present().backend().needs_context;
  std::vector<std::string> facts = {
      fmt::format("t = {:.3f} s", comparison.clock().time()),
      fmt::format("{}{}", s.present().solver().backend(), software ? " (software)" : ""),
      fmt::format("speed ×{:g}", s.pacer().speed()),
  };
  if (video) facts.insert(facts.begin() + 1, fmt::format("● recording, {:.2f} s", video->seconds()));
  const double factor = comparison.clock().runs() ? comparison.clock().real_time_factor() : 0.0;
  if (factor > 0.0) {
    const std::string why = video && !video->ready() ? " (waits for the encoder)"
                            : comparison.clock().setter().pacer().falls_short(factor) && !video
                                ? " (" + slowness(factor, longest_edge(s)) + ")"
                                : "";
    facts.push_back(fmt::format("{:.3g} × real time{}", factor, why));
  }
  if (s.jobs().long_under_way())
    facts.insert(facts.begin(), s.rebuild().changing() ? "working: rebuilding the scene"
                                                       : fmt::format("working on step {}", s.step() + 1));
  const PlaybackSession& setter = comparison.clock().setter();
  facts.push_back(
      fmt::format("step {}", std::llround(comparison.clock().time() / setter.model().simulation.timestep)));
  facts.emplace_back("F1 all keys");
  const float gap = 22.0f * static_cast<float>(scale);
  const float end = ImGui::GetWindowContentRegionMax().x;
  for (const std::string& fact : facts) {
    const float left = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + gap;
    const float width = ImGui::CalcTextSize(fact.c_str()).x;
    if (left + width > end) break;
    ImGui::SameLine(&fact == &facts.back() ? end - width : left);
    // A speed that is not that of the clock is easily forgotten.
    const bool odd = fact.starts_with("speed") && s.pacer().speed() != 1.0;
    ImGui::TextColored(odd ? bright : ImGui::GetStyleColorVec4(ImGuiCol_Text), "%s", fact.c_str());
  }
}

/// The bar of the history, under the image: any step since the start.
void timeline(Gui& gui, const PlaybackSession& s, ComparisonView& comparison_view, RunControl& run,
              const Box& box) {
  const Comparison& comparison = comparison_view.comparison();

  const History& history = s.playback().history();
  const double scale = gui.scale();
  const Panel panel("##timeline", box, at(12.0 * scale, 4.0 * scale), bar);
  const double first = history.time(history.begin_moment()),
               last = std::max(comparison.clock().end_time(), first);
  double now = std::clamp(comparison.clock().time(), first, last);
  const bool on_the_way = s.playback().seeking() || comparison.clock().setter().playback().seeking();
  const std::string text = fmt::format("{:.3f} / {:.3f} s{}", now, last, on_the_way ? "  …" : "");
  ImGui::SetNextItemWidth(-1.0f);
  const bool moved = ImGui::SliderScalar("##history", ImGuiDataType_Double, &now, &first, &last, text.c_str(),
                                         ImGuiSliderFlags_NoInput | ImGuiSliderFlags_AlwaysClamp);
  gui.mark("timeline");
  const ImVec2 corner = ImGui::GetItemRectMin(), end = ImGui::GetItemRectMax();
  tooltip(fmt::format("Shows the run so far, {} of at most 512 MiB in {} states. Drag to go to any step. "
                      "Continuing there discards later steps.",
                      human_bytes(history.bytes()), history.keyframe_count()),
          "step back");
  if (last > first) {
    for (const double t : history.changes()) {
      const float x = corner.x + static_cast<float>((t - first) / (last - first)) * (end.x - corner.x);
      ImGui::GetWindowDrawList()->AddLine({x, end.y - static_cast<float>(5.0 * scale)}, {x, end.y},
                                          IM_COL32(242, 176, 92, 255), static_cast<float>(1.5 * scale));
    }
  }
  if (moved && last > first && !comparison_view.go_to(now)) run.go_to(now);
}

/// The buttons of a lesson, large, at the bottom of the image. Returns the view above them.
Box action_bar(Parts p, const Box& view) {
  const double scale = p.gui.scale(), gap = 8.0 * scale, pad = 8.0 * scale;
  const double width = std::min(118.0 * scale, (view.right - view.left - 5.0 * gap - 2.0 * pad) / 4.0);
  if (width < 64.0 * scale) return view;
  const double height = 36.0 * scale, top = view.bottom - height - 2.0 * pad - gap;
  const double half = 2.0 * width + 1.5 * gap + pad;
  ImGui::SetNextWindowPos(at(view.center_x() - half, top));
  ImGui::SetNextWindowSize(at(2.0 * half, height + 2.0 * pad));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(pad, pad));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, at(gap, gap));
  {
    const Panel panel("##actions", 8.0 * scale, ImVec4(0.09f, 0.095f, 0.10f, 0.72f),
                      bar | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::SetWindowFontScale(1.15f);
    const auto large = [&](const char* name, const char* label, std::string_view help, const char* command,
                           bool enabled) {
      ImGui::PushID(name);
      ImGui::BeginDisabled(!enabled);
      const bool pressed = ImGui::Button(label, at(width, height));
      ImGui::EndDisabled();
      named(p.gui, name, help, command);
      ImGui::PopID();
      if (pressed) p.gui.commands().run(command);
    };
    const Comparison& comparison = p.comparison;
    const bool runs = comparison.clock().runs(), videos = p.video.recording() != nullptr;
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_SliderGrabActive));
    large("actions/start", runs ? "Pause" : "Start", "Starts or pauses the motion.", "start or pause",
          !p.simulation.divergence() || comparison.clock().others_go_on());
    ImGui::PopStyleColor();
    ImGui::SameLine();
    large("actions/reset", "Reset", "Returns to the scene's start.", "reset to the start", true);
    ImGui::SameLine();
    large("actions/compare", "Compare", "Adds a run with one difference. Change it under Side by side.",
          "add a run side by side", comparison.count() < most_compared);
    ImGui::SameLine();
    large("actions/video", videos ? "End video" : "Video", "Starts or ends a video of all runs.",
          "start or end a video", true);
  }
  ImGui::PopStyleVar(2);
  Box above = view;
  above.bottom = top;
  return above;
}

/// The edge of a side, which can be dragged. `inwards` is 1 where the panel lies on the left.
void drag_edge(Gui& gui, const char* name, double place, double height, double inwards, double& width) {
  const double scale = gui.scale(), grip = edge * scale;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, at(1.0, 1.0));
  const Panel panel(name, {place - 0.5 * grip, 0.0, place + 0.5 * grip, height}, at(0.0, 0.0),
                    ImGuiWindowFlags_NoBackground);
  ImGui::PopStyleVar();
  ImGui::InvisibleButton("##edge", at(grip, height));
  named(gui, name, "Drag to resize the panels; double-click to reset their width.");
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  if (ImGui::IsItemHovered() || ImGui::IsItemActive())
    ImGui::GetWindowDrawList()->AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_ButtonHovered));
  if (ImGui::IsItemActive()) {
    const double there = ImGui::GetIO().MousePos.x - place;
    const double wanted = width + inwards * there / scale;
    width = std::clamp(wanted, Layout::narrowest, Layout::widest);
  }
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
    width = Layout::side_width;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> section_names() {
  std::vector<std::pair<std::string, std::string>> names;
  for (const auto& side : {std::span<const Heading>(left_sections), std::span<const Heading>(right_sections)})
    for (const Heading& heading : side) names.emplace_back(heading.name, heading.help);
  return names;
}

void show_section(Layouts& layout, std::string_view name) {
  const auto& there = layout.row().sections;
  if (!there.empty() && std::ranges::find(there, name) == there.end()) layout.choose(layouts().front());
  layout.panels = true;
  layout.sections[std::string(name)] = true;
  layout.want(name);
}

void draw_panels(const PanelParts& p, double width, double height) {
  const double scale = p.gui.scale();
  Layouts& layout = p.layout;
  Box view = {0.0, 0.0, width, height};
  if (layout.panels) {
    const double bottom = height - status_height * scale;
    const double left = std::min(layout.left_width * scale, most_of_width * width);
    const bool two = layout.row().sides == 2 &&
                     width - (layout.left_width + layout.right_width) * scale >= least_view * scale;
    const double right = two ? layout.right_width * scale : 0.0;
    const ImVec2 padding = ImGui::GetStyle().WindowPadding;
    const std::string wanted = p.layout.take_wanted();
    {
      const Panel panel("##left", {0.0, 0.0, left, bottom}, padding, behind);
      sections(p, left_sections, wanted);
      if (!two) sections(p, right_sections, wanted);
    }
    if (two) {
      const Panel panel("##right", {width - right, 0.0, width, bottom}, padding, behind);
      sections(p, right_sections, wanted);
    }
    status_line(p, {0.0, bottom, width, height});
    view = {left, 0.0, width - right, bottom - timeline_height * scale};
    timeline(p.gui, p.simulation, p.comparison_view, p.run, {view.left, view.bottom, view.right, bottom});
    drag_edge(p.gui, "layout/left", left, bottom, 1.0, layout.left_width);
    if (two) drag_edge(p.gui, "layout/right", width - right, bottom, -1.0, layout.right_width);
  }
  if (const auto error = take_typing_error()) p.messages.refuse(*error);
  p.comparison_view.place(view);
  const Box corners = layout.panels ? action_bar(p, view) : view;
  draw_corners(p, corners);
  notice_panels(p, corners);
  help_panel(p.gui, p.help_visible, width, height);
  closing_panel(p.gui, p.closing, width, height);
  p.files.draw(p.gui, width, height);
  p.palette.draw(p, width, height);
  draw_edited_layer(p);
  if (const auto& hovered = p.pointer.hovered())
    ball_mark(p.gui, p.simulation.hand(), *hovered, p.view, p.image.shown());
}

}  // namespace aspic::app
