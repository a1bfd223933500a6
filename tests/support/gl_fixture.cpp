#include "support/gl_fixture.h"

#include <glad/gl.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "support/value_of.h"

namespace aspic::testing {
namespace {

std::shared_ptr<gl::Context>& process_context() {
  static std::shared_ptr<gl::Context> context;
  return context;
}

/// Severe messages of the process's context since the test began.
std::vector<std::string>& severe_messages() {
  static std::vector<std::string> messages;
  return messages;
}

/// Takes the context down before the process's static objects go, while the driver is still loaded.
class ContextEnvironment : public ::testing::Environment {
 public:
  void TearDown() override { process_context().reset(); }
};

[[maybe_unused]] const ::testing::Environment* const environment =
    ::testing::AddGlobalTestEnvironment(new ContextEnvironment);

}  // namespace

gl::DeviceChoice test_device() {
  const char* const variable = std::getenv("ASPIC_TEST_DEVICE");
  const std::string_view wish = variable && *variable ? variable : "software";
  if (wish == "hardware") return gl::DeviceChoice::hardware;
  if (wish == "automatic") return gl::DeviceChoice::automatic;
  EXPECT_EQ(wish, "software") << "ASPIC_TEST_DEVICE is none of software, hardware, automatic";
  return gl::DeviceChoice::software;
}

void GlTest::SetUpTestSuite() {
  if (process_context()) return;
  auto made = test::value_of(gl::Context::create_headless({.debug = true, .device = test_device()}));
  // A run that is meant for one driver must not pass on another that EGL took instead.
  if (const char* const renderer = std::getenv("ASPIC_TEST_RENDERER")) {
    ASSERT_THAT(made->info().renderer, ::testing::HasSubstr(renderer));
  }
  process_context() = std::move(made);
}

gl::Context& GlTest::context() {
  if (!process_context()) throw std::runtime_error("There is no OpenGL context to test with.");
  return *process_context();
}

void GlTest::SetUp() {
  const Status current = context().make_current();
  ASSERT_TRUE(current.ok()) << current.error().message();
  severe_messages().clear();
  context().set_message_sink([](const gl::DebugMessage& message) {
    if (message.severe) severe_messages().push_back(message.text);
  });
}

void GlTest::TearDown() {
  if (!process_context()) return;
  EXPECT_TRUE(context().make_current().ok());
  for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError())
    ADD_FAILURE() << "GL error 0x" << std::hex << error << " was left behind";
  for (const std::string& message : severe_messages()) ADD_FAILURE() << "The driver reported: " << message;
  EXPECT_FALSE(context().lost()) << "The device was lost";
}

int GlTest::forgive_errors() {
  int count = static_cast<int>(severe_messages().size());
  while (glGetError() != GL_NO_ERROR) ++count;
  severe_messages().clear();
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
