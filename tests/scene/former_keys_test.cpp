// Names that keys had before 0.3.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "aspic/parameters.h"
#include "scene/scene_support.h"
#include "scene/write.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string start = "schema = 1\n[[cube]]\n[contact]\n";

void expect_contact(const Scene& scene, double distance, double resting_speed) {
  EXPECT_EQ(scene.model.contact.distance, distance);
  EXPECT_EQ(scene.model.contact.resting_speed, resting_speed);
}

TEST(FormerKeys, SetTheirSuccessors) {
  const Scene present = test::parsed(start + "distance = 0.02\nresting-speed = 0.02\n");
  expect_contact(present, 0.02, 0.02);
  const Scene former = test::parsed(start + "epsilon = 0.02\n");
  test::expect_same_scene(former, present);
  EXPECT_EQ(to_toml(former), to_toml(present));
  EXPECT_THAT(to_toml(former), Not(HasSubstr("epsilon")));
  test::expect_same_scene(test::parsed(start, {"contact.epsilon=0.02"}), present);
  test::expect_same_scene(test::parsed(start, {"contact={epsilon=0.02}"}), present);
  test::expect_same_scene(
      *with_overrides(test::parsed(start), std::vector<std::string>{"contact.epsilon=0.02"}), present);
}

TEST(FormerKeys, AcceptBritishSpellings) {
  const Scene present = test::parsed(start +
                                     "[view]\ncolor = \"strain\"\nscale.map = \"gray\"\n[[terrain]]\nshape = "
                                     "\"bowl\"\ncenter = [1, 8, 1]\n");
  const Scene former = test::parsed(start +
                                    "[view]\ncolour = \"strain\"\nscale.map = \"grey\"\n[[terrain]]\nshape = "
                                    "\"bowl\"\ncentre = [1, 8, 1]\n");
  test::expect_same_scene(former, present);
  test::expect_same_scene(
      test::parsed(start + "[[terrain]]\nshape = \"bowl\"\n",
                   {"view.colour=strain", "view.scale.map=grey", "terrain[0].centre=[1, 8, 1]"}),
      present);
  EXPECT_EQ(std::get<Vec3>(value_of(present, "terrain[0].centre").value().value()), (Vec3{1.0, 8.0, 1.0}));
  EXPECT_THAT(
      test::rejection(start + "[[terrain]]\nshape = \"bowl\"\ncenter = [1, 8, 1]\ncentre = [1, 8, 1]\n"),
      HasSubstr("'centre' is the former name of terrain.center"));
}

TEST(FormerKeys, YieldToArguments) {
  expect_contact(test::parsed(start + "epsilon = 0.02\n", {"contact.distance=0.03"}), 0.03, 0.02);
  expect_contact(test::parsed(start + "epsilon = 0.02\n", {"contact.resting-speed=0.03"}), 0.02, 0.03);
  expect_contact(test::parsed(start + "distance = 0.02\n", {"contact.epsilon=0.03"}), 0.03, 0.03);
  expect_contact(test::parsed(start, {"contact.epsilon=0.02", "contact.epsilon=0.03"}), 0.03, 0.03);
}

TEST(FormerKeys, ExcludeTheirSuccessors) {
  constexpr const char* message =
      "'epsilon' is the former name of contact.distance and contact.resting-speed, and both are "
      "given; "
      "remove 'epsilon'";
  for (const char* line : {"distance = 0.02\n", "resting-speed = 0.02\n"}) {
    for (const std::string& keys :
         {line + std::string("epsilon = 0.02\n"), "epsilon = 0.02\n" + std::string(line)}) {
      const std::string rejected = test::rejection(start + keys);
      EXPECT_THAT(rejected, HasSubstr(message));
      EXPECT_EQ(test::problems_in(rejected).size(), 1u) << rejected;
    }
  }
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"contact.epsilon=0.02", "contact.distance=0.02"},
        {"contact.resting-speed=0.02", "contact.epsilon=0.02"}})
    EXPECT_THAT(test::rejection(start, arguments), HasSubstr(message));
}

TEST(FormerKeys, AreBlamedOnceForTheirValue) {
  const std::string rejected = test::rejection(start + "epsilon = -1.0\n");
  EXPECT_THAT(rejected, HasSubstr("scene.toml:4:11: "));
  EXPECT_EQ(test::problems_in(rejected).size(), 1u) << rejected;
}

TEST(FormerKeys, ReadAsTheirFirstSuccessor) {
  const Scene scene = test::parsed(start + "distance = 0.02\n");
  EXPECT_EQ(std::get<double>(value_of(scene, "contact.epsilon").value().value()), 0.02);
  EXPECT_FALSE(value_of(scene, "contact.epsilom").ok());
}

}  // namespace
}  // namespace aspic
