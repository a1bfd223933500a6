#include "app/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "app/parameter_widget.h"

namespace aspic::app {
namespace {

constexpr double status_height = 30.0, timeline_height = 34.0;
/// Where both sides would leave the scene less, one takes all sections; and the most that one takes.
constexpr double least_view = 376.0, most_of_width = 0.5;
constexpr double edge = 6.0;  // width of the strip by which a panel is dragged
constexpr ImGuiWindowFlags fixed_panel =
    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

struct Heading {
  const char* name;
  void (*section)(const PanelParts&);
  bool open;  ///< at first
  const char* help;
};
using Parts = const PanelParts&;
constexpr Heading left_sections[] = {
    {"Scene", [](Parts p) { scene_section(p.gui, p.scene); }, true,
     "Scenes and terrain; opening, saving and reloading."},
    {"Simulation", [](Parts p) { simulation_section(p.gui, p.simulation, p.scene); }, true,
     "Motion, integrator, time step, pace and gravity."},
    {"Bodies", [](Parts p) { bodies_section(p.gui, p.scene); }, false,
     "Cubes, nets, balls and launchers of the scene: place, size, mass, pins."},
    {"Springs", [](Parts p) { springs_section(p.gui, p.scene); }, false,
     "Stiffness and damping by type, or a material."},
    {"Contact", [](Parts p) { contact_section(p.gui, p.scene); }, false,
     "Contact model, restitution, friction, and the terrain's own values."},
    {"Balls", [](Parts p) { balls_section(p.gui, p.simulation, p.hands); }, false,
     "Balls thrown by hand, and the strength of pulls."}};
constexpr Heading right_sections[] = {
    {"View", [](Parts p) { view_section(p.gui, p.scene, p.view.camera, p.picture.shadows, p.layout); }, true,
     "What is drawn, its colours, the camera, and the size of text."},
    {"Recording",
     [](Parts p) {
       recording_section(p.gui, p.scene.editor().source(), p.film);
       ImGui::Separator();
       state_files(p.gui, p.scene.editor(), p.simulation, p.messages);
     },
     false, "Films of the scene; its states, energies and checkpoints as files."},
    {"Performance", [](Parts p) { performance_section(p.gui, p.simulation, p.picture); }, true,
     "Speed of simulation and drawing, and the devices used."},
    {"Energy", [](Parts p) { energy_section(p.gui, p.simulation.samples().energies()); }, true,
     "Energies and momentum over time."},
    {"Shadow", [](Parts p) { shadow_section(p.gui, p.simulation, p.run); }, false,
     "A second backend on the same run, and how far the two differ."},
    {"Stability", [](Parts p) { stability_section(p.gui, p.scene); }, false,
     "Which time steps and stiffnesses are stable, and where the scene is among them."}};

ImVec2 at(double x, double y) {
  return {static_cast<float>(x), static_cast<float>(y)};
}

void sections(Parts parts, std::span<const Heading> headings) {
  std::map<std::string, bool>& kept = parts.layout.sections;
  for (const Heading& heading : headings) {
    const auto known = kept.find(heading.name);
    const bool was_open = known == kept.end() ? heading.open : known->second;
    ImGui::SetNextItemOpen(was_open);
    const bool open = ImGui::CollapsingHeader(heading.name);
    if (open != was_open) kept[heading.name] = open;
    parts.gui.mark("section/{}", heading.name);
    tooltip(heading.help);
    if (!open) continue;
    ImGui::PushID(heading.name);
    heading.section(parts);
    ImGui::PopID();
    ImGui::Dummy(at(0.0, 2.0 * parts.gui.scale()));
  }
}

/// The facts of the run, as many as there is room for: the first are never left out.
void status_line(double scale, const Simulation& s, const Recording* film, bool software_device) {
  const ImVec4 bright = ImGui::GetStyleColorVec4(ImGuiCol_CheckMark);
  const char* const motion = s.divergence() ? "Diverged" : s.running() ? "Running" : "Paused";
  ImGui::TextColored(s.divergence() ? ImVec4(0.95f, 0.55f, 0.40f, 1.0f) : bright, "%s", motion);
  const bool software = software_device && s.backend().needs_context;
  std::vector<std::string> facts = {
      fmt::format("t = {:.3f} s", s.time()),
      fmt::format("{}{}", s.solver().backend(), software ? " (software)" : ""),
      fmt::format("speed ×{:g}", s.pacer().speed),
  };
  if (film) facts.insert(facts.begin() + 1, fmt::format("● filming, {:.2f} s", film->seconds()));
  if (s.running()) {
    const char* const why = film && !film->ready()        ? " (waits for the encoder)"
                            : s.pacer().behind() && !film ? " (the solver does not keep up)"
                                                          : "";
    facts.push_back(fmt::format("{:.3g} × real time{}", s.real_time_factor(), why));
  }
  if (s.working())
    facts.insert(facts.begin(), s.changing() ? "working: rebuilds the scene"
                                             : fmt::format("working on step {}", s.step() + 1));
  facts.push_back(fmt::format("step {}", s.step()));
  facts.emplace_back("F1 all keys");
  const float gap = 22.0f * static_cast<float>(scale);
  const float end = ImGui::GetWindowContentRegionMax().x;
  for (const std::string& fact : facts) {
    const float left = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + gap;
    const float width = ImGui::CalcTextSize(fact.c_str()).x;
    if (left + width > end) break;
    ImGui::SameLine(&fact == &facts.back() ? end - width : left);
    ImGui::TextUnformatted(fact.c_str());
  }
}

/// A panel that floats over the picture, with round corners.
class FloatingPanel {
 public:
  FloatingPanel(const char* name, double rounding, const ImVec4& colour, ImGuiWindowFlags flags = 0) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, static_cast<float>(rounding));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, colour);
    ImGui::Begin(name, nullptr, (fixed_panel & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | flags);
  }
  ~FloatingPanel() {
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
  }
  FloatingPanel(const FloatingPanel&) = delete;
  FloatingPanel& operator=(const FloatingPanel&) = delete;
};

