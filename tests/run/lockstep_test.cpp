// A comparison of two solvers finds out if they are one.
#include "run/lockstep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

using testing::HasSubstr;

/// A solver whose one particle rests for `still` steps, and that works on a state which others may have as
/// well, as two gpu solvers did whose buffers had the same names.
class Stepper final : public Solver {
 public:
  Stepper(const Model& model, State& state, std::uint64_t still)
      : model_(model), state_(state), still_(still) {}
  std::string_view backend() const override { return "stepper"; }
  std::string description() const override { return "stepper"; }
  Precision precision() const override { return Precision::double_; }
  const Model& model() const override { return model_; }
  std::uint64_t bytes() const override { return 0; }
  Result<Advance> advance(std::uint64_t steps) override {
    state_.step += steps;
    if (state_.step > still_) state_.position[0].x += static_cast<double>(steps);
    return Advance{steps};
  }

 private:
  Status take_state(const ConstStateView& view, std::uint64_t step) override {
    const StateView own = view_of(state_);
    for (std::size_t n = 0; n < own.size(); ++n) copy_vectors(view[n], own[n]);
    state_.step = step;
    return {};
  }
  Result<std::uint64_t> give_state(const StateView& view) override {
    const ConstStateView own = view_of(std::as_const(state_));
    for (std::size_t n = 0; n < own.size(); ++n) copy_vectors(own[n], view[n]);
    return state_.step;
  }
  Status take_inputs(const Inputs&) override { return {}; }
  Status take_constants(SharedModel, std::uint64_t) override { return {}; }
  const Model& model_;
  State& state_;
  std::uint64_t still_;
};

bool always(std::uint64_t) {
  return true;
}

// At rest a step says nothing: the look goes on until something moves.
TEST(Lockstep, TwoSolversOfOneStateAreFoundOut) {
  const Model model = test::particles({{0.0, 0.0, 0.0}}, {{0.0, 0.0, 0.0}});
  for (const std::uint64_t still : {0u, 7u}) {
    State state = initial_state(model, Precision::double_);
    Stepper first(model, state, still), second(model, state, still);
    const auto compared = compare_in_lockstep(first, second, 20, always);
    ASSERT_FALSE(compared.ok());
    EXPECT_EQ(compared.error().code, ErrorCode::check_failed);
    EXPECT_THAT(compared.error().message(), HasSubstr("they share a state"));
    EXPECT_FALSE(compare_in_lockstep(first, first, 20, always).ok());
    State other = initial_state(model, Precision::double_);
    Stepper apart(model, other, still);
    state = other;
    EXPECT_TRUE(compare_in_lockstep(first, apart, 20, always).ok());
  }
}

TEST(Lockstep, TwoSolversOfTheirOwnAreCompared) {
  const Model model = test::build(test::cube_on_plane(3));
  const auto first = test::solver_for(model, Precision::single),
             second = test::solver_for(model, Precision::single),
             other = test::solver_for(model, Precision::double_);
  const auto same = compare_in_lockstep(*first, *second, 10, always);
  ASSERT_TRUE(same.ok()) << same.error().message();
  EXPECT_EQ(same->steps, 10u);
  EXPECT_FALSE(same->first_difference);
  EXPECT_EQ(same->hash[0], same->hash[1]);
  ASSERT_TRUE(first->load(initial_state(model, Precision::single)).ok());
  const auto differ = compare_in_lockstep(*first, *other, 10, always);
  ASSERT_TRUE(differ.ok());
  EXPECT_TRUE(differ->first_difference.has_value());
  EXPECT_GT(differ->largest_absolute(), 0.0);
}

TEST(Lockstep, EndsWhereItIsTold) {
  const Model model = test::build(test::cube_on_plane(3));
  const auto first = test::solver_for(model), second = test::solver_for(model);
  const auto compared = compare_in_lockstep(*first, *second, 10, [](std::uint64_t done) { return done < 4; });
  ASSERT_TRUE(compared.ok());
  EXPECT_EQ(compared->steps, 4u);
  EXPECT_TRUE(compared->interrupted);
}

}  // namespace
}  // namespace aspic
