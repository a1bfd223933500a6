// A run in motion without a window, with a backend on another thread and with one in the context.
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "aspic/scene.h"
#include "cpu_reference/reference_solver.h"
#include "playback/playback_session.h"
#include "playback/recorded_inputs.h"
#include "support/gl_fixture.h"

namespace aspic::test {
namespace {

class InMotion : public aspic::testing::GlTest, public ::testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    scene = load_scene("cube-plane", std::vector<std::string>{"cube[0].particles-per-edge=4"}).value();
    auto made = PlaybackSession::create(context(), scene, *find_backend(GetParam()));
    ASSERT_TRUE(made.ok()) << made.error().message();
    run = std::move(*made);
  }
  void TearDown() override {
    run.reset();
    GlTest::TearDown();
  }
  void go_to(const Moment& moment) {
    ASSERT_TRUE(run->playback().seek(moment).ok());
    ASSERT_TRUE(run->settle().ok());
  }
  /// Single steps up to this one; the hashes of all states on the way.
  void step_to(std::uint64_t step) {
    while (run->step() < step) {
      ASSERT_TRUE(run->single_step().ok());
      ASSERT_TRUE(run->settle().ok());
      ASSERT_TRUE(run->refresh_snapshot().ok());
      hashes[run->step()] = state_hash_text(run->snapshot());
    }
  }

  /// Images until a condition holds, for which another thread works; a failure after 20 s.
  template <class Condition>
  void update_until(Condition condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition()) {
      ASSERT_LT(std::chrono::steady_clock::now(), end);
      ASSERT_TRUE(run->update(0.016, 0.01).ok());
      std::this_thread::yield();
    }
  }

  Scene scene;
  std::unique_ptr<PlaybackSession> run;
  std::map<std::uint64_t, std::string> hashes;
};

TEST_P(InMotion, EveryStepOfThePastHasTheSameBits) {
  step_to(10);
  run->set_hand(Pull{5, {1.0, 3.0, 0.0}, 400.0, 2.0});
  step_to(25);
  run->set_hand(std::nullopt);
  step_to(40);
  for (const std::uint64_t step : {31u, 12u, 0u, 10u, 40u}) {
    go_to({0, step});
    EXPECT_EQ(run->step(), step);
    if (step == 0) continue;
    EXPECT_EQ(state_hash_text(run->snapshot()), hashes[step]) << "step " << step;
  }
  EXPECT_TRUE(run->playback().at_end());
  EXPECT_TRUE(run->playback().can_step_back());
}

class DoubleInMotion : public aspic::testing::GlTest {};

TEST_F(DoubleInMotion, KeepsItsPrecisionBackInTime) {
  const Scene scene =
      load_scene("cube-plane", std::vector<std::string>{"cube[0].particles-per-edge=4"}).value();
  const BackendChoice choice = parse_backend("reference:double").value();
  auto made = PlaybackSession::create(context(), scene, *choice.row, choice);
  ASSERT_TRUE(made.ok()) << made.error().message();
  PlaybackSession& run = **made;
  const auto solver =
      std::move(make_reference_solver(make_model(scene.model).value(), Precision::double_)).value();
  for (int n = 0; n < 30; ++n) ASSERT_TRUE(run.single_step().ok() && run.settle().ok());
  ASSERT_TRUE(run.playback().seek({0, 20}).ok() && run.settle().ok() && run.refresh_snapshot().ok());
  ASSERT_TRUE(solver->advance(20).ok());
  EXPECT_EQ(run.snapshot(), *solver->state());
  made->reset();
}

TEST_P(InMotion, AnotherRunRepeatsItsHistory) {
  step_to(5);
  run->set_hand(Pull{5, {1.0, 3.0, 0.0}, 400.0, 2.0});
  step_to(20);
  auto other = PlaybackSession::create(context(), scene, run->present().backend());
  ASSERT_TRUE(other.ok());
  ASSERT_TRUE((*other)->playback().replay(run->playback().history()).ok());
  ASSERT_TRUE((*other)->playback().seek({0, 18}).ok());
  ASSERT_TRUE((*other)->settle().ok());
  EXPECT_EQ(state_hash_text((*other)->snapshot()), hashes[18]);
}

/// Of the run so far, by the reference with the log alone.
std::string replayed(const Scene& scene, const InputLog& log, std::uint64_t steps) {
  const SharedModel model = make_model(scene.model).value();
  const auto solver = std::move(make_reference_solver(model, Precision::single)).value();
  EXPECT_FALSE(advance(*solver, log, 0, steps)->divergence.has_value());
  return state_hash_text(solver->state().value());
}

