// What stands in the corners of the view, in window pixels whatever the picture's own: labels, legends and
// axes.
#include <imgui.h>

#include "app/panels.h"
#include "render/axes.h"

namespace aspic::app {
namespace {

void draw_axes(const Gui& gui, const Camera& camera, const Box& view) {
  const float em = ImGui::GetFontSize();
  const auto gap = static_cast<float>(16.0 * gui.scale());
  const float reach = static_cast<float>(axes_reach) * em;
  const ImVec2 middle = {static_cast<float>(view.right) - gap - reach,
                         static_cast<float>(view.top) + gap + reach};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddCircleFilled(middle, reach, IM_COL32(12, 14, 18, 110), 48);
  for (const AxisArm& arm : axes_seen(camera)) {
    const auto at = [&](double share) {
      const auto length = static_cast<float>(share * axis_length) * em;
      return ImVec2(middle.x + static_cast<float>(arm.right) * length,
                    middle.y + static_cast<float>(arm.down) * length);
    };
    const ImU32 colour = display_colour(arm.colour);
    list.AddLine(middle, at(1.0), colour, 2.0f * static_cast<float>(0.5 * axis_width) * em);
    const ImVec2 size = ImGui::CalcTextSize(&arm.letter, &arm.letter + 1), letter = at(axis_letter_at);
    list.AddText({letter.x - 0.5f * size.x, letter.y - 0.5f * size.y}, IM_COL32(240, 243, 247, 255),
                 &arm.letter, &arm.letter + 1);
  }
}

}  // namespace

double draw_corners(const PanelParts& p, const Box& view) {
  p.beside.draw_labels(p.gui);
  const double colours = draw_legend(p.gui, "legend", p.picture.legend(), view);
  const Box above = {view.left, view.top, view.right, view.bottom - colours};
  const double arrows = draw_legend(p.gui, "legend/arrows", p.picture.arrow_legend(), above);
  if (p.scene.scene().view.axes && !p.picture.film) {
    // Below the time, where that stands in the same corner.
    const double clock =
        p.layout.clock ? static_cast<double>(p.gui.large_font()->FontSize) + 40.0 * p.gui.scale() : 0.0;
    draw_axes(p.gui, p.view.lens(), {view.left, view.top + clock, view.right, view.bottom});
  }
  return colours + arrows;
}

}  // namespace aspic::app
