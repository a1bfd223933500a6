#include "app/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "app/app.h"
#include "app/parameter_widget.h"
#include "app/shortcuts.h"

namespace aspic::app {
namespace {

constexpr double status_height = 30.0, timeline_height = 34.0;
/// Where both sides would leave the scene less, one takes all sections; and the most that one takes.
constexpr double least_view = 376.0, most_of_width = 0.5;
constexpr double edge = 6.0;  // what takes hold of a panel's edge
constexpr ImGuiWindowFlags fixed_panel =
    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

using Section = void (*)(App&);
struct Heading {
  const char* name;
  Section section;
  bool open;  ///< at first
  const char* help;
};
constexpr Heading left_sections[] = {
    {"Scene", scene_section, true, "Scenes, terrain, and what to do with the scene as a whole."},
    {"Simulation", simulation_section, true, "Motion, integrator, time step, pace and gravity."},
    {"Bodies", bodies_section, false,
     "Cubes, nets, balls and launchers of the scene: place, size, mass, pins."},
    {"Springs", springs_section, false, "Stiffness and damping by type, or a material."},
    {"Contact", contact_section, false,
     "Contact model, restitution, friction, and the terrain's own values."},
    {"Balls", balls_section, false, "Balls thrown by hand, and how hard hands pull."}};
constexpr Heading right_sections[] = {
    {"View", view_section, true, "What is drawn, its colours, the camera, and the size of text."},
    {"Recording", recording_section, false,
     "Films of the scene; its states, energies and checkpoints as files."},
    {"Performance", performance_section, true, "How fast simulation and pictures are, and by what."},
    {"Energy", energy_section, true, "Energies and momentum over time."},
    {"Shadow", shadow_section, false, "The other backend alongside, and how far the two are apart."}};

ImVec2 at(double x, double y) {
  return {static_cast<float>(x), static_cast<float>(y)};
}

void sections(App& app, std::span<const Heading> headings) {
  std::map<std::string, bool>& kept = app.layout().sections;
  for (const Heading& heading : headings) {
    const auto known = kept.find(heading.name);
    const bool was_open = known == kept.end() ? heading.open : known->second;
    ImGui::SetNextItemOpen(was_open);
    const bool open = ImGui::CollapsingHeader(heading.name);
    if (open != was_open) kept[heading.name] = open;
    app.gui().mark(fmt::format("section/{}", heading.name));
    tooltip(heading.help);
    if (!open) continue;
    ImGui::PushID(heading.name);
    heading.section(app);
    ImGui::PopID();
    ImGui::Dummy(at(0.0, 2.0 * app.gui().scale()));
  }
}

/// The facts of the run, as many as there is room for: the first are never left out.
void status_line(App& app) {
  const Simulation& s = app.simulation();
  const ImVec4 bright = ImGui::GetStyleColorVec4(ImGuiCol_CheckMark);
  const char* const motion = s.divergence() ? "Diverged" : s.running() ? "Running" : "Paused";
  ImGui::TextColored(s.divergence() ? ImVec4(0.95f, 0.55f, 0.40f, 1.0f) : bright, "%s", motion);
  const bool software = app.device().is_software && s.backend().needs_context;
  std::vector<std::string> facts = {
      fmt::format("t = {:.3f} s", s.time()),
      fmt::format("{}{}", s.solver().backend(), software ? " (software)" : ""),
      fmt::format("speed ×{:g}", s.speed),
  };
  if (app.recording())
    facts.insert(facts.begin() + 1, fmt::format("● filming, {:.2f} s", app.recording()->seconds()));
  if (s.running()) {
    const bool waits = app.recording() && !app.recording()->ready();
    const char* const why = waits                            ? " (waits for the encoder)"
                            : s.behind() && !app.recording() ? " (the solver does not keep up)"
                                                             : "";
    facts.push_back(fmt::format("{:.3g} × real time{}", s.real_time_factor(), why));
  }
  facts.push_back(fmt::format("step {}", s.step()));
  facts.push_back("F1 all keys");
  const float gap = 22.0f * static_cast<float>(app.gui().scale());
  const float end = ImGui::GetWindowContentRegionMax().x;
  for (const std::string& fact : facts) {
    const float left = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + gap;
    const float width = ImGui::CalcTextSize(fact.c_str()).x;
    if (left + width > end) break;
    ImGui::SameLine(&fact == &facts.back() ? end - width : left);
    ImGui::TextUnformatted(fact.c_str());
  }
}

void notice_panel(App& app, const Box& view) {
  if (!app.notice()) return;
  const Notice notice = *app.notice();
  const double scale = app.gui().scale();
  const double width = std::min(view.right - view.left - 32.0 * scale, 640.0 * scale);
  if (width < 80.0 * scale) return;
  ImGui::SetNextWindowPos(at(view.left + 16.0 * scale, view.top + 16.0 * scale));
  ImGui::SetNextWindowSize(at(width, 0.0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6.0f * static_cast<float>(scale));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, notice.is_error ? ImVec4(0.23f, 0.11f, 0.09f, 0.94f)
                                                           : ImVec4(0.10f, 0.13f, 0.14f, 0.90f));
  ImGui::Begin("##notice", nullptr, fixed_panel & ~ImGuiWindowFlags_NoBringToFrontOnFocus);
  // Scene errors come with their line and a caret, whose columns must stay.
  wrapped_text(notice.text, ImGui::GetContentRegionAvail().x);
  Gui& gui = app.gui();
  const auto& stable = app.stable_step();
  if (app.simulation().divergence()) {
    if (stable && stable->step && std::isfinite(*stable->step)) {
      const bool pressed = button(gui, "diverged/stable", "Take a stable step",
                                  "Steps back, and sets the time step to 0.95 of the estimate.");
      if (pressed) app.take_stable_step();
      ImGui::SameLine();
    }
    const Simulation& simulation = app.simulation();
    if (simulation.can_step_back()) {
      const std::string back =
          fmt::format("Back to t = {:.3f} s", simulation.history().time(simulation.before_trouble()));
      if (button(gui, "diverged/back", back.c_str(),
                 "A while before it happened, with the values the scene had then."))
        app.back_before_trouble();
      ImGui::SameLine();
    }
    if (button(gui, "diverged/reset", "Reset", "Back to the scene's start.", "reset to the start")) {
      app.reset();
      app.dismiss_notice();
    }
    ImGui::SameLine();
  }
  if (button(gui, "notice/close", "Close", "Takes this message away (Escape).")) app.dismiss_notice();
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
}

void help_panel(App& app, double width, double height) {
  if (!app.help_visible()) return;
  ImGui::SetNextWindowPos(at(0.5 * width, 0.5 * height), ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 8.0f * static_cast<float>(app.gui().scale()));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0.09f, 0.095f, 0.10f, 0.97f));
  ImGui::Begin("##help", nullptr,
               (fixed_panel & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::TextUnformatted("Keys and mouse");
  ImGui::Separator();
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const Shortcut& s : shortcuts()) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextColored(ImGui::GetStyleColorVec4(ImGuiCol_CheckMark), "%.*s    ",
                         static_cast<int>(s.keys.size()), s.keys.data());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(s.meaning.data(), s.meaning.data() + s.meaning.size());
    }
    ImGui::EndTable();
  }
  ImGui::Separator();
  if (button(app.gui(), "help/close", "Close", "Takes this page away (F1 or Escape).")) app.toggle_help();
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
}

