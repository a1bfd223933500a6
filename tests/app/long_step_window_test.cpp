// The real window while a step takes as long as one likes: nothing that the user does waits for its end.

#include "app/stage.h"
#include "playback/endless.h"

namespace aspic::test {
namespace {

class LongStep : public Stage {
 protected:
  /// A run on the endless backend, from step 5 on.
  void run_endlessly() {
    open("cube-plane", {"cube[0].position=[0,1.2,0]"}, "cpu");
    for (int i = 0; i < 5; ++i) type(U'.');
    ASSERT_TRUE(simulation().rebuild().set_backend(endless_backend()).ok());
    press(GLFW_KEY_SPACE);
    frames(5);
    ASSERT_TRUE(simulation().running());
    ASSERT_TRUE(simulation().busy());
    ASSERT_EQ(simulation().step(), 5u);
  }
  std::string hash() { return state_hash_text(simulation().snapshot()); }
  /// Goes on where the endless backend stood, and has the bits of a run without it.
  void goes_on() {
    ASSERT_TRUE(simulation().rebuild().set_backend(reference_backend()).ok());
    simulation().set_running(true);
    frames_to_step(simulation().step() + 10);
    simulation().set_running(false);
    ASSERT_TRUE(simulation().settle().ok());
    EXPECT_EQ(hash(), reference_hash(app().scene.scene(), simulation().step()));
  }
};

TEST_F(LongStep, PauseAndOtherBackendsComeAtOnce) {
  run_endlessly();
  press(GLFW_KEY_SPACE);
  EXPECT_FALSE(simulation().running());
  frames_until([&] { return !simulation().busy(); });
  EXPECT_EQ(simulation().step(), 5u) << "the step in progress is dropped";
  press(GLFW_KEY_SPACE);
  frames(2);
  goes_on();
}

TEST_F(LongStep, TheWindowSaysThatItWorks) {
  run_endlessly();
  frames_until([&] { return simulation().jobs().long_under_way(); });
  EXPECT_GT(app().wait(0.0), 0.0) << "with nothing new to show images wait";
  press(GLFW_KEY_R);
  EXPECT_FALSE(simulation().jobs().long_under_way());
  EXPECT_EQ(simulation().step(), 0u);
  EXPECT_EQ(hash(), reference_hash(app().scene.scene(), 0));
}

TEST_F(LongStep, PinsBallsPullsAndTimeTravelActAtTheStepShown) {
  run_endlessly();
  simulation().set_hand(Pull{5, {0.0, 5.0, 0.0}, 2000.0, 10.0});
  frames(2);
  simulation().set_hand(std::nullopt);
  ASSERT_TRUE(simulation().rebuild().toggle_pin(3).ok());
  EXPECT_EQ(simulation().model().inverse_mass[3], 0.0);
  frames(2);
  app().gui().commands().run("throw a ball");
  EXPECT_EQ(simulation().model().ball_count(), 1u);
  EXPECT_EQ(simulation().model().balls[0].launch_step, 5u);
  frames(2);
  EXPECT_EQ(simulation().step(), 5u);
  ASSERT_TRUE(simulation().rebuild().set_backend(*find_backend("cpu")).ok());
  ASSERT_TRUE(
      simulation().playback().seek({simulation().playback().history().begin_moment().stretch, 2}).ok());
  ASSERT_TRUE(simulation().settle().ok());
  EXPECT_EQ(simulation().model().ball_count(), 0u);
  EXPECT_EQ(hash(), reference_hash(app().scene.scene(), 2));
}

TEST_F(LongStep, AWayThroughHistoryGoesOnOnAnotherBackend) {
  run_endlessly();
  ASSERT_TRUE(simulation().playback().seek({simulation().playback().here().stretch, 3}).ok());
  frames(5);
  EXPECT_TRUE(simulation().playback().seeking());
  ASSERT_TRUE(simulation().rebuild().set_backend(*find_backend("cpu")).ok());
  frames_until([&] { return !simulation().playback().seeking(); });
  EXPECT_EQ(simulation().step(), 3u);
  EXPECT_EQ(hash(), reference_hash(app().scene.scene(), 3));
}

TEST_F(LongStep, ReloadAndOtherScenesComeAtOnce) {
  run_endlessly();
  press(GLFW_KEY_F5);
  EXPECT_EQ(simulation().step(), 0u);
  frames(3);
  EXPECT_TRUE(simulation().running());
  app().scene.open("cube-bowl");
  EXPECT_EQ(simulation().model().terrain[0].shape, TerrainShape::bowl);
  frames(3);
}

TEST_F(LongStep, AShadowThatTakesLongHoldsNothingUp) {
  run_endlessly();
  ASSERT_TRUE(simulation().rebuild().set_backend(*find_backend("cpu")).ok());
  ASSERT_TRUE(simulation().rebuild().set_shadow(&endless_backend()).ok());
  frames(5);
  EXPECT_EQ(simulation().step(), 5u) << "the leader waits for its shadow";
  ASSERT_TRUE(simulation().rebuild().set_shadow(&reference_backend()).ok());
  frames_to_step(12);
  EXPECT_FALSE(simulation().samples().ever_differed());
  ASSERT_TRUE(simulation().rebuild().set_shadow(nullptr).ok());
  goes_on();
}

TEST_F(LongStep, ASingleStepIsDoneByTheBackendThatCan) {
  open("cube-plane", {"cube[0].particles-per-edge=15", "simulation.integrator=implicit-euler"}, "reference");
  ASSERT_TRUE(simulation().rebuild().set_backend(endless_backend()).ok());
  type(U'.');
  frames(5);
  EXPECT_TRUE(simulation().busy());
  EXPECT_EQ(simulation().step(), 0u);
  ASSERT_TRUE(simulation().rebuild().set_backend(reference_backend()).ok());
  frames_until([&] { return !simulation().busy(); });
  EXPECT_EQ(simulation().step(), 1u);
  EXPECT_EQ(hash(), reference_hash(app().scene.scene(), 1));
}

TEST_F(LongStep, ASingleStepThatTheDeviceTakesOnIsDoneOnce) {
  open("cube-plane", {"cube[0].particles-per-edge=15", "simulation.integrator=implicit-euler"}, "reference");
  ASSERT_TRUE(simulation().rebuild().set_backend(endless_backend()).ok());
  type(U'.');
  frames(2);
  ASSERT_TRUE(simulation().rebuild().set_backend(*find_backend("gpu")).ok());
  frames_until([&] { return !simulation().busy(); });
  EXPECT_EQ(simulation().step(), 1u);
}

TEST_F(LongStep, TheWindowClosesAtOnce) {
  run_endlessly();
  close();
}

}  // namespace
}  // namespace aspic::test
