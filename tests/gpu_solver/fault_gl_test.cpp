// What a gpu solver says when the device is lost or out of memory, and that nothing is left behind. Each test
// has a context of its own.
#include <glad/gl.h>
#include <gmock/gmock.h>

#include "cpu_reference/reference_solver.h"
#include "gpu_solver/gpu_solver.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/temporary_directory.h"
#include "support/value_of.h"

namespace aspic {
namespace {

using gl::Fault;
using ::testing::HasSubstr;

struct Case {
  Integrator integrator;
  ForcePath path;
};
constexpr Case cases[] = {{Integrator::runge_kutta_4, ForcePath::lattice},
                          {Integrator::runge_kutta_4, ForcePath::gather},
                          {Integrator::runge_kutta_4, ForcePath::per_spring},
                          {Integrator::implicit_euler, ForcePath::gather}};

class FaultySolverGl : public aspic::testing::GlTest {
 protected:
  void TearDown() override {
    own_.reset();
    ASSERT_TRUE(context().make_current().ok());
    GlTest::TearDown();
  }

  /// A fresh context, in which no fault has struck yet.
  gl::Context& own() {
    own_ = test::value_of(
        gl::Context::create_headless({.debug = true, .device = aspic::testing::test_device()}));
    return *own_;
  }

  static Result<std::unique_ptr<GpuSolver>> make(gl::Context& context, const Model& model, const Case& c) {
    GpuOptions options;
    options.force_path = c.path;
    options.ball_search = BallSearch::grid;
    return make_gpu_solver(context, model, options);
  }

  static Model scene(Integrator integrator) {
    ModelSettings settings = test::cube_on_plane(4, 1.9);
    settings.simulation.integrator = integrator;
    settings.balls.push_back({0.5, 2.0, {0.2, 6.0, 0.1}, {0.0, -9.0, 0.0}, {}});
    return test::build(settings);
  }

  /// GL buffers that exist in the current context.
  static int live_buffers() {
    int count = 0;
    for (GLuint name = 1; name < 4096; ++name) count += glIsBuffer(name) == GL_TRUE;
    return count;
  }

