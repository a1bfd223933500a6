// A lost device and memory that runs out, caused on purpose: the run goes on on the CPU.
#include <gmock/gmock.h>

#include "app/stage.h"

namespace aspic::test {
namespace {

using testing::HasSubstr;

class Revival : public Stage {
 protected:
  std::string hash() { return state_hash_text(simulation().snapshot()); }
  std::string notice() { return app().messages.notice() ? app().messages.notice()->text : ""; }
  void pause() {
    simulation().set_running(false);
    ASSERT_TRUE(simulation().settle().ok());
  }
};

TEST_F(Revival, ARunOnTheGpuGoesOnOnTheProcessorFromTheLastCopy) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, "gpu");
  simulation().set_running(true);
  frames_to_step(100);
  app().view.camera.orbit(0.2, 0.1);
  frames_to_rest();
  const CameraSettings camera = app().view.camera.goal();
  const std::uint64_t copy = simulation().snapshot().step, step = simulation().step();
  lose_device(0);
  EXPECT_EQ(simulation().present().backend().name, "cpu");
  EXPECT_TRUE(simulation().running()) << "it goes on";
  EXPECT_EQ(simulation().step(), copy);
  EXPECT_LE(copy, step);
  frames(1);
  EXPECT_TRUE(app().messages.notice() && app().messages.notice()->is_error);
  EXPECT_THAT(notice(), HasSubstr("The CPU continues from the last copy"));
  EXPECT_THAT(notice(), HasSubstr(" s old"));
  frames_to_step(copy + 50);
  pause();
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), simulation().step())) << "the copy was good";
  EXPECT_EQ(app().view.camera.goal(), camera);
  // The history is that of before.
  app().run.go_to(0.010);
  ASSERT_TRUE(simulation().settle().ok());
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), 10));
  // And the gpu of the new window is as good as the old one.
  while (simulation().present().backend().name != "gpu") press(GLFW_KEY_G);
  for (int i = 0; i < 3; ++i) type(U'.');
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), 13));
}

TEST_F(Revival, ADeviceLostWithinAStepIsNoticedByTheSolver) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, "gpu");
  simulation().set_running(true);
  frames_to_step(60);
  // The window looks first, the solver next.
  lose_device(1);
  EXPECT_EQ(simulation().present().backend().name, "cpu");
  EXPECT_THAT(notice(), HasSubstr(" s old"));
  frames_to_step(simulation().step() + 20);
  pause();
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), simulation().step()));
}

TEST_F(Revival, ARunOnTheReferenceLosesNothing) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, "reference");
  simulation().set_running(true);
  frames_to_step(40);
  const std::uint64_t before = simulation().step();
  lose_device(0);
  EXPECT_GE(simulation().step(), before);
  EXPECT_TRUE(app().messages.notice() && app().messages.notice()->is_error);
  frames_to_step(before + 40);
  pause();
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), simulation().step()));
}

TEST_F(Revival, ShadowModeEndsWithTheDevice) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, "reference");
  ASSERT_TRUE(simulation().rebuild().set_shadow(&next_backend(simulation().present().backend())).ok());
  simulation().set_running(true);
  frames_to_step(30);
  lose_device(0);
  EXPECT_FALSE(simulation().present().engines().shadowed());
  frames(1);
  EXPECT_THAT(notice(), HasSubstr("Shadow mode has ended"));
  frames_to_step(simulation().step() + 20);
  pause();
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), simulation().step()));
}

TEST_F(Revival, GpuOutOfMemoryFallsBackToCpu) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, "reference");
  for (int i = 0; i < 5; ++i) type(U'.');
  const std::string before = hash();
  context().inject_fault(gl::Fault::out_of_memory);
  press(GLFW_KEY_G);
  EXPECT_EQ(simulation().present().backend().name, "cpu");
  EXPECT_TRUE(app().messages.notice() && app().messages.notice()->is_error);
  EXPECT_THAT(notice(), HasSubstr("memory"));
  EXPECT_EQ(hash(), before);
  while (simulation().present().backend().name != "gpu") press(GLFW_KEY_G);
  EXPECT_EQ(simulation().present().backend().name, "gpu") << "once there is memory it works";
  EXPECT_EQ(hash(), before);
}

TEST_F(Revival, AChangeTheGpuHasNoMemoryForGoesToTheProcessor) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, "gpu");
  for (int i = 0; i < 5; ++i) type(U'.');
  context().inject_fault(gl::Fault::out_of_memory, 1);  // not at the read-back, but at the first new buffer
  // A constant alone would need none.
  app().scene.set_value(*find_parameter("contact.model"), 0, Value(std::string("course")), "");
  frames(2);
  EXPECT_EQ(simulation().present().backend().name, "cpu");
  EXPECT_EQ(simulation().model().contact.model, ContactModel::course) << "the change holds";
  EXPECT_EQ(simulation().step(), 5u);
  EXPECT_THAT(notice(), HasSubstr("The CPU takes over"));
}

}  // namespace
}  // namespace aspic::test
