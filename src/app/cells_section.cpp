// The section that edits the cells of a body: its layers, painted with the mouse, and its palette.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "app/panels.h"
#include "app/parameter_widget.h"
#include "base/printable.h"
#include "model/voxels.h"
#include "render/color_map.h"
#include "scene/materials.h"

namespace aspic::app {
namespace {

constexpr ImU32 empty_color = IM_COL32(30, 33, 37, 255), line_color = IM_COL32(66, 72, 80, 255),
                bright = IM_COL32(255, 255, 255, 235), waits_color = IM_COL32(242, 140, 102, 255);

/// With another opacity, 0 to 255.
ImU32 translucent(ImU32 color, ImU32 alpha) {
  return (color & ~IM_COL32_A_MASK) | (alpha << IM_COL32_A_SHIFT);
}

std::string text_of(char c) {
  return std::string(1, c);
}

/// Places of the grid's cells in the window.
struct GridPlaces {
  ImVec2 corner;
  float cell = 1.0f;
  ImVec2 low(const CellPlace& p) const {
    return {corner.x + cell * static_cast<float>(p.column), corner.y + cell * static_cast<float>(p.row)};
  }
  ImVec2 high(const CellPlace& p) const {
    const ImVec2 l = low(p);
    return {l.x + cell, l.y + cell};
  }
  CellPlace under(const ImVec2& mouse) const {
    return {static_cast<int>(std::floor((mouse.y - corner.y) / cell)),
            static_cast<int>(std::floor((mouse.x - corner.x) / cell))};
  }
};

/// The cells of the layer that can be seen; those of the layer below show through where there is none.
void draw_cells(const Scene& scene, const VoxelsSettings& voxels, int layer, const GridPlaces& places) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const auto [columns, high, rows] = size_of(voxels.layers);
  const CellPlace first = places.under(draw.GetClipRectMin()), last = places.under(draw.GetClipRectMax());
  const bool signs = places.cell > 1.15f * ImGui::GetTextLineHeight();
  for (int row = std::max(first.row, 0); row <= std::min(last.row, rows - 1); ++row) {
    for (int column = std::max(first.column, 0); column <= std::min(last.column, columns - 1); ++column) {
      const CellPlace place = {row, column};
      const ImVec2 a = places.low(place), b = places.high(place);
      const char cell = cell_at(voxels.layers, layer, place);
      const bool full = is_full_cell(cell);
      draw.AddRectFilled(a, b, full ? cell_color(scene.model, voxels, cell) : empty_color);
      const char below = layer > 0 ? cell_at(voxels.layers, layer - 1, place) : empty_cell;
      if (!full && is_full_cell(below)) {
        const float inset = 0.3f * places.cell;
        draw.AddRectFilled({a.x + inset, a.y + inset}, {b.x - inset, b.y - inset},
                           translucent(cell_color(scene.model, voxels, below), 90));
      }
      if (full && signs) {
        const ImVec2 size = ImGui::CalcTextSize(&cell, &cell + 1);
        draw.AddText({0.5f * (a.x + b.x - size.x), 0.5f * (a.y + b.y - size.y)}, IM_COL32(10, 12, 14, 235),
                     &cell, &cell + 1);
      }
    }
  }
  const ImVec2 end = places.low({rows, columns});
  if (places.cell < 4.0f) return;
  for (int row = 0; row <= rows; ++row)
    draw.AddLine(places.low({row, 0}), {end.x, places.low({row, 0}).y}, line_color);
  for (int column = 0; column <= columns; ++column)
    draw.AddLine(places.low({0, column}), {places.low({0, column}).x, end.y}, line_color);
}

/// Paints and erases where the mouse goes with a button held on the grid.
void strokes(CellEditor& cells, const GridPlaces& places, const CellPlace& under) {
  const bool left = ImGui::IsMouseDown(ImGuiMouseButton_Left),
             right = ImGui::IsMouseDown(ImGuiMouseButton_Right);
  if (ImGui::IsItemActivated()) {
    // Where the button went down, though the mouse may be farther by now.
    const ImGuiIO& io = ImGui::GetIO();
    cells.begin_stroke(
        places.under(io.MouseClickedPos[left ? ImGuiMouseButton_Left : ImGuiMouseButton_Right]),
        right && !left ? empty_cell : cells.brush());
  }
  // The mouse may have gone on in the image in which the button came up.
  if (ImGui::IsItemActive() || ImGui::IsItemDeactivated()) cells.stroke(under);
  if (!ImGui::IsItemActive()) cells.end_stroke();
}

/// The material of the cell is the one to paint with.
void take_material(CellEditor& cells, const VoxelsSettings& voxels, const CellPlace& under) {
  if (!ImGui::IsMouseClicked(ImGuiMouseButton_Middle) || !is_inside(voxels.layers, under)) return;
  const char cell = cell_at(voxels.layers, cells.layer(), under);
  cells.choose_brush(is_full_cell(cell) ? cell : empty_cell);
}

/// What is under the mouse, or what the mouse does.
void say_cell(const CellEditor& cells, const VoxelsSettings& voxels, const std::optional<CellPlace>& under) {
  if (!under || !is_inside(voxels.layers, *under)) {
    ImGui::TextDisabled("left paints, right erases");
    return;
  }
  const char cell = cell_at(voxels.layers, cells.layer(), *under);
  const std::string what = is_full_cell(cell) ? material_text(voxels, cell) : "empty";
  ImGui::TextDisabled("%s", fmt::format("column {}, row {}: {}", under->column, under->row, what).c_str());
}

constexpr std::string_view grid_help =
    "Edits the layer, seen from above. Left drag: paint, right drag: erase, middle click: pick.\n\nScene "
    "key: voxels[].layers\nA change restarts the simulation.";

/// The layer as a grid, seen from above: back at the top, left at the left. Wide ones are scrolled.
void grid(Gui& gui, const SceneControl& scene, CellEditor& cells) {
  const VoxelsSettings voxels = cells.voxels();
  const auto [columns, high, rows] = size_of(voxels.layers);
  const auto unit = static_cast<float>(gui.scale());
  const float wide = ImGui::GetContentRegionAvail().x;
  GridPlaces places;
  places.cell = std::clamp(std::floor(std::min((wide - 2.0f) / static_cast<float>(columns),
                                               300.0f * unit / static_cast<float>(rows))),
                           std::round(7.0f * unit), std::round(28.0f * unit));
  const ImVec2 size = {places.cell * static_cast<float>(columns) + 1.0f,
                       places.cell * static_cast<float>(rows) + 1.0f};
  const float bar = ImGui::GetStyle().ScrollbarSize, most = 320.0f * unit;
  const bool across = size.x > wide, down = size.y > most;
  ImGui::TextDisabled("back, seen from above");
  tooltip(grid_help);
  if (across || down)
    ImGui::BeginChild("##cells", {0.0f, std::min(size.y, most) + (across ? bar : 0.0f)}, false,
                      ImGuiWindowFlags_HorizontalScrollbar);
  places.corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("##grid", size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  gui.mark("cells/grid");
  gui.explain(grid_help, "");  // shown at the line above, where it does not hide the image
  std::optional<CellPlace> under;
  const CellPlace here = places.under(ImGui::GetIO().MousePos);
  if (ImGui::IsItemHovered()) {
    under = here;
    take_material(cells, voxels, here);
  }
  strokes(cells, places, here);
  const bool held = ImGui::IsItemActive();
  const VoxelsSettings shown = cells.voxels();
  draw_cells(scene.scene(), shown, cells.layer(), places);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  if (!cells.refusal().empty())
    draw.AddRect(places.corner, {places.corner.x + size.x, places.corner.y + size.y}, waits_color, 0.0f, 0,
                 2.0f * unit);
  if (under && is_inside(shown.layers, here))
    draw.AddRect(places.low(here), places.high(here), bright, 0.0f, 0, 1.5f * unit);
  if (across || down) ImGui::EndChild();
  say_cell(cells, shown, under);
  cells.show(under || held ? std::optional(here) : std::nullopt);
}

/// Cells that the scene does not take, and the ways on.
void waiting(Gui& gui, CellEditor& cells) {
  if (cells.refusal().empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, waits_color);
  wrapped_text("Pending. " + printable(cells.refusal()), ImGui::GetContentRegionAvail().x);
  ImGui::PopStyleColor();
  gui.mark("cells/refusal");
  if (cells.in_pieces()) {
    const float half = share_of_line(2);
    if (button(gui, "cells/all", "Keep all pieces",
               "Accepts the cells: the pieces move separately.\n\nScene key: voxels[].pieces", true, half))
      return cells.take_as(Pieces::all);
    ImGui::SameLine();
    if (button(gui, "cells/largest", "Keep the largest",
               "Accepts the cells, and excludes smaller pieces from the body.\n\nScene key: voxels[].pieces",
               true, half))
      return cells.take_as(Pieces::largest);
  }
  if (button(gui, "cells/back", "Take back",
             "Undoes the last stroke. Pending strokes apply once the cells are connected.", true, -1.0f,
             "undo"))
    cells.take_back();
}

/// From below, with buttons for one up and one down.
void layer_row(Gui& gui, CellEditor& cells, int high) {
  label_column("Layer");
  const float side = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
  ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - 2.0f * (side + gap), 1.0f));
  int layer = cells.layer();
  ImGui::BeginDisabled(high < 2);
  ImGui::SliderInt("##layer", &layer, 0, std::max(high - 1, 0), fmt::format("%d of 0 … {}", high - 1).c_str(),
                   ImGuiSliderFlags_AlwaysClamp);
  ImGui::EndDisabled();
  named(gui, "cells/layer", "Selects the layer to show, counted from 0 at the bottom.");
  ImGui::SameLine(0.0f, gap);
  if (button(gui, "cells/down", "-", "Shows the layer below.", layer > 0, side, "the layer of cells below"))
    --layer;
  ImGui::SameLine(0.0f, gap);
  if (button(gui, "cells/up", "+", "Shows the layer above.", layer + 1 < high, side,
             "the layer of cells above"))
    ++layer;
  if (layer != cells.layer()) cells.choose_layer(layer);
}

