// A driver computes with every kernel, compiled with every set of defines in use, what the reference
// computes. These are the tests of a driver: physics is tested on one.
#include <fmt/format.h>
#include <glad/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "gpu/program.h"
#include "gpu_solver/gpu_solver.h"
#include "support/gl_fixture.h"
#include "support/golden_runs.h"
#include "support/kernel_variants.h"
#include "support/model_building.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

/// What marks a kernel that does nothing, and how many of them went to the driver.
constexpr std::string_view idle_mark = "void does_nothing_main";
int idle_kernels = 0;
PFNGLSHADERSOURCEPROC driver_shader_source = nullptr;

void GLAD_API_PTR count_idle(GLuint shader, GLsizei count, const GLchar* const* texts, const GLint* lengths) {
  std::string source;
  for (GLsizei i = 0; i < count; ++i) source.append(texts[i], static_cast<std::size_t>(lengths[i]));
  if (source.find(idle_mark) != std::string::npos) ++idle_kernels;
  driver_shader_source(shader, count, texts, lengths);
}

class Programs : public aspic::testing::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    driver_shader_source = std::exchange(glad_glShaderSource, count_idle);
  }
  void TearDown() override {
    glad_glShaderSource = driver_shader_source;
    GlTest::TearDown();
  }

  /// Fast arithmetic has no bits of its own, nor have corrections by an fma() that rounds twice.
  static bool has_bits(const test::KernelVariant& variant) {
    static const bool fused = [] {
      const auto report = gl::measure_arithmetic(context(), gl::ShaderLibrary());
      EXPECT_TRUE(report.ok());
      return report.ok() && report->fma_fused;
    }();
    if (!fused &&
        std::ranges::count(variant.options.arithmetic->defines, "ASPIC_FUSED_FMA", &gl::Define::name) > 0)
      return false;
    return variant.options.spring_arithmetic == Arithmetic::exact ||
           !row_of(variant.settings.simulation.integrator).staged();
  }

  static std::string text_of(const test::KernelVariant& variant) {
    const GpuOptions& options = variant.options;
    return fmt::format("{}, {}, path {}, work group {}, lattice run {}, {}, {} corrections, ball search {}",
                       variant.scene, name_of(variant.settings.simulation.integrator),
                       name_of(options.force_path), options.group_size, options.lattice_run,
                       name_of(options.spring_arithmetic), options.arithmetic->defines.size(),
                       static_cast<int>(options.ball_search));
  }

  /// Largest distance of a particle from itself in the other state [m].
  static double distance(const State& a, const State& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.position.size(); ++i)
      most = std::max(most, length(a.position[i] - b.position[i]));
    return most;
  }
};

TEST_F(Programs, HaveTheReferencesBits) {
  for (const test::KernelVariant& variant : test::kernel_variants()) {
    SCOPED_TRACE(text_of(variant));
    const Model model = test::build(variant.settings);
    const std::uint64_t before = context().programs().compiled();
    auto solver = make_gpu_solver(context(), model, variant.options);
    ASSERT_TRUE(solver.ok()) << solver.error().message();
    if (context().programs().compiled() == before) continue;
    const auto advanced = (*solver)->advance(variant.steps());
    ASSERT_TRUE(advanced.ok()) << advanced.error().message();
    ASSERT_FALSE(advanced->divergence.has_value());
    const test::GoldenRun run = test::golden_run(variant);
    const State state = *(*solver)->state();
    if (has_bits(variant)) {
      test::expect_golden(run, state);
      continue;
    }
    // A step adds at most 100 roundings of a coordinate below 16 m, and motion here does not grow them by
    // more than 10 in so few steps.
    const double bound = 10.0 * static_cast<double>(run.steps) * 100 * 16.0 * 0x1p-24;
    const double away = distance(state, test::reference_state(run));
    EXPECT_LE(away, bound);
  }
  std::printf("%llu programs\n", static_cast<unsigned long long>(context().programs().compiled()));
}

/// Whether a kernel that the scene has finds nothing to do in it: its two balls meet the cube's faces, no
/// particles; no body comes from afar, so that its lists are good to the end.
bool has_nothing_to_do(std::string_view kernel, const test::KernelVariant& variant) {
  constexpr std::array of_particles = {"compute/ball_clear.comp", "compute/ball_gather.comp",
                                       "compute/ball_near.comp", "compute/ball_particles.comp",
                                       "compute/ball_tally.comp"};
  if (variant.scene.ends_with("with balls")) return std::ranges::count(of_particles, kernel) > 0;
  return !variant.scene.ends_with("struck by a cube") && kernel.ends_with("contact_moved.comp");
}

// The test above means nothing for a kernel whose work does not show in the state.
TEST_F(Programs, ShowEachKernelThatDoesNothing) {
  for (const EmbeddedFile& file : embedded_shaders()) {
    if (!file.name.starts_with("compute/") || file.name.starts_with("compute/canary")) continue;
    std::string text(file.text);
    const std::size_t main = text.find("void main()");
    if (main == std::string::npos) continue;
    SCOPED_TRACE(file.name);
    text.replace(main, std::string_view("void main()").size(),
                 fmt::format("void main() {{}}\n{}()", idle_mark));
    const test::TemporaryDirectory directory;
    std::filesystem::create_directory(directory.path() / "compute");
    directory.write(std::string(file.name), text);
    int variants = 0;
    for (const test::KernelVariant& variant : test::kernel_variants()) {
      if (!has_bits(variant) || variant.settings.terrain[0].shape != TerrainShape::plane) continue;
      if (has_nothing_to_do(file.name, variant)) continue;
      const int before = idle_kernels;
      GpuOptions options = variant.options;
      options.shader_directory = directory.path();
      const Model model = test::build(variant.settings);
      auto solver = make_gpu_solver(context(), model, options);
      ASSERT_TRUE(solver.ok()) << solver.error().message();
      if (idle_kernels == before) continue;
      ++variants;
      const auto advanced = (*solver)->advance(variant.steps());
      if (!advanced.ok() || advanced->divergence.has_value()) continue;
      EXPECT_NE(state_hash_text(*(*solver)->state()), test::golden_end(test::golden_run(variant))->hash)
          << text_of(variant);
    }
    EXPECT_GT(variants, 0) << "no variant uses it";
  }
  forgive_errors();
}

}  // namespace
}  // namespace aspic
