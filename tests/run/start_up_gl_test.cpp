// What the driver compiles for a start, and when it is waited for.
#include <gmock/gmock.h>

#include "aspic/scene.h"
#include "gpu_solver/gpu_solver.h"
#include "render/renderer.h"
#include "support/gl_calls.h"
#include "support/gl_fixture.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using aspic::testing::GlCalls;
using ::testing::MatchesRegex;

struct Start {
  std::string scene;
  std::vector<std::string> set;
  int kernels, images;  ///< programs of the solver without the canary, and of an image
  std::size_t lines;    ///< of all shaders
};

class StartUp : public aspic::testing::GlTest {};

// The figures are upper bounds: whoever raises one makes every first start slower.
TEST_F(StartUp, BeginsAllProgramsBeforeItWaitsAndCompilesFew) {
  const std::vector<Start> starts = {{"cube-plane", {}, 1, 14, 12000},
                                     {"ball-pit", {}, 8, 10, 17500},
                                     {"heap", {}, 7, 11, 15000},
                                     {"cube-plane", {"simulation.integrator=implicit-euler"}, 6, 14, 19500},
                                     {"goal-net", {"view.draw=[\"solid\", \"particles\"]"}, 10, 17, 28000}};
  for (const Start& start : starts) {
    SCOPED_TRACE(::testing::PrintToString(start.set) + start.scene);
    const Scene scene = load_scene(start.scene, start.set).value();
    const Model model = build_model(scene.model).value();
    // Another context has compiled nothing yet.
    const auto own = gl::Context::create_headless({.debug = true, .device = aspic::testing::test_device()});
    ASSERT_TRUE(own.ok()) << own.error().message();
    const GlCalls calls;
    const auto solver = make_gpu_solver(**own, model, {});
    ASSERT_TRUE(solver.ok()) << solver.error().message();
    // The canary's result decides how kernels are compiled.
    EXPECT_THAT(calls.order, MatchesRegex("L+\\?+L+\\?+"));
    const auto of_solver = calls.links();
    // On an inexact device the canary tries the corrected form and all its mantissas too.
    const int canaries = (*solver)->arithmetic().corrected ? 3 : 1;
    EXPECT_LE(of_solver, start.kernels + canaries);

    const auto renderer = Renderer::create(**own);
    ASSERT_TRUE(renderer.ok()) << renderer.error().message();
    ASSERT_TRUE((*renderer)->set_model(model).ok());
    EXPECT_EQ(calls.links(), of_solver);
    const std::size_t before = calls.order.size();
    ImageOptions options;
    options.view = scene.view;
    const Status drawn = (*renderer)->draw(64, 36, (*solver)->device_state(), options);
    ASSERT_TRUE(drawn.ok()) << drawn.error().message();
    EXPECT_THAT(calls.order.substr(before), MatchesRegex("L+\\?+"));
    EXPECT_LE(calls.links() - of_solver, start.images);
    EXPECT_LE(calls.lines(), start.lines + (canaries > 1 ? 1000 : 0));

    const auto compiled = calls.links();
    const auto again = make_gpu_solver(**own, model, {});
    const auto another = Renderer::create(**own);
    ASSERT_TRUE(again.ok() && another.ok());
    ASSERT_TRUE((*another)->set_model(model).ok());
    ASSERT_TRUE((*another)->draw(64, 36, (*again)->device_state(), options).ok());
    EXPECT_EQ(calls.links(), compiled) << "programs are shared within a context";
  }
}

TEST_F(StartUp, AnImageNamesTheShaderThatIsRefusedUntilItIsMended) {
  const test::TemporaryDirectory directory;
  std::filesystem::create_directory(directory.path() / "render");
  directory.write("render/sky.frag", "\nvoid main() { misspelt; }\n");
  const Scene scene = load_scene("cube-plane").value();
  const Model model = build_model(scene.model).value();
  const auto renderer = Renderer::create(context(), {.shaders = gl::ShaderLibrary(directory.path())});
  ASSERT_TRUE(renderer.ok()) << renderer.error().message();
  ASSERT_TRUE((*renderer)->set_model(model).ok());
  const auto state = (*renderer)->upload(initial_state(model, Precision::single));
  ASSERT_TRUE(state.ok());
  ImageOptions options;
  options.view = scene.view;
  const Status refused = (*renderer)->draw(64, 36, *state, options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::no_device);
  EXPECT_THAT(refused.error().message(), ::testing::HasSubstr("render/sky.frag:2: error"));
  forgive_errors();
  std::filesystem::remove(directory.path() / "render/sky.frag");
  const Status mended = (*renderer)->draw(64, 36, *state, options);
  EXPECT_TRUE(mended.ok()) << mended.error().message();
}

}  // namespace
}  // namespace aspic
