#include <gtest/gtest.h>

#include "cli/process.h"

namespace aspic {
namespace {

using test::aspic;
using test::json_member;

TEST(Bench, ReportsWhatItMeasured) {
  const auto run = aspic(
      {"bench", "--backend", "reference", "--size", "4", "--duration", "0.05", "--repeats", "2", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* key : {"\"spring_evaluations_per_second\"", "\"steps_per_second\"", "\"bytes\"",
                          "\"renderer\"", "\"spread\""}) {
    EXPECT_NE(run.out.find(key), std::string::npos) << key;
  }
  EXPECT_NE(run.out.find("\"springs\": 564"), std::string::npos)
      << run.out;  // 144 + 324 + 96 (docs/physics.md, section 2)
  EXPECT_NE(run.out.find("\"steps\": 50"), std::string::npos) << run.out;
}

TEST(Bench, LargestStepIsTheIntegratorsOwn) {
  const auto run = aspic({"bench", "--backend", "reference", "--size", "3", "--duration", "0.05", "--repeats",
                          "1", "--timestep", "largest", "--integrator", "explicit-euler", "--integrator",
                          "implicit-euler", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("\"timestep\": 0.016666666666666666"), std::string::npos) << run.out;
}

TEST(Bench, RefusesWhatItCannotMeasure) {
  EXPECT_EQ(aspic({"bench", "--size", "1"}).exit_code, 3);
  EXPECT_EQ(aspic({"bench", "--integrator", "leapfrog"}).exit_code, 2);
  EXPECT_EQ(aspic({"bench", "--timestep", "0.1"}).exit_code, 2);
  EXPECT_EQ(aspic({"bench", "--seconds", "0"}).exit_code, 2);
  EXPECT_EQ(aspic({"bench", "--seconds", "1", "--duration", "1"}).exit_code, 2);
  EXPECT_EQ(aspic({"bench", "--backend", "reference:gather"}).exit_code, 2);
  const auto undamped = aspic({"bench", "--backend", "reference", "--size", "3", "--timestep", "largest",
                               "--set", "cube[0].structural.damping=0", "--set", "cube[0].shear.damping=0",
                               "--set", "cube[0].bending.damping=0"});
  EXPECT_EQ(undamped.exit_code, 3) << undamped.err;
}

}  // namespace
}  // namespace aspic
