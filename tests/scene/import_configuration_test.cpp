#include "scene/import_configuration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "scene/scene_support.h"

namespace aspic {
namespace {

using testing::HasSubstr;

std::string example() {
  std::ifstream file(ASPIC_TEST_DATA "/import/Configuration.txt");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_FALSE(text.str().empty());
  return text.str();
}

TEST(Import, EveryKeyFindsItsPlace) {
  const auto imported = import_configuration(example(), "Configuration.txt");
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  const Scene& scene = imported->scene;
  ASSERT_EQ(scene.model.goal_nets.size(), 1u);
  const GoalNetSettings& net = scene.model.goal_nets[0];
  EXPECT_EQ(scene.model.simulation.integrator, Integrator::runge_kutta_4);
  EXPECT_EQ(scene.model.simulation.timestep, 0.0005);
  EXPECT_EQ(scene.model.simulation.steps_per_frame, 4);
  EXPECT_EQ(net.position, (Vec3{0.5, 0.7, -1.0}));
  EXPECT_EQ(net.size, (Vec3{2.5, 3.5, 9.0}));
  EXPECT_EQ(net.particles, (std::array<int, 3>{8, 12, 24}));
  EXPECT_EQ(net.structural.stiffness, 1200.0);
  EXPECT_EQ(net.structural.damping, 40.0);
  EXPECT_TRUE(scene.view.draw.particles && scene.view.draw.structural && scene.view.draw.bending);
  EXPECT_FALSE(scene.view.draw.shear);
  EXPECT_EQ(scene.author, "0412345");
  EXPECT_TRUE(scene.view.terrain);
  ASSERT_EQ(scene.model.terrain.size(), 1u);
  EXPECT_EQ(scene.model.launchers.size(), 1u);
}

TEST(Import, SaysWhatItDoesNotCarryAndPrintsAValidScene) {
  const auto imported = import_configuration(example(), "Configuration.txt");
  ASSERT_TRUE(imported.ok());
  const std::string text = imported_toml(*imported, "Configuration.txt");
  for (const auto& [line, key] : std::vector<std::pair<int, std::string>>{
           {12, "DrawGoalpost"}, {16, "DrawBackground"}, {20, "SimulationStart"}, {51, "NetColor"}}) {
    const std::string note = fmt::format("Configuration.txt:{}: *{} ", line, key);
    EXPECT_THAT(imported->notes, testing::Contains(HasSubstr(note)));
    EXPECT_THAT(text, HasSubstr("# Not translated: " + note));
  }
  EXPECT_EQ(imported->notes.size(), 4u);
  EXPECT_FALSE(imported->scene.view.axes);
  test::expect_same_scene(test::parsed(text), imported->scene);
}

TEST(Import, SkipsAByteOrderMark) {
  const auto imported = import_configuration("\xef\xbb\xbf*DeltaT\n0.002\n*DrawAxis\ntrue\n", "c.txt");
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  EXPECT_EQ(imported->scene.model.simulation.timestep, 0.002);
  EXPECT_TRUE(imported->scene.view.axes);
}

// "In this case, plane will not be showed in the beginning": it is there all the same.
TEST(Import, APlaneThatIsNotDrawnIsThereAllTheSame) {
  const auto imported = import_configuration("*DrawPlane\nfalse\n*StudentID\n0356611 \"A\" \n", "c.txt");
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  EXPECT_FALSE(imported->scene.view.terrain);
  EXPECT_EQ(imported->scene.model.terrain.size(), 1u);
  EXPECT_EQ(imported->scene.author, "0356611 \"A\"");
  EXPECT_TRUE(imported->notes.empty());
  test::expect_same_scene(test::parsed(imported_toml(*imported, "c.txt")), imported->scene);
}

TEST(Import, KeepsTheAssignmentsNetWhereNothingIsSaid) {
  const auto imported = import_configuration("*DeltaT\r\n0.002f\r\n", "c.txt");
  ASSERT_TRUE(imported.ok());
  EXPECT_EQ(imported->scene.model.simulation.timestep, 0.002);
  EXPECT_EQ(imported->scene.model.goal_nets[0].particles, (std::array<int, 3>{10, 20, 35}));
  EXPECT_TRUE(imported->notes.empty());
}

TEST(Import, ReportsAllErrorsWithTheirLines) {
  const auto imported = import_configuration(
      "*DeltaT\n*IntegratorType\n2\nstray\n*NumAtWidth\n1\n*NumAtHeight\n2.5\n*SpringCoef\nstiff\n"
      "*NetWidth\n-1\n*SpringCoef\n5\n*DamperCoef\n",
      "c.txt");
  ASSERT_FALSE(imported.ok());
  EXPECT_EQ(imported.error().code, ErrorCode::scene_rejected);
  for (const char* expected :
       {"c.txt:1: *DeltaT has no value", "c.txt:3: *IntegratorType must be 0 (Euler) or 1",
        "c.txt:4: \"stray\" is neither", "c.txt:6: *NumAtWidth: 'goal-net.particles' is out of range: 1",
        "c.txt:8: *NumAtHeight must be an integer", "c.txt:10: *SpringCoef must be a number, not \"stiff\"",
        "c.txt:12: *NetWidth: 'goal-net.size' is out of range", "c.txt:13: *SpringCoef repeats line 9",
        "c.txt:15: *DamperCoef has no value"}) {
    EXPECT_THAT(imported.error().message(), HasSubstr(expected));
  }
  const auto empty = import_configuration("", "c.txt");
  ASSERT_FALSE(empty.ok());
  EXPECT_THAT(empty.error().message(), testing::StartsWith("c.txt:1: no key"));
}

TEST(Import, SuggestsTheNearestKey) {
  const auto imported = import_configuration("*DeltaTT\n1\n", "c.txt");
  ASSERT_TRUE(imported.ok());
  EXPECT_THAT(imported->notes, testing::ElementsAre(HasSubstr("did you mean 'DeltaT'?")));
}

TEST(Import, RefusesNumbersThatAreNone) {
  for (const char* value : {"nan", "-nan", "inf", "1e308", "1e999", "2", "-1"}) {
    const auto imported = import_configuration(std::string("*DrawParticle\n") + value + "\n", "c.txt");
    ASSERT_FALSE(imported.ok()) << value;
    EXPECT_THAT(imported.error().message(), HasSubstr("c.txt:2: *DrawParticle must be")) << value;
  }
  for (const char* value : {"nan", "inf", "1e308"})
    EXPECT_FALSE(import_configuration(std::string("*SpringCoef\n") + value + "\n", "c.txt").ok()) << value;
  EXPECT_TRUE(import_configuration("*DrawParticle\n1\n*DrawSpringShear\nfalse\n", "c.txt").ok());
}

TEST(Import, QuotesNoBytesThatAreNoText) {
  const auto binary = import_configuration(std::string_view("\x7f"
                                                            "ELF\0\0\0",
                                                            7),
                                           "c");
  ASSERT_FALSE(binary.ok());
  EXPECT_THAT(binary.error().message(), testing::AllOf(HasSubstr("binary"), testing::Not(HasSubstr("ELF"))));
  const auto stray = import_configuration(std::string(10000, '\xe9'), "c");
  ASSERT_FALSE(stray.ok());
  EXPECT_LT(stray.error().message().size(), 400u);
  // Comments may be in any encoding; values that end up in notes become valid text.
  const auto imported =
      import_configuration("*StudentID # \xb1\n\xb1\x61\x1b\n*NetColor\n\xb2\x61\x1b\n", "c\n\xff");
  ASSERT_TRUE(imported.ok());
  const std::string toml = imported_toml(*imported, "c\n\xff");
  EXPECT_EQ(imported->scene.author, "\\xb1a\\x1b");
  EXPECT_THAT(toml, HasSubstr("(value \\xb2a\\x1b)"));
  EXPECT_TRUE(parse_scene(toml, "s.toml").ok());
}

}  // namespace
}  // namespace aspic
