// The map of stable time steps and stiffnesses, with the scene on it.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/panels.h"
#include "app/parameter_widget.h"
#include "aspic/scene.h"
#include "scene/short_keys.h"

namespace aspic::app {
namespace {

constexpr ImU32 ground = IM_COL32(20, 21, 23, 255), stable_color = IM_COL32(38, 92, 122, 255),
                unstable_color = IM_COL32(128, 72, 30, 255), hatch = IM_COL32(214, 140, 80, 150),
                unknown_color = IM_COL32(48, 51, 56, 255), theory = IM_COL32(235, 237, 240, 255),
                words = IM_COL32(160, 165, 172, 255);

/// The center of a logarithmic axis' cell `index` is at (index + ½)/cells of its length.
double share(const std::vector<double>& centers, double value) {
  const double cell = std::log(centers[1] / centers[0]);
  return (std::log(value / centers[0]) / cell + 0.5) / static_cast<double>(centers.size());
}

/// Value with two digits: a cell is wider than what it rounds.
double two_digits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::round(value / unit) * unit;
}

/// Where the map lies on the screen.
struct Place {
  const StabilityCells& map;
  ImVec2 corner, size;

  ImVec2 at(double step, double stiffness) const {
    return {corner.x + size.x * static_cast<float>(share(map.steps, step)),
            corner.y + size.y * static_cast<float>(1.0 - share(map.stiffness, stiffness))};
  }
  /// The cell under the mouse.
  std::size_t cell_below(const ImVec2& mouse) const {
    const auto index = [](float share, std::size_t count) {
      return static_cast<std::size_t>(std::clamp(share, 0.0f, 0.9999f) * static_cast<float>(count));
    };
    const std::size_t column = index((mouse.x - corner.x) / size.x, map.steps.size()),
                      row = index(1.0f - (mouse.y - corner.y) / size.y, map.stiffness.size());
    return row * map.steps.size() + column;
  }
};

void draw_cells(ImDrawList& draw, const Place& place) {
  const StabilityCells& map = place.map;
  const std::size_t columns = map.steps.size(), rows = map.stiffness.size();
  const float width = place.size.x / static_cast<float>(columns),
              height = place.size.y / static_cast<float>(rows);
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    const std::size_t column = i % columns, row = i / columns;
    const float left = place.corner.x + width * static_cast<float>(column),
                top = place.corner.y + place.size.y - height * static_cast<float>(row + 1);
    const ImVec2 low = {left + 0.5f, top + 0.5f}, high = {left + width - 0.5f, top + height - 0.5f};
    const Stability cell = map.cells[i];
    draw.AddRectFilled(low, high,
                       cell == Stability::stable     ? stable_color
                       : cell == Stability::unstable ? unstable_color
                                                     : unknown_color);
    // Told apart without colors too.
    if (cell == Stability::unstable) draw.AddLine({low.x, high.y}, {high.x, low.y}, hatch);
  }
}

void draw_theory(ImDrawList& draw, const Place& place, float thickness) {
  const StabilityCells& map = place.map;
  for (std::size_t row = 0; row < map.limit.size(); ++row) {
    if (map.limit[row] > 0.0 && std::isfinite(map.limit[row]))
      draw.PathLineTo(place.at(map.limit[row], map.stiffness[row]));
  }
  draw.PathStroke(theory, 0, thickness);
}

/// The decades of an axis along the bottom (0) or the left (1).
void draw_decades(ImDrawList& draw, const Place& place, int axis) {
  const std::vector<double>& centers = axis == 0 ? place.map.steps : place.map.stiffness;
  const int last = static_cast<int>(std::floor(std::log10(centers.back())));
  for (int power = static_cast<int>(std::ceil(std::log10(centers.front()))); power <= last; ++power) {
    const double decade = std::pow(10.0, power);
    const std::string text = fmt::format("{:g}", decade);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float along = static_cast<float>(share(centers, decade));
    const ImVec2 at = axis == 0 ? ImVec2(place.corner.x + along * place.size.x - 0.5f * size.x,
                                         place.corner.y + place.size.y + 1.0f)
                                : ImVec2(place.corner.x - size.x - 5.0f,
                                         place.corner.y + (1.0f - along) * place.size.y - 0.5f * size.y);
    draw.AddText(at, words, text.c_str());
  }
}

