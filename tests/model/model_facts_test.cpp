// What programs outside the library are told of a model, against its members.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "aspic/model.h"
#include "model/model.h"
#include "model/springs.h"

namespace aspic {
namespace {

/// A cube that hangs on its top, which lists no springs, a cloth, which does, and a ball.
ModelSettings settings() {
  ModelSettings s;
  CubeSettings& cube = s.cubes.emplace_back();
  cube.particles_per_edge = 3;
  cube.pinned.names = {"top"};
  s.cloths.emplace_back().particles = {3, 2};
  BallSettings& ball = s.balls.emplace_back();
  ball.radius = 0.25;
  ball.mass = 2.0;
  return s;
}

TEST(ModelFacts, AreThoseOfTheModel) {
  const auto made = make_model(settings());
  ASSERT_TRUE(made.ok()) << made.error().message();
  const Model& model = **made;
  const auto ranges = particle_ranges(model);
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_EQ(ranges[0].first, 0u);
  EXPECT_EQ(ranges[0].count, 27u);
  EXPECT_EQ(ranges[1].first, 27u);
  EXPECT_EQ(ranges[1].count, 6u);

  const auto masses = particle_masses(model);
  ASSERT_EQ(masses.size(), 33u);
  EXPECT_EQ(masses[0], 1.0);
  EXPECT_EQ(masses[32], 0.02);
  const auto pinned = pinned_indices(model);
  EXPECT_EQ(pinned.size(), 9u);
  EXPECT_TRUE(std::ranges::is_sorted(pinned));
  for (const std::uint32_t i : pinned) EXPECT_EQ(model.inverse_mass[i], 0.0) << i;

  const auto springs = spring_facts(model);
  EXPECT_EQ(springs.size(), spring_count(model));
  EXPECT_TRUE(std::ranges::is_sorted(
      springs, {}, [](const SpringFacts& spring) { return std::tuple(spring.a, spring.b); }));
  const SpringFacts& first = springs.front();
  EXPECT_EQ(std::tuple(first.a, first.b), std::tuple(0u, 1u));
  EXPECT_EQ(first.type, SpringType::structural);
  EXPECT_EQ(std::tuple(first.stiffness, first.damping, first.rest_length, first.cord),
            std::tuple(2000.0, 60.0, 2.0, false));
  EXPECT_EQ(springs.back().stiffness, 400.0) << "between the last two of the cloth";

  EXPECT_EQ(surface_quads(model, 0).size(), 24u);
  EXPECT_EQ(surface_quads(model, 1).size(), 2u);
  const auto balls = ball_facts(model);
  ASSERT_EQ(balls.size(), 1u);
  EXPECT_EQ(std::tuple(balls[0].radius, balls[0].mass, balls[0].launch_step), std::tuple(0.25, 2.0, 0u));
}

TEST(ModelFacts, AModelThatCannotBeIsAnError) {
  ModelSettings s = settings();
  s.cubes[0].pinned.names = {"middle"};
  const auto made = make_model(s);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, ErrorCode::scene_rejected);
}

}  // namespace
}  // namespace aspic
