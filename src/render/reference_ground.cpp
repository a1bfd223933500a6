#include "render/reference_ground.h"

#include <glad/gl.h>

#include <utility>

#include "render/layout.h"
#include "render/terrain_mesh.h"

namespace aspic {

Result<ReferenceGround> ReferenceGround::create(gl::Context& context, RenderProgram program) {
  ReferenceGround made;
  made.program_ = std::move(program);
  ASPIC_TRY(made.square_, DeviceMesh::create(context, "reference ground", square_mesh()));
  return made;
}

void ReferenceGround::draw(const ViewSettings& view, const Camera& lens) const {
  if (!view.ground) return;
  const Vec3& target = view.camera.target;
  program_.set(LOCATION_PLANE_POINT,
               four({target.x, *view.ground, target.z}, 8.0 * static_cast<double>(lens.target_distance())));
  program_.set(LOCATION_PLANE_NORMAL, four({0.0, 1.0, 0.0}, 0.0));
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  // Before a terrain that is as high: rounding would decide pixel by pixel which of the two is seen.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(-2.0f, -256.0f);
  glUseProgram(program_.id());
  square_.draw();
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace aspic