void take_cell(SceneControl& scenes, const StabilityCells& map, std::size_t cell) {
  const double step = two_digits(map.steps[cell % map.steps.size()]),
               stiffness = two_digits(map.stiffness[cell / map.steps.size()]);
  auto set = assignments(scenes.scene(), "k", fmt::format("{:.6g}", stiffness));
  if (!set) return;
  set->push_back(fmt::format("simulation.timestep={:.6g}", step));
  if (auto changed = with_overrides(scenes.scene(), *set))
    scenes.apply(std::move(*changed), "time step and stiffness");
}

std::string help_of(const StabilityCells& map, std::optional<std::size_t> cell) {
  std::string text =
      "Maps stability by time step (across) and stiffness (up). Blue: stable. Line: theory. Dot: the scene.";
  if (!cell) return text;
  const double step = map.steps[*cell % map.steps.size()],
               stiffness = map.stiffness[*cell / map.steps.size()];
  const Stability known = map.cells[*cell];
  return fmt::format("h = {:.2g} s, k = {:.2g} N/m: {}. Click to set both.\n\n{}", two_digits(step),
                     two_digits(stiffness),
                     known == Stability::stable     ? "stable"
                     : known == Stability::unstable ? "unstable"
                                                    : "not measured",
                     text);
}

}  // namespace

void stability_section(Gui& gui, SceneControl& scenes, StabilityMap& map) {
  map.update(scenes.scene());
  const StabilityCells* const cells = map.cells();
  if (!cells) {
    ImGui::TextWrapped(
        "%s", map.busy()
                  ? "Analyzing the springs…"
                  : "No springs with a separate stiffness; those of a material follow its Young's modulus.");
    return;
  }
  const float scale = static_cast<float>(gui.scale()), line = ImGui::GetTextLineHeight();
  const float left = ImGui::CalcTextSize("100000").x + 8.0f * scale;
  ImGui::TextDisabled("k [N/m]");
  if (map.busy()) {
    ImGui::SameLine();
    ImGui::TextDisabled("   measuring…");
    gui.mark("stability/measuring");
    gui.keep_awake();
    tooltip("Aspic computes cells in the background; gray cells are pending.");
  }
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 size = {std::max(60.0f, ImGui::GetContentRegionAvail().x - left), 170.0f * scale};
  const Place place = {*cells, {corner.x + left, corner.y}, size};
  ImGui::SetCursorScreenPos(place.corner);
  const bool clicked = ImGui::InvisibleButton("##map", size);
  gui.mark("stability/map");
  const bool hovered = ImGui::IsItemHovered();
  const std::size_t below = place.cell_below(ImGui::GetIO().MousePos);
  tooltip(help_of(*cells, hovered ? std::optional(below) : std::nullopt));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(place.corner, {place.corner.x + size.x, place.corner.y + size.y}, true);
  draw.AddRectFilled(place.corner, {place.corner.x + size.x, place.corner.y + size.y}, ground);
  draw_cells(draw, place);
  draw_theory(draw, place, 1.5f * scale);
  const ImVec2 dot = place.at(map.step(), map.stiffness());
  draw.AddCircleFilled(dot, 5.0f * scale, IM_COL32(255, 214, 92, 255));
  draw.AddCircle(dot, 5.0f * scale, IM_COL32(20, 21, 23, 255), 0, 1.5f * scale);
  draw.PopClipRect();
  draw_decades(draw, place, 0);
  draw_decades(draw, place, 1);
  ImGui::SetCursorScreenPos({corner.x, corner.y + size.y + line + 4.0f});
  ImGui::TextDisabled("h [s], %s",
                      std::string(row_of(scenes.scene().model.simulation.integrator).title).c_str());
  if (clicked) take_cell(scenes, *cells, below);
}

}  // namespace aspic::app
