// A device that is lost at each dispatch in turn, of every kind of scene: from then on nothing runs and
// read-backs are all ones. Each call must end with the sentence about the loss, and nothing read back may
// come out as a result.
#include <gmock/gmock.h>

#include "gpu_solver/gpu_solver.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"

namespace aspic {
namespace {

using gl::Fault;
using ::testing::HasSubstr;

struct Case {
  const char* name;
  Integrator integrator;
  ForcePath path = ForcePath::gather;
  int balls = 0;
  BallSearch search = BallSearch::automatic;
};
constexpr Case cases[] = {
    {"ExplicitEuler", Integrator::explicit_euler},
    {"RungeKutta4PerSpring", Integrator::runge_kutta_4, ForcePath::per_spring},
    {"ImplicitEuler", Integrator::implicit_euler},
    {"ImplicitEulerOnePass", Integrator::implicit_euler_one_pass},
    {"BallsAllPairs", Integrator::symplectic_euler, ForcePath::gather, 3, BallSearch::all_pairs},
    {"BallsGrid", Integrator::explicit_euler, ForcePath::gather, 3, BallSearch::grid},
    {"ImplicitEulerWithBalls", Integrator::implicit_euler, ForcePath::gather, 2, BallSearch::grid},
};
constexpr std::uint64_t steps = 3;

class LostDeviceGl : public aspic::testing::GlTest, public ::testing::WithParamInterface<Case> {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    auto made = gl::Context::create_headless({.debug = true, .device = aspic::testing::test_device()});
    ASSERT_TRUE(made.ok()) << made.error().message();
    device_ = std::move(*made);
    ModelSettings settings = test::cube_on_plane(3, 1.9);
    settings.simulation.integrator = GetParam().integrator;
    for (int b = 0; b < GetParam().balls; ++b)
      settings.balls.push_back({0.5, 2.0, {0.9 * b, 4.2, 0.1}, {0.0, -9.0, 0.0}, {}});
    model_ = test::build(settings);
  }
  void TearDown() override {
    device_.reset();
    ASSERT_TRUE(context().make_current().ok());
    GlTest::TearDown();
  }

  Result<std::unique_ptr<GpuSolver>> make() {
    GpuOptions options;
    options.force_path = GetParam().path;
    options.ball_search = GetParam().search;
    return make_gpu_solver(*device_, model_, options);
  }

  static void expect_loss(const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::no_device);
    EXPECT_THAT(error.message(), HasSubstr("was reset or lost"));
  }

  std::shared_ptr<gl::Context> device_;
  Model model_;
};

TEST_P(LostDeviceGl, EndsEveryRunWithASentenceWhicheverPassItStrikes) {
  auto made = make();
  ASSERT_TRUE(made.ok()) << made.error().message();
  GpuSolver& solver = **made;
  const std::uint64_t before = device_->dispatches();
  ASSERT_TRUE(solver.advance(steps).ok());
  const State wanted = *solver.state();
  const std::uint64_t passes = device_->dispatches() - before;
  ASSERT_GE(passes, steps);

  const State start = initial_state(model_, Precision::single);
  for (std::uint64_t n = 0; n < passes; ++n) {
    SCOPED_TRACE(n);
    ASSERT_TRUE(solver.load(start).ok());
    device_->inject_fault(Fault::lost_at_dispatch, n);
    const auto advanced = solver.advance(steps);
    if (advanced.ok()) {
      // How many passes an implicit solver queues depends on the solves before: the last ones may not come.
      device_->take_back_faults();
      EXPECT_GE(n, passes / 2);
      EXPECT_EQ(*solver.state(), wanted);
      continue;
    }
    expect_loss(advanced.error());
    expect_loss(solver.state().error());
    expect_loss(solver.load(start).error());
    expect_loss(solver.advance(1).error());
    expect_loss(make().error());
    device_->take_back_faults();
  }
  // What was lost was the device, not the solver: from a good state it gives the same bits as ever.
  ASSERT_TRUE(solver.load(start).ok());
  ASSERT_TRUE(solver.advance(steps).ok());
  EXPECT_EQ(*solver.state(), wanted);
}

// Between steps too: what was read before the loss stays good, and no later step is told.
TEST_P(LostDeviceGl, EndsARunThatLooksAfterEachStep) {
  auto made = make();
  ASSERT_TRUE(made.ok()) << made.error().message();
  GpuSolver& solver = **made;
  const std::uint64_t before = device_->dispatches();
  std::vector<State> wanted;
  for (std::uint64_t s = 0; s < steps; ++s) {
    ASSERT_TRUE(solver.advance(1).ok());
    wanted.push_back(*solver.state());
  }
  const std::uint64_t passes = device_->dispatches() - before;
  const State start = initial_state(model_, Precision::single);
  for (std::uint64_t n = 0; n < passes; ++n) {
    SCOPED_TRACE(n);
    ASSERT_TRUE(solver.load(start).ok());
    device_->inject_fault(Fault::lost_at_dispatch, n);
    for (std::uint64_t s = 0; s < steps; ++s) {
      const auto advanced = solver.advance(1);
      const auto state = solver.state();
      if (!advanced.ok()) {
        expect_loss(advanced.error());
        expect_loss(state.error());
        break;
      }
      ASSERT_TRUE(state.ok());
      EXPECT_EQ(*state, wanted[s]) << "step " << s;
    }
    device_->take_back_faults();
  }
}

// The passes that ask a device about its arithmetic, before the first step.
TEST_P(LostDeviceGl, IsNoticedWhileASolverIsMade) {
  const std::uint64_t before = device_->dispatches();
  ASSERT_TRUE(make().ok());
  const std::uint64_t passes = device_->dispatches() - before;
  EXPECT_GE(passes, 1u);
  for (std::uint64_t n = 0; n < passes; ++n) {
    SCOPED_TRACE(n);
    device_->inject_fault(Fault::lost_at_dispatch, n);
    const auto made = make();
    ASSERT_FALSE(made.ok());
    expect_loss(made.error());
    EXPECT_EQ(device_->bytes_held(), 0u);
    device_->take_back_faults();
  }
  ASSERT_TRUE(make().ok());
}

INSTANTIATE_TEST_SUITE_P(Scenes, LostDeviceGl, ::testing::ValuesIn(cases),
                         [](const auto& chosen) { return chosen.param.name; });

}  // namespace
}  // namespace aspic