/// A button in the color of a cell; the one that paints has a frame. True if it was pressed.
bool swatch(Gui& gui, const std::string& name, const std::string& sign, ImU32 color, bool chosen,
            std::string_view help) {
  const float side = ImGui::GetFrameHeight();
  ImGui::PushStyleColor(ImGuiCol_Button, color);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, translucent(color, 210));
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, translucent(color, 170));
  ImGui::PushStyleColor(ImGuiCol_Text, color == empty_color ? bright : IM_COL32(10, 12, 14, 235));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0.0f, ImGui::GetStyle().FramePadding.y));
  const bool pressed = button(gui, name.c_str(), sign.c_str(), help, true, side);
  ImGui::PopStyleVar();
  ImGui::PopStyleColor(4);
  if (chosen)
    ImGui::GetWindowDrawList()->AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), bright,
                                        ImGui::GetStyle().FrameRounding, 0,
                                        2.0f * static_cast<float>(gui.scale()));
  return pressed;
}

/// A material of the palette: its sign and color, its name, and a button that removes it.
void palette_row(Gui& gui, SceneControl& scene, CellEditor& cells, char cell) {
  const ModelSettings& settings = scene.scene().model;
  const VoxelsSettings& voxels = settings.voxels[cells.body()];
  const std::string key = text_of(cell), name = "cells/palette/" + key;
  if (swatch(gui, name, key, cell_color(settings, voxels, cell), cells.brush() == cell,
             fmt::format("Paints cells '{}'. Digits select materials in the order of the rows.", cell)))
    cells.choose_brush(cell);
  ImGui::SameLine();
  if (voxels.palette.empty()) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(material_text(voxels, cell).c_str());
    return;
  }
  const float side = ImGui::GetFrameHeight();
  ImGui::SetNextItemWidth(
      std::max(ImGui::GetContentRegionAvail().x - side - ImGui::GetStyle().ItemSpacing.x, 1.0f));
  std::vector<std::string_view> names;
  for (const MaterialSettings& m : settings.materials)
    if (!m.name.empty()) names.push_back(m.name);
  const std::string& own = voxels.palette.at(key);
  auto index = static_cast<std::size_t>(std::ranges::find(names, own) - names.begin());
  if (index == names.size()) names.push_back(own);
  const std::string before = own;
  if (choice(gui, name + "/material", names, names, index,
             "Sets the material of these cells; Materials has its values.\n\nScene key: voxels[].palette"))
    return scene.change("palette", [&, chosen = std::string(names[index])](Scene& s) {
      s.model.voxels[cells.body()].palette[key] = chosen;
    });
  ImGui::SameLine();
  const bool used = has_cell(cells.voxels(), cell) || voxels.palette.size() == 1;
  if (button(gui, (name + "/remove").c_str(), "×",
             used ? "In use. Erase its cells or choose another material for them."
                  : "Removes it from the palette; the scene keeps the material.",
             !used, side))
    scene.change("remove from the palette",
                 [&](Scene& s) { s.model.voxels[cells.body()].palette.erase(key); });
}

