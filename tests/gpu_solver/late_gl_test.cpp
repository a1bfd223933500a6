// Hearing of the device late, or never: queues that are looked at an image later, and a device that stops
// answering.
#include <gmock/gmock.h>

#include "cpu_reference/reference_solver.h"
#include "gpu/read_ring.h"
#include "gpu_solver/gpu_solver.h"
#include "gpu_solver/queue_depth.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/value_of.h"

namespace aspic {
namespace {

using gl::Fault;
using ::testing::HasSubstr;

class LateGl : public aspic::testing::GlTest {
 protected:
  void TearDown() override {
    context().take_back_faults();
    GlTest::TearDown();
  }
  static std::unique_ptr<GpuSolver> solver_for(const Model& model) {
    return test::value_of(make_gpu_solver(context(), model, {}));
  }
  /// A cube that diverges after some steps.
  static Model diverging() {
    ModelSettings settings = test::cube_on_plane(4, 1.2);
    settings.simulation.timestep = 0.01;
    settings.cubes[0].velocity = {1.0, -3.0, 0.5};
    return test::build(settings);
  }
};

TEST(QueueDepth, FollowsTheMeasuredTime) {
  QueueDepth depth(1000);
  EXPECT_EQ(depth.next(), 1u);
  depth.took(1, 0x1p-10);  // 51 would fit, but little is known
  EXPECT_EQ(depth.next(), 4u);
  depth.took(4, 0x1p-8);
  depth.took(16, 0x1p-6);
  EXPECT_EQ(depth.next(), 51u);
  depth.took(8, 0x1p-7);  // a few, as long as ever
  EXPECT_EQ(depth.next(), 51u);
  depth.took(50, 5.0);
  EXPECT_EQ(depth.next(), 1u);
  for (std::uint32_t n = 0; n < 20; ++n) depth.took(depth.next(), 0.0);
  EXPECT_EQ(depth.next(), 1000u);
  depth.took(0, 1.0);
  EXPECT_EQ(depth.next(), 1000u);
}

// The bits are those of a solver that waits, whatever is heard when; the end comes out of a later call.
TEST_F(LateGl, ADivergenceComesOutOfALaterAdvance) {
  const Model model = diverging();
  auto prompt = solver_for(model), late = solver_for(model);
  late->set_late(true);
  const auto expected = prompt->advance(100000)->divergence;
  ASSERT_TRUE(expected.has_value());
  ASSERT_GT(expected->step, 3u);
  ASSERT_FALSE((*late->advance(expected->step - 1)).divergence.has_value());
  EXPECT_EQ(late->state()->step, expected->step - 1);

  context().inject_fault(Fault::late);
  // One step is one queue; how many queues more would make depends on the time they take.
  ASSERT_FALSE((*late->advance(1)).divergence.has_value()) << "nothing has been heard of this step";
  EXPECT_EQ(late->device_state().step, expected->step);
  const auto found = late->advance(1)->divergence;
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->step, expected->step);
  EXPECT_EQ(found->particle, expected->particle);
  EXPECT_EQ(late->device_state().step, expected->step - 1);
  EXPECT_EQ(*late->state(), *prompt->state());

