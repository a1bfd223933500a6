#include "app/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/app.h"
#include "app/parameter_widget.h"
#include "app/shortcuts.h"

namespace aspic::app {
namespace {

constexpr double side_width = 322.0, status_height = 30.0, timeline_height = 34.0;
/// Below this width both sides would leave the scene too little.
constexpr double narrow = 1020.0;
constexpr ImGuiWindowFlags fixed_panel =
    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

using Section = void (*)(App&);
struct Heading {
  const char* name;
  Section section;
  bool open;
};
constexpr Heading left_sections[] = {
    {"Scene", scene_section, true},      {"Simulation", simulation_section, true},
    {"Bodies", bodies_section, false},   {"Springs", springs_section, false},
    {"Contact", contact_section, false}, {"Balls", balls_section, false}};
constexpr Heading right_sections[] = {{"View", view_section, true},
                                      {"Recording", recording_section, false},
                                      {"Performance", performance_section, true},
                                      {"Energy", energy_section, true},
                                      {"Shadow", shadow_section, false}};

ImVec2 at(double x, double y) {
  return {static_cast<float>(x), static_cast<float>(y)};
}

void sections(App& app, std::span<const Heading> headings) {
  for (const Heading& heading : headings) {
    ImGui::SetNextItemOpen(heading.open, ImGuiCond_Once);
    const bool open = ImGui::CollapsingHeader(heading.name);
    app.gui().mark(fmt::format("section/{}", heading.name));
    if (!open) continue;
    ImGui::PushID(heading.name);
    heading.section(app);
    ImGui::PopID();
    ImGui::Dummy(at(0.0, 2.0 * app.gui().scale()));
  }
}

void status_line(App& app) {
  const Simulation& s = const_cast<App&>(app).simulation();
  const ImVec4 bright = ImGui::GetStyleColorVec4(ImGuiCol_CheckMark);
  const char* const motion = s.divergence() ? "Diverged" : s.running() ? "Running" : "Paused";
  ImGui::TextColored(s.divergence() ? ImVec4(0.95f, 0.55f, 0.40f, 1.0f) : bright, "%s", motion);
  std::string text = fmt::format("t = {:.3f} s     step {}     {}", s.time(), s.step(), s.solver().backend());
  if (app.device().is_software && s.backend() == BackendName::gpu) text += " (software)";
  text += fmt::format("     speed ×{:g}", s.speed);
  if (s.running()) text += fmt::format("     {:.3g} × real time", s.real_time_factor());
  if (s.behind()) text += " (the solver does not keep up)";
  ImGui::SameLine(0.0f, 18.0f * static_cast<float>(app.gui().scale()));
  ImGui::TextUnformatted(text.c_str());
  const char* const hint = "F1 all keys";
  const float width = ImGui::CalcTextSize(hint).x;
  const float place = ImGui::GetWindowContentRegionMax().x - width;
  if (place > ImGui::GetItemRectMax().x) {
    ImGui::SameLine(place);
    ImGui::TextDisabled("%s", hint);
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

}  // namespace

Box draw_panels(App& app, double width, double height) {
  const double scale = app.gui().scale();
  Box view = {0.0, 0.0, width, height};
  if (app.panels_visible()) {
    const double bottom = height - status_height * scale;
    const double column = std::min(side_width * scale, 0.5 * width);
    const bool two = width >= narrow * scale;
    side(app, "##left", 0.0, column, bottom, left_sections,
         two ? std::span<const Heading>() : std::span<const Heading>(right_sections));
    if (two) side(app, "##right", width - column, column, bottom, {}, right_sections);
    ImGui::SetNextWindowPos(at(0.0, bottom));
    ImGui::SetNextWindowSize(at(width, status_height * scale));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(12.0 * scale, 6.0 * scale));
    ImGui::Begin("##status", nullptr, fixed_panel | ImGuiWindowFlags_NoScrollbar);
    status_line(app);
    ImGui::End();
    ImGui::PopStyleVar();
    view = {column, 0.0, two ? width - column : width, bottom - timeline_height * scale};
    draw_timeline(app, {view.left, view.bottom, view.right, bottom});
  }
  notice_panel(app, view);
  help_panel(app, width, height);
  hover_tooltip(app);
  return view;
}

}  // namespace aspic::app