/// One more material to paint with: one of the scene's that the palette does not have, or a new one.
void add_to_palette(SceneControl& scene, CellEditor& cells) {
  char cell = '\0';
  scene.change("add to the palette", [&](Scene& s) {
    VoxelsSettings& voxels = s.model.voxels[cells.body()];
    make_palette(s.model, voxels);
    VoxelsSettings with_waiting = cells.voxels();
    with_waiting.palette = voxels.palette;
    cell = free_cell(with_waiting);
    if (cell == '\0') return;
    const auto in_palette = [&](const MaterialSettings& m) {
      return m.name.empty() ||
             std::ranges::any_of(voxels.palette, [&](const auto& entry) { return entry.second == m.name; });
    };
    const auto unused = std::ranges::find_if_not(s.model.materials, in_palette);
    voxels.palette[text_of(cell)] = unused != s.model.materials.end()
                                        ? unused->name
                                        : add_material(s.model, s.model.materials.front(), "material");
  });
  if (cell == '\0') return;
  cells.choose_brush(cell);
  cells.follow();
}

void palette(Gui& gui, SceneControl& scene, CellEditor& cells) {
  for (const char cell : cells.brushes()) {
    palette_row(gui, scene, cells, cell);
    if (cells.voxels().palette.empty()) break;
  }
  if (swatch(gui, "cells/eraser", " ", empty_color, cells.brush() == empty_cell,
             "Erases cells, as the right button does. Key: 0"))
    cells.choose_brush(empty_cell);
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("empty");
  ImGui::SameLine();
  if (button(gui, "cells/palette/add", "Add a material",
             "Adds a material to paint with; Materials has its values.\n\nScene key: voxels[].palette", true,
             -1.0f))
    add_to_palette(scene, cells);
}

