#include <gtest/gtest.h>

#include <random>

#include "physics/springs/law.h"

namespace aspic::physics {
namespace {

SpringConstants<double> spring(double k, double c, double r, bool cord = false) {
  return SpringConstants<double>(SpringClass{SpringType::structural, k, c, r, cord});
}

TEST(SpringForce, FollowsTheFormula) {
  // Along x: stretched by 1 of rest 2, ends parting at 4 m/s: −[10·1 + 3·4] on a, which sits at +x.
  const Vector<double> f = spring_force<double>(spring(10, 3, 2), {3, 0, 0}, {4, 7, 0});
  EXPECT_EQ(f, Vector<double>(-22, 0, 0));
  // A 3-4-5 triangle, compressed by 5 of rest 10, at rest: pushes a away with 2·5.
  const Vector<double> g = spring_force<double>(spring(2, 0, 10), {3, 4, 0}, {0, 0, 0});
  EXPECT_NEAR(g.x(), 6.0, 1e-14);
  EXPECT_NEAR(g.y(), 8.0, 1e-14);
}

TEST(SpringForce, OfNoLengthIsZero) {
  const SpringConstants<float> s(SpringClass{SpringType::shear, 100, 5, 1, false});
  EXPECT_EQ(spring_force<float>(s, {0, 0, 0}, {1, -1, 0}), (Vector<float>(0, 0, 0)));
}

TEST(SpringForce, CordResistsStretchOnly) {
  const Vector<double> none(0, 0, 0);
  EXPECT_EQ(spring_force<double>(spring(10, 3, 2, true), {1, 0, 0}, {9, 0, 0}), none);
  EXPECT_EQ(spring_force<double>(spring(10, 0, 2, true), {3, 0, 0}, none), Vector<double>(-10, 0, 0));
}

TEST(SpringForce, ExchangingTheEndsNegatesEveryBit) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-5.0f, 5.0f);
  const SpringConstants<float> s(SpringClass{SpringType::structural, 2000.0, 60.0, 0.444, false});
  const auto vector = [&] { return Vector<float>(any(random), any(random), any(random)); };
  for (int n = 0; n < 10000; ++n) {
    const Vector<float> xa = vector(), va = vector(), xb = vector(), vb = vector();
    const Vector<float> on_a = spring_force<float>(s, xa - xb, va - vb),
                        on_b = spring_force<float>(s, xb - xa, vb - va);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(on_a[axis]) ^ 0x80000000u,
                std::bit_cast<std::uint32_t>(on_b[axis]));
    }
  }
}

}  // namespace
}  // namespace aspic::physics
