// What lies over the image for a while: notices, the page of keys, and the question at closing.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "app/panel.h"
#include "app/panels.h"
#include "app/parameter_widget.h"

namespace aspic::app {
namespace {

/// Ways on after a divergence.
void divergence_buttons(Gui& gui, const PlaybackSession& simulation, RunControl& run, Messages& messages) {
  if (const auto step = run.offered_step()) {
    if (button(gui, "diverged/stable", fmt::format("Use h = {:.4g} s", *step).c_str(),
               "Continues from shortly before the divergence with this time step."))
      run.take_offered_step();
    ImGui::SameLine();
  }
  if (simulation.playback().can_step_back()) {
    const std::string back = fmt::format(
        "Back to t = {:.3f} s", simulation.playback().history().time(simulation.playback().before_trouble()));
    if (button(gui, "diverged/back", back.c_str(),
               "Returns to shortly before the divergence, with the values of that time."))
      run.back_before_divergence();
    ImGui::SameLine();
  }
  if (command_button(gui, "diverged/reset", "Reset", "Returns to the scene's start.", "reset to the start"))
    messages.dismiss();
  ImGui::SameLine();
}

/// The text of a message. In a proportional font a caret would not stand below what it points at: it is put
/// there.
void notice_text(std::string_view text, float width) {
  std::string_view before;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const std::size_t caret = line.find('^');
    if (caret != std::string_view::npos && line.find_first_not_of(" |^") == std::string_view::npos) {
      const std::string_view above = before.substr(0, std::min(caret, before.size()));
      ImGui::SetCursorPosX(ImGui::GetCursorPosX() +
                           ImGui::CalcTextSize(above.data(), above.data() + above.size()).x);
      ImGui::TextUnformatted("^");
    } else {
      wrapped_text(line, width);
      if (line.empty()) ImGui::NewLine();
    }
    before = line;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace

/// Each as wide as its text needs, one below the other: at the left, or at the right of a video's text, or
/// upwards from below where runs have their names above.
void notice_panels(const PanelParts& parts, const Box& view) {
  Messages& messages = parts.messages;
  const double scale = parts.gui.scale();
  const double room = std::min(view.right - view.left - 32.0 * scale, 640.0 * scale);
  if (room < 80.0 * scale) return;
  const bool right = parts.image.video && parts.image.video->text;
  const std::vector<Notice> notices = messages.notices();
  const auto waits = [](const Notice& n) { return n.until == Until::divergence_is_over; };
  const auto of_divergence = std::ranges::find_if(notices, waits);
  double y = 16.0 * scale;
  for (std::size_t n = 0; n < notices.size(); ++n) {
    const Notice& notice = notices[n];
    const bool low = parts.comparison.several() || notice.greeting;
    ImGui::SetNextWindowPos(at(right ? view.right - 16.0 * scale : view.left + 16.0 * scale,
                               low ? view.bottom - y : view.top + y),
                            ImGuiCond_Always, {right ? 1.0f : 0.0f, low ? 1.0f : 0.0f});
    const Panel panel(
        notice_window(n).c_str(), 6.0 * scale,
        notice.is_error ? ImVec4(0.23f, 0.11f, 0.09f, 0.94f) : ImVec4(0.10f, 0.13f, 0.14f, 0.90f),
        // Taking the focus would end a drag, and typing.
        ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
    notice_text(notice.text, static_cast<float>(room) - 2.0f * ImGui::GetStyle().WindowPadding.x);
    if (parts.simulation.divergence() &&
        (of_divergence == notices.end() ? n + 1 == notices.size() : &notice == &*of_divergence))
      divergence_buttons(parts.gui, parts.simulation, parts.run, messages);
    if (button(parts.gui, n == 0 ? "notice/close" : fmt::format("notice/close {}", n + 1).c_str(), "Close",
               "Dismisses this message (Escape)."))
      messages.dismiss(notice.text);
    y += ImGui::GetWindowHeight() + 8.0 * scale;
  }
}

void help_panel(Gui& gui, bool& visible, double width, double height) {
  if (!visible) return;
  ImGui::SetNextWindowPos(at(0.5 * width, 0.5 * height), ImGuiCond_Always, {0.5f, 0.5f});
  // A small window scrolls it.
  const ImVec2 most = at(width - 16.0 * gui.scale(), height - 16.0 * gui.scale());
  ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, most);
  const Panel panel("##help", 8.0 * gui.scale(), ImVec4(0.09f, 0.095f, 0.10f, 0.97f),
                    ImGuiWindowFlags_AlwaysAutoResize, ImGuiWindowFlags_NoScrollbar);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Keys and mouse");
  ImGui::SameLine(0.0f, 2.0f * ImGui::GetTextLineHeightWithSpacing());
  // Above the rows: in a small window their end is out of sight.
  if (button(gui, "help/close", "Close", "Closes this page (F1 or Escape).")) visible = false;
  ImGui::Separator();
  // Headings begin groups, in two columns of about the same length.
  const auto& rows = gui.commands().rows();
  const float line = ImGui::GetTextLineHeightWithSpacing();
  ImGui::BeginGroup();
  float taken = 0.0f, keys = 0.0f;
  for (const Command& c : rows) keys = std::max(keys, ImGui::CalcTextSize(c.keys.data()).x);
  // What a name may take in half of the largest page.
  const ImGuiStyle& style = ImGui::GetStyle();
  const float room =
      0.5f * (most.x - 2.0f * style.WindowPadding.x - style.ScrollbarSize) - 2.0f * line - keys;
  for (const Command& c : rows) {
    const bool heading = c.keys.empty();
    if (heading && taken > 0.45f * static_cast<float>(rows.size()) * line) {
      ImGui::EndGroup();
      ImGui::SameLine(0.0f, 2.0f * line);
      ImGui::BeginGroup();
      taken = 0.0f;
    }
    taken += line;
    if (heading) {
      ImGui::TextDisabled("%s", c.name.data());
      continue;
    }
    ImGui::TextColored(ImGui::GetStyleColorVec4(ImGuiCol_CheckMark), "%s", c.keys.data());
    ImGui::SameLine(keys + line);
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + std::max(room, 4.0f * line));
    ImGui::TextUnformatted(c.name.data());
    ImGui::PopTextWrapPos();
    gui.mark("help/{}", c.name);
    taken += ImGui::GetItemRectSize().y - ImGui::GetTextLineHeight();
  }
  ImGui::EndGroup();
}

/// Asks before changes are lost.
void closing_panel(Gui& gui, Closing& closing, double width, double height) {
  if (closing != Closing::asked) return;
  shade_all_but("##closing");
  ImGui::SetNextWindowPos(at(0.5 * width, 0.5 * height), ImGuiCond_Always, {0.5f, 0.5f});
  const Panel panel("##closing", 8.0 * gui.scale(), ImVec4(0.23f, 0.11f, 0.09f, 0.97f),
                    ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::TextUnformatted("The scene has unsaved changes.");
  if (button(gui, "closing/close", "Close without saving", "Closes the window and discards the changes."))
    closing = Closing::decided;
  ImGui::SameLine();
  if (command_button(gui, "closing/save", "Save…", "Writes the scene to a file.", "save the scene"))
    closing = Closing::no;
  ImGui::SameLine();
  if (button(gui, "closing/stay", "Stay", "Closes this page (Escape).")) closing = Closing::no;
}

}  // namespace aspic::app