  std::shared_ptr<gl::Context> own_;
};

TEST_F(FaultySolverGl, ALostDeviceEndsEveryCallWithASentence) {
  for (const Case& c : cases) {
    gl::Context& device = own();
    const Model model = scene(c.integrator);
    auto solver = std::move(make(device, model, c)).value();
    ASSERT_TRUE(solver->advance(5).ok());
    const State last = *solver->state();
    device.inject_fault(Fault::lost_context);
    const auto advanced = solver->advance(5);
    ASSERT_FALSE(advanced.ok());
    EXPECT_EQ(advanced.error().code, ErrorCode::no_device);
    EXPECT_THAT(advanced.error().message(), HasSubstr("was reset or lost"));
    EXPECT_THAT(advanced.error().message(), HasSubstr(device.info().renderer));
    EXPECT_EQ(solver->advance(1).error().code, ErrorCode::no_device);
    EXPECT_EQ(solver->state().error().code, ErrorCode::no_device);
    EXPECT_EQ(solver->load(last).error().code, ErrorCode::no_device);
    EXPECT_EQ(make(device, model, c).error().code, ErrorCode::no_device);
    EXPECT_NE(solver->device_state().particles->id(), 0u);

    // The run goes on elsewhere from the last copy, with the bits it would have had.
    auto whole = std::move(make_reference_solver(model, Precision::single)).value();
    auto rescue = std::move(make_reference_solver(model, Precision::single)).value();
    ASSERT_TRUE(rescue->load(last).ok());
    ASSERT_TRUE(rescue->advance(20).ok());
    ASSERT_TRUE(whole->advance(25).ok());
    EXPECT_EQ(*rescue->state(), *whole->state());
  }
}

TEST_F(FaultySolverGl, ALossFoundByStateIsReportedThere) {
  for (const Case& c : cases) {
    gl::Context& device = own();
    const Model model = scene(c.integrator);
    auto solver = std::move(make(device, model, c)).value();
    device.inject_fault(Fault::lost_context);
    EXPECT_EQ(solver->state().error().code, ErrorCode::no_device);
  }
}

// Wherever among the allocations memory runs out, also after the last of them: the scene is refused with
// figures, nothing stays behind, and the next attempt succeeds.
TEST_F(FaultySolverGl, RunningOutOfMemoryRefusesTheSceneAndLeaksNothing) {
  for (const Case& c : cases) {
    gl::Context& device = own();
    const Model model = scene(c.integrator);
    { ASSERT_TRUE(make(device, model, c).ok()); }  // kernels that stay with the context
    ASSERT_EQ(device.bytes_held(), 0u);
    const int buffers = live_buffers();
    std::uint64_t chance = 0;
    for (;; ++chance) {
      ASSERT_LT(chance, 100u);
      device.inject_fault(Fault::out_of_memory, chance);
      const auto made = make(device, model, c);
      if (made.ok()) break;
      EXPECT_EQ(made.error().code, ErrorCode::scene_rejected) << chance;
      EXPECT_THAT(made.error().message(), HasSubstr("memory"));
      EXPECT_THAT(made.error().message(), HasSubstr("held"));
      EXPECT_THAT(made.error().message(), HasSubstr("bytes"));
      EXPECT_EQ(device.bytes_held(), 0u) << chance;
      EXPECT_EQ(live_buffers(), buffers) << chance;
    }
    EXPECT_GE(chance, 10u) << "each buffer is a chance";
    EXPECT_EQ(device.bytes_held(), 0u);
    EXPECT_EQ(live_buffers(), buffers);
  }
}

// A driver that compiles a kernel to nothing, or drops what it is given, must not keep the host waiting.
TEST_F(FaultySolverGl, ADeviceThatDoesNothingEndsTheRun) {
  for (const char* const kernel : {"begin", "evaluate", "apply", "update", "direction", "finish"}) {
    const test::TemporaryDirectory shaders;
    std::filesystem::create_directory(shaders.path() / "compute");
    shaders.write(std::string("compute/implicit_") + kernel + ".comp",
                  "layout(local_size_x = 256) in;\nvoid main() {}\n");
    ModelSettings settings =
        test::cube_on_plane(4, 0.99);  // on the ground, so that there is something to solve
    settings.simulation.integrator = Integrator::implicit_euler;
    settings.simulation.implicit.newton_iterations = 3;
    settings.simulation.implicit.cg_iterations = 10;
    const Model model = test::build(settings);
    GpuOptions options;
    options.shader_directory = shaders.path();
    auto solver = make_gpu_solver(context(), model, options);
    ASSERT_TRUE(solver.ok()) << solver.error().message();
    const auto done = (*solver)->advance(50);
    ASSERT_FALSE(done.ok()) << kernel;
    EXPECT_EQ(done.error().code, ErrorCode::no_device) << kernel;
    EXPECT_THAT(done.error().message(), HasSubstr("does not run")) << kernel;
  }
}

// Explicit methods wait for nothing, and would go on with whatever memory held.
TEST_F(FaultySolverGl, ADeviceThatDropsExplicitPassesEndsTheRun) {
  struct Dropped {
    const char* kernel;
    ForcePath path;
  };
  for (const auto& [kernel, path] : {Dropped{"gather", ForcePath::gather},
                                     {"spring_forces", ForcePath::per_spring},
                                     {"sum_springs", ForcePath::per_spring},
                                     {"ball_fly", ForcePath::gather}}) {
    const test::TemporaryDirectory shaders;
    std::filesystem::create_directory(shaders.path() / "compute");
    shaders.write(
        std::string("compute/") + kernel + ".comp",
        "layout(local_size_x = 64) in;\nlayout(location = 0) uniform uint a;\n"
        "layout(location = 1) uniform uint b;\nlayout(location = 2) uniform uint c;\nvoid main() {}\n");
    const Model model = scene(Integrator::midpoint);
    GpuOptions options;
    options.shader_directory = shaders.path();
    options.force_path = path;
    auto solver = make_gpu_solver(context(), model, options);
    ASSERT_TRUE(solver.ok()) << solver.error().message();
    for (const std::uint64_t steps : {1u, 50u}) {
      const auto done = (*solver)->advance(steps);
      ASSERT_FALSE(done.ok()) << kernel;
      EXPECT_EQ(done.error().code, ErrorCode::no_device) << kernel;
      EXPECT_THAT(done.error().message(), HasSubstr("not usable")) << kernel;
    }
  }
}

// Some of a pass alone: the first particle is carried out, and later ones are not.
TEST_F(FaultySolverGl, ADeviceThatDropsAPartOfAPassEndsTheRun) {
  for (const auto& [integrator, kernel] : {std::pair{Integrator::explicit_euler, "gather"},
                                           {Integrator::implicit_euler, "implicit_direction"}}) {
    const std::string path = std::string("compute/") + kernel + ".comp";
    const auto text = gl::ShaderLibrary().read(path);
    ASSERT_TRUE(text.ok());
    std::string cut = *text;
    const std::size_t main_at = cut.find("void main() {\n");
    ASSERT_NE(main_at, std::string::npos);
    cut.insert(main_at + std::string_view("void main() {\n").size(), "  if (item_index() >= 64u) return;\n");
    const test::TemporaryDirectory shaders;
    std::filesystem::create_directory(shaders.path() / "compute");
    shaders.write(path, cut);
    Model model = test::build(test::cube_on_plane(6, 0.99));
    model.simulation.integrator = integrator;
    GpuOptions options;
    options.shader_directory = shaders.path();
    options.force_path = ForcePath::gather;
    auto solver = make_gpu_solver(context(), model, options);
    ASSERT_TRUE(solver.ok()) << solver.error().message();
    const auto done = (*solver)->advance(20);
    ASSERT_FALSE(done.ok()) << kernel;
    EXPECT_EQ(done.error().code, ErrorCode::no_device) << kernel;
    EXPECT_THAT(done.error().message(), HasSubstr("not usable")) << kernel;
  }
}

TEST_F(FaultySolverGl, RunningOutOfMemoryAtWorkIsNoticed) {
  for (const Case& c : cases) {
    gl::Context& device = own();
    const Model model = scene(c.integrator);
    auto solver = std::move(make(device, model, c)).value();
    ASSERT_TRUE(solver->advance(2).ok());
    device.inject_fault(Fault::out_of_memory);
    const auto advanced = solver->advance(2);
    ASSERT_FALSE(advanced.ok());
    EXPECT_EQ(advanced.error().code, ErrorCode::no_device);
    EXPECT_THAT(advanced.error().message(), HasSubstr("ran out of memory"));
    device.inject_fault(Fault::out_of_memory);
    EXPECT_EQ(solver->state().error().code, ErrorCode::no_device);
    // The memory is there again: so is the solver, from a state that is known to be good.
    ASSERT_TRUE(solver->load(initial_state(model, Precision::single)).ok());
    ASSERT_TRUE(solver->advance(2).ok());
    EXPECT_EQ(solver->state()->step, 2u);
  }
}

}  // namespace
}  // namespace aspic
