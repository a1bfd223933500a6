// Kernels loop no more often than every device is sure to do: at the bound they are right, past it they are
// named.
#include <glad/gl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <string>

#include "cpu_reference/reference_solver.h"
#include "device/particles.h"
#include "gpu/loop_bound.h"
#include "gpu/pass.h"
#include "gpu/program.h"
#include "gpu/shader_source.h"
#include "gpu_solver/gpu_solver.h"
#include "render/layout.h"
#include "render/model_buffers.h"
#include "render/programs.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/temporary_directory.h"
#include "support/value_of.h"

namespace aspic {
namespace {

using ::testing::HasSubstr;

class LoopBounds : public aspic::testing::GlTest {
 protected:
  /// One particle with springs to `degree` others, pinned, all at rest length.
  static Model hub(std::uint32_t degree) {
    Model model;
    for (std::uint32_t p = 0; p <= degree; ++p) {
      const double angle = 0.001 * p;
      model.initial_position.push_back(p == 0 ? Vec3{} : Vec3{std::cos(angle), std::sin(angle), 1e-5 * p});
      model.initial_velocity.push_back({});
      model.mass.push_back(p == 0 ? 100.0 : 1.0);
      model.inverse_mass.push_back(p == 0 ? 0.01 : 0.0);
    }
    SpringClass spring;
    spring.stiffness = 1.0;
    spring.damping = 0.1;
    spring.rest_length = 1.0;
    model.spring_classes.push_back(spring);
    for (std::uint32_t p = 1; p <= degree; ++p) model.listed_springs.push_back({0, p, 0});
    return model;
  }

  /// What a run of one step says with this kernel compiled for loops of one round; empty without an error.
  static std::string complaint(Model model, Integrator integrator, const std::string& kernel,
                               ForcePath path = ForcePath::gather) {
    model.simulation.integrator = integrator;
    const test::TemporaryDirectory directory;
    std::filesystem::create_directories(directory.path() / "compute");
    const std::string file = "compute/" + kernel + ".comp";
    std::ofstream(directory.path() / file) << "#define MAX_ROUNDS 1u\n" << *gl::ShaderLibrary().read(file);
    GpuOptions options;
    options.force_path = path;
    options.shader_directory = directory.path();
    const auto ran = test::value_of(make_gpu_solver(context(), model, options))->advance(1);
    if (ran.ok()) return {};
    EXPECT_EQ(ran.error().code, ErrorCode::no_device);
    return ran.error().message();
  }

  static std::string named(const std::string& kernel) { return "The kernel " + kernel + " would loop"; }

  /// 40 balls that strike one coarse face of a cube, more than a particle sorts by itself.
  static Model on_a_face() {
    ModelSettings settings = test::cube_on_plane(2, 3.0);
    settings.cubes[0].edge_length = 4.0;
    settings.balls.assign(40, {0.1, 1.0, {0.3, 5.1, 0.2}, {0.0, -1.0, 0.0}, {}});
    for (std::size_t b = 0; b < settings.balls.size(); ++b)
      settings.balls[b].position.x += 0.01 * static_cast<double>(b);
    return test::build(settings);
  }