void layer_buttons(Gui& gui, CellEditor& cells) {
  const float third = share_of_line(3);
  const int layer = cells.layer();
  if (button(gui, "cells/fill", "Fill", "Fills the layer with the chosen material.", true, third))
    cells.change("fill the layer", [&](VoxelsSettings& v) { fill(v.layers, layer, cells.brush()); });
  ImGui::SameLine();
  if (button(gui, "cells/clear", "Clear", "Empties the layer.", true, third))
    cells.change("clear the layer", [&](VoxelsSettings& v) { fill(v.layers, layer, empty_cell); });
  ImGui::SameLine();
  if (button(gui, "cells/copy", "Copy up", "Copies this layer to the one above, and shows that one.", true,
             third)) {
    cells.change("copy the layer up", [&](VoxelsSettings& v) { copy_up(v, layer); });
    cells.choose_layer(layer + 1);
  }
}

/// How many cells there are along an axis, with buttons for one less and one more at both ends.
void size_row(Gui& gui, CellEditor& cells, const char* label, int count, CellSide low, CellSide high,
              const char* one, const char* at_low, const char* at_high) {
  ImGui::PushID(label);
  label_column(label);
  const float side = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const auto pressed = [&](const char* sign, CellSide where, const char* end) {
    const bool more = *sign == '+';
    const std::string name = fmt::format("cells/{}/{}", more ? "grow" : "shrink", end),
                      help = more ? fmt::format("Adds one {} of empty cells at the {}.", one, end)
                                  : fmt::format("Removes one {} at the {}, with its cells.", one, end);
    if (!button(gui, name.c_str(), sign, help, more || count > 1, side)) return;
    const int layer = cells.layer();
    cells.change(fmt::format("{} a {} of cells", more ? "add" : "remove", one), [&](VoxelsSettings& v) {
      if (more)
        grow(v, where);
      else
        shrink(v, where);
    });
    // The same cells are shown.
    if (where == CellSide::bottom) cells.choose_layer(layer + (more ? 1 : -1));
  };
  const float left = ImGui::GetCursorPosX(), right = ImGui::GetWindowContentRegionMax().x;
  pressed("-", low, at_low);
  ImGui::SameLine(0.0f, gap);
  pressed("+", low, at_low);
  const std::string text = fmt::format("{}", count);
  ImGui::SameLine(0.5f * (left + right - ImGui::CalcTextSize(text.c_str()).x));
  ImGui::TextUnformatted(text.c_str());
  ImGui::SameLine(right - 2.0f * side - gap);
  pressed("-", high, at_high);
  ImGui::SameLine(0.0f, gap);
  pressed("+", high, at_high);
  ImGui::PopID();
}