/// Ways on after a divergence.
void divergence_buttons(Gui& gui, const Simulation& simulation, RunControl& run, Messages& messages) {
  const auto& stable = run.stable_step();
  if (stable && stable->step && std::isfinite(*stable->step)) {
    if (button(gui, "diverged/stable", "Use a stable step",
               "Steps back and sets the time step to 0.95 of the estimate."))
      run.take_stable_step();
    ImGui::SameLine();
  }
  if (simulation.can_step_back()) {
    const std::string back =
        fmt::format("Back to t = {:.3f} s", simulation.history().time(simulation.before_trouble()));
    if (button(gui, "diverged/back", back.c_str(),
               "Returns to shortly before the divergence, with the values that the scene had then."))
      run.back_before_divergence();
    ImGui::SameLine();
  }
  if (command_button(gui, "diverged/reset", "Reset", "Returns to the scene's start.", "reset to the start"))
    messages.dismiss();
  ImGui::SameLine();
}

void notice_panel(Gui& gui, Messages& messages, const Simulation& simulation, RunControl& run,
                  const Box& view) {
  if (!messages.notice()) return;
  const Notice notice = *messages.notice();
  const double scale = gui.scale();
  const double width = std::min(view.right - view.left - 32.0 * scale, 640.0 * scale);
  if (width < 80.0 * scale) return;
  ImGui::SetNextWindowPos(at(view.left + 16.0 * scale, view.top + 16.0 * scale));
  ImGui::SetNextWindowSize(at(width, 0.0));
  const FloatingPanel panel(
      "##notice", 6.0 * scale,
      notice.is_error ? ImVec4(0.23f, 0.11f, 0.09f, 0.94f) : ImVec4(0.10f, 0.13f, 0.14f, 0.90f));
  // Scene errors come with their line and a caret, whose columns must stay.
  wrapped_text(notice.text, ImGui::GetContentRegionAvail().x);
  if (simulation.divergence()) divergence_buttons(gui, simulation, run, messages);
  if (button(gui, "notice/close", "Close", "Dismiss this message (Escape).")) messages.dismiss();
}

