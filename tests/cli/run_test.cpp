#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "cli/process.h"
#include "support/state_csv_reader.h"

namespace aspic {
namespace {

using test::aspic;
using test::json_member;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Run, JsonSummaryIsTheWholeOfStdout) {
  const auto run = aspic({"run", "cube-plane", "--backend", "reference", "--steps", "25", "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  ASSERT_TRUE(test::is_json(run.out)) << run.out;
  EXPECT_THAT(run.err, IsEmpty());
  EXPECT_EQ(json_member(run.out, "scene"), "cube-plane");
  EXPECT_EQ(json_member(run.out, "backend"), "reference");
  EXPECT_EQ(json_member(run.out, "precision"), "single");
  EXPECT_EQ(json_member(run.out, "integrator"), "explicit-euler");
  EXPECT_EQ(json_member(run.out, "timestep"), "0.001");
  EXPECT_EQ(json_member(run.out, "steps"), "25");
  EXPECT_EQ(json_member(run.out, "time"), "0.025");
  EXPECT_EQ(json_member(run.out, "diverged"), "null");
  EXPECT_EQ(json_member(run.out, "state_hash").size(), 16u);
  for (const char* key : {"device", "force_path", "wall_seconds", "steps_per_second", "kinetic", "elastic",
                          "gravitational", "total"}) {
    EXPECT_THAT(run.out, HasSubstr('"' + std::string(key) + "\": "));
  }
}

TEST(Run, ReadableSummaryHasTheSameHash) {
  const auto json = aspic({"run", "cube-plane", "--backend", "reference", "--steps", "25", "--json"});
  const auto text = aspic({"run", "cube-plane", "--backend", "reference", "--steps", "25"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, HasSubstr(json_member(json.out, "state_hash")));
}

TEST(Run, DurationIsRoundedToTheNearestStep) {
  const auto steps = [](const char* duration) {
    return json_member(
        aspic({"run", "cube-plane", "--backend", "reference", "--duration", duration, "--json"}).out,
        "steps");
  };
  EXPECT_EQ(steps("0.0104"), "10");
  EXPECT_EQ(steps("0.0106"), "11");
  EXPECT_EQ(steps("0"), "0");
}

TEST(Run, SetChangesTheScene) {
  const auto run =
      aspic({"run", "cube-plane", "--backend", "reference", "--steps", "2", "--set",
             "simulation.integrator=midpoint", "--set", "cube[0].particles-per-edge=4", "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(json_member(run.out, "integrator"), "midpoint");
  EXPECT_EQ(json_member(run.out, "particles"), "64");
}

TEST(Run, ImplicitEulerReportsItsSolves) {
  const auto run = aspic({"run", "cube-plane", "--backend", "reference", "--steps", "5", "--set",
                          "simulation.integrator=implicit-euler", "--set", "cube[0].position=[0,0.995,0]",
                          "--json"});  // in contact: free flight takes no iteration
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto count_of = [&](const char* key) { return std::stoi(json_member(run.out, key)); };
  EXPECT_EQ(count_of("converged") + count_of("stagnated") + count_of("not_converged"), 5);
  EXPECT_GE(count_of("newton_iterations"), 5);
}

TEST(Run, DivergenceEndsAtTheLastGoodStateAndSaysWhy) {
  const test::TemporaryDirectory dir;
  const auto run =
      aspic({"run", "cube-plane", "--backend", "reference", "--set", "simulation.timestep=0.01", "--steps",
             "100000", "--state", dir.file("s.csv"), "--series", dir.file("e.csv"), "--json"});
  EXPECT_EQ(run.exit_code, 5) << run.err;
  EXPECT_THAT(run.err, HasSubstr("diverged in step"));
  EXPECT_THAT(run.err, HasSubstr("particle"));
  EXPECT_THAT(run.err, HasSubstr("The time step is 0.01 s"));
  EXPECT_THAT(run.err, HasSubstr("0.002048"));
  EXPECT_THAT(run.err, HasSubstr("warning: the time step 0.01 s is not stable"));
  ASSERT_TRUE(test::is_json(run.out)) << run.out;
  EXPECT_THAT(json_member(run.out, "finite"), testing::AnyOf("true", "false"));
  const auto state = test::read_state_csv(dir.file("s.csv"), Precision::single);
  ASSERT_TRUE(state.ok()) << state.error().message();
  EXPECT_EQ(state_hash_text(*state), json_member(run.out, "state_hash"));
  EXPECT_THAT(dir.read("e.csv"), testing::Not(testing::AnyOf(HasSubstr("nan"), HasSubstr("inf"))));
  // The state is that of the last good step: a run that stops there ends with the same bits and no error.
  const auto shorter =
      aspic({"run", "cube-plane", "--backend", "reference", "--set", "simulation.timestep=0.01", "--steps",
             json_member(run.out, "steps"), "--json"});
  EXPECT_EQ(shorter.exit_code, 0);
  EXPECT_EQ(json_member(shorter.out, "state_hash"), json_member(run.out, "state_hash"));
}

// "The first step within 0.3 s": the best of five, since the machine may be busy.
TEST(Run, FirstStepComesAtOnce) {
  double best = 1e9;
  for (int i = 0; i < 5; ++i) {
    const auto before = std::chrono::steady_clock::now();
    EXPECT_EQ(aspic({"run", "cube-plane", "--backend", "reference", "--steps", "1"}).exit_code, 0);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count());
  }
#ifdef NDEBUG
  EXPECT_LT(best, 0.3);
#else
  EXPECT_LT(best, 3.0);  // without optimization, perhaps under sanitizers
#endif
}

}  // namespace
}  // namespace aspic