// A log acts at its steps whether they are made singly or in batches, and with a hand besides.
TEST_P(InMotion, ReplaysALogAndRecordsItWithTheHand) {
  InputLog log;
  log.set(7, {.pulls = {{5, {1.0, 12.0, 0.0}, 400.0, 2.0}, {5, {-1.0, 12.0, 1.0}, 300.0, 0.0}}});
  log.set(20, {.pulls = {{63, {2.0, 10.0, 0.0}, 400.0, 2.0}}, .pinned = {0, 3}, .channels = {0.5}});
  log.set(33, {.pinned = {3}});
  log.set(90, {});
  run->stepper().replay(log);
  step_to(12);
  EXPECT_EQ(hashes[12], replayed(scene, log, 12));
  run->set_running(true);
  while (run->step() < 120) ASSERT_TRUE(run->update(0.02, 0.01).ok());
  run->set_running(false);
  ASSERT_TRUE(run->settle().ok() && run->refresh_snapshot().ok());
  const std::uint64_t end = run->step();
  EXPECT_EQ(state_hash_text(run->snapshot()), replayed(scene, log, end));
  EXPECT_EQ(*recorded_inputs(run->playback().history(), run->playback().here()), log);
  go_to({0, 25});
  EXPECT_EQ(state_hash_text(run->snapshot()), replayed(scene, log, 25));
  // A run from there on, with a hand and a pin of it: single steps would follow the history.
  run->set_hand(Pull{9, {0.0, 14.0, 0.0}, 200.0, 1.0});
  run->set_running(true);
  while (run->step() < 27) ASSERT_TRUE(run->update(0.001, 0.01).ok());
  run->set_running(false);
  ASSERT_TRUE(run->settle().ok() && run->refresh_snapshot().ok());
  const std::uint64_t pinned_at = run->step();
  ASSERT_TRUE(run->rebuild().toggle_pin(12).ok());
  step_to(pinned_at + 70);
  const auto recorded = recorded_inputs(run->playback().history(), run->playback().here());
  ASSERT_TRUE(recorded.ok()) << recorded.error().message();
  EXPECT_EQ(recorded->at(24).pulls.size(), 1u);
  EXPECT_EQ(recorded->at(25).pulls.size(), 2u);
  EXPECT_EQ(recorded->at(25).channels, std::vector<double>{0.5});
  EXPECT_EQ(recorded->at(pinned_at).pinned.back(), 12u);
  EXPECT_EQ(recorded->at(pinned_at + 69).pinned, std::vector<std::uint32_t>{12});
  EXPECT_EQ(recorded->at(pinned_at + 69).pulls.size(), 1u);
  EXPECT_EQ(hashes[run->step()], replayed(scene, *recorded, run->step()));
  // The start again has the log again.
  run->set_hand(std::nullopt);
  ASSERT_TRUE(run->rebuild().reset().ok());
  step_to(40);
  EXPECT_EQ(hashes[40], replayed(scene, log, 40));
}

// A run that continues another one's has what its log says of later steps, until it starts again.
TEST_P(InMotion, AContinuedRunHasItsLogUntilItStartsAgain) {
  InputLog log;
  log.set(3, {.pulls = {{5, {1.0, 12.0, 0.0}, 400.0, 2.0}}, .pinned = {0, 3}});
  log.set(20, {.pulls = {{63, {2.0, 10.0, 0.0}, 400.0, 2.0}}, .pinned = {3}, .released = {}});
  log.set(30, {});
  const SharedModel model = make_model(scene.model).value();
  const auto solver = std::move(make_reference_solver(model, Precision::single)).value();
  ASSERT_TRUE(advance(*solver, log, 0, 12).ok());
  ASSERT_TRUE(run->rebuild().start_from(solver->state().value(), log).ok());
  step_to(40);
  for (const std::uint64_t step : {13u, 25u, 40u})
    EXPECT_EQ(hashes[step], replayed(scene, log, step)) << step;
  // What a checkpoint there would hold leads to the same end.
  go_to({run->playback().here().stretch, 15});
  const auto rest = inputs_to_go_on(run->playback().history(), run->playback().here(), run->stepper().log());
  ASSERT_TRUE(rest.ok());
  for (const std::uint64_t step : {15u, 19u, 20u, 29u, 30u, 50u})
    EXPECT_EQ(rest->at(step), log.at(step)) << step;
  ASSERT_TRUE(run->rebuild().reset().ok());
  step_to(25);
  EXPECT_EQ(hashes[25], replayed(scene, {}, 25));
}

