#pragma once
// Forces and normals as arrows at particles.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "aspic/scene.h"
#include "base/result.h"
#include "gpu/buffer.h"
#include "gpu/vertex_array.h"
#include "render/overlay.h"
#include "render/programs.h"

namespace aspic {

enum class ArrowKind { normal, contact, springs, external, net };

struct Arrow {
  Vec3 from;   ///< [m]
  Vec3 value;  ///< [N]; of a normal, the unit vector
  ArrowKind kind = ArrowKind::net;

  friend bool operator==(const Arrow&, const Arrow&) = default;
};

/// The arrows of an image.
struct ArrowSet {
  std::vector<Arrow> arrows;
  double room = 1.0;   ///< how long the longest one may be [m], > 0
  double noise = 0.0;  ///< forces that rounding alone may bring about [N], ≥ 0

  friend bool operator==(const ArrowSet&, const ArrowSet&) = default;
};

/// Force that an arrow of a meter represents [N/m]: that of the view; else the smallest 1, 2 or 5 times a
/// power of ten with which the longest arrow finds room; 0, for none, where no force is above the noise.
double arrow_scale(const ViewSettings& view, const ArrowSet& set);

/// What the arrows of a view mean, and the force that a round length represents: "arrows: 1 cm = 0.2 N".
/// Empty without arrows.
Legend arrow_legend(const ViewSettings& view, const ArrowSet& set);

/// Draws arrows. Its context must outlive it and be current.
class ArrowPainter {
 public:
  explicit ArrowPainter(const std::shared_ptr<RenderProgram::Source>& source);

  /// Draws into an unfinished image whose frame block is bound and whose depth is complete: arrows are
  /// faint where something hides them, and those cut away are left out. Leaves blending off. Error
  /// (scene_rejected): no device memory.
  Status draw(const ViewSettings& view, const ArrowSet& set);

 private:
  gl::Context* context_;
  RenderProgram program_;
  gl::Buffer vertices_;
};

}  // namespace aspic
