#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "cli/process.h"
#include "support/temporary_directory.h"

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

// Two solvers on one device have each its own result, in either order. Their paths are exact and end alike;
// fast has other bits from the first step in which a spring is stretched.
TEST(CompareGl, TwoSolversOnTheGpuHaveEachItsOwnBits) {
  const auto hashes = [](const std::string& backends, int exit_code) {
    const auto run =
        aspic({"compare", "cube-plane", "--backends", backends, "--steps", "40", "--json", "--set",
               "cube[0].position=[0.0, 1.05, 0.0]", "--set", "cube[0].particles-per-edge=5"});
    EXPECT_EQ(run.exit_code, exit_code) << backends << "\n" << run.out << run.err;
    const std::size_t second = run.out.rfind("\"state_hash\"");
    return second == std::string::npos ? std::pair<std::string, std::string>()
                                       : std::pair(json_member(run.out, "state_hash"),
                                                   json_member(run.out.substr(second), "state_hash"));
  };
  const auto [fast, exact] = hashes("gpu:fast,reference", 1);
  EXPECT_NE(fast, exact);
  EXPECT_EQ(hashes("gpu:fast,gpu", 1), std::pair(fast, exact));
  EXPECT_EQ(hashes("gpu,gpu:fast", 1), std::pair(exact, fast));
  for (const char* pair :
       {"gpu,gpu", "gpu:gather,gpu:per-spring", "gpu:per-spring,gpu:lattice", "gpu:lattice,gpu:gather"})
    EXPECT_EQ(hashes(pair, 0), std::pair(exact, exact)) << pair;
}

TEST(CompareGl, RunOnTheGpuEndsWithTheReferencesHash) {
  const auto gpu = aspic({"run", "cube-plane", "--backend", "gpu", "--steps", "60", "--json"});
  ASSERT_EQ(gpu.exit_code, 0) << gpu.err;
  EXPECT_EQ(json_member(gpu.out, "backend"), "gpu");
  EXPECT_EQ(json_member(gpu.out, "force_path"), "lattice");
  const auto reference = aspic({"run", "cube-plane", "--backend", "reference", "--steps", "60", "--json"});
  EXPECT_EQ(json_member(gpu.out, "state_hash"), json_member(reference.out, "state_hash"));
}

TEST(CompareGl, PenaltyIsIdenticalOverThreeThousandSteps) {
  const auto run = aspic({"compare", "penalty", "--steps", "3000", "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err << run.out;
  EXPECT_EQ(json_member(run.out, "identical"), "true");
  EXPECT_EQ(json_member(run.out, "steps"), "3000");
}

// A shader edited without rebuilding: its mistakes are told in its own file and line.
TEST(CompareGl, ShaderDirectoryGoesBeforeTheEmbeddedShaders) {
  const test::TemporaryDirectory dir;
  std::filesystem::create_directory(dir.file("compute"));
  dir.write("compute/lattice.comp",
            "#include \"compute/layout.glsl\"\n\nvoid main() { no_such_function(); }\n");
  const std::vector<std::string> run = {"run", "cube-plane", "--backend", "gpu", "--steps", "1"};
  ASSERT_EQ(setenv("ASPIC_SHADER_DIR", dir.file("").c_str(), 1), 0);
  const auto broken = aspic(run);
  ASSERT_EQ(setenv("ASPIC_SHADER_DIR", dir.file("none").c_str(), 1), 0);
  const auto missing = aspic(run);
  ASSERT_EQ(unsetenv("ASPIC_SHADER_DIR"), 0);
  EXPECT_EQ(broken.exit_code, 4) << broken.err;
  EXPECT_NE(broken.err.find("compute/lattice.comp:3: error"), std::string::npos) << broken.err;
  EXPECT_EQ(missing.exit_code, 6) << missing.err;
  EXPECT_EQ(aspic(run).exit_code, 0);
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

// Masses and stiffnesses that the ranges allow and single precision does not bear: neither backend calls that
// a success, both end at the same step, and no figure of theirs is anything but a number.
TEST(CompareGl, SolvesThatOverflowDivergeAlike) {
  const std::vector<std::vector<std::string>> cases = {
      {"cube[0].particle-mass=1.9e-38", "cube[0].structural.stiffness=1e12", "cube[0].rotation.axis=[1,2,3]",
       "cube[0].rotation.angle=20"},
      {"cube[0].particle-mass=1.9e-38", "contact.friction=96052", "simulation.timestep=0.05"}};
  for (const auto& sets : cases) {
    std::vector<std::string> outcomes;
    for (const char* backend : {"reference", "gpu"}) {
      const test::TemporaryDirectory dir;
      std::vector<std::string> words = {"run",
                                        "cube-and-balls",
                                        "--backend",
                                        backend,
                                        "--steps",
                                        "40",
                                        "--json",
                                        "--series",
                                        dir.file("e.csv"),
                                        "--state",
                                        dir.file("s.csv"),
                                        "--set",
                                        "simulation.integrator=implicit-euler",
                                        "--set",
                                        "cube[0].particles-per-edge=5"};
      for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
      const auto run = aspic(words);
      EXPECT_EQ(run.exit_code, 5) << run.err;
      // Which of the two it becomes is the solve's affair; what leaves must be numbers, the same on each
      // backend.
      EXPECT_THAT(run.err, testing::AnyOf(testing::HasSubstr("is no longer a finite number"),
                                          testing::HasSubstr("became faster than 1000 m/s")));
      for (const std::string& text : {run.out, dir.read("e.csv"), dir.read("s.csv")}) {
        EXPECT_EQ(text.find("nan"), std::string::npos) << text;
        EXPECT_EQ(text.find("inf,"), std::string::npos) << text;
      }
      EXPECT_NE(json_member(run.out, "worst_residual"), "null");
      outcomes.push_back(run.err + json_member(run.out, "state_hash") + json_member(run.out, "step") +
                         json_member(run.out, "worst_residual"));
    }
    EXPECT_EQ(outcomes[0], outcomes[1]);
  }
}

}  // namespace
}  // namespace aspic
