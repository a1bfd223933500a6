// Where the layer that is edited is in the image.
#include <imgui.h>

#include <array>
#include <optional>

#include "app/panels.h"
#include "model/rotation.h"
#include "model/voxels.h"

namespace aspic::app {
namespace {

/// Corners of cells in the window.
class CellCorners {
 public:
  CellCorners(const VoxelsSettings& voxels, const View& view, const Box& image)
      : voxels_(voxels),
        size_(size_of(voxels.layers)),
        turn_(voxels.rotation.axis, voxels.rotation.angle),
        image_(image),
        camera_(view.seen(), static_cast<int>(image.right - image.left),
                static_cast<int>(image.bottom - image.top)),
        through_(camera_.projection() * camera_.view()) {}

  /// The corner between cells, counted from the first of the layers; nothing behind the camera.
  std::optional<ImVec2> at(double x, double y, double z) const {
    const Vec3 local = {x - 0.5 * size_[0], y - 0.5 * size_[1], z - 0.5 * size_[2]};
    const Vec3 place = voxels_.position + turn_(voxels_.size * local);
    const glm::vec4 p = through_ * glm::vec4(to_glm(place), 1.0f);
    if (!(p.w > 0.0f)) return std::nullopt;
    return ImVec2(
        static_cast<float>(image_.left) + 0.5f * (1.0f + p.x / p.w) * static_cast<float>(camera_.width()),
        static_cast<float>(image_.top) + 0.5f * (1.0f - p.y / p.w) * static_cast<float>(camera_.height()));
  }
  /// The four corners of a level rectangle.
  std::optional<std::array<ImVec2, 4>> rectangle(double left, double back, double right, double front,
                                                 double y) const {
    std::array<ImVec2, 4> corners;
    const double places[4][2] = {{left, back}, {right, back}, {right, front}, {left, front}};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto corner = at(places[i][0], y, places[i][1]);
      if (!corner) return std::nullopt;
      corners[i] = *corner;
    }
    return corners;
  }

 private:
  const VoxelsSettings& voxels_;
  std::array<int, 3> size_;
  Rotation turn_;
  Box image_;
  Camera camera_;
  glm::mat4 through_;
};

/// The box around the layer.
void draw_frame(ImDrawList& draw, const CellCorners& corners, const std::array<int, 3>& size, int layer,
                float unit) {
  const auto low = corners.rectangle(0, 0, size[0], size[2], layer),
             high = corners.rectangle(0, 0, size[0], size[2], layer + 1);
  if (!low || !high) return;
  constexpr ImU32 dark = IM_COL32(20, 24, 28, 130), bright = IM_COL32(255, 255, 255, 220);
  for (const auto& [color, width] : {std::pair(dark, 3.5f * unit), std::pair(bright, 1.5f * unit)}) {
    for (std::size_t i = 0; i < 4; ++i) {
      draw.AddLine((*low)[i], (*low)[(i + 1) % 4], color, width);
      draw.AddLine((*high)[i], (*high)[(i + 1) % 4], color, width);
      draw.AddLine((*low)[i], (*high)[i], color, width);
    }
  }
}

}  // namespace

void draw_edited_layer(const PanelParts& p) {
  constexpr int most_cells = 10000;  // that are drawn one by one
  if (!p.cells.take_shown()) {
    p.cells.show(std::nullopt);  // of a section that is closed no cell is pointed at
    p.cells.take_shown();
    return;
  }
  p.cells.follow();
  // Later the body has moved on from where its cells are.
  if (!p.cells.any() || p.simulation.step() != 0 || p.image.video) return;
  const VoxelsSettings voxels = p.cells.voxels();
  const std::array<int, 3> size = size_of(voxels.layers);
  const Box& image = p.image.shown();
  if (image.right - image.left < 2.0 || image.bottom - image.top < 2.0) return;
  const CellCorners corners(voxels, p.view, image);
  const int layer = p.cells.layer();
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  draw.PushClipRect({static_cast<float>(image.left), static_cast<float>(image.top)},
                    {static_cast<float>(image.right), static_cast<float>(image.bottom)});
  const bool all = size[0] * size[2] <= most_cells;
  for (int row = 0; all && row < size[2]; ++row) {
    for (int column = 0; column < size[0]; ++column) {
      const char cell = cell_at(voxels.layers, layer, {row, column});
      if (!is_full_cell(cell)) continue;
      const auto top = corners.rectangle(column, row, column + 1, row + 1, layer + 1);
      const ImU32 color = cell_color(p.scene.scene().model, voxels, cell);
      if (top)
        draw.AddQuadFilled((*top)[0], (*top)[1], (*top)[2], (*top)[3],
                           (color & ~IM_COL32_A_MASK) | (ImU32{120} << IM_COL32_A_SHIFT));
    }
  }
  const auto unit = static_cast<float>(p.gui.scale());
  draw_frame(draw, corners, size, layer, unit);
  if (const auto& pointed = p.cells.pointed(); pointed && is_inside(voxels.layers, *pointed)) {
    const auto top =
        corners.rectangle(pointed->column, pointed->row, pointed->column + 1, pointed->row + 1, layer + 1);
    if (top)
      draw.AddQuad((*top)[0], (*top)[1], (*top)[2], (*top)[3], IM_COL32(255, 255, 255, 255), 2.5f * unit);
  }
  draw.PopClipRect();
}

}  // namespace aspic::app
