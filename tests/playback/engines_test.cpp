#include "playback/engines.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "aspic/scene.h"
#include "playback/endless.h"

namespace aspic::test {
namespace {

/// Rows of two backends that both compute as the reference does; one says that it needs the context.
const BackendRow outside = [] {
  BackendRow row;
  row.name = "outside";
  return row;
}();
const BackendRow in_context = [] {
  BackendRow row;
  row.name = "in context";
  row.needs_context = true;
  return row;
}();

Engines engines_of(const BackendRow& leader, const BackendRow* shadow) {
  const std::vector<std::string> small = {"cube[0].particles-per-edge=3"};
  auto built = build_model(load_scene("cube-plane", small)->model);
  EXPECT_TRUE(built.ok());
  const SharedModel model = shared(std::move(*built));
  const auto engine = [&](const BackendRow& row) {
    Backend made;
    made.row = &row;
    made.solver = std::move(*make_reference_solver(model, Precision::single));
    return made;
  };
  Backend first = engine(leader), second;
  if (shadow) second = engine(*shadow);
  return {model, std::move(first), std::move(second)};
}

std::string hash_after(std::uint64_t steps) {
  const Engines engines = engines_of(outside, nullptr);
  EXPECT_TRUE(engines.leader().solver->advance(steps).ok());
  return state_hash_text(*engines.leader().solver->state());
}

TEST(Engines, AJobAndTheContextAdvanceAnyTwoByTheSameSteps) {
  const std::string expected = hash_after(7);
  for (const auto& [leader, shadow] :
       {std::pair{&outside, &outside}, std::pair{&outside, &in_context}, std::pair{&in_context, &outside}}) {
    Engines engines = engines_of(*leader, shadow);
    EXPECT_FALSE(engines.only_context());
    auto advanced = engines.advance_outside({0, 7, 1e9}, false);
    ASSERT_TRUE(advanced.ok()) << advanced.error().message();
    JobResult& outcome = *advanced;
    ASSERT_TRUE(engines.follow(outcome).ok());
    EXPECT_EQ(outcome.steps, 7u);
    EXPECT_EQ(state_hash_text(outcome.leader.state), expected) << leader->name << ", " << shadow->name;
    EXPECT_EQ(state_hash_text(outcome.shadow.state), expected) << leader->name << ", " << shadow->name;
  }
}

TEST(Engines, TheShadowOfALeaderInTheContextMayBeThereToo) {
  Engines engines = engines_of(in_context, &in_context);
  EXPECT_TRUE(engines.only_context());
  JobResult outcome;
  outcome.steps = 7;
  ASSERT_TRUE(engines.follow(outcome).ok());
  EXPECT_EQ(state_hash_text(outcome.shadow.state), hash_after(7));
}

TEST(Engines, AloneTheLeaderLeavesItsShadowBehind) {
  Engines engines = engines_of(outside, &outside);
  EXPECT_EQ(engines.advance_outside({0, 7, 1e9, true}, false)->steps, 7u);
  EXPECT_EQ(engines.leader().solver->state()->step, 7u);
  EXPECT_EQ(engines.shadow().solver->state()->step, 0u);
}

TEST(Engines, CancelingOrASpentBudgetEndsAJobEarly) {
  Engines engines = engines_of(outside, nullptr);
  EXPECT_EQ(engines.advance_outside({0, 1000, 1e9}, true)->steps, 0u);
  EXPECT_EQ(engines.advance_outside({0, 1000, 0.0}, false)->steps, 0u);
}

/// Its steps never end but by being canceled, which comes when the first has begun.
class Canceling final : public Endless {
 public:
  Canceling(std::unique_ptr<Solver> inner, std::atomic<bool>& canceled)
      : Endless(std::move(inner)), canceled_(canceled) {}
  Result<Advance> advance(std::uint64_t steps) override {
    canceled_ = true;
    return Endless::advance(steps);
  }

 private:
  std::atomic<bool>& canceled_;
};

TEST(Engines, CancelingDropsTheStepInProgressOfBoth) {
  Engines engines = engines_of(outside, nullptr);
  std::atomic<bool> canceled = false;
  const BackendRow also_outside = outside;
  Backend endless;
  endless.row = &also_outside;
  endless.solver = std::make_unique<Canceling>(
      std::move(*make_reference_solver(engines.model(), Precision::single)), canceled);
  engines.set_shadow(std::move(endless));
  const std::string start = hash_after(0);
  const auto outcome = engines.advance_outside({0, 3, 1e9}, canceled);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message();
  EXPECT_EQ(outcome->steps, 0u) << "the leader takes its steps back: the shadow has none";
  EXPECT_EQ(state_hash_text(outcome->leader.state), start);
  EXPECT_EQ(state_hash_text(*engines.leader().solver->state()), start);
  EXPECT_EQ(state_hash_text(*engines.shadow().solver->state()), start);
}

}  // namespace
}  // namespace aspic::test
