// Khronos' reference compiler accepts every shader of the project with every set of defines that solvers and
// images compile it with: a driver that reads the language more strictly than Mesa does finds nothing to
// refuse.
#include <fmt/format.h>
#include <glad/gl.h>
#include <gmock/gmock.h>

#include <cstdio>
#include <map>
#include <memory>
#include <set>

#include "gpu/canary.h"
#include "gpu/portable_lint.h"
#include "gpu_solver/gpu_solver.h"
#include "model/terrain.h"
#include "render/programs.h"
#include "render/studio.h"
#include "support/kernel_variants.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

/// The sources that went to the driver, by stage.
std::map<GLenum, std::set<std::string>> seen;
PFNGLSHADERSOURCEPROC driver_shader_source = nullptr;
/// What the driver warned of.
std::set<std::string> warnings;
PFNGLCOMPILESHADERPROC driver_compile_shader = nullptr;

void GLAD_API_PTR record(GLuint shader, GLsizei count, const GLchar* const* texts, const GLint* lengths) {
  GLint kind = 0;
  glGetShaderiv(shader, GL_SHADER_TYPE, &kind);
  std::string source;
  for (GLsizei i = 0; i < count; ++i) source.append(texts[i], static_cast<std::size_t>(lengths[i]));
  seen[static_cast<GLenum>(kind)].insert(std::move(source));
  driver_shader_source(shader, count, texts, lengths);
}

void GLAD_API_PTR compile(GLuint shader) {
  driver_compile_shader(shader);
  char log[1024];
  GLsizei length = 0;
  glGetShaderInfoLog(shader, sizeof log, &length, log);
  if (length > 0) warnings.insert(log);
}

std::string_view word_of(GLenum kind) {
  switch (kind) {
    case GL_COMPUTE_SHADER:
      return "comp";
    case GL_VERTEX_SHADER:
      return "vert";
    case GL_GEOMETRY_SHADER:
      return "geom";
    default:
      return "frag";
  }
}

