// The reference in single precision has the bits that tests/data/hashes.json tells of.
#include "support/golden_runs.h"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cpu_reference/reference_solver.h"
#include "model/bodies.h"
#include "support/model_building.h"

namespace aspic::test {
namespace {

TEST(GoldenRuns, ReferenceHasThoseOfTheCases) {
  for (const GoldenRun& run : case_runs()) {
    const State state = reference_state(run);
    expect_golden(run, state);
    EXPECT_EQ(state.step, run.steps) << run.scene << ", " << name_of(run.method) << " diverges";
  }
}

class GoldenScenes : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(GoldenRuns, GoldenScenes, testing::ValuesIn(all_integrators),
                         [](const auto& instance) {
                           std::string name(name_of(instance.param));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(GoldenScenes, ReferenceHasThem) {
  for (const GoldenRun& run : scene_runs()) {
    if (run.method == GetParam()) expect_golden(run, reference_state(run));
  }
}

TEST(GoldenRuns, ReferenceHasThoseOfEveryScene) {
  for (const GoldenRun& run : core_scene_runs()) expect_golden(run, reference_state(run));
}

TEST(GoldenRuns, AreAllThatTheFileHas) {
  EXPECT_EQ(golden_count(), scene_runs().size() + case_runs().size());
}

TEST(GoldenRuns, AreToldFromOthersByEveryBit) {
  const GoldenRun run = golden_run(covering_cases()[0]);
  State state = reference_state(run);
  expect_golden(run, state);
  float last = static_cast<float>(state.velocity.back().z);
  state.velocity.back().z = std::nextafter(last, 1e9f);
  EXPECT_NONFATAL_FAILURE(expect_golden(run, state), "first at particle");
  GoldenRun other = run;
  --other.steps;
  EXPECT_NONFATAL_FAILURE(expect_golden(other, state), "scripts/hashes.sh");
}

// What falls freely has the same bits whatever the terrain.
TEST(CoveringCases, ReachTheirTerrain) {
  for (const EqualityCase& row : covering_cases()) {
    SCOPED_TRACE(text_of(row));
    Model model = model_of(row);
    model.terrain.clear();
    auto solver = std::move(make_reference_solver(model, Precision::single)).value();
    ASSERT_FALSE((*solver->advance(steps_of(row))).divergence.has_value());
    EXPECT_NE(state_hash_text(*solver->state()), golden_end(golden_run(row))->hash);
  }
}

TEST(CoveringCases, HaveEveryKindOfBody) {
  for (const BodyRow& body : body_rows()) {
    EXPECT_TRUE(std::ranges::any_of(covering_cases(), [&](const EqualityCase& row) {
      return body.list.size(settings_of(row)) > 0;
    })) << body.list.key;
  }
}

// Every method meets every kind of bodies: 8 × 7 at least. The cases of earlier kinds stay, so a few more.
TEST(CoveringCases, AreFew) {
  EXPECT_LE(covering_cases().size(), 80u);
}

}  // namespace
}  // namespace aspic::test
