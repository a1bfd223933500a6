// Where a device ends: groups, memory, and more groups than one dimension has.
#include <gmock/gmock.h>

#include "cpu_reference/reference_solver.h"
#include "gpu/pass.h"
#include "gpu_solver/capacity.h"
#include "gpu_solver/gpu_solver.h"
#include "gpu_solver/group_size.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"

namespace aspic {
namespace {

using ::testing::HasSubstr;

class LimitsGl : public aspic::testing::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    own_limits();
  }
  void TearDown() override {
    context().assume_free_memory(std::nullopt);
    context().assume_limits(own_limits());
    GlTest::TearDown();
  }
  /// What the device takes.
  static const gl::DeviceLimits& own_limits() {
    static const gl::DeviceLimits limits = context().info().limits;
    return limits;
  }
};

TEST_F(LimitsGl, GroupsThatTheDeviceDoesNotTakeAreRefused) {
  const Model model = test::build(test::cube_on_plane(3));
  const std::uint32_t most = context().info().limits.group_invocations;
  GpuOptions options;
  options.group_size = most + 1;
  const auto refused = make_gpu_solver(context(), model, options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::no_device);
  EXPECT_THAT(refused.error().message(), HasSubstr("work groups of 1 to"));
  EXPECT_THAT(refused.error().message(), HasSubstr(std::to_string(most + 1)));
  options.group_size = most;
  EXPECT_TRUE(make_gpu_solver(context(), model, options).ok());
}

TEST(GroupSize, DependsOnTheDevice) {
  gl::DeviceInfo device;
  device.limits.group_invocations = 1024;
  device.limits.group_size = {1024, 1024, 64};
  EXPECT_EQ(group_size_on(device), 256u);
  device.limits.group_invocations = 128;
  EXPECT_EQ(group_size_on(device), 128u);
  device.is_software = true;
  EXPECT_EQ(group_size_on(device), 64u);
}

TEST_F(LimitsGl, ASceneThatNeedsMoreThanIsFreeIsRefusedBeforeAnythingIsAllocated) {
  const Model model = test::build(test::cube_on_plane(8));
  const std::uint64_t needed = gpu_bytes(model, ForcePath::automatic);
  context().assume_free_memory(needed - 1);
  EXPECT_EQ(context().free_memory(), needed - 1);
  const std::uint64_t held = context().bytes_held();
  const auto refused = make_gpu_solver(context(), model, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::scene_rejected);
  EXPECT_THAT(refused.error().message(), HasSubstr(std::to_string(needed) + " bytes"));
  EXPECT_THAT(refused.error().message(), HasSubstr("are free"));
  EXPECT_EQ(context().bytes_held(), held);
  context().assume_free_memory(needed);
  const auto first = make_gpu_solver(context(), model, {});
  ASSERT_TRUE(first.ok()) << first.error().message();
  // A solver that shares the springs of another needs no memory for them.
  GpuOptions sharing;
  sharing.share_springs_of = first->get();
  context().assume_free_memory(needed - (*first)->spring_buffers()->bytes());
  EXPECT_TRUE(make_gpu_solver(context(), model, sharing).ok());
}

// The largest cube that is foretold is taken, and one a little larger is not.
TEST_F(LimitsGl, TheLargestCubeOfEachPathIsForetold) {
  gl::DeviceLimits limits = own_limits();
  limits.buffer_bytes = 8u << 20;
  limits.storage_block_bytes = 2u << 20;
  context().assume_limits(limits);
  for (const Integrator integrator : {Integrator::explicit_euler, Integrator::implicit_euler}) {
    for (const CubeCapacity& largest : largest_cubes(limits, std::nullopt, integrator)) {
      const auto path = std::ranges::find(force_paths(), largest.force_path, &ForcePathRow::name)->path;
      EXPECT_EQ(largest.limit, CapacityLimit::block) << largest.force_path;
      for (const std::uint32_t more : {0u, 2u}) {
        ModelSettings cube = test::cube_on_plane(static_cast<int>(largest.particles_per_edge + more));
        cube.simulation.integrator = integrator;
        const Model model = test::build(cube);
        GpuOptions options;
        options.force_path = path;
        const auto made = make_gpu_solver(context(), model, options);
        EXPECT_EQ(made.ok(), more == 0) << largest.force_path << ", " << largest.particles_per_edge + more;
      }
    }
  }
}