/// Which of several bodies of cells.
void body_choice(Gui& gui, const SceneControl& scene, CellEditor& cells) {
  const auto& bodies = scene.scene().model.voxels;
  if (bodies.size() < 2) return;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    names.push_back(bodies[i].name.empty() ? fmt::format("body of cells {}", i)
                                           : printable_line(bodies[i].name));
  const std::vector<std::string_view> views(names.begin(), names.end());
  std::size_t index = cells.body();
  label_column("Body");
  if (choice(gui, "cells/body", views, views, index, "Selects the body whose cells to show."))
    cells.choose_body(index);
}

/// Of a mesh the skin is drawn, whatever its cells are.
bool has_skin(Gui& gui, SceneControl& scene, std::size_t body) {
  if (scene.scene().model.voxels[body].skin.empty()) return false;
  wrapped_text(
      "These cells come from a mesh, which is their skin. To paint them, remove the skin: the window then "
      "shows the cells.",
      ImGui::GetContentRegionAvail().x);
  if (button(gui, "cells/without-skin", "Edit as layers",
             "Removes the skin. Undo restores it.\n\nScene key: voxels[].skin", true, -1.0f))
    scene.change("remove the skin", [&](Scene& s) { s.model.voxels[body].skin.clear(); });
  return true;
}

}  // namespace

ImU32 material_color(const ModelSettings& settings, std::string_view name) {
  const auto found = std::ranges::find(settings.materials, name, &MaterialSettings::name);
  const bool named = !name.empty() && found != settings.materials.end();
  return display_color(named ? body_color(static_cast<std::size_t>(found - settings.materials.begin()))
                             : neutral_body_color());
}

ImU32 cell_color(const ModelSettings& settings, const VoxelsSettings& voxels, char cell) {
  if (voxels.palette.empty()) return material_color(settings, voxels.material.name);
  const auto entry = voxels.palette.find(text_of(cell));
  return material_color(settings, entry == voxels.palette.end() ? std::string_view() : entry->second);
}

std::string material_text(const VoxelsSettings& voxels, char cell) {
  if (!voxels.palette.empty()) {
    const auto entry = voxels.palette.find(text_of(cell));
    return entry == voxels.palette.end() ? "without a material" : printable_line(entry->second);
  }
  return voxels.material.name.empty() ? "the body's own material" : printable_line(voxels.material.name);
}

void cells_section(Gui& gui, SceneControl& scene, CellEditor& cells) {
  cells.follow();
  if (!cells.any()) {
    ImGui::TextDisabled("The scene has no body of cells.");
    if (button(gui, "cells/add-body", "Add a body of cells",
               "Adds a few cells in free space above. Restarts the simulation.\n\nScene key: [[voxels]]",
               true, -1.0f))
      add_body(scene, *list_of_bodies("voxels"));
    return;
  }
  body_choice(gui, scene, cells);
  if (has_skin(gui, scene, cells.body())) return;
  const auto [columns, high, rows] = size_of(cells.voxels().layers);
  palette(gui, scene, cells);
  layer_row(gui, cells, high);
  grid(gui, scene, cells);
  waiting(gui, cells);
  layer_buttons(gui, cells);
  size_row(gui, cells, "Columns", columns, CellSide::left, CellSide::right, "column", "left", "right");
  size_row(gui, cells, "Rows", rows, CellSide::back, CellSide::front, "row", "back", "front");
  size_row(gui, cells, "Layers", high, CellSide::bottom, CellSide::top, "layer", "bottom", "top");
  if (!scene.scene().model.voxels[cells.body()].pinned.indices.empty())
    wrapped_text("Adding or removing cells changes the indices that pins use.",
                 ImGui::GetContentRegionAvail().x);
}

}  // namespace aspic::app
