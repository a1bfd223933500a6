#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "aspic/analysis.h"

namespace aspic {
namespace {

State three_particles(Precision precision) {
  State state;
  state.precision = precision;
  state.position = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}};
  state.velocity = {{0.0, 0.0, 0.0}, {0.5, 0.25, 0.0}, {-1.0, -2.0, -3.0}};
  return state;
}

TEST(Ulp, NeighborsAreOneApart) {
  EXPECT_EQ(ulp_distance(1.0f, std::nextafter(1.0f, 2.0f)), 1u);
  EXPECT_EQ(ulp_distance(std::nextafter(-1.0, -2.0), -1.0), 1u);
  EXPECT_EQ(ulp_distance(1.0f, 2.0f), 1u << 23);
  EXPECT_EQ(ulp_distance(-0.0f, 0.0f), 1u);
  const float tiny = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(ulp_distance(-tiny, tiny), 3u);
  const double huge = std::numeric_limits<double>::max();
  EXPECT_EQ(ulp_distance(-huge, huge), ulp_distance(huge, -huge));
  EXPECT_GT(ulp_distance(-huge, huge), std::uint64_t{1} << 63);
}

TEST(Compare, EqualStatesAreIdentical) {
  const auto d = compare_states(three_particles(Precision::single), three_particles(Precision::single));
  ASSERT_TRUE(d.ok());
  EXPECT_TRUE(d->identical());
  EXPECT_EQ(d->largest_absolute(), 0.0);
}

TEST(Compare, BallsAreComparedToo) {
  State a = three_particles(Precision::single);
  a.ball_position = {{1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}};
  a.ball_velocity = a.ball_angular_velocity = a.ball_position;
  State b = a;
  b.ball_angular_velocity[1].x = 2.5;
  const auto d = compare_states(a, b);
  ASSERT_TRUE(d.ok());
  EXPECT_FALSE(d->identical());
  EXPECT_EQ(d->largest_absolute(), 0.5);
  EXPECT_EQ(d->ball_angular_velocity.absolute_index, 1u);
  EXPECT_EQ(d->ball_velocity.ulp, 0u);
  b.ball_position.pop_back();
  EXPECT_FALSE(compare_states(a, b).ok());
}

TEST(Compare, FindsTheLargestDifferenceOfEachKind) {
  const State a = three_particles(Precision::single);
  State b = a;
  b.position[1].y = 5.5;  // large in meters
  b.position[2].z = std::nextafter(9.0f, 10.0f);
  b.velocity[0].x = 1e-30f;  // large in ULPs only
  b.velocity[2].z = -3.25;
  const auto d = compare_states(a, b);
  ASSERT_TRUE(d.ok());
  EXPECT_EQ(d->position.absolute, 0.5);
  EXPECT_EQ(d->position.absolute_index, 1u);
  EXPECT_EQ(d->position.ulp, (1u << 23) / 8);  // 0.5 of the binade 4…8
  EXPECT_EQ(d->velocity.absolute, 0.25);
  EXPECT_EQ(d->velocity.absolute_index, 2u);
  EXPECT_EQ(d->velocity.ulp_index, 0u);
  EXPECT_FALSE(d->identical());
}

TEST(Compare, SignOfZeroIsADifference) {
  const State a = three_particles(Precision::single);
  State b = a;
  b.velocity[1].z = -0.0;
  const auto d = compare_states(a, b);
  ASSERT_TRUE(d.ok());
  EXPECT_FALSE(d->identical());
  EXPECT_EQ(d->velocity.absolute, 0.0);
}

TEST(Compare, MixedPrecisionCountsSingleUlps) {
  const State a = three_particles(Precision::single);
  State b = three_particles(Precision::double_);
  b.position[0].x = 1.0 + 1e-12;  // vanishes in single precision
  auto d = compare_states(a, b);
  ASSERT_TRUE(d.ok());
  EXPECT_EQ(d->position.ulp, 0u);
  EXPECT_NEAR(d->position.absolute, 1e-12, 1e-15);
  State c = three_particles(Precision::double_);
  d = compare_states(b, c);
  ASSERT_TRUE(d.ok());
  EXPECT_GT(d->position.ulp, 1000u);
}

TEST(Compare, DifferentParticleCountsAreRefused) {
  State b = three_particles(Precision::single);
  b.position.pop_back();
  b.velocity.pop_back();
  const auto d = compare_states(three_particles(Precision::single), b);
  ASSERT_FALSE(d.ok());
  EXPECT_EQ(d.error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace aspic