void help_panel(Gui& gui, bool& visible, double width, double height) {
  if (!visible) return;
  ImGui::SetNextWindowPos(at(0.5 * width, 0.5 * height), ImGuiCond_Always, {0.5f, 0.5f});
  const FloatingPanel panel("##help", 8.0 * gui.scale(), ImVec4(0.09f, 0.095f, 0.10f, 0.97f),
                            ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::TextUnformatted("Keys and mouse");
  ImGui::Separator();
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const Command& c : gui.commands().rows()) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextColored(ImGui::GetStyleColorVec4(ImGuiCol_CheckMark), "%.*s    ",
                         static_cast<int>(c.keys.size()), c.keys.data());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(c.name.data(), c.name.data() + c.name.size());
    }
    ImGui::EndTable();
  }
  ImGui::Separator();
  if (button(gui, "help/close", "Close", "Close this page (F1 or Escape).")) visible = false;
}

void side(Parts parts, const char* name, double left, double width, double height,
          std::span<const Heading> first, std::span<const Heading> second) {
  ImGui::SetNextWindowPos(at(left, 0.0));
  ImGui::SetNextWindowSize(at(width, height));
  ImGui::Begin(name, nullptr, fixed_panel);
  sections(parts, first);
  sections(parts, second);
  ImGui::End();
}

/// The edge of a side, which can be dragged. `inwards` is 1 where the panel lies on the left.
void drag_edge(Gui& gui, const char* name, double place, double height, double inwards, double& width) {
  const double scale = gui.scale(), grip = edge * scale;
  ImGui::SetNextWindowPos(at(place - 0.5 * grip, 0.0));
  ImGui::SetNextWindowSize(at(grip, height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(0.0, 0.0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, at(1.0, 1.0));
  ImGui::Begin(name, nullptr,
               (fixed_panel & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | ImGuiWindowFlags_NoBackground);
  ImGui::InvisibleButton("##edge", at(grip, height));
  gui.mark("{}", name);
  tooltip("Drag to make the panels wider or narrower; double-click for their default width.");
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
  ImGui::End();
  ImGui::PopStyleVar(2);
}

}  // namespace

Box draw_panels(const PanelParts& p, double width, double height) {
  const double scale = p.gui.scale();
  Layout& layout = p.layout;
  Box view = {0.0, 0.0, width, height};
  if (layout.panels) {
    const double bottom = height - status_height * scale;
    const double left = std::min(layout.left_width * scale, most_of_width * width);
    const bool two = width - (layout.left_width + layout.right_width) * scale >= least_view * scale;
    const double right = two ? layout.right_width * scale : 0.0;
    side(p, "##left", 0.0, left, bottom, left_sections,
         two ? std::span<const Heading>() : std::span<const Heading>(right_sections));
    if (two) side(p, "##right", width - right, right, bottom, {}, right_sections);
    ImGui::SetNextWindowPos(at(0.0, bottom));
    ImGui::SetNextWindowSize(at(width, status_height * scale));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(12.0 * scale, 6.0 * scale));
    ImGui::Begin("##status", nullptr, fixed_panel | ImGuiWindowFlags_NoScrollbar);
    status_line(scale, p.simulation, p.film.recording(), p.picture.context().info().is_software);
    ImGui::End();
    ImGui::PopStyleVar();
    view = {left, 0.0, width - right, bottom - timeline_height * scale};
    draw_timeline(p.gui, p.simulation, p.run, {view.left, view.bottom, view.right, bottom});
    drag_edge(p.gui, "layout/left", left, bottom, 1.0, layout.left_width);
    if (two) drag_edge(p.gui, "layout/right", width - right, bottom, -1.0, layout.right_width);
  }
  notice_panel(p.gui, p.messages, p.simulation, p.run, view);
  help_panel(p.gui, p.help_visible, width, height);
  if (const auto& hovered = p.pointer.hovered()) hover_tooltip(scale, p.simulation, *hovered, p.view.box);
  return view;
}

}  // namespace aspic::app
