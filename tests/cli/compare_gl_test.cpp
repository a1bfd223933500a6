#include <gtest/gtest.h>

#include "cli/process.h"

namespace aspic {
namespace {

using test::aspic;
using test::json_member;

// From just above the plane, so that contact takes part.
TEST(CompareGl, GpuHasTheBitsOfTheReferenceOnEveryForcePath) {
  for (const char* path : {"gather", "per-spring"}) {
    const auto run = aspic({"compare", "cube-plane", "--backends", "gpu,reference", "--force-path", path,
                            "--steps", "150", "--set", "cube[0].position=[0.0, 1.05, 0.0]", "--set",
                            "cube[0].particles-per-edge=5", "--json"});
    EXPECT_EQ(run.exit_code, 0) << run.err << run.out;
    EXPECT_EQ(json_member(run.out, "identical"), "true");
    EXPECT_EQ(json_member(run.out, "steps"), "150");
  }
}

TEST(CompareGl, RunOnTheGpuEndsWithTheReferencesHash) {
  const auto gpu = aspic({"run", "cube-plane", "--backend", "gpu", "--steps", "60", "--json"});
  ASSERT_EQ(gpu.exit_code, 0) << gpu.err;
  EXPECT_EQ(json_member(gpu.out, "backend"), "gpu");
  EXPECT_EQ(json_member(gpu.out, "force_path"), "gather");
  const auto reference = aspic({"run", "cube-plane", "--backend", "reference", "--steps", "60", "--json"});
  EXPECT_EQ(json_member(gpu.out, "state_hash"), json_member(reference.out, "state_hash"));
}

TEST(CompareGl, DivergenceOnTheGpuEndsWhereTheReferenceEnds) {
  const auto words = [](const char* backend) {
    return std::vector<std::string>{"run",     "cube-plane", "--backend",
                                    backend,   "--set",      "simulation.timestep=0.01",
                                    "--steps", "100000",     "--json"};
  };
  const auto gpu = aspic(words("gpu")), reference = aspic(words("reference"));
  EXPECT_EQ(gpu.exit_code, 5) << gpu.err;
  EXPECT_EQ(json_member(gpu.out, "steps"), json_member(reference.out, "steps"));
  EXPECT_EQ(json_member(gpu.out, "state_hash"), json_member(reference.out, "state_hash"));
}

}  // namespace
}  // namespace aspic
