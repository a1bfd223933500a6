#include "app/cell_editor.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "base/memory.h"
#include "model/voxels.h"
#include "scene/scene_checks.h"

namespace aspic::app {

void CellEditor::choose_body(std::size_t body) {
  if (body == body_) return;
  drop_waiting();
  body_ = body;
  brush_ = '\0';
  follow();
}

void CellEditor::choose_layer(int layer) {
  layer_ = layer;
  follow();
}

std::vector<char> CellEditor::brushes() const {
  std::vector<char> cells;
  const VoxelsSettings& voxels = scene_.scene().model.voxels[body_];
  for (const auto& [cell, name] : voxels.palette) cells.push_back(cell.front());
  if (!cells.empty()) return cells;
  std::map<char, std::size_t> counts;
  for (const auto& layer : voxels.layers)
    for (const std::string& row : layer)
      for (const char c : row)
        if (is_full_cell(c)) ++counts[c];
  const auto most = std::ranges::max_element(counts, {}, &std::pair<const char, std::size_t>::second);
  return {most == counts.end() ? '1' : most->first};
}

bool CellEditor::choose_by_digit(char32_t character) {
  if (character < U'0' || character > U'9' || !any()) return false;
  const std::vector<char> cells = brushes();
  const auto number = static_cast<std::size_t>(character - U'0');
  if (number > cells.size()) return false;
  brush_ = number == 0 ? empty_cell : cells[number - 1];
  return true;
}

VoxelsSettings CellEditor::voxels() const {
  VoxelsSettings voxels = scene_.scene().model.voxels[body_];
  if (waiting_.empty()) return voxels;
  voxels.layers = waiting_.back().layers;
  voxels.position = voxels.position + waiting_.back().shift;
  return voxels;
}

Scene CellEditor::with(const VoxelsSettings& voxels) const {
  Scene scene = scene_.scene();
  scene.model.voxels[body_] = voxels;
  return scene;
}

void CellEditor::change(const std::string& name, const std::function<void(VoxelsSettings&)>& make,
                        const std::string& gesture) {
  const VoxelsSettings before = voxels();
  VoxelsSettings after = before;
  make(after);
  if (after.layers == before.layers) return;
  Scene changed = with(after);
  if (check_scene(changed, available_memory()).empty()) {
    drop_waiting();
    scene_.apply(std::move(changed), name, gesture);
    return;
  }
  if (waiting_.empty()) waits_upon_ = scene_.scene().model.voxels[body_].layers;
  if (waiting_.empty() || gesture.empty() || waiting_.back().gesture != gesture)
    waiting_.push_back({{}, {}, gesture});
  waiting_.back().shift = after.position - scene_.scene().model.voxels[body_].position;
  waiting_.back().layers = std::move(after.layers);
  refuse(changed);
}

/// Says why, and what would help.
void CellEditor::refuse(const Scene& changed) {
  refusal_.clear();
  for (const SceneComplaint& complaint : check_scene(changed, available_memory()))
    refusal_ += (refusal_.empty() ? "" : "\n") + complaint.message;
  const VoxelsSettings& voxels = changed.model.voxels[body_];
  VoxelsSettings all = voxels;
  all.pieces = Pieces::all;
  in_pieces_ =
      voxels.pieces == Pieces::refuse && fault_of(changed.model, voxels) && !fault_of(changed.model, all);
  if (in_pieces_) {
    const auto shape = shape_of(all);
    refusal_ = fmt::format("These cells form {} pieces that share no face, and the body must be one piece.",
                           std::get<VoxelShape>(shape).pieces);
  }
}

void CellEditor::begin_stroke(const CellPlace& from, char cell) {
  stroke_ = {from, cell};
  ++strokes_;
}

void CellEditor::stroke(const CellPlace& to) {
  if (!stroke_) return;
  const auto [from, cell] = std::exchange(*stroke_, {to, stroke_->cell});
  change(
      cell == empty_cell ? "erase cells" : "paint cells",
      [&](VoxelsSettings& v) { paint(v.layers, layer_, from, to, cell); },
      fmt::format("cells of {}, stroke {}", body_, strokes_));
}

void CellEditor::take_as(Pieces pieces) {
  VoxelsSettings taken = voxels();
  taken.pieces = pieces;
  drop_waiting();
  scene_.apply(with(taken), "paint cells");
}

bool CellEditor::take_back() {
  if (waiting_.empty()) return false;
  waiting_.pop_back();
  if (waiting_.empty())
    drop_waiting();
  else
    refuse(with(voxels()));
  return true;
}

void CellEditor::drop_waiting() {
  waiting_.clear();
  waits_upon_.clear();
  refusal_.clear();
  in_pieces_ = false;
}

void CellEditor::follow() {
  if (!any()) return drop_waiting();
  const auto& bodies = scene_.scene().model.voxels;
  if (body_ >= bodies.size()) {
    drop_waiting();
    body_ = bodies.size() - 1;
  }
  if (!waiting_.empty() && bodies[body_].layers != waits_upon_) drop_waiting();
  layer_ = std::clamp(layer_, 0, std::max(size_of(voxels().layers)[1] - 1, 0));
  const std::vector<char> cells = brushes();
  if (brush_ != empty_cell && std::ranges::find(cells, brush_) == cells.end()) brush_ = cells.front();
}

}  // namespace aspic::app
