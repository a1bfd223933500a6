// A lost device and failed allocations, injected and real. Each test has a context of its own.
#include <EGL/egl.h>
#include <glad/gl.h>
#include <gmock/gmock.h>

#include "gpu/buffer.h"
#include "gpu/texture.h"
#include "support/gl_fixture.h"

namespace aspic::gl {
namespace {

using ::testing::HasSubstr;

class FaultGl : public testing::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    auto made = Context::create_headless({.debug = true, .device = aspic::testing::test_device()});
    ASSERT_TRUE(made.ok()) << made.error().message();
    own_ = std::move(*made);
  }
  void TearDown() override {
    own_.reset();
    ASSERT_TRUE(context().make_current().ok());
    GlTest::TearDown();
  }
  std::shared_ptr<Context> own_;
};

TEST_F(FaultGl, RobustContextsComeFromEglWhereTheyAreAskedFor) {
  EXPECT_TRUE(own_->info().robust);
  EXPECT_FALSE(own_->lost());
  const auto plain =
      Context::create_headless({.debug = false, .robust = false, .device = aspic::testing::test_device()});
  ASSERT_TRUE(plain.ok()) << plain.error().message();
  EXPECT_FALSE((*plain)->info().robust);
  EXPECT_FALSE((*plain)->lost());
  // An injected loss needs no help from the driver.
  (*plain)->inject_fault(Fault::lost_context);
  EXPECT_TRUE((*plain)->lost());
}

TEST_F(FaultGl, ALossIsFoundAtThePollAndStays) {
  own_->inject_fault(Fault::lost_context, 2);
  EXPECT_FALSE(own_->lost());
  EXPECT_FALSE(own_->lost());
  EXPECT_TRUE(own_->lost());
  EXPECT_TRUE(own_->lost());
  const Error error = own_->lost_error();
  EXPECT_EQ(error.code, ErrorCode::no_device);
  EXPECT_THAT(error.message(), HasSubstr(own_->info().renderer));
  EXPECT_THAT(error.message(), HasSubstr("lost"));
  // The other context never noticed.
  EXPECT_FALSE(context().lost());
}

TEST_F(FaultGl, AnAdoptedContextIsToldToo) {
  auto adopted = Context::adopt_current(eglGetProcAddress);
  ASSERT_TRUE(adopted.ok()) << adopted.error().message();
  EXPECT_TRUE((*adopted)->info().robust);
  (*adopted)->inject_fault(Fault::lost_context);
  EXPECT_TRUE((*adopted)->lost());
}

TEST_F(FaultGl, AFailedAllocationIsRefusedWithFiguresOnce) {
  auto kept = Buffer::create(*own_, "kept", 4096);
  ASSERT_TRUE(kept.ok());
  own_->inject_fault(Fault::out_of_memory, 1);
  ASSERT_TRUE(Buffer::create(*own_, "still there", 64).ok());
  const auto refused = Buffer::create(*own_, "spring list", 123456);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::scene_rejected);
  EXPECT_THAT(refused.error().message(), HasSubstr("has no memory for the storage buffer \"spring list\""));
  EXPECT_THAT(refused.error().message(), HasSubstr("123456 bytes"));
  EXPECT_THAT(refused.error().message(), HasSubstr("4 KiB held already"));
  EXPECT_EQ(own_->bytes_held(), 4096u);
  EXPECT_TRUE(Buffer::create(*own_, "spring list", 123456).ok());
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});

  own_->inject_fault(Fault::out_of_memory);
  const auto image = Texture::create(*own_, "image", {.width = 64, .height = 32});
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().code, ErrorCode::scene_rejected);
  EXPECT_THAT(image.error().message(), HasSubstr("64 x 32"));
  EXPECT_TRUE(Texture::create(*own_, "image", {.width = 64, .height = 32}).ok());
}

TEST_F(FaultGl, AnAllocationThatFailsBecauseTheDeviceIsLostSaysThat) {
  own_->inject_fault(Fault::lost_context);
  own_->inject_fault(Fault::out_of_memory);
  EXPECT_EQ(Buffer::create(*own_, "a", 64).error().code, ErrorCode::no_device);
  own_->inject_fault(Fault::out_of_memory);
  EXPECT_EQ(Texture::create(*own_, "b", {.width = 8, .height = 8}).error().code, ErrorCode::no_device);
}

TEST_F(FaultGl, MemoryThatRanOutAtWorkIsFoundAfterwards) {
  EXPECT_FALSE(own_->ran_out_of_memory());
  own_->inject_fault(Fault::out_of_memory);
  EXPECT_TRUE(own_->ran_out_of_memory());
  EXPECT_FALSE(own_->ran_out_of_memory());

  // The driver's own: more than any address space.
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
  glBufferData(GL_COPY_WRITE_BUFFER, GLsizeiptr{1} << 60, nullptr, GL_DYNAMIC_COPY);
  EXPECT_TRUE(own_->ran_out_of_memory());
  EXPECT_FALSE(own_->ran_out_of_memory());
  glDeleteBuffers(1, &buffer);

  // Another error that is met on the way does not get lost.
  std::vector<std::string> severe;
  own_->set_message_sink([&](const DebugMessage& m) {
    if (m.severe) severe.push_back(m.text);
  });
  glDisable(GL_DEBUG_OUTPUT);
  glEnable(GL_FRAMEBUFFER);
  EXPECT_FALSE(own_->ran_out_of_memory());
  own_->set_message_sink({});
  ASSERT_EQ(severe.size(), 1u);
  EXPECT_THAT(severe[0], HasSubstr("0x0500"));
}

}  // namespace
}  // namespace aspic::gl
