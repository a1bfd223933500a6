// The corners of the view, in window pixels whatever the image's own: labels, legends and
// axes.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/panels.h"
#include "render/axes.h"

namespace aspic::app {
namespace {

bool meet(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

/// In the upper right corner, or where nothing that is `taken` is in the way; not at all where there is no
/// room.
void draw_axes(const Gui& gui, const Camera& camera, const Box& view, std::span<const Box> taken) {
  const float em = ImGui::GetFontSize();
  const double gap = 16.0 * gui.scale(), size = 2.0 * axes_reach * static_cast<double>(em);
  const auto free = [&](const Box& b) {
    return b.left >= view.left && b.right <= view.right && b.top >= view.top && b.bottom <= view.bottom &&
           std::ranges::none_of(taken, [&](const Box& other) { return meet(b, other); });
  };
  std::vector<Box> places;
  const auto add = [&](double right, double top) {
    places.push_back({right - size, top, right, top + size});
  };
  add(view.right - gap, view.top + gap);
  for (const Box& other : taken) {
    add(view.right - gap, other.bottom + gap);
    add(other.left - gap, view.top + gap);
  }
  add(view.left + gap + size, view.top + gap);
  const auto place = std::ranges::find_if(places, free);
  if (place == places.end()) return;
  gui.mark_box("axes", *place);
  const float reach = static_cast<float>(axes_reach) * em;
  const ImVec2 middle = {static_cast<float>(place->center_x()), static_cast<float>(place->center_y())};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddCircleFilled(middle, reach, IM_COL32(12, 14, 18, 110), 48);
  for (const AxisArm& arm : axes_seen(camera)) {
    const auto at = [&](double share) {
      const auto length = static_cast<float>(share * axis_length) * em;
      return ImVec2(middle.x + static_cast<float>(arm.right) * length,
                    middle.y + static_cast<float>(arm.down) * length);
    };
    const ImU32 color = display_color(arm.color);
    list.AddLine(middle, at(1.0), color, 2.0f * static_cast<float>(0.5 * axis_width) * em);
    const ImVec2 drawn = ImGui::CalcTextSize(&arm.letter, &arm.letter + 1), letter = at(axis_letter_at);
    list.AddText({letter.x - 0.5f * drawn.x, letter.y - 0.5f * drawn.y}, IM_COL32(240, 243, 247, 255),
                 &arm.letter, &arm.letter + 1);
  }
}

Box box_of(const ImGuiWindow& w) {
  const auto left = static_cast<double>(w.Pos.x), top = static_cast<double>(w.Pos.y);
  return {left, top, left + static_cast<double>(w.Size.x), top + static_cast<double>(w.Size.y)};
}

/// Where the labels of runs side by side and of a ghost are in this image.
std::vector<Box> label_boxes() {
  std::vector<Box> boxes;
  for (const ImGuiWindow* w : ImGui::GetCurrentContext()->Windows) {
    const std::string_view name(w->Name);
    if (w->Active && (name.starts_with("##comparison") || name.starts_with("##ghost")))
      boxes.push_back(box_of(*w));
  }
  return boxes;
}

/// The time in large figures, in the upper right corner of the view. Returns its place.
Box draw_clock(const Gui& gui, const PlaybackSession& simulation, const Box& view) {
  const std::string text = fmt::format("t = {:.2f} s", simulation.time());
  const auto gap = static_cast<float>(16.0 * gui.scale());
  ImGui::SetNextWindowPos({static_cast<float>(view.right) - gap, static_cast<float>(view.top) + gap},
                          ImGuiCond_Always, {1.0f, 0.0f});
  ImGui::SetNextWindowBgAlpha(0.72f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * gap);
  ImGui::Begin("##clock", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PushFont(gui.large_font());
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopFont();
  gui.mark("clock");
  const Box place = window_box();
  ImGui::End();
  ImGui::PopStyleVar();
  return place;
}

}  // namespace

Box window_box() {
  return box_of(*ImGui::GetCurrentWindowRead());
}

void draw_corners(const PanelParts& p, const Box& view) {
  p.comparison_view.draw_labels(p.gui);
  const std::vector<Box> labels = label_boxes();
  std::vector<Box> taken = {draw_legend(p.gui, "legend", p.image.legend(), view)};
  const Box above = {view.left, view.top, view.right, taken.front().top};
  taken.push_back(draw_legend(p.gui, "legend/arrows", p.image.arrow_legend(), above));
  std::vector<Box> legends = taken;
  std::erase_if(legends, [](const Box& box) { return box.right <= box.left; });
  // A message may be where the readout comes to be.
  for (std::size_t n = 0; n < p.messages.notices().size(); ++n)
    if (const ImGuiWindow* const notice = ImGui::FindWindowByName(notice_window(n).c_str());
        notice && notice->WasActive)
      legends.push_back(box_of(*notice));
  Box below = view;
  for (const Box& label : labels)
    if (label.right > view.center_x()) below.top = std::max(below.top, label.bottom);
  taken.insert(taken.end(), labels.begin(), labels.end());
  // Labels of runs side by side tell the time themselves.
  if (p.layout.clock && !p.comparison.active()) {
    taken.push_back(draw_clock(p.gui, p.simulation, below));
    below.top = taken.back().bottom;
  }
  if (const auto& hovered = p.pointer.hovered(); hovered && p.layout.row().readout)
    taken.push_back(particle_readout(p.gui, p.simulation, *hovered, below, legends));
  std::erase_if(taken, [](const Box& box) { return box.right <= box.left; });
  if (p.scene.scene().view.axes && !p.image.video) draw_axes(p.gui, p.view.lens(), view, taken);
}

}  // namespace aspic::app
