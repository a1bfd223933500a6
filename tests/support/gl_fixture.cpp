#include "support/gl_fixture.h"

#include <glad/gl.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <memory>

namespace aspic::testing {
namespace {

std::unique_ptr<gl::Context>& process_context() {
  static std::unique_ptr<gl::Context> context;
  return context;
}

/// Takes the context down before the process's static objects go, while the driver is still loaded.
class ContextEnvironment : public ::testing::Environment {
 public:
  void TearDown() override { process_context().reset(); }
};

[[maybe_unused]] const ::testing::Environment* const environment =
    ::testing::AddGlobalTestEnvironment(new ContextEnvironment);

}  // namespace

void GlTest::SetUpTestSuite() {
  if (process_context()) return;
  auto made = gl::Context::create_headless({.debug = true, .device = gl::DeviceChoice::software});
  ASSERT_TRUE(made.ok()) << made.error().message;
  // A run that is meant for one driver must not pass on another that EGL took instead.
  if (const char* const renderer = std::getenv("ASPIC_TEST_RENDERER")) {
    ASSERT_THAT((*made)->info().renderer, ::testing::HasSubstr(renderer));
  }
  process_context() = std::move(made).value();
}

gl::Context& GlTest::context() {
  return *process_context();
}

void GlTest::SetUp() {
  ASSERT_TRUE(process_context());
  const Status current = context().make_current();
  ASSERT_TRUE(current.ok()) << current.error().message;
  context().clear_messages();
}

void GlTest::TearDown() {
  if (!process_context()) return;
  for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError())
    ADD_FAILURE() << "GL error 0x" << std::hex << error << " was left behind";
  EXPECT_EQ(context().high_severity_count(), 0u);
  for (const gl::DebugMessage& message : context().messages())
    if (message.severity == gl::Severity::high) ADD_FAILURE() << "The driver reported: " << message.text;
  EXPECT_FALSE(context().lost()) << "The device was lost";
}

int GlTest::forgive_errors() {
  int count = static_cast<int>(context().high_severity_count());
  while (glGetError() != GL_NO_ERROR) ++count;
  context().clear_messages();
  return count;
}

void expect_finite(std::span<const float> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    ADD_FAILURE() << "value " << i << " of " << values.size() << " is " << values[i];
    return;
  }
}

}  // namespace aspic::testing
