// The blocks that C++ fills are laid out as the driver reads them.
#include <gtest/gtest.h>

#include "gpu/program.h"
#include "render/layout.h"
#include "support/gl_fixture.h"
#include "support/program_reflection.h"

namespace aspic {
namespace {

using aspic::testing::Reflection;

class RenderLayout : public testing::GlTest {};

TEST_F(RenderLayout, FrameBlockMatchesTheDriver) {
  const gl::Define plane[] = {{"PLANE", "1"}, {"SHADOWED_PLANE", "1"}};
  const auto program =
      gl::Program::graphics(context(), gl::ShaderLibrary(),
                            {.vertex = "render/terrain.vert", .fragment = "render/terrain.frag"}, plane);
  ASSERT_TRUE(program.ok()) << program.error().message();
  using render_layout::Frame;
  EXPECT_EQ(Reflection(*program).uniform_block_binding("Frame"), BINDING_FRAME);
  EXPECT_EQ(Reflection(*program).uniform_block_data_size("Frame"), static_cast<int>(sizeof(Frame)));
  EXPECT_EQ(Reflection(*program).uniform_offset("view_projection"),
            static_cast<int>(offsetof(Frame, view_projection)));
  EXPECT_EQ(Reflection(*program).uniform_offset("lights[0]"), static_cast<int>(offsetof(Frame, lights)));
  EXPECT_EQ(Reflection(*program).uniform_offset("eye"), static_cast<int>(offsetof(Frame, eye)));
  EXPECT_EQ(Reflection(*program).uniform_offset("sun"), static_cast<int>(offsetof(Frame, sun)));
  EXPECT_EQ(Reflection(*program).uniform_offset("shadow_tint"),
            static_cast<int>(offsetof(Frame, shadow_tint)));
  EXPECT_EQ(Reflection(*program).uniform_offset("shadow_spheres[0]"),
            static_cast<int>(offsetof(Frame, shadow_spheres)));
  EXPECT_EQ(Reflection(*program).uniform_offset("shadow_sphere_count"),
            static_cast<int>(offsetof(Frame, shadow_sphere_count)));
  EXPECT_EQ(Reflection(*program).uniform_block_binding("LightBoxes"), BINDING_LIGHT_BOXES);
  EXPECT_EQ(Reflection(*program).uniform_block_data_size("LightBoxes"),
            static_cast<int>(LIGHTS * sizeof(render_layout::LightBox)));
}

TEST_F(RenderLayout, LightBoxesMatchTheDriver) {
  const auto program = gl::Program::compute(context(), gl::ShaderLibrary(), "render/light_boxes.comp");
  ASSERT_TRUE(program.ok()) << program.error().message();
  EXPECT_EQ(Reflection(*program).storage_block_binding("LightBoxes"), BINDING_LIGHT_BOXES_OUT);
  EXPECT_EQ(Reflection(*program).buffer_variable_offset("light_boxes[0].depth"),
            static_cast<int>(offsetof(render_layout::LightBox, depth)));
  EXPECT_EQ(Reflection(*program).buffer_variable_top_level_stride("light_boxes[0].center"),
            static_cast<int>(sizeof(render_layout::LightBox)));
  EXPECT_EQ(Reflection(*program).buffer_variable_offset("bounds[0].upper"),
            static_cast<int>(offsetof(render_layout::Bounds, upper)));
}

TEST_F(RenderLayout, GraphicsProgramsReportInFilesAndLines) {
  const gl::Define broken[] = {{"PLANE", "1"}, {"to_display", "no_such_function"}, {"sky", "+"}};
  const auto program =
      gl::Program::graphics(context(), gl::ShaderLibrary(),
                            {.vertex = "render/screen.vert", .fragment = "render/sky.frag"}, broken);
  ASSERT_FALSE(program.ok());
  EXPECT_NE(program.error().message().find("render/"), std::string::npos) << program.error().message();
  (void)forgive_errors();
}

}  // namespace
}  // namespace aspic
