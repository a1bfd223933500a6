// Smooth normals come from the positions on the device.
#include <gtest/gtest.h>

#include <cmath>

#include "aspic/scene.h"
#include "model/skin.h"
#include "render/studio.h"
#include "render/surface.h"

namespace aspic {
namespace {

class Normals : public test::Studio {};

/// One sum of at most four cross products in single precision, normalized: a few roundings of each component.
constexpr double rounding = 16 * 0x1p-24;

TEST_F(Normals, FacesOfAnUndeformedCubeAreFlatUpToTheirEdges) {
  const int n = 4;
  const Model model = test::build(test::cube_on_plane(n, 0.0));
  (void)draw(model, initial_state(model, Precision::single), {}, 64, 64);
  const std::vector<Vec3> normals = renderer().normals();
  const Surface surface = make_surface(model);
  ASSERT_EQ(normals.size(), surface.fan_vertex.size());
  // Triangles of a face have its normal at all three vertices.
  for (std::size_t i = 0; i < surface.indices.size(); i += 3) {
    const auto x = [&](std::size_t c) { return model.initial_position[surface.indices[i + c]]; };
    const Vec3 across = cross(x(1) - x(0), x(2) - x(0));
    for (std::size_t c = 0; c < 3; ++c)
      // Positions round to single precision: relative to the spacing 4/3 m that is twice epsilon of 2 m.
      EXPECT_LT(length(normals[surface.corners[i + c]] - across / length(across)), 4 * rounding);
  }
}

TEST_F(Normals, CubeBlownUpToASphereHasRadialNormals) {
  const int n = 17;
  const Model model = test::build(test::cube_on_plane(n, 0.0));
  State state = initial_state(model, Precision::single);
  for (Vec3& x : state.position)
    if (length(x) > 0.0) x = 3.0 / length(x) * x;
  (void)draw(model, state, {}, 64, 64);
  const std::vector<Vec3> normals = renderer().normals();
  double worst = 0.0;
  const Surface surface = make_surface(model);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec3 x = state.position[surface.fan_vertex[i]];
    worst = std::max(worst, length(normals[i] - x / length(x)));
  }
  // Quads on the unit sphere span up to δ = 2/16 rad. Where their sizes change along the surface, or a cube's
  // edge bends them, the sum leans by a first-order share of δ: no more than δ itself.
  EXPECT_LT(worst, 2.0 / 16);
  EXPECT_GT(worst, 0.0);
}

// Where the device puts the vertices of a mesh, and their normals, against the formulas in double precision.
TEST_F(Normals, MeshFollowsTheCellsOfItsBody) {
  const auto scene = load_scene("jelly-figure");
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  const Model model = test::build(scene->model);
  const BodySkin& skin = model.bodies[0].skin;
  ASSERT_FALSE(skin.empty());
  State state = initial_state(model, Precision::single);
  for (Vec3& x : state.position) x = {x.x + 0.2 * std::sin(x.y), x.y, 1.2 * x.z + 0.1 * x.x * x.x};
  (void)draw(model, state, {}, 64, 64);
  const std::vector<Vec3> places = skin_positions(skin.binding, skin.corners, state.position);
  const std::vector<Vec3> right = skin_normals(places, skin.triangles), found = renderer().normals();
  ASSERT_EQ(found.size(), right.size());
  // Positions of 10 m have an error of 2⁻²¹ m on the device, edges are a tenth of a meter: a share of 5e-6,
  // and a few of them where triangles around a vertex are thin.
  double worst = 0.0;
  for (std::size_t v = 0; v < found.size(); ++v) worst = std::max(worst, length(found[v] - right[v]));
  EXPECT_LT(worst, 1e-3);
  EXPECT_GT(worst, 0.0);
}

}  // namespace
}  // namespace aspic
