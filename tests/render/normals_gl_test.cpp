// Smooth normals come from the positions on the device.
#include <gtest/gtest.h>

#include <cmath>

#include "render/studio.h"

namespace aspic {
namespace {

class Normals : public test::Studio {};

/// One sum of at most four cross products in single precision, normalised: a few roundings of each component.
constexpr double rounding = 16 * 0x1p-24;

TEST_F(Normals, UndeformedCubeLeansEquallyAtEdgesAndCorners) {
  const int n = 4;
  const Model model = test::build(test::cube_on_plane(n, 0.0));
  (void)draw(model, initial_state(model, Precision::single), {}, 64, 64);
  const std::vector<Vec3> normals = renderer().normals();
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        const auto side = [&](int c) { return c == 0 ? -1.0 : c == n - 1 ? 1.0 : 0.0; };
        const Vec3 sides = {side(i), side(j), side(k)};
        if (length(sides) == 0.0) continue;
        const Vec3 expected = sides / length(sides);
        const Vec3 got = normals[static_cast<std::size_t>((i * n + j) * n + k)];
        // Positions round to single precision: relative to the spacing 4/3 m that is twice epsilon of 2 m.
        EXPECT_LT(length(got - expected), 4 * rounding) << i << " " << j << " " << k;
      }
    }
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
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (length(normals[i]) == 0.0) continue;
    worst = std::max(worst, length(normals[i] - state.position[i] / length(state.position[i])));
  }
  // Quads on the unit sphere span up to δ = 2/16 rad. Where their sizes change along the surface, or a cube's
  // edge bends them, the sum leans by a first-order share of δ: no more than δ itself.
  EXPECT_LT(worst, 2.0 / 16);
  EXPECT_GT(worst, 0.0);
}

}  // namespace
}  // namespace aspic
