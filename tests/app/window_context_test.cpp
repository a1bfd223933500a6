// The window's context: it tells when the device is lost, and a solver in it says so.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "app/window.h"
#include "gpu_solver/gpu_solver.h"
#include "support/model_building.h"

namespace aspic::app {
namespace {

TEST(WindowContext, TellsWhenTheDeviceIsLost) {
  const auto window = Window::create(320, 200, "aspic");
  ASSERT_TRUE(window.ok()) << window.error().message();
  gl::Context& context = (*window)->context();
  // Not every driver knows how; there is a window all the same. Mesa's software GLX does not, its EGL does.
  EXPECT_EQ(context.info().robust,
            glfwExtensionSupported("GLX_ARB_create_context_robustness") == GLFW_TRUE ||
                glfwExtensionSupported("EGL_EXT_create_context_robustness") == GLFW_TRUE);
  EXPECT_FALSE(context.lost());
  const Model model = test::build(test::cube_on_plane(3));
  auto solver = make_gpu_solver(context, model);
  ASSERT_TRUE(solver.ok()) << solver.error().message();
  ASSERT_TRUE((*solver)->advance(3).ok());
  context.inject_fault(gl::Fault::lost_context);
  EXPECT_EQ((*solver)->advance(3).error().code, ErrorCode::no_device);
  EXPECT_TRUE(context.lost());
}

}  // namespace
}  // namespace aspic::app
