// What a camera follows.
#include "scene/follow.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "aspic/scene.h"
#include "model/bodies.h"
#include "scene/scene_support.h"

namespace aspic {
namespace {

TEST(Followed, EveryNameIsFoundAndMeansItsOwnBody) {
  Scene scene;
  for (int i = 0; i < 2; ++i)
    for (const BodyRow& row : body_rows()) row.list.append(scene.model);
  const Model model = std::move(build_model(scene.model)).value();
  const std::vector<std::string> names = followable(scene.model, 1000);
  // Two balls, and ten of each launcher.
  ASSERT_EQ(names.size(), model.bodies.size() + 22);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found = find_followed(scene.model, names[i]);
    ASSERT_TRUE(found.has_value()) << names[i];
    EXPECT_EQ(found->ball, i >= model.bodies.size());
    EXPECT_EQ(found->index, found->ball ? i - model.bodies.size() : i) << names[i];
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    EXPECT_EQ(name_of_body(scene.model, model, model.bodies[b].first_particle), names[b]);
  EXPECT_EQ(find_followed(scene.model, "goal-net"), find_followed(scene.model, "goal-net[0]"));
  for (const char* wrong : {"", "cube[2]", "cube[", "cube[]", "cube[-1]", "cube[0]x", "launcher[0]",
                            "ball[22]", "[0]", "cube[99999999999]", "terrain[0]"})
    EXPECT_FALSE(find_followed(scene.model, wrong).has_value()) << wrong;
}

TEST(Followed, MayBeNamedAsItNamesItself) {
  Scene scene = load_scene("worm").value();
  EXPECT_EQ(scene.model.voxels[0].name, "worm");
  scene.model.cubes.emplace_back();
  EXPECT_EQ(find_followed(scene.model, "worm"), find_followed(scene.model, "voxels[0]"));
  EXPECT_TRUE(find_followed(scene.model, "worm").has_value());
  EXPECT_NE(find_followed(scene.model, "worm"), find_followed(scene.model, "cube[0]"));
  scene.model.voxels[0].name.clear();
  EXPECT_FALSE(find_followed(scene.model, "worm").has_value());
  const std::string wrong[] = {"view.follow=legs"};
  EXPECT_THAT(load_scene("worm", wrong).error().message(), testing::HasSubstr("it has worm"));
  // A body that has something wrong is there all the same.
  const std::string empty[] = {"voxels[worm].layers=[[\"...\"]]"};
  EXPECT_THAT(load_scene("worm", empty).error().message(),
              testing::AllOf(testing::HasSubstr("the body is empty"),
                             testing::Not(testing::HasSubstr("view.follow"))));
}

TEST(Followed, KeepsItsMeaningWhereElementsAreRemoved) {
  EXPECT_EQ(followed_without("cube[2]", "cube", 0), "cube[1]");
  EXPECT_EQ(followed_without("cube[2]", "cube", 2), std::nullopt);
  EXPECT_EQ(followed_without("cube", "cube", 0), std::nullopt);
  EXPECT_EQ(followed_without("cube[2]", "cube", 3), "cube[2]");
  EXPECT_EQ(followed_without("cloth[2]", "cube", 0), "cloth[2]");
  EXPECT_EQ(followed_without("ball[2]", "ball", 1), "ball[1]");
}

TEST(Followed, NoneFollowsNothing) {
  const std::string none[] = {"view.follow=none"}, cube[] = {"view.follow=cube"};
  EXPECT_EQ(load_scene("cube-sphere", cube)->view.follow, "cube");
  EXPECT_FALSE(load_scene("cube-sphere", none)->view.follow.has_value());
}

TEST(Followed, MovesACameraByWhatItMovedItself) {
  Scene scene;
  scene.model.cubes.resize(1);
  scene.model.balls.emplace_back();
  const Model model = std::move(build_model(scene.model)).value();
  State state = initial_state(model, Precision::double_);
  EXPECT_FALSE(Following(scene, model, Precision::double_).any());
  EXPECT_EQ(Following(scene, model, Precision::double_).offset(model, state), Vec3{});
  scene.view.follow = "ball";
  const Following ball(scene, model, Precision::double_);
  scene.view.follow = "cube";
  const Following cube(scene, model, Precision::double_);
  const Vec3 start = state.ball_position[0];
  state.ball_position[0] = start + Vec3{1.0, 2.0, 4.0};
  EXPECT_EQ(ball.offset(model, state), state.ball_position[0] - start);
  EXPECT_EQ(cube.offset(model, state), Vec3{});
  // A scene that has more bodies than the model, which is not built yet.
  scene.model.cubes.resize(2);
  scene.view.follow = "cube[1]";
  EXPECT_FALSE(Following(scene, model, Precision::double_).any());
}

TEST(Followed, MovesWithTheMeanOfItsParticlesOrTheBall) {
  ModelSettings settings;
  settings.cubes.resize(2);
  settings.cubes[1].position = {20.0, 3.0, 1.0};
  settings.balls.emplace_back();
  const Model model = std::move(build_model(settings)).value();
  const State state = initial_state(model, Precision::double_);
  // A thousand additions of numbers below 32.
  EXPECT_LT(length(place_of(model, state, {false, 1}) - settings.cubes[1].position), 1000 * 32 * 0x1p-52);
  EXPECT_EQ(place_of(model, state, {true, 0}), settings.balls[0].position);
}

}  // namespace
}  // namespace aspic
