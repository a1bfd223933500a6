// Smooth normals come from the positions on the device.
#include <gtest/gtest.h>

#include <cmath>

#include "render/studio.h"
#include "render/surface.h"

namespace aspic {
namespace {

class Normals : public test::Studio {};

/// One sum of at most four cross products in single precision, normalised: a few roundings of each component.
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

}  // namespace
}  // namespace aspic