  // state() waits, and what it finds is told by the next call.
  ASSERT_TRUE(late->load(initial_state(model, Precision::single)).ok());
  ASSERT_FALSE((*late->advance(expected->step - 1)).divergence.has_value());
  ASSERT_TRUE(late->state().ok());
  context().inject_fault(Fault::late);
  ASSERT_FALSE((*late->advance(1)).divergence.has_value());
  EXPECT_EQ(*late->state(), *prompt->state());
  EXPECT_EQ((*late->advance(0)).divergence->step, expected->step);
}

// Contacts that find no room make steps be repeated, also those that a late look finds, under the pull they
// had.
TEST_F(LateGl, RepeatedStepsKeepTheirPull) {
  ModelSettings settings = test::cube_on_plane(6, 1.6);
  for (int n = 0; n < 40; ++n)
    settings.balls.push_back({0.3, 0.5, {0.01 * n, 2.8, 0.005 * n}, {0.0, -6.0, 0.0}, {}});
  const Model model = test::build(settings);
  auto late = solver_for(model);
  late->set_late(true);
  auto reference = std::move(make_reference_solver(model, Precision::single)).value();
  for (std::uint32_t n = 0; n < 12; ++n) {
    const std::optional<Pull> pull = Pull{5 * n, {1.0, 3.0, -0.1 * n}, 700.0, 10.0};
    ASSERT_TRUE(late->set_inputs(inputs_of(pull)).ok());
    ASSERT_TRUE(reference->set_inputs(inputs_of(pull)).ok());
    context().inject_fault(Fault::late);
    ASSERT_FALSE((*late->advance(4)).divergence.has_value());
    ASSERT_FALSE((*reference->advance(4)).divergence.has_value());
  }
  EXPECT_EQ(*late->state(), *reference->state());
}

// Implicit Euler does not wait for its solves: steps are queued behind steps of which nothing is known yet,
// fewer rounds than they take among them, terrain moves, hands pull, and the bits and the counts of
// iterations are those of the reference.
TEST_F(LateGl, ImplicitEulerQueuesBehindStepsOfWhichItHasNotHeard) {
  ModelSettings settings = test::cube_on_plane(5, 1.1);
  settings.cubes[0].velocity = {0.3, -3.0, 0.1};
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 1.0 / 60.0;
  settings.terrain[0].motion = TerrainMotion{{0.1, 1.0, 0.0}, 0.2, 0.9, 0.1};
  for (const bool balls : {false, true}) {
    if (balls) {
      for (int n = 0; n < 40; ++n)
        settings.balls.push_back({0.3, 0.5, {0.01 * n, 2.8, 0.005 * n}, {0.0, -6.0, 0.0}, {}});
    }
    const Model model = test::build(settings);
    auto late = solver_for(model);
    late->set_late(true);
    auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    for (std::uint32_t n = 0; n < 20; ++n) {
      if (n % 5 == 4) {
        const Pull pull = {3 * n, {0.5, 2.0, -0.1}, 300.0, 10.0};
        ASSERT_TRUE(late->set_inputs(inputs_of(pull)).ok());
        ASSERT_TRUE(reference->set_inputs(inputs_of(pull)).ok());
      }
      context().inject_fault(Fault::late, n % 3);
      ASSERT_FALSE((*late->advance(1 + n % 3)).divergence.has_value());
      ASSERT_FALSE((*reference->advance(1 + n % 3)).divergence.has_value());
      context().take_back_faults();
      EXPECT_EQ(late->device_state().step, reference->state()->step);
    }
    EXPECT_EQ(*late->state(), *reference->state());
    const auto expected = reference->solve_statistics(), got = late->solve_statistics();
    ASSERT_TRUE(expected && got);
    EXPECT_EQ(got->steps, expected->steps);
    EXPECT_EQ(got->newton_iterations, expected->newton_iterations);
    EXPECT_EQ(got->cg_iterations, expected->cg_iterations);
  }
}

TEST_F(LateGl, ImplicitEulerReturnsBeforeTheDeviceIsDone) {
  ModelSettings settings = test::cube_on_plane(6, 0.99);
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 1.0 / 60.0;
  const Model model = test::build(settings);
  auto late = solver_for(model);
  late->set_late(true);
  context().inject_fault(Fault::late);
  ASSERT_FALSE((*late->advance(1)).divergence.has_value());
  EXPECT_EQ(late->device_state().step, 1u);
  EXPECT_EQ(late->solve_statistics()->steps, 0u) << "nothing has been heard of it";
  ASSERT_TRUE(late->state().ok());
  EXPECT_EQ(late->solve_statistics()->steps, 1u);
}

TEST_F(LateGl, NoMoreThanTwoQueuesAreUnderWay) {
  const Model model = test::build(test::cube_on_plane(4, 1.2));
  auto late = solver_for(model);
  late->set_late(true);
  context().inject_fault(Fault::late);
  ASSERT_FALSE((*late->advance(1)).divergence.has_value());
  // With a second one queued, the first is waited for, which takes a wait that never ends.
  context().inject_fault(Fault::late);
  context().inject_fault(Fault::no_answer);
  const auto second = late->advance(1);
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().code, ErrorCode::no_device);
}

TEST_F(LateGl, ADeviceThatStopsAnsweringEndsTheRun) {
  for (const Integrator integrator : {Integrator::explicit_euler, Integrator::implicit_euler}) {
    Model model = test::build(test::cube_on_plane(4, 1.2));
    model.simulation.integrator = integrator;
    auto solver = solver_for(model);
    ASSERT_TRUE(solver->advance(3).ok());
    context().inject_fault(Fault::no_answer);
    const auto advanced = solver->advance(3);
    ASSERT_FALSE(advanced.ok());
    EXPECT_EQ(advanced.error().code, ErrorCode::no_device);
    EXPECT_THAT(advanced.error().message(), HasSubstr("has not answered for"));
    EXPECT_FALSE(solver->state().ok());
    EXPECT_TRUE(context().lost());
    context().take_back_faults();
    context().inject_fault(Fault::no_answer);
    EXPECT_FALSE(solver->state().ok());
    context().take_back_faults();
  }
}

TEST_F(LateGl, AReadRingBringsCopiesInTheirOrder) {
  auto source = std::move(gl::Buffer::create(context(), "numbers", 64)).value();
  gl::ReadRing ring(context(), 8);
  for (std::uint32_t round = 0; round < 3; ++round) {
    for (std::uint32_t n = 0; n < gl::ReadRing::capacity; ++n) {
      const std::uint32_t number = 10 * round + n;
      source.upload_items(std::span(&number, 1), 3);
      ring.submit(source, 12, 4);
    }
    EXPECT_TRUE(ring.full());
    context().inject_fault(Fault::late);
    EXPECT_FALSE(ring.ready());
    for (std::uint32_t n = 0; n < gl::ReadRing::capacity; ++n) {
      std::uint32_t number = 0;
      ring.take(std::as_writable_bytes(std::span(&number, 1)));
      EXPECT_EQ(number, 10 * round + n);
    }
    EXPECT_EQ(ring.pending(), 0u);
  }
  ring.submit(source, 0, 8);
  ring.forget();
  EXPECT_EQ(ring.pending(), 0u);
}

// Larger than the copies a download is made of.
TEST_F(LateGl, LargeDownloadsComeWholeAndInOrder) {
  std::vector<std::uint32_t> numbers(gl::read_part_bytes * 9 / 8);
  for (std::size_t n = 0; n < numbers.size(); ++n) numbers[n] = static_cast<std::uint32_t>(n);
  const auto buffer = std::move(gl::Buffer::of(context(), "numbers", numbers)).value();
  EXPECT_EQ(buffer.download_items<std::uint32_t>(numbers.size()), numbers);
}

}  // namespace
}  // namespace aspic
