#include "live/live_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cpu_reference/reference_solver.h"
#include "model/model.h"

namespace aspic::live {
namespace {

const std::vector<std::string> small = {"cube[0].particles-per-edge=4", "cube[0].position=[0, 1.5, 0]"};

Scene scene_of(std::vector<std::string> overrides = {}, const std::string& name = "cube-plane") {
  if (name == "cube-plane") overrides.insert(overrides.begin(), small.begin(), small.end());
  return load_scene(name, overrides).value();
}

LiveRun run_of(const Scene& scene) {
  auto run = LiveRun::create(to_toml(scene));
  EXPECT_TRUE(run.ok()) << run.error().message();
  return std::move(*run);
}

std::unique_ptr<Solver> solver_of(const Scene& scene) {
  return make_reference_solver(build_model(scene.model).value(), Precision::single).value();
}

std::string hash_of(LiveRun& run) {
  EXPECT_TRUE(run.take().ok());
  return run.hash();
}

TEST(LiveRun, HasTheBitsOfTheReference) {
  for (const std::string name : {"cube-plane", "penalty"}) {
    const Scene scene = scene_of({}, name);
    LiveRun run = run_of(scene);
    const auto solver = solver_of(scene);
    ASSERT_TRUE(run.advance(150).ok() && solver->advance(150).ok());
    const State state = solver->state().value();
    EXPECT_EQ(hash_of(run), state_hash_text(state));
    EXPECT_EQ(run.step(), 150u);
    EXPECT_EQ(run.measures().kinetic, measure(solver->model(), state).kinetic);
    // Particles first, then balls.
    ASSERT_EQ(run.numbers().size(), 6 * state.position.size() + 9 * state.ball_position.size());
    EXPECT_EQ(run.numbers()[4], static_cast<float>(state.position[1].y));
    if (!state.ball_position.empty()) {
      EXPECT_EQ(run.numbers()[6 * state.position.size()], static_cast<float>(state.ball_position[0].x));
    }
  }
}

TEST(LiveRun, KnowsHowFarRestLengthsAreChanged) {
  LiveRun run = run_of(scene_of({}, "worm"));
  ASSERT_TRUE(run.advance(200).ok() && run.take().ok());
  const auto& classes = run.model().actuation.classes;
  const std::vector<double> lengths = rest_lengths(run.model(), 200, 0.0, {});
  ASSERT_EQ(run.changes().size(), classes.size());
  for (std::size_t n = 0; n < classes.size(); ++n) {
    const std::uint32_t c = classes[n].spring_class;
    EXPECT_NEAR(run.changes()[n], lengths[c] / run.model().spring_classes[c].rest_length - 1.0, 1e-7);
  }
  EXPECT_GT(std::ranges::max(run.changes()), 0.01f);
  EXPECT_LT(std::ranges::min(run.changes()), -0.01f);
  // Since the start their work, of which going back leaves none.
  EXPECT_EQ(run.work(), 0.0);
  ASSERT_TRUE(run.advance(100).ok() && run.take().ok());
  const std::optional<double> work = run.work();
  ASSERT_TRUE(work && *work != 0.0);
  ASSERT_TRUE(run.load(300).ok() && run.take().ok());
  EXPECT_EQ(run.work(), 0.0);
  // As a reader changes them, which works on the springs, too.
  ASSERT_TRUE(run.change("actuator[0].amplitude=0.0\n").ok() && run.take().ok());
  EXPECT_THAT(run.changes(), testing::Each(0.0f));
  EXPECT_NE(run.work(), 0.0);
  // Of a run without actuators there are none.
  LiveRun plain = run_of(scene_of());
  EXPECT_TRUE(plain.take().ok() && plain.changes().empty() && !plain.work());
}

TEST(LiveRun, GoesOnWithOtherValuesFromWhereItIs) {
  const Scene scene = scene_of(), stiff = scene_of({"cube[0].structural.stiffness=4000"});
  LiveRun run = run_of(scene);
  const auto before = solver_of(scene), after = solver_of(stiff);
  ASSERT_TRUE(run.advance(90).ok() && before->advance(90).ok());
  ASSERT_TRUE(run.change("cube[0].structural.stiffness=4000.0\n").ok());
  ASSERT_TRUE(after->load(before->state().value()).ok());
  ASSERT_TRUE(run.advance(60).ok() && after->advance(60).ok());
  EXPECT_EQ(hash_of(run), state_hash_text(after->state().value()));
}

TEST(LiveRun, FollowsInputs) {
  const Scene scene = scene_of({"actuator[0].signal=input", "actuator[0].name=legs"}, "worm");
  LiveRun run = run_of(scene);
  const auto solver = solver_of(scene);
  Inputs half;
  half.channels = {0.5};
  ASSERT_TRUE(run.advance(50).ok() && solver->advance(50).ok());
  ASSERT_TRUE(run.change("", {0.5}).ok() && solver->set_inputs(half).ok());
  ASSERT_TRUE(run.advance(50).ok() && solver->advance(50).ok());
  const State state = solver->state().value();
  EXPECT_EQ(hash_of(run), state_hash_text(state));
  EXPECT_EQ(run.measures().elastic, measure(solver->model(), state, half).elastic);
  EXPECT_GT(std::ranges::max(run.changes()), 0.01f);
  // An actuator that comes to follow another signal reads no channel; back again it does.
  ASSERT_TRUE(run.change("actuator[0].signal=\"sine\"\n", {0.5}).ok());
  ASSERT_TRUE(run.change("actuator[0].signal=\"input\"\n", {-0.5}).ok() && run.take().ok());
  EXPECT_LT(std::ranges::min(run.changes()), -0.01f);
  EXPECT_FALSE(run.change("", {0.5, 0.5}).ok());
}

TEST(LiveRun, RefusesWhatNoRunCanHaveAndGoesOnAsItWas) {
  const Scene scene = scene_of();
  LiveRun run = run_of(scene);
  const auto solver = solver_of(scene);
  EXPECT_FALSE(run.change("simulation.timestep=-1\n").ok());
  EXPECT_FALSE(run.change("nonsense\n").ok());
  EXPECT_FALSE(run.change("cube[0].particles-per-edge=3\n").ok());
  ASSERT_TRUE(run.advance(20).ok() && solver->advance(20).ok());
  EXPECT_EQ(hash_of(run), state_hash_text(solver->state().value()));
  EXPECT_FALSE(LiveRun::create("simulation.timestep=0.1\n").ok());
}

TEST(LiveRun, GoesBackToAStateThatItHad) {
  LiveRun run = run_of(scene_of());
  ASSERT_TRUE(run.advance(30).ok() && run.take().ok());
  const std::vector<float> numbers(run.numbers().begin(), run.numbers().end());
  ASSERT_TRUE(run.advance(40).ok());
  const std::string later = hash_of(run);
  std::ranges::copy(numbers, run.numbers().begin());
  ASSERT_TRUE(run.load(30).ok() && run.advance(40).ok());
  EXPECT_EQ(hash_of(run), later);
  EXPECT_EQ(run.step(), 70u);
}

TEST(LiveRun, SaysWhereItDivergesAndRecovers) {
  LiveRun run = run_of(scene_of({"cube[0].structural.stiffness=1e7"}));
  const auto advanced = run.advance(1000);
  ASSERT_TRUE(advanced.ok() && advanced->divergence);
  const std::string last = hash_of(run);
  EXPECT_EQ(run.step() + 1, advanced->divergence->step);
  ASSERT_TRUE(run.change("cube[0].structural.stiffness=10.0\nsimulation.timestep=0.0001\n").ok());
  EXPECT_EQ(hash_of(run), last);
  EXPECT_FALSE(run.advance(1).value().divergence.has_value());
}

}  // namespace
}  // namespace aspic::live
