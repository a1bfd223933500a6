#include <gtest/gtest.h>

#include "render/frame_policy.h"
#include "support/gl_fixture.h"

namespace aspic {
namespace {

using FramePolicyTest = testing::GlTest;

TEST_F(FramePolicyTest, HardwareHasNone) {
  EXPECT_EQ(FramePolicy::create(context()) != nullptr, context().info().is_software);
}

TEST_F(FramePolicyTest, ImagesComeNoFasterThanADisplayShowsAndLeaveTimeForSteps) {
  const auto policy = FramePolicy::create(context());
  if (!policy) GTEST_SKIP() << "hardware has none";
  EXPECT_EQ(policy->interval(false, false, 1.0), 1.0 / 60.0);
  EXPECT_EQ(policy->interval(true, false, 0.0), 0.1) << "nothing new";
  EXPECT_DOUBLE_EQ(policy->interval(false, true, 0.02), 0.06) << "a third of the time";
  EXPECT_EQ(policy->interval(false, true, 0.001), 1.0 / 60.0);
  EXPECT_EQ(policy->interval(false, true, 1.0), 0.1);
}

}  // namespace
}  // namespace aspic