TEST(LargestCubes, FollowBuffersBlocksMemoryAndWords) {
  gl::DeviceLimits limits;
  limits.buffer_bytes = std::uint64_t{1} << 32;
  limits.storage_block_bytes = 128u << 20;
  const auto of = [&](std::optional<std::uint64_t> free, Integrator integrator, std::string_view path) {
    for (const CubeCapacity& cube : largest_cubes(limits, free, integrator))
      if (cube.force_path == path) return cube;
    return CubeCapacity{};
  };
  const auto cube = [](std::uint64_t n) { return n * n * n; };
  EXPECT_EQ(of(std::nullopt, Integrator::midpoint, "lattice").particles_per_edge, 161u);  // 32 n³ ≤ 2²⁷
  EXPECT_EQ(of(std::nullopt, Integrator::midpoint, "gather").particles_per_edge, 101u);   // 128 n³
  EXPECT_EQ(of(std::nullopt, Integrator::implicit_euler, "lattice").particles_per_edge, 91u);  // 176 n³
  EXPECT_EQ(of(std::nullopt, Integrator::implicit_euler, "per-spring").particles_per_edge,
            0u);  // has no such path
  const CubeCapacity small = of(100 * cube(50), Integrator::explicit_euler, "lattice");
  EXPECT_EQ(small.limit, CapacityLimit::memory);
  EXPECT_EQ(small.particles_per_edge, 50u);  // 96 n³
  EXPECT_EQ(of(std::nullopt, Integrator::midpoint, "lattice").limit, CapacityLimit::block);
  limits.buffer_bytes = 64u << 20;
  EXPECT_EQ(of(std::nullopt, Integrator::midpoint, "lattice").limit, CapacityLimit::buffer);
  limits.buffer_bytes = limits.storage_block_bytes = std::uint64_t{1} << 62;
  EXPECT_EQ(of(std::nullopt, Integrator::explicit_euler, "gather").limit, CapacityLimit::words);
}

// Particles far apart, a few of them joined: more groups than the 65,535 that one dimension surely takes.
TEST_F(LimitsGl, ManyParticlesTakeTwoDimensionsOfGroups) {
  constexpr std::uint32_t count = 65535 * 64 + 64;
  ASSERT_EQ(gl::groups_for(count, 64).y, 2u);
  std::vector<Vec3> x, v;
  x.reserve(count);
  v.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t row = i / 2048, column = i % 2048;
    x.push_back({0.01 * column, 0.01 * row, 0.5});
    v.push_back({0.001 * (i % 7), -0.002 * (i % 11), 0.003 * (i % 5)});
  }
  Model model = test::particles(std::move(x), v, 0.5);
  model.spring_classes.push_back({SpringType::structural, 300.0, 2.0, 0.02, false});
  for (std::uint32_t a = 0; a + 5 < count; a += 4099) model.listed_springs.push_back({a, a + 5, 0});
  model.listed_springs.push_back({count - 3, count - 1, 0});
  auto reference = std::move(make_reference_solver(model, Precision::single)).value();
  ASSERT_FALSE((*reference->advance(2)).divergence.has_value());
  for (const ForcePath path : {ForcePath::gather, ForcePath::per_spring}) {
    GpuOptions options;
    options.force_path = path;
    auto made = make_gpu_solver(context(), model, options);
    ASSERT_TRUE(made.ok()) << made.error().message();
    ASSERT_FALSE((*(*made)->advance(2)).divergence.has_value());
    EXPECT_TRUE(*(*made)->state() == *reference->state()) << name_of(path);
  }
}

}  // namespace
}  // namespace aspic
