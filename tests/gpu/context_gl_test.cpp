#include <EGL/egl.h>
#include <glad/gl.h>
#include <gmock/gmock.h>
#include <gtest/gtest-spi.h>

#include <algorithm>
#include <cstdlib>

#include "base/printable.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "support/gl_fixture.h"

namespace aspic::gl {
namespace {

using ::testing::HasSubstr;

/// Sets ASPIC_EGL_DEVICE for a scope.
class DeviceVariable {
 public:
  explicit DeviceVariable(const char* value) {
    if (const char* before = std::getenv(name)) before_ = before, had_ = true;
    setenv(name, value, 1);
  }
  ~DeviceVariable() { had_ ? setenv(name, before_.c_str(), 1) : unsetenv(name); }
  DeviceVariable(const DeviceVariable&) = delete;
  DeviceVariable& operator=(const DeviceVariable&) = delete;

 private:
  static constexpr const char* name = "ASPIC_EGL_DEVICE";
  std::string before_;
  bool had_ = false;
};

class ContextGl : public testing::GlTest {
 protected:
  void TearDown() override {
    // Tests here make others current.
    ASSERT_TRUE(context().make_current().ok());
    GlTest::TearDown();
  }
};

TEST(SoftwareRenderer, IsKnownByItsName) {
  for (const char* name :
       {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "Software Rasterizer", "Mesa swrast",
        "Google SwiftShader", "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (LLVM 10.0.0)))",
        "zink (lavapipe)", "SWR (LLVM 9)", "Microsoft Basic Render Driver", "GDI Generic"})
    EXPECT_TRUE(is_software_renderer(name)) << name;
  for (const char* name : {"NVIDIA H200/PCIe/SSE2", "Mesa Intel(R) UHD Graphics 620 (KBL GT2)",
                           "AMD Radeon RX 6800 (radeonsi, navi21, LLVM 15.0.6, DRM 3.49)", "V3D 4.2"})
    EXPECT_FALSE(is_software_renderer(name)) << name;
}

TEST(HumanBytes, KeepsFourFigures) {
  EXPECT_EQ(human_bytes(0), "0 bytes");
  EXPECT_EQ(human_bytes(1023), "1023 bytes");
  EXPECT_EQ(human_bytes(1536), "1.5 KiB");
  EXPECT_EQ(human_bytes(128ull << 20), "128 MiB");
  EXPECT_EQ(human_bytes(2ull << 30), "2 GiB");
}

TEST_F(ContextGl, DescribesTheDevice) {
  const DeviceInfo& info = context().info();
  EXPECT_TRUE(info.debug);
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_EQ(info.is_software, is_software_renderer(info.renderer));
  // What OpenGL 4.3 guarantees (core profile specification, tables 23.60 to 23.64).
  EXPECT_GE(info.limits.storage_block_bytes, 1u << 24);
  EXPECT_GE(info.limits.uniform_block_bytes, 16384u);
  EXPECT_GE(info.limits.compute_storage_blocks, 8u);
  EXPECT_GE(info.limits.group_invocations, 1024u);
  for (const std::uint32_t count : info.limits.group_count) EXPECT_GE(count, 65535u);
  EXPECT_GE(info.limits.shared_bytes, 32768u);
  const auto lines = describe(info);
  EXPECT_TRUE(
      std::ranges::any_of(lines, [&](const auto& l) { return l.find(info.renderer) != std::string::npos; }));
  EXPECT_TRUE(std::ranges::none_of(lines, [](const auto& l) { return l.find('\n') != std::string::npos; }));
  EXPECT_FALSE(context().lost());
}

TEST_F(ContextGl, ASoftwareRasterizerIsNotAskedForMemoryOfItsOwn) {
  if (!context().info().is_software) GTEST_SKIP() << "hardware has its own";
  EXPECT_EQ(context().free_memory(), std::nullopt);
  EXPECT_TRUE(context().check_memory(std::uint64_t{1} << 30).ok());
}

TEST_F(ContextGl, OffersTheSoftwareDeviceByChoiceAndByVariable) {
  const DeviceVariable variable("software");
  const auto made = Context::create_headless({.debug = false, .device = DeviceChoice::automatic});
  ASSERT_TRUE(made.ok()) << made.error().message();
  EXPECT_TRUE((*made)->info().is_software);
  EXPECT_FALSE((*made)->info().debug);
}

TEST_F(ContextGl, GivesHardwareOrSaysWhatWasTried) {
  const DeviceVariable variable("hardware");
  const auto made = Context::create_headless({});
  if (made.ok()) {
    EXPECT_FALSE((*made)->info().is_software);
  } else {
    EXPECT_EQ(made.error().code, ErrorCode::no_device);
    EXPECT_THAT(made.error().message(), HasSubstr("Tried: "));
    EXPECT_THAT(made.error().message(),
                HasSubstr("Unset the environment variable ASPIC_EGL_DEVICE, which is \"hardware\""));
    const bool found = made.error().message().find(", a software rasterizer") != std::string::npos;
    EXPECT_EQ(made.error().message().find("apt install libegl1") != std::string::npos, !found);
    EXPECT_THAT(made.error().message(), HasSubstr("install the graphics card's OpenGL driver"));
  }
}

TEST_F(ContextGl, ListsDevicesThatAnIndexChooses) {
  const auto devices = list_devices();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    EXPECT_EQ(devices[i].index, static_cast<int>(i));
    EXPECT_FALSE(devices[i].name.empty());
    if (!devices[i].software) continue;
    const DeviceVariable variable(std::to_string(i).c_str());
    const auto made = Context::create_headless({});
    ASSERT_TRUE(made.ok()) << made.error().message();
    EXPECT_EQ((*made)->info().platform, "EGL device " + std::to_string(i));
  }
}

TEST_F(ContextGl, RefusesADeviceThatIsNotThere) {
  {
    const DeviceVariable variable("9999");
    const auto beyond = Context::create_headless({});
    ASSERT_FALSE(beyond.ok());
    EXPECT_EQ(beyond.error().code, ErrorCode::no_device);
    EXPECT_THAT(beyond.error().message(), HasSubstr("9999"));
  }
  const DeviceVariable variable("toaster");
  const auto unknown = Context::create_headless({});
  ASSERT_FALSE(unknown.ok());
  EXPECT_THAT(unknown.error().message(), HasSubstr("\"toaster\""));
  EXPECT_THAT(unknown.error().message(), HasSubstr("surfaceless"));
}

TEST_F(ContextGl, TwoContextsLiveSideBySide) {
  auto buffer = Buffer::create(context(), "kept", 4);
  ASSERT_TRUE(buffer.ok());
  buffer->clear();
  {
    const auto second = Context::create_headless({.debug = true, .device = aspic::testing::test_device()});
    ASSERT_TRUE(second.ok()) << second.error().message();
    EXPECT_EQ((*second)->bytes_held(), 0u);
  }
  ASSERT_TRUE(context().make_current().ok());
  EXPECT_EQ(buffer->download_items<std::uint32_t>(1).front(), 0u);
}

TEST_F(ContextGl, AdoptsTheCurrentContext) {
  auto owner = Context::create_headless({.debug = true, .device = aspic::testing::test_device()});
  ASSERT_TRUE(owner.ok()) << owner.error().message();
  {
    auto adopted = Context::adopt_current(eglGetProcAddress);
    ASSERT_TRUE(adopted.ok()) << adopted.error().message();
    EXPECT_EQ((*adopted)->info().renderer, (*owner)->info().renderer);
    EXPECT_EQ((*adopted)->info().platform, "window");
    EXPECT_TRUE((*adopted)->info().debug);
    EXPECT_EQ((*adopted)->info().robust, (*owner)->info().robust);
    EXPECT_TRUE((*adopted)->make_current().ok());
  }
  // It was not the adopter's to destroy.
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  EXPECT_NE(eglGetCurrentContext(), EGL_NO_CONTEXT);
  owner->reset();
  const auto none = Context::adopt_current(eglGetProcAddress);
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().code, ErrorCode::no_device);
}