class Glslang : public aspic::testing::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    // Other tests' context has compiled much of this already.
    auto made = gl::Context::create_headless({.debug = true, .device = aspic::testing::test_device()});
    ASSERT_TRUE(made.ok()) << made.error().message();
    own_ = std::move(made).value();
    driver_shader_source = std::exchange(glad_glShaderSource, record);
    driver_compile_shader = std::exchange(glad_glCompileShader, compile);
  }
  void TearDown() override {
    glad_glShaderSource = driver_shader_source;
    glad_glCompileShader = driver_compile_shader;
    own_.reset();
    GlTest::TearDown();
  }

  /// Compiles what solvers need.
  void compile_solvers() {
    std::set<std::size_t> arithmetic;  // by number of defines
    for (const test::KernelVariant& variant : test::kernel_variants()) {
      const Model model = test::build(variant.settings);
      const auto solver = make_gpu_solver(*own_, model, variant.options);
      ASSERT_TRUE(solver.ok()) << solver.error().message();
      const std::vector<gl::Define>& defines = variant.options.arithmetic->defines;
      if (!arithmetic.insert(defines.size()).second) continue;
      ASSERT_TRUE(gl::measure_arithmetic(*own_, gl::ShaderLibrary{}, defines).ok());
      ASSERT_TRUE(gl::try_mantissas(*own_, gl::ShaderLibrary{}, defines).ok());
    }
  }

  void compile_images() {
    ModelSettings settings = test::cube_on_plane(3);
    settings.balls.emplace_back();
    settings.goal_nets.emplace_back();
    settings.terrain.clear();
    for (const TerrainShapeRow& shape : terrain_shapes) settings.terrain.emplace_back().shape = shape.value;
    const Model model = test::build(settings);
    auto renderer = Renderer::create(*own_);
    ASSERT_TRUE(renderer.ok()) << renderer.error().message();
    ASSERT_TRUE((*renderer)->set_model(model).ok());
    const auto state = (*renderer)->upload(initial_state(model, Precision::single));
    ASSERT_TRUE(state.ok());
    ImageOptions options;
    options.view.draw = {
        .solid = true, .particles = true, .structural = true, .shear = true, .bending = true};
    options.view.color = ViewColor::strain;
    options.view.cut.inside = CutInside::section;
    options.view.arrows.net = true;
    options.arrows.arrows = {{{}, {0.0, 1.0, 0.0}, ArrowKind::net}};
    options.highlight.emplace() = {.hovered = 0, .pull = HighlightOptions::Pull{}};
    options.text = {{"label", "value"}};
    ASSERT_TRUE((*renderer)->draw(64, 48, *state, options).ok());
    ASSERT_TRUE((*renderer)->request_pick({1.0, 1.0, 64.0, 48.0}).ok());
    // What this image does without.
    const RenderPrograms p = RenderPrograms::create(*own_, gl::ShaderLibrary());
    for (const RenderProgram* const program :
         {&p.mesh_skin, &p.mesh_normals, &p.rods, &p.sheet, &p.glass, &p.reference_ground, &p.halve[0],
          &p.halve[1], &p.plane[0], &p.plane[1], &p.cut_plane[0], &p.cut_plane[1], &p.present, &p.ghost})
      EXPECT_NE(program->id(), 0u);
  }

  std::shared_ptr<gl::Context> own_;

  /// What the compiler says of the files, by name; empty if it accepts them all.
  static std::string complaints(const test::TemporaryDirectory& directory) {
    // Version 12.0.0 crashes on some texts; those it must accept where it makes SPIR-V of them.
    const std::string command = fmt::format(
        "cd '{}' && for file in *; do glslangValidator $file || {{ [ $? -ge 128 ] && "
        "glslangValidator -G -o /dev/null $file; }} || echo refused: $file; done 2>&1",
        directory.path().string());
    std::FILE* const pipe = ::popen(command.c_str(), "r");
    if (!pipe) return "no shell";
    std::string text;
    char part[4096];
    for (std::size_t n = 0; (n = std::fread(part, 1, sizeof part, pipe)) > 0;) text.append(part, n);
    ::pclose(pipe);
    return text.find("refused: ") == std::string::npos ? "" : text;
  }
};

TEST_F(Glslang, AcceptsEveryShaderWithEverySetOfDefines) {
  compile_solvers();
  compile_images();
  const test::TemporaryDirectory directory;
  int number = 0;
  for (const auto& [kind, sources] : seen) {
    for (const std::string& source : sources) {
      directory.write(fmt::format("{}.{}", number++, word_of(kind)), source);
      for (const auto& [line, rule, text] :
           aspic::testing::lint_portability(source, aspic::testing::Branches::taken))
        ADD_FAILURE() << rule << " (" << text << ") in line " << line << " of\n" << source;
    }
  }
  EXPECT_GT(number, 60);
  EXPECT_EQ(complaints(directory), "");
  // Mesa warns of what is legal and yet not for every driver, such as a mask of another sign.
  EXPECT_THAT(warnings, ::testing::IsEmpty());
  // Nothing was left out: what follows the includes of every file with a main() has been seen.
  for (const EmbeddedFile& file : embedded_shaders()) {
    const std::string_view text = file.text;
    const std::size_t main = text.find("void main()");
    if (main == std::string_view::npos) continue;
    bool found = false;
    for (const auto& [kind, sources] : seen) {
      for (const std::string& source : sources)
        found = found || source.find(text.substr(main)) != std::string::npos;
    }
    EXPECT_TRUE(found) << file.name << " is compiled by no solver and no image of this test";
  }
}

// The test above means nothing if the compiler accepts everything.
TEST_F(Glslang, RefusesWhatTheLanguageDoesNotHave) {
  const test::TemporaryDirectory directory;
  directory.write("wrong.comp",
                  "#version 430 core\nlayout(local_size_x = 1) in;\nvoid main() { float x = missing; }\n");
  EXPECT_NE(complaints(directory), "");
}

}  // namespace
}  // namespace aspic
