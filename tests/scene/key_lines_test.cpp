#include "scene/key_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "model/model.h"
#include "model/springs.h"
#include "scene/scene_support.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using testing::Not;

Scene scene_of(const std::string& name, const std::vector<std::string>& overrides = {}) {
  auto scene = load_scene(name, overrides);
  EXPECT_TRUE(scene.ok()) << scene.error().message();
  return *scene;
}

void expect_same_motion(const Scene& scene) {
  SCOPED_TRACE(scene.name);
  const std::string lines = to_key_lines(scene);
  const auto again = with_key_lines({}, lines);
  ASSERT_TRUE(again.ok()) << again.error().message() << lines;
  EXPECT_EQ(to_key_lines(*again), lines);
  const auto model = build_model(scene.model), copy = build_model(again->model);
  ASSERT_TRUE(model.ok() && copy.ok());
  EXPECT_EQ(state_hash(initial_state(*model, Precision::double_)),
            state_hash(initial_state(*copy, Precision::double_)));
  EXPECT_EQ(spring_count(*model), spring_count(*copy));
  EXPECT_TRUE(same_pins(*model, *copy));
}

TEST(KeyLines, HoldTheMotionOfEveryBuiltInScene) {
  for (const BuiltinScene& builtin : list_builtin_scenes())
    expect_same_motion(scene_of(std::string(builtin.name)));
}

TEST(KeyLines, HoldWhatNoBuiltInSceneHas) {
  expect_same_motion(scene_of("cube-plane", {"cube[0].particles=[3, 4, 5]", "cube[0].pinned=[\"left\", 3]",
                                             "cube[0].position=[0.1, 1e-7, 123456.789012345]"}));
  expect_same_motion(scene_of("large-cube", {"cube[0].particles-per-edge=3"}));
}

TEST(KeyLines, LeaveOutWhatIsOnlyShown) {
  EXPECT_THAT(to_key_lines(scene_of("cube-plane")), Not(HasSubstr("view.")));
}

TEST(KeyLines, ChangeAScene) {
  const Scene scene = scene_of("cube-plane");
  const auto changed = with_key_lines(scene, "contact.friction=0.75\nsimulation.integrator=\"midpoint\"\n");
  ASSERT_TRUE(changed.ok()) << changed.error().message();
  EXPECT_EQ(changed->model.contact.friction, 0.75);
  EXPECT_EQ(changed->model.simulation.integrator, Integrator::midpoint);
  EXPECT_EQ(changed->model.cubes.size(), 1u);
}

TEST(KeyLines, SayWhatIsWrong) {
  const std::pair<std::string, std::string> wrong[] = {
      {"nonsense", "names no key"},
      {"cube[0].stifness=1", "names no key"},
      {"contact.friction=much", "allowed is a number"},
      {"contact.friction=-1", "out of range"},
      {"contact.friction=1 ", "allowed is a number"},
      {"simulation.gravity=[0, 1]", "three numbers"},
      {"simulation.integrator=midpoint", "allowed is"},
      {"simulation.integrator=\"leapfrog\"", "unknown value"},
      {"contact.spin=1", "true or false"},
      {"cube[2].particle-mass=1", "does not have"},
      {"cube[0].particles-per-edge=2.5", "integer"},
      {"cube[0].pinned=[\"left\", 1000]", "is not in the cube"},
  };
  for (const auto& [line, sentence] : wrong) {
    const auto changed = with_key_lines(scene_of("cube-plane"), line + "\n");
    ASSERT_FALSE(changed.ok()) << line;
    EXPECT_THAT(changed.error().what, HasSubstr(sentence));
  }
  EXPECT_FALSE(with_key_lines({}, "contact.friction=1\n").ok());  // nothing moves
}

}  // namespace
}  // namespace aspic
