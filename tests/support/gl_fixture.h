#pragma once
// A test with an OpenGL context that fails on whatever the driver has to complain about.
#include <gtest/gtest.h>

#include <span>

#include "gpu/context.h"

namespace aspic::testing {

/// The device that tests of this process ask for: the environment variable ASPIC_TEST_DEVICE (software,
/// hardware or automatic), else software. ASPIC_EGL_DEVICE goes before it.
gl::DeviceChoice test_device();

/// One headless context on test_device() with debug output per test process, made at the first use. Each test
/// ends in failure if it left a GL error or caused a KHR_debug message of high severity.
class GlTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite();
  void SetUp() override;
  void TearDown() override;

  /// The process's context; legal within a test, which ends in failure where there is none.
  static gl::Context& context();

  /// For tests of refusals: takes the pending GL errors and high-severity messages off the record and returns
  /// how many there were.
  static int forgive_errors();
};

/// Fails the test if any value is NaN or infinite, naming the first index.
void expect_finite(std::span<const float> values);

}  // namespace aspic::testing
