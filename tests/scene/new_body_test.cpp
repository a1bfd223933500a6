#include "scene/new_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>

#include "aspic/scene.h"
#include "aspic/state.h"
#include "model/model.h"
#include "model/terrain.h"

namespace aspic::test {
namespace {

/// Boxes around them do not overlap.
bool apart(std::span<const Vec3> a, std::span<const Vec3> b) {
  if (a.empty() || b.empty()) return true;
  for (int axis = 0; axis < 3; ++axis) {
    const auto along = [axis](const Vec3& x) { return x[axis]; };
    if (along(std::ranges::max(a, {}, along)) <= along(std::ranges::min(b, {}, along)) ||
        along(std::ranges::max(b, {}, along)) <= along(std::ranges::min(a, {}, along)))
      return true;
  }
  return false;
}

TEST(NewBody, EveryKindHasAPlaceAboveTheGroundAndAwayFromOthers) {
  for (const BodyRow& row : body_rows()) {
    Scene scene = load_scene("cube-plane").value();
    const std::size_t before = build_model(scene.model).value().particle_count();
    add_body(scene, row.list);
    const auto model = build_model(scene.model);
    ASSERT_TRUE(model.ok()) << row.list.key << ": " << model.error().message();
    const State state = initial_state(*model, Precision::double_);
    const Terrain ground = terrain_at(model->terrain.front(), model->simulation.timestep, 0);
    const auto all = std::span(state.position);
    EXPECT_TRUE(apart(all.first(before), all.subspan(before))) << row.list.key;
    for (const Vec3& x : all.subspan(before)) EXPECT_GE(signed_distance(ground, x), 0.0) << row.list.key;
    for (std::size_t b = 0; b < state.ball_position.size(); ++b)
      EXPECT_GE(signed_distance(ground, state.ball_position[b]), model->balls[b].radius) << row.list.key;
  }
}

TEST(NewBody, IsLikeTheLastOfItsKind) {
  Scene scene = load_scene("cube-plane").value();
  scene.model.cubes[0].structural.stiffness = 1234.5;
  add_body(scene, body_rows().front().list);
  ASSERT_EQ(scene.model.cubes.size(), 2u);
  EXPECT_EQ(scene.model.cubes[1].structural.stiffness, 1234.5);
  EXPECT_NE(scene.model.cubes[1].position, scene.model.cubes[0].position);
}

/// Least and greatest height of the particles of a body at the start.
std::pair<double, double> heights(const Scene& scene, std::size_t body) {
  const Model model = build_model(scene.model).value();
  const State state = initial_state(model, Precision::double_);
  const Body& of = model.bodies.at(body);
  const auto y = [](const Vec3& x) { return x.y; };
  const auto all = std::span(state.position).subspan(of.first_particle, of.particle_count);
  return {std::ranges::min(all, {}, y).y, std::ranges::max(all, {}, y).y};
}

const SettingsList& list_of(std::string_view key) {
  return std::ranges::find(body_rows(), key, [](const BodyRow& row) { return row.list.key; })->list;
}

// It falls on what is there: a tenth of its size above the highest under it, whatever the order of the list.
TEST(NewBody, FallsOnTheHighestUnderIt) {
  Scene scene = load_scene("cubes-stack").value();
  add_body(scene, list_of("cube"));
  const double turned = 12.0 * std::numbers::pi / 180.0, wide = 4.0 * (std::cos(turned) + std::sin(turned));
  EXPECT_NEAR(heights(scene, 3).first - heights(scene, 2).second, 0.1 * wide, 1e-9);
  const Vec3 position = scene.model.cubes[3].position, below = scene.model.cubes[2].position;
  EXPECT_EQ(position.x, below.x);
  EXPECT_EQ(position.z, below.z);
  scene.model.cubes[0].position = scene.model.cubes[3].position;
  place_body(scene, list_of("cube"), 0);
  EXPECT_GT(heights(scene, 0).first, heights(scene, 3).second);
}

TEST(NewBody, StaysAboveTheGroundWhereNothingIsUnderIt) {
  Scene scene = load_scene("cubes-stack").value();
  scene.model.cubes.push_back(scene.model.cubes.front());
  scene.model.cubes.back().position = {20.0, 3.0, 0.0};
  place_body(scene, list_of("cube"), 3);
  EXPECT_EQ(scene.model.cubes.back().position, (Vec3{20.0, 3.0, 0.0}));
}

// A cloth that lies level has no height of its own.
TEST(NewBody, ClothIsDroppedFromAboveToo) {
  Scene scene = load_scene("cube-plane").value();
  ClothSettings cloth;
  cloth.rotation = {{1.0, 0.0, 0.0}, 90.0};
  cloth.position = scene.model.cubes[0].position;
  scene.model.cloths.push_back(cloth);
  place_body(scene, list_of("cloth"), 0);
  EXPECT_NEAR(heights(scene, 1).first - heights(scene, 0).second, 0.3, 1e-9);
}

TEST(NewBody, StandsUnderNoOther) {
  Scene scene = load_scene("cube-plane").value();
  add_body(scene, list_of("goal-net"));
  const GoalNetSettings& net = scene.model.goal_nets.at(0);
  const CubeSettings& cube = scene.model.cubes.at(0);
  EXPECT_GT(std::abs(net.position.x - cube.position.x), 0.5 * (net.size.x + cube.edge_length));
}

}  // namespace
}  // namespace aspic::test