void side(App& app, const char* name, double left, double width, double height,
          std::span<const Heading> first, std::span<const Heading> second) {
  ImGui::SetNextWindowPos(at(left, 0.0));
  ImGui::SetNextWindowSize(at(width, height));
  ImGui::Begin(name, nullptr, fixed_panel);
  sections(app, first);
  sections(app, second);
  ImGui::End();
}

/// The edge of a side, which can be dragged. `inwards` is 1 where the panel lies on the left.
void drag_edge(App& app, const char* name, double place, double height, double inwards, double& width) {
  const double scale = app.gui().scale(), grip = edge * scale;
  ImGui::SetNextWindowPos(at(place - 0.5 * grip, 0.0));
  ImGui::SetNextWindowSize(at(grip, height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(0.0, 0.0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, at(1.0, 1.0));
  ImGui::Begin(name, nullptr,
               (fixed_panel & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | ImGuiWindowFlags_NoBackground);
  ImGui::InvisibleButton("##edge", at(grip, height));
  app.gui().mark(name);
  tooltip("Drag to make the panels wider or narrower; double-click for the width they had at first.");
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

Box draw_panels(App& app, double width, double height) {
  const double scale = app.gui().scale();
  Layout& layout = app.layout();
  Box view = {0.0, 0.0, width, height};
  if (layout.panels) {
    const double bottom = height - status_height * scale;
    const double left = std::min(layout.left_width * scale, most_of_width * width);
    const bool two = width - (layout.left_width + layout.right_width) * scale >= least_view * scale;
    const double right = two ? layout.right_width * scale : 0.0;
    side(app, "##left", 0.0, left, bottom, left_sections,
         two ? std::span<const Heading>() : std::span<const Heading>(right_sections));
    if (two) side(app, "##right", width - right, right, bottom, {}, right_sections);
    ImGui::SetNextWindowPos(at(0.0, bottom));
    ImGui::SetNextWindowSize(at(width, status_height * scale));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(12.0 * scale, 6.0 * scale));
    ImGui::Begin("##status", nullptr, fixed_panel | ImGuiWindowFlags_NoScrollbar);
    status_line(app);
    ImGui::End();
    ImGui::PopStyleVar();
    view = {left, 0.0, width - right, bottom - timeline_height * scale};
    draw_timeline(app, {view.left, view.bottom, view.right, bottom});
    drag_edge(app, "layout/left", left, bottom, 1.0, layout.left_width);
    if (two) drag_edge(app, "layout/right", width - right, bottom, -1.0, layout.right_width);
  }
  notice_panel(app, view);
  help_panel(app, width, height);
  hover_tooltip(app);
  return view;
}

}  // namespace aspic::app
