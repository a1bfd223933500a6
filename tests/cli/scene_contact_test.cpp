// What `aspic scene check` and `aspic run` say of contact between bodies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/process.h"

namespace aspic {
namespace {

using test::aspic;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Words = std::vector<std::string>;

TEST(SceneContact, ReportsBodiesThatMayBeInContact) {
  const auto check = aspic({"scene", "check", "cubes-stack", "--set", "cube[0].friction=0.1"});
  EXPECT_EQ(check.exit_code, 0);
  EXPECT_THAT(
      check.out,
      AllOf(
          HasSubstr("contact      cube[0] with cube[1], cube[2]: k 1.462e+04 N/m, c 34.21 N·s/m, ρ 0.0444 m, "
                    "D 0.111 m, μ 0.1; no penetration below 48.4 m/s, 0.9 of the speed of sound 53.7 m/s"),
          HasSubstr("contact      cube[1], cube[2]: "), HasSubstr("μ 0.3"),
          HasSubstr("a stack of these is stable up to 12.4 m"), HasSubstr("; in contact at least 0.00"),
          HasSubstr(", edges on edges at least 0.00")));
  EXPECT_THAT(check.err, Not(HasSubstr("warning")));
  const auto one = aspic({"scene", "check", "cube-plane"});
  EXPECT_THAT(one.out, AllOf(Not(HasSubstr("contact")), HasSubstr("time step")));
}

TEST(SceneCheck, NamesDampingOfSpringsThatANetLacks) {
  const Words damped = {"scene", "check", "goal-net", "--set", "goal-net[0].shear.damping=3"};
  EXPECT_THAT(aspic(damped).err,
              HasSubstr("goal-net[0].shear.damping has no effect: its shear.stiffness is 0"));
  Words stiff = damped;
  stiff.insert(stiff.end(), {"--set", "goal-net[0].shear.stiffness=1"});
  EXPECT_THAT(aspic(stiff).err, Not(HasSubstr("no effect")));
}

TEST(SceneContact, WarnsOfNoBuiltInScene) {
  for (const char* scene : {"cubes-stack", "cubes-tower", "heap", "squeeze", "jelly-in-net", "knot"})
    EXPECT_EQ(aspic({"scene", "check", scene}).err, "") << scene;
}

TEST(SceneContact, IsInTheJson) {
  const auto check = aspic({"scene", "check", "cubes-stack", "--json", "--set", "cube[1].position=[0,6,0]"});
  const auto json = nlohmann::json::parse(check.out)["contact"];
  ASSERT_EQ(json["kinds"].size(), 1u);
  EXPECT_EQ(json["kinds"][0]["bodies"].size(), 3u);
  EXPECT_NEAR(json["pairs"][0]["speed"].get<double>(), 48.4, 0.1);
  EXPECT_GT(json["stable_steps"]["symplectic-euler"]["faces"].get<double>(),
            json["stable_steps"]["symplectic-euler"]["edges"].get<double>());
  ASSERT_EQ(json["overlaps"].size(), 1u);
  EXPECT_NEAR(json["overlaps"][0]["deepest"].get<double>(), 0.1, 0.02);
  EXPECT_TRUE(
      nlohmann::json::parse(aspic({"scene", "check", "cube-plane", "--json"}).out)["contact"].is_null());
}

TEST(SceneContact, WarnsOfWhatDoesNotHold) {
  const auto overlap = aspic({"scene", "check", "cubes-stack", "--set", "cube[1].position=[0,5.8,0]"});
  EXPECT_THAT(overlap.err, HasSubstr("two bodies overlap at the start: cube[0] and cube[1] by 0."));
  const auto gain = aspic({"scene", "check", "cubes-stack", "--set", "simulation.integrator=explicit-euler",
                           "--set", "contact.body-damping=0.05"});
  EXPECT_THAT(gain.err,
              HasSubstr("impacts of bodies gain energy under explicit-euler: contact.body-damping is 0.05, "
                        "and this time step needs 0.086"));
  const auto step = aspic({"scene", "check", "cubes-stack", "--set", "simulation.timestep=0.0019"});
  EXPECT_THAT(step.err, HasSubstr("during contact of bodies, the time step 0.0019 s may not be stable"));
}

TEST(SceneContact, RunsNameWhatOverlapsAtTheStart) {
  const auto start = aspic(
      {"run", "cubes-stack", "--steps", "2", "--backend", "cpu", "--set", "cube[1].position=[0,5.8,0]"});
  EXPECT_THAT(start.err, HasSubstr("cube[0] and cube[1] by 0."));
  EXPECT_THAT(start.out, HasSubstr("J of contact)"));
}

TEST(SceneContact, RunsNameOnceWhatIsDeepWithinEachOther) {
  // More than a spacing a step: the lower face is in the middle of the other cube at the watch's first look.
  std::vector<std::string> words = {"run", "cubes-stack", "--steps", "250", "--backend", "cpu"};
  for (const char* const setting :
       {"cube[0].particles-per-edge=6", "cube[1].particles-per-edge=6", "cube[2].particles-per-edge=6",
        "cube[1].position=[0.5,63,0.5]", "cube[1].velocity=[0,-600,0]", "cube[2].position=[30,3,0]"})
    words.insert(words.end(), {"--set", setting});
  const auto deep = aspic(words);
  EXPECT_THAT(deep.err, HasSubstr("interpenetrate beyond the contact range at step 100 (t = 0.1 s)"));
  const std::size_t first = deep.err.find("interpenetrate");
  EXPECT_EQ(deep.err.find("cube[0] and cube[1]", deep.err.find("cube[0] and cube[1]", first) + 1),
            std::string::npos)
      << "once: " << deep.err;
}

}  // namespace
}  // namespace aspic
