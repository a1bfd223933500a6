#include "scene/new_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

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

}  // namespace
}  // namespace aspic::test
