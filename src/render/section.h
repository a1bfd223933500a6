#pragma once
// The inside of bodies where a plane cuts them.
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "aspic/scene.h"
#include "base/result.h"
#include "device/device_state.h"
#include "gpu/buffer.h"
#include "model/model.h"
#include "render/model_buffers.h"
#include "render/programs.h"

namespace aspic {

/// What a section is drawn into.
enum class SectionUse { color, thickness, identities };

/// What a view draws of springs: the types that `draw` names, or where a cut shows springs and it names none,
/// structural and shear ones.
DrawSettings drawn_springs(const ViewSettings& view);

/// How far behind the cut's plane its section is filled [m]: a spacing where springs are drawn before it.
double section_depth(const CutSettings& cut, double spacing);

/// While it lives, skins end at the frame block's cut, if `cut` is on.
class SkinsCut {
 public:
  explicit SkinsCut(const CutSettings& cut);
  ~SkinsCut();
  SkinsCut(const SkinsCut&) = delete;
  SkinsCut& operator=(const SkinsCut&) = delete;

 private:
  bool on_;
};

/// Fills the parts of lattices that the frame block's section plane crosses, cell by cell as deformed.
/// Its context must outlive it and be current.
class SectionPainter {
 public:
  explicit SectionPainter(const std::shared_ptr<RenderProgram::Source>& source);

  /// Makes room for the cells of a model that are looked at together, at most 4 MiB. Error (scene_rejected):
  /// no device memory.
  Status prepare(const Model& model);
  /// Draws the sections of all bodies with the program of that use, in the state of OpenGL as it is; the
  /// frame block must be bound. `color` of bodies: their own, as skins have it, or all neutral.
  void draw(SectionUse use, const Model& model, const ModelBuffers& buffers, const gl::Buffer& particles,
            ViewColor color) const;

 private:
  void draw_body(const RenderProgram& program, const Model& model, std::size_t body,
                 const gl::Buffer& particles) const;

  /// Corners and places of lattices whose cells are not all full, if they are not those listed before.
  Status list_cells(const Model& model);

  gl::Context* context_;
  RenderProgram crossed_, crossed_listed_, color_, thickness_, identities_;
  // By body: its particles, and its lattice if that is listed.
  std::vector<std::pair<std::uint32_t, std::optional<Lattice>>> lattices_;
  std::vector<gl::Buffer> corners_;  // by body, of its full cells
  gl::Buffer places_;                // by particle
  mutable gl::Buffer tetrahedra_;
  std::uint32_t cells_ = 0;  // that there is room for
};

}  // namespace aspic