  /// 300 balls in one place on a cube's corner.
  static Model crowd() {
    ModelSettings settings = test::cube_on_plane(3, 3.0);
    settings.contact.model = ContactModel::course;
    settings.balls.assign(300, {0.3, 1.0, {2.0, 5.2, 2.0}, {0.0, -1.0, 0.0}, {}});
    for (std::size_t b = 0; b < settings.balls.size(); ++b)
      settings.balls[b].position.x += 1e-4 * static_cast<double>(b);
    return test::build(settings);
  }
};

// What the bound rests on: this driver carries out three loops of as many rounds, of neighbors in step or
// not.
TEST_F(LoopBounds, AreWhatTheDriverDoes) {
  const test::TemporaryDirectory directory;
  std::ofstream(directory.path() / "rounds.comp") << R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Counts { uint counts[]; };
layout(location = 0) uniform uint rounds;
void main() {
  uint count = 0u, mine = rounds - gl_LocalInvocationIndex;
  for (uint loop_a = 0u; loop_a < mine; ++loop_a) count += counts[64] + 1u;
  for (uint loop_b = 0u; loop_b < mine; ++loop_b) count += counts[65] + 1u;
  for (uint loop_c = 0u; loop_c < mine; ++loop_c) count += counts[66] + 1u;
  counts[gl_LocalInvocationIndex] = count;
}
)";
  const auto program = gl::Program::compute(context(), gl::ShaderLibrary(directory.path()), "rounds.comp");
  ASSERT_TRUE(program.ok()) << program.error().message();
  auto counts = std::move(gl::Buffer::create(context(), "counts", std::uint64_t{4} * 67)).value();
  const auto count = [&](std::uint32_t rounds) {
    counts.clear();
    program->set(0, rounds);
    gl::Pass(*program, {{0, &counts}}, gl::ReadBy::read_back).dispatch_for(64);
    return counts.download_items<std::uint32_t>(64);
  };
  const auto done = count(gl::max_rounds);
  for (std::uint32_t i = 0; i < 64; ++i) EXPECT_EQ(done[i], 3 * (gl::max_rounds - i));
  // On record: how far it goes.
  RecordProperty("rounds-of-300000", std::to_string(count(100000)[0]));
}

TEST_F(LoopBounds, ArePlacedInEveryKernelThatNeedsOne) {
  const Model cube = test::build(test::cube_on_plane(3));
  ModelSettings course = test::cube_on_plane(3);
  course.contact.model = ContactModel::course;
  EXPECT_THAT(complaint(cube, Integrator::midpoint, "gather"), HasSubstr(named("gather")));
  EXPECT_THAT(complaint(cube, Integrator::midpoint, "sum_springs", ForcePath::per_spring),
              HasSubstr(named("sum_springs")));
  EXPECT_THAT(complaint(test::build(course), Integrator::implicit_euler, "implicit_begin"),
              HasSubstr(named("implicit_begin")));
  const Model landed = test::build(test::cube_on_plane(3, 0.99));  // a fall takes no conjugate gradients
  for (const char* kernel : {"implicit_evaluate", "implicit_apply"}) {
    EXPECT_THAT(complaint(landed, Integrator::implicit_euler, kernel), HasSubstr(named(kernel)));
  }
  for (const Integrator integrator : {Integrator::midpoint, Integrator::implicit_euler}) {
    for (const char* kernel :
         {"ball_find", "ball_gather", "ball_partials", "ball_exchange", "ball_particles"}) {
      EXPECT_THAT(complaint(crowd(), integrator, kernel), HasSubstr(named(kernel)));
    }
    for (const char* kernel : {"ball_face_find", "ball_face_gather"})
      EXPECT_THAT(complaint(on_a_face(), integrator, kernel), HasSubstr(named("ball_faces"))) << kernel;
  }
}

TEST_F(LoopBounds, LetPassWhatStaysBelow) {
  for (const char* kernel : {"ball_fly", "ball_clear", "ball_insert", "ball_near", "ball_tally"}) {
    EXPECT_EQ(complaint(crowd(), Integrator::midpoint, kernel), "") << kernel;
  }
}

// As many springs at one particle as a loop may go over, and one more.
TEST_F(LoopBounds, OfSpringsAtOneParticle) {
  for (const Integrator integrator : {Integrator::midpoint, Integrator::implicit_euler}) {
    for (const ForcePath path : {ForcePath::gather, ForcePath::per_spring}) {
      if (integrator == Integrator::implicit_euler && path == ForcePath::per_spring) continue;  // refused
      GpuOptions options;
      options.force_path = path;
      Model model = hub(gl::max_rounds);
      model.simulation.integrator = integrator;
      model.simulation.gravity = {0.0, -9.8, 0.0};
      auto reference = std::move(make_reference_solver(model, Precision::single)).value();
      auto solver = test::value_of(make_gpu_solver(context(), model, options));
      ASSERT_FALSE((*reference->advance(3)).divergence.has_value());
      const auto advanced = solver->advance(3);
      ASSERT_TRUE(advanced.ok()) << advanced.error().message();
      EXPECT_EQ(*solver->state(), *reference->state());

      model = hub(gl::max_rounds + 1);
      model.simulation.integrator = integrator;
      auto refused = test::value_of(make_gpu_solver(context(), model, options))->advance(1);
      ASSERT_FALSE(refused.ok());
      EXPECT_THAT(refused.error().message(), HasSubstr("the springs of one particle"));
    }
  }
}

// Every stage of every integrator goes over all terrains, of which there are 64 at most, and so does a ball.
TEST_F(LoopBounds, OfTerrains) {
  for (const Integrator integrator : {Integrator::runge_kutta_4, Integrator::implicit_euler}) {
    for (const ContactModel contact : {ContactModel::coulomb, ContactModel::course}) {
      ModelSettings settings = test::cube_on_plane(4, 1.02);
      settings.simulation.integrator = integrator;
      settings.contact.model = contact;
      while (settings.terrain.size() < 64) {
        TerrainSettings sphere;
        sphere.shape = TerrainShape::sphere;
        sphere.geometry["center"] = Vec3{0.1 * static_cast<double>(settings.terrain.size()), -2.0, 0.0};
        sphere.geometry["radius"] = 1.0 + 0.01 * static_cast<double>(settings.terrain.size() % 5);
        settings.terrain.push_back(sphere);
      }
      settings.balls.push_back({0.5, 2.0, {3.0, -0.4, 0.0}, {-1.0, -1.0, 0.0}, {}});
      const Model model = test::build(settings);
      auto reference = std::move(make_reference_solver(model, Precision::single)).value();
      auto solver = test::value_of(make_gpu_solver(context(), model));
      ASSERT_FALSE((*reference->advance(50)).divergence.has_value());
      ASSERT_FALSE((*solver->advance(50)).divergence.has_value());
      EXPECT_EQ(*solver->state(), *reference->state());
    }
  }
}

// A reduction over more than 65,536 particles has three levels.
TEST_F(LoopBounds, OfReductions) {
  std::vector<Vec3> positions, velocities;
  for (int p = 0; p < 140000; ++p) {
    positions.push_back({0.01 * p, 0.0, 0.0});
    velocities.push_back({0.0, 0.001 * (p % 1000), 0.0});
  }
  Model model = test::particles(std::move(positions), velocities);
  model.simulation.integrator = Integrator::implicit_euler;
  auto reference = std::move(make_reference_solver(model, Precision::single)).value();
  auto solver = test::value_of(make_gpu_solver(context(), model));
  ASSERT_FALSE((*reference->advance(2)).divergence.has_value());
  ASSERT_FALSE((*solver->advance(2)).divergence.has_value());
  EXPECT_EQ(*solver->state(), *reference->state());
}

// Images: their kernels go over lists that the host has made, which looks at them first.
TEST_F(LoopBounds, OfImages) {
  EXPECT_TRUE(gl::check_loop("k", "n", gl::max_rounds).ok());
  const Status over = gl::check_loop("normals", "the faces at one particle", gl::max_rounds + 1);
  ASSERT_FALSE(over.ok());
  EXPECT_THAT(over.error().message(), HasSubstr("The kernel normals would loop over the faces"));
  for (const std::uint32_t springs : {gl::max_rounds, gl::max_rounds + 1}) {
    const Model model = hub(springs);
    auto buffers = ModelBuffers::create(context(), model);
    ASSERT_TRUE(buffers.ok()) << buffers.error().message();
    const Status ready = buffers->prepare_incident(context(), model, {});
    EXPECT_EQ(ready.ok(), springs == gl::max_rounds);
    EXPECT_THAT(ready.ok() ? named("quantity") : ready.error().message(), HasSubstr(named("quantity")));
  }
}

/// A frame block for `particles` that shows `mode`, lights looking along z and along x.
gl::Buffer frame_of(gl::Context& context, std::uint32_t particles, std::uint32_t mode) {
  render_layout::Frame frame{};
  frame.lights[LIGHT_SUN] = glm::mat4(1.0f);
  frame.lights[LIGHT_SKY] = glm::mat4(0.0f);  // the world's y, z, x are the light's x, y, z
  frame.lights[LIGHT_SKY][1][0] = frame.lights[LIGHT_SKY][2][1] = frame.lights[LIGHT_SKY][0][2] = 1.0f;
  frame.particle_count = particles;
  frame.color_mode = mode;
  return std::move(gl::Buffer::of(context, "frame", std::span(&frame, 1), gl::BufferKind::uniform)).value();
}

// One group, whose invocations take as many particles for both lights as a kernel may take rounds. What lies
// farthest out comes in their last round.
TEST_F(LoopBounds, OfTheBoxOfAllParticles) {
  const std::uint32_t group = 64, rounds = gl::max_rounds / LIGHTS, particles = group * rounds;
  ASSERT_TRUE(gl::check_loop("bounds", "particles", std::uint64_t{LIGHTS} * rounds).ok());
  const std::array<float, 3> lowest = {-3.25f, -1.5f, -7.125f}, highest = {2.75f, 11.5f, 0.0625f};
  std::vector<std::array<float, 8>> items(particles, {0.5f, 0.25f, -0.125f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f});
  for (std::size_t c = 0; c < 3; ++c) {
    items[particles - 1 - c][c] = lowest[c];
    items[particles - group + c][c] = highest[c];
  }
  const auto state = std::move(gl::Buffer::of(context(), "particles", items)).value();
  const gl::Buffer frame = frame_of(context(), particles, COLOR_MATERIAL);
  std::array<render_layout::Bounds, LIGHTS> found;
  found.fill({glm::uvec4(0xffffffffu), glm::uvec4(0u)});
  const auto bounds = std::move(gl::Buffer::of(context(), "bounds", found)).value();
  const RenderPrograms programs = RenderPrograms::create(context(), gl::ShaderLibrary());
  ASSERT_EQ(programs.bounds.get().group_size()[0], group);
  gl::Pass(programs.bounds,
           {{BINDING_PARTICLES, &state},
            {BINDING_BOUNDS, &bounds},
            {BINDING_FRAME, &frame, gl::BufferKind::uniform}},
           gl::ReadBy::read_back)
      .dispatch_for(group);
  const auto ordered = [](float value) {  // shaders/render/bounds.glsl
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
  };
  const auto boxes = bounds.download_items<render_layout::Bounds>(LIGHTS);
  for (int c = 0; c < 3; ++c) {
    const auto world = static_cast<std::size_t>(c), turned = static_cast<std::size_t>((c + 1) % 3);
    EXPECT_EQ(boxes[LIGHT_SUN].lower[c], ordered(lowest[world]));
    EXPECT_EQ(boxes[LIGHT_SUN].upper[c], ordered(highest[world]));
    EXPECT_EQ(boxes[LIGHT_SKY].lower[c], ordered(lowest[turned]));
    EXPECT_EQ(boxes[LIGHT_SKY].upper[c], ordered(highest[turned]));
  }
}

// As many springs at one particle as a kernel may take rounds, of which the last pulls hardest by far.
TEST_F(LoopBounds, OfTheForceThatIsDrawn) {
  const Model model = hub(gl::max_rounds);
  State state = initial_state(model, Precision::single);
  state.position.back() = {0.0, 1e6, 0.0};
  Vec3 sum;
  double others = 0.0;
  for (std::size_t p = 1; p < state.position.size(); ++p) {
    const double L = length(state.position[p]);
    sum = sum + ((L - 1.0) / L) * state.position[p];  // k = 1 N/m, r = 1 m
    if (p < gl::max_rounds) others += std::abs(L - 1.0);
  }
  const auto items = packed_particles(model, state);
  const auto particles = std::move(gl::Buffer::of(context(), "particles", items)).value();
  const DeviceState shown = {.particles = &particles};
  auto buffers = std::move(ModelBuffers::create(context(), model)).value();
  ASSERT_TRUE(buffers.prepare_incident(context(), model, shown).ok());
  const RenderPrograms programs = RenderPrograms::create(context(), gl::ShaderLibrary());
  const gl::Buffer frame = frame_of(context(), model.particle_count(), COLOR_FORCE);
  frame.bind(gl::BufferKind::uniform, BINDING_FRAME);
  buffers.compute_quantity(programs, shown);
  const auto force = static_cast<double>(buffers.quantity().download_items<float>(1).front());
  // Each addition rounds what the others have come to; the last spring's force and the result take a few
  // more.
  EXPECT_NEAR(force, length(sum), 0x1p-24 * (gl::max_rounds * others + 8 * length(sum)));
  EXPECT_GT(length(sum), 100 * others);
}

}  // namespace
}  // namespace aspic