// Hands free what a log has pinned, and pin what it releases.
TEST_P(InMotion, AHandGoesBeforeALog) {
  InputLog log;
  log.set(0, {.pinned = {0, 3}});
  run->stepper().replay(log);
  step_to(5);
  ASSERT_TRUE(run->rebuild().toggle_pin(3).ok());
  step_to(25);
  InputLog freed = log;
  freed.set(5, {.pinned = {0}});
  EXPECT_EQ(hashes[25], replayed(scene, freed, 25));
  const auto recorded = recorded_inputs(run->playback().history(), run->playback().here());
  ASSERT_TRUE(recorded.ok());
  EXPECT_EQ(*recorded, freed);
  ASSERT_TRUE(run->rebuild().toggle_pin(3).ok());
  step_to(40);
  freed.set(25, {.pinned = {0, 3}});
  EXPECT_EQ(hashes[40], replayed(scene, freed, 40));
}

// What no longer fits is left out, and the run goes on.
TEST_P(InMotion, ALogThatDoesNotFitAChangedSceneStopsNothing) {
  InputLog log;
  log.set(0, {.pulls = {{63, {1.0, 12.0, 0.0}, 400.0, 2.0}}, .pinned = {1, 60}});
  run->stepper().replay(log);
  step_to(3);
  scene.model.cubes[0].particles_per_edge = 3;
  ASSERT_TRUE(run->rebuild().change(scene, false).ok());
  hashes.clear();
  step_to(5);
  InputLog rest;
  rest.set(0, {.pinned = {1}});
  EXPECT_EQ(hashes[5], replayed(scene, rest, 5));
}

TEST_P(InMotion, AChangeThatHasNotBegunIsDroppedByAWayBack) {
  step_to(10);
  Scene other = scene;
  other.model.cubes[0].structural.stiffness *= 2.0;
  run->rebuild().request(other, true);
  EXPECT_TRUE(run->rebuild().changing());
  go_to({0, 4});
  EXPECT_FALSE(run->rebuild().changing());
  ASSERT_TRUE(run->update(0.016, 0.01).ok());
  EXPECT_FALSE(run->rebuild().take_change().has_value());
  run->rebuild().request(other, true);
  // It begins once the figures of the state are measured.
  update_until([&] { return !run->rebuild().changing(); });
  const auto changed = run->rebuild().take_change();
  ASSERT_TRUE(changed.has_value());
  EXPECT_TRUE(changed->ok());
  EXPECT_EQ(run->playback().here(), (Moment{1, 4})) << "another stretch begins where it was";
  EXPECT_EQ(run->model().spring_classes.front().stiffness, other.model.cubes[0].structural.stiffness);
}

TEST_P(InMotion, FiguresOfAPausedRunAreOfItsState) {
  step_to(7);
  update_until([&] { return run->samples().nearest(run->time())->step == 7; });
  EXPECT_EQ(run->samples().nearest(run->time())->step, 7u);
}

TEST_P(InMotion, BuildsALargeModelOnAnotherThread) {
  Scene large = scene;
  large.model.cubes[0].particles_per_edge = 28;
  const auto change_to = [&](bool keep_state) {
    const std::uint64_t before = run->present().model_number();
    update_until([&] { return !run->busy(); });
    run->rebuild().request(large, keep_state);
    ASSERT_TRUE(run->update(0.016, 0.01).ok());
    EXPECT_TRUE(run->rebuild().building()) << "a later update takes the model up";
    EXPECT_EQ(run->present().model_number(), before);
  };
  const auto finish = [&] {
    update_until([&] { return !run->rebuild().changing(); });
    const auto changed = run->rebuild().take_change();
    ASSERT_TRUE(changed.has_value());
    EXPECT_TRUE(changed->ok());
  };
  change_to(false);
  finish();
  EXPECT_EQ(run->model().particle_count(), 28u * 28u * 28u);
  large.model.contact.friction = 0.7;
  change_to(true);
  finish();
  EXPECT_EQ(run->model().contact.friction, 0.7);
  EXPECT_EQ(run->playback().here(), (Moment{1, 0})) << "the motion continues";
  // The context goes while a model is built.
  large.model.contact.friction = 0.6;
  change_to(true);
  ASSERT_TRUE(run->rebuild().leave_context({ErrorCode::no_device, "gone"}).ok());
  finish();
  EXPECT_EQ(run->model().contact.friction, 0.6);
  EXPECT_FALSE(run->present().engines().use_context());
}

INSTANTIATE_TEST_SUITE_P(Backends, InMotion, ::testing::Values("reference", "gpu"));

}  // namespace
}  // namespace aspic::test