TEST_F(ContextGl, PassesMessagesOn) {
  std::vector<DebugMessage> seen;
  context().set_message_sink([&](const DebugMessage& m) { seen.push_back(m); });
  for (const auto severity : {GLenum{GL_DEBUG_SEVERITY_MEDIUM}, GLenum{GL_DEBUG_SEVERITY_HIGH}})
    glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_OTHER, 7, severity, -1,
                         "grave or slight");
  context().set_message_sink({});
  glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_OTHER, 7, GL_DEBUG_SEVERITY_HIGH, -1,
                       "unseen");
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_FALSE(seen[0].severe);
  EXPECT_TRUE(seen[1].severe);
  EXPECT_EQ(seen[1].id, 7u);
  EXPECT_EQ(seen[1].text, "grave or slight");
}

TEST_F(ContextGl, TheFixtureFailsOnGlErrorsAndOnValuesThatAreNotFinite) {
  ::testing::TestPartResultArray failures;
  {
    const ::testing::ScopedFakeTestPartResultReporter reporter(
        ::testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &failures);
    glEnable(GL_FRAMEBUFFER);
    TearDown();
    const float values[] = {1.0f, std::numeric_limits<float>::quiet_NaN()};
    testing::expect_finite(values);
  }
  std::string text;
  for (int i = 0; i < failures.size(); ++i) text += failures.GetTestPartResult(i).message();
  EXPECT_THAT(text, HasSubstr("GL error 0x500"));
  EXPECT_THAT(text, HasSubstr("The driver reported"));
  EXPECT_THAT(text, HasSubstr("value 1 of 2 is nan"));
  forgive_errors();
}

}  // namespace
}  // namespace aspic::gl
