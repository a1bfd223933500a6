#pragma once
// A level ground that images show and physics knows nothing of.
#include "aspic/scene.h"
#include "base/result.h"
#include "gpu/context.h"
#include "render/camera.h"
#include "render/mesh.h"
#include "render/programs.h"

namespace aspic {

class ReferenceGround {
 public:
  /// Error (scene_rejected): no device memory.
  static Result<ReferenceGround> create(gl::Context& context, RenderProgram program);

  /// Half of the ground at view.ground, if there is one: before the translucent bodies and again after them.
  /// Frame block and light maps must be bound.
  void draw(const ViewSettings& view, const Camera& lens) const;

 private:
  RenderProgram program_;
  DeviceMesh square_;
};

}  // namespace aspic
