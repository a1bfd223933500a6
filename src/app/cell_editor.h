#pragma once
// The cells of a body that are being edited: which body and layer, with what, and changes that the scene does
// not take yet.
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/cell_layers.h"
#include "app/scene_control.h"

namespace aspic::app {

class CellEditor {
 public:
  /// The scene must outlive it.
  explicit CellEditor(SceneControl& scene) : scene_(scene) {}

  /// Whether the scene has a body of cells; the others may be called only then.
  bool any() const { return !scene_.scene().model.voxels.empty(); }
  std::size_t body() const { return body_; }
  void choose_body(std::size_t body);
  /// From below; one that does not exist is the nearest that does.
  int layer() const { return layer_; }
  void choose_layer(int layer);
  /// The character that is painted with.
  char brush() const { return brush_; }
  void choose_brush(char cell) { brush_ = cell; }
  /// Characters of full cells to paint with: those of the palette, or the one that most cells have.
  std::vector<char> brushes() const;
  /// Chooses what a digit means: 0 erases, others count the characters to paint with. False: it means
  /// nothing here.
  bool choose_by_digit(char32_t character);

  /// The body as it is edited: as the scene has it, or with the cells that wait.
  VoxelsSettings voxels() const;
  /// Why cells wait that the scene does not take; empty: none do.
  const std::string& refusal() const { return refusal_; }
  /// Whether another choice of `pieces` would let them be taken.
  bool in_pieces() const { return in_pieces_; }

  /// Changes the body's cells under a name for undo; changes of the same gesture (not empty) are one. Cells
  /// that the scene refuses wait: nothing is lost, and the next change may mend them.
  void change(const std::string& name, const std::function<void(VoxelsSettings&)>& make,
              const std::string& gesture = "");
  /// A stroke of the mouse over cells of the layer that become `cell`, all of it one change for undo.
  void begin_stroke(const CellPlace& from, char cell);
  /// Goes on to a place; without effect where no stroke has begun.
  void stroke(const CellPlace& to);
  void end_stroke() { stroke_.reset(); }
  /// Takes the cells that wait with another choice of `pieces`.
  void take_as(Pieces pieces);
  /// Takes back the last change that waits. False: none does.
  bool take_back();
  /// All that wait are dropped.
  void drop_waiting();

  /// Once for each image: the scene may have changed otherwise.
  void follow();
  /// The layer is shown in the panels, with the mouse on a cell or none.
  void show(const std::optional<CellPlace>& pointed) {
    shown_ = true;
    pointed_ = pointed;
  }
  /// Whether it was since the last call, and on what cell the mouse was.
  bool take_shown() { return std::exchange(shown_, false); }
  const std::optional<CellPlace>& pointed() const { return pointed_; }

 private:
  struct Waiting {
    CellLayers layers;
    Vec3 shift;  ///< of the body's position [m]
    std::string gesture;
  };
  Scene with(const VoxelsSettings& voxels) const;
  void refuse(const Scene& changed);

  SceneControl& scene_;
  std::size_t body_ = 0;
  int layer_ = 0;
  char brush_ = '\0';
  struct Stroke {
    CellPlace last;
    char cell = '\0';
  };
  std::optional<Stroke> stroke_;
  unsigned strokes_ = 0;
  std::vector<Waiting> waiting_;
  CellLayers waits_upon_;  // the scene's cells that those were made of
  std::string refusal_;
  bool in_pieces_ = false, shown_ = false;
  std::optional<CellPlace> pointed_;
};

}  // namespace aspic::app
