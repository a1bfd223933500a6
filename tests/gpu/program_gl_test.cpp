#include <EGL/egl.h>
#include <gmock/gmock.h>

#include "gpu/pass.h"
#include "gpu/program.h"
#include "support/gl_calls.h"
#include "support/gl_fixture.h"
#include "support/program_reflection.h"
#include "support/temporary_directory.h"

namespace aspic::gl {
namespace {

using aspic::testing::GlCalls;
using aspic::testing::Reflection;

using ::testing::HasSubstr;

class ProgramGl : public testing::GlTest {
 protected:
  Result<Program> compile(const char* path, std::vector<Define> defines = {}) {
    return Program::compute(context(), ShaderLibrary(ASPIC_TEST_SHADERS), path, defines);
  }
};

TEST_F(ProgramGl, RefusesNineStorageBlocksAndTakesEight) {
  const auto nine = compile("nine_blocks.comp");
  ASSERT_FALSE(nine.ok());
  EXPECT_EQ(nine.error().code, ErrorCode::no_device);
  EXPECT_THAT(nine.error().message(), HasSubstr("nine_blocks.comp"));
  EXPECT_THAT(nine.error().message(), HasSubstr("9 storage blocks"));
  EXPECT_THAT(nine.error().message(), HasSubstr("Block8"));
  const auto eight = compile("nine_blocks.comp", {{"EIGHT", "1"}});
  ASSERT_TRUE(eight.ok()) << eight.error().message();
  EXPECT_EQ(Reflection(*eight).storage_block_count(), 8);
}

TEST_F(ProgramGl, CompileErrorsNameOurFileAndLine) {
  const auto broken = compile("broken/kernel.comp");
  ASSERT_FALSE(broken.ok());
  EXPECT_EQ(broken.error().code, ErrorCode::no_device);
  EXPECT_THAT(broken.error().message(), HasSubstr("broken/kernel.comp"));
  EXPECT_THAT(broken.error().message(), HasSubstr("\nbroken/part.glsl:3: error"));
  EXPECT_THAT(broken.error().message(), HasSubstr("precise float x = misspelt;"));
  forgive_errors();  // some drivers report it as a message too
}

TEST_F(ProgramGl, MissingFileIsAnInputError) {
  const auto missing = compile("no/such.comp");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, ErrorCode::io);
}

TEST_F(ProgramGl, TellsItsLayout) {
  const auto program = compile("layout.comp", {{"ASPIC_GROUP_SIZE", "32"}});
  ASSERT_TRUE(program.ok()) << program.error().message();
  EXPECT_EQ(program->group_size(), (std::array<std::uint32_t, 3>{32, 1, 1}));
  EXPECT_EQ(Reflection(*program).storage_block_binding("Items"), 3);
  EXPECT_EQ(Reflection(*program).uniform_block_binding("Classes"), 5);
  EXPECT_EQ(Reflection(*program).storage_block_binding("Absent"), std::nullopt);
  // std430: the array of four floats is packed from byte 4, the struct aligned to 16 and rounded up to 32
  // bytes.
  EXPECT_EQ(Reflection(*program).buffer_variable_offset("header"), 0);
  EXPECT_EQ(Reflection(*program).buffer_variable_offset("weights[0]"), 4);
  EXPECT_EQ(Reflection(*program).buffer_variable_array_stride("weights[0]"), 4);
  EXPECT_EQ(Reflection(*program).buffer_variable_offset("items[0].position"), 32);
  EXPECT_EQ(Reflection(*program).buffer_variable_offset("items[0].mass"), 48);
  EXPECT_EQ(Reflection(*program).buffer_variable_offset("items[0].flags"), 52);
  EXPECT_EQ(Reflection(*program).buffer_variable_top_level_stride("items[0].flags"), 32);
  // Drivers differ in whether the last element's padding counts.
  EXPECT_THAT(Reflection(*program).storage_block_data_size("Items"), ::testing::AnyOf(56, 64));
  // std140: array elements are rounded up to 16 bytes.
  EXPECT_EQ(Reflection(*program).uniform_offset("factors[0]"), 16);
  EXPECT_EQ(Reflection(*program).uniform_array_stride("factors[0]"), 16);
  EXPECT_EQ(Reflection(*program).uniform_block_data_size("Classes"), 64);
  EXPECT_EQ(Reflection(*program).uniform_location("gravity"), 4);
}

TEST_F(ProgramGl, SetsUniformsOfEachKind) {
  auto made = compile("layout.comp");
  ASSERT_TRUE(made.ok()) << made.error().message();
  const Program program = std::move(made).value();
  auto items = Buffer::create(context(), "items", 32 + 2 * 32);
  const float factors[] = {0, 0, 0, 0, 1, 0, 0, 0, 7, 0, 0, 0, 3, 0, 0, 0};
  auto classes = Buffer::of(context(), "classes", factors, BufferKind::uniform);
  ASSERT_TRUE(items.ok() && classes.ok());
  items->clear();
  const float weight = 2.5f;
  items->upload(std::as_bytes(std::span(&weight, 1)), 4 + 2 * 4);
  program.set(1, 2u);
  program.set(2, 40);
  program.set(3, 0.5f);
  program.set(4, std::array{1.0f, 2.0f, 3.0f, 4.0f});
  Pass(program,
       {{.binding = 3, .buffer = &*items}, {.binding = 5, .buffer = &*classes, .kind = BufferKind::uniform}},
       ReadBy::read_back)
      .dispatch_for(2);
  const auto got = items->download_items<float>(24);
  testing::expect_finite(got);
  EXPECT_EQ(got[4], 7.0f);
  for (const std::ptrdiff_t item : {8, 16}) {
    EXPECT_EQ(std::vector<float>(got.begin() + item, got.begin() + item + 5),
              (std::vector<float>{1, 2, 3, 0.5f, 2.5f}));
  }
  const auto words = items->download_items<std::uint32_t>(24);
  EXPECT_EQ(words[8 + 5], 40u);
  EXPECT_EQ(words[16 + 5], 41u);
}

class ProgramCacheGl : public testing::GlTest {};

TEST_F(ProgramCacheGl, GivesTheSameProgramForTheSameSource) {
  ProgramCache cache(context());
  const ShaderLibrary library(ASPIC_TEST_SHADERS);
  const std::vector<Define> small = {{"ASPIC_GROUP_SIZE", "32"}}, large = {{"ASPIC_GROUP_SIZE", "64"}};
  const auto first = cache.compute(library, "count.comp", small);
  ASSERT_TRUE(first.ok()) << first.error().message();
  EXPECT_EQ(*cache.compute(library, "count.comp", small), *first);
  EXPECT_EQ(*cache.compute(ShaderLibrary(ASPIC_TEST_SHADERS), "count.comp", small), *first);
  const auto other = cache.compute(library, "count.comp", large);
  ASSERT_TRUE(other.ok());
  EXPECT_NE(*other, *first);
  EXPECT_EQ((*other)->group_size()[0], 64u);
  EXPECT_NE(*cache.compute(library, "double_items.comp", small), *first);
  EXPECT_EQ(cache.size(), 3u);
  EXPECT_EQ(cache.compiled(), 3u);
}

TEST_F(ProgramCacheGl, AnEditedFileIsCompiledAnewAndTheOldTextForgotten) {
  const test::TemporaryDirectory directory;
  const auto kernel = [](const char* value) {
    return std::string("layout(local_size_x = ") + value + ") in;\n#include \"part.glsl\"\nvoid main() {}\n";
  };
  directory.write("kernel.comp", kernel("8"));
  directory.write("part.glsl", "");
  ProgramCache cache(context());
  const ShaderLibrary library(directory.path());
  const auto first = cache.compute(library, "kernel.comp");
  ASSERT_TRUE(first.ok()) << first.error().message();
  directory.write("part.glsl", "const float gravity = 9.8;\n");
  const auto second = cache.compute(library, "kernel.comp");
  ASSERT_TRUE(second.ok()) << second.error().message();
  EXPECT_NE(*second, *first);
  EXPECT_EQ(cache.size(), 1u);

  // A text that does not compile leaves the last one that did.
  directory.write("part.glsl", "nonsense\n");
  EXPECT_EQ(cache.compute(library, "kernel.comp").error().code, ErrorCode::no_device);
  forgive_errors();
  directory.write("part.glsl", "const float gravity = 9.8;\n");
  EXPECT_EQ(*cache.compute(library, "kernel.comp"), *second);
  EXPECT_EQ(cache.compiled(), 2u);
}

TEST_F(ProgramCacheGl, ErrorsAreThoseOfTheProgram) {
  ProgramCache cache(context());
  const ShaderLibrary library(ASPIC_TEST_SHADERS);
  EXPECT_EQ(cache.compute(library, "no/such.comp").error().code, ErrorCode::io);
  EXPECT_THAT(cache.compute(library, "nine_blocks.comp").error().message(), HasSubstr("9 storage blocks"));
  EXPECT_EQ(cache.size(), 0u);
}

TEST_F(ProgramCacheGl, SharesOneProgramOfTextsThatAreEqual) {
  ProgramCache cache(context());
  const ShaderLibrary library(ASPIC_TEST_SHADERS);
  const std::vector<Define> unused = {{"ASPIC_UNUSED", "1"}};
  const auto first = cache.compute(library, "double_items.comp");
  ASSERT_TRUE(first.ok()) << first.error().message();
  EXPECT_EQ(*cache.compute(library, "double_items.comp", unused), *first);
  EXPECT_EQ(cache.compiled(), 1u);
}

TEST_F(ProgramCacheGl, BeginsABatchBeforeItWaitsForAnyOfIt) {
  ProgramCache cache(context());
  const ShaderLibrary library(ASPIC_TEST_SHADERS);
  const GlCalls calls;
  ProgramBatch batch(cache);
  for (const char* const path : {"count.comp", "layout.comp", "double_items.comp"})
    ASSERT_TRUE(batch.start(library, {.compute = path}).ok());
  EXPECT_EQ(calls.order, "LLL");
  ASSERT_TRUE(batch.finish().ok());
  EXPECT_EQ(cache.compiled(), 3u);
  EXPECT_EQ(cache.size(), 3u);
}

TEST_F(ProgramCacheGl, ABatchNamesTheFirstProgramThatFailsAndKeepsTheOthers) {
  ProgramCache cache(context());
  const ShaderLibrary library(ASPIC_TEST_SHADERS);
  ProgramBatch batch(cache);
  for (const char* const path : {"count.comp", "broken/kernel.comp", "nine_blocks.comp", "layout.comp"})
    ASSERT_TRUE(batch.start(library, {.compute = path}).ok());
  const Status finished = batch.finish();
  ASSERT_FALSE(finished.ok());
  EXPECT_EQ(finished.error().code, ErrorCode::no_device);
  EXPECT_THAT(finished.error().message(), HasSubstr("\nbroken/part.glsl:3: error"));
  forgive_errors();
  // What was left unfinished is finished by whoever asks for it next; what failed is tried again.
  const auto left = cache.compute(library, "layout.comp");
  ASSERT_TRUE(left.ok()) << left.error().message();
  EXPECT_GT((*left)->group_size()[0], 0u);
  EXPECT_THAT(cache.compute(library, "broken/kernel.comp").error().message(),
              HasSubstr("\nbroken/part.glsl:3: error"));
  forgive_errors();
  EXPECT_EQ(cache.compiled(), 2u);
}

/// Caches that keep binaries in a folder, as those of two processes.
class ProgramBinariesGl : public testing::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    GLint formats = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    if (formats == 0) GTEST_SKIP() << "the driver has no program binaries";
  }
  std::filesystem::path only_file() const { return std::filesystem::directory_iterator(folder())->path(); }
  const std::filesystem::path& folder() const { return directory_.path(); }
  std::string read() const { return directory_.read(only_file().filename().string()); }
  void write(const std::string& text) const { directory_.write(only_file().filename().string(), text); }

  const ShaderLibrary library_{ASPIC_TEST_SHADERS};

 private:
  test::TemporaryDirectory directory_;
};

TEST_F(ProgramBinariesGl, GiveTheNextProcessTheSameProgram) {
  std::vector<Define> defines = {{"ASPIC_GROUP_SIZE", "32"}};
  ProgramCache first(context(), folder()), second(context(), folder());
  const auto compiled = first.compute(library_, "layout.comp", defines);
  const GlCalls calls;
  const auto loaded = second.compute(library_, "layout.comp", defines);
  ASSERT_TRUE(compiled.ok() && loaded.ok());
  EXPECT_EQ(calls.links(), 0);
  EXPECT_EQ(first.compiled(), 1u);
  EXPECT_EQ(second.compiled(), 0u);
  EXPECT_EQ(second.loaded(), 1u);
  EXPECT_EQ((*loaded)->group_size(), (*compiled)->group_size());
  EXPECT_EQ((*loaded)->path(), (*compiled)->path());
  const Reflection a(**compiled), b(**loaded);
  EXPECT_EQ(b.storage_block_binding("Items"), a.storage_block_binding("Items"));
  EXPECT_EQ(b.uniform_block_binding("Classes"), a.uniform_block_binding("Classes"));
  EXPECT_EQ(b.uniform_location("gravity"), a.uniform_location("gravity"));
  EXPECT_EQ(b.buffer_variable_offset("items[0].flags"), a.buffer_variable_offset("items[0].flags"));

  const auto doubled = [&](ProgramCache& cache) {
    const auto program = cache.compute(library_, "double_items.comp");
    const std::vector<std::uint32_t> items = {1, 2, 35};
    const auto given = Buffer::of(context(), "given", items), result = Buffer::of(context(), "result", items);
    EXPECT_TRUE(program.ok() && given.ok() && result.ok());
    (*program)->set(0, 3u);
    Pass(**program, {{.binding = 0, .buffer = &*given}, {.binding = 1, .buffer = &*result}},
         ReadBy::read_back)
        .dispatch_for(3);
    return result->download_items<std::uint32_t>(3);
  };
  EXPECT_EQ(doubled(first), (std::vector<std::uint32_t>{2, 4, 70}));
  EXPECT_EQ(doubled(second), (std::vector<std::uint32_t>{2, 4, 70}));
  EXPECT_EQ(second.loaded(), 2u);
}

TEST_F(ProgramBinariesGl, AreNotGivenToTheDriverWhereDamaged) {
  ASSERT_TRUE(ProgramCache(context(), folder()).compute(library_, "count.comp").ok());
  const std::string whole = read();
  for (const std::size_t at : {std::size_t{0}, std::size_t{20}, whole.size() / 2, whole.size() - 1}) {
    for (const bool cut : {false, true}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] + 1);
      write(cut ? whole.substr(0, at) : damaged);
      ProgramCache cache(context(), folder());
      const GlCalls calls;
      ASSERT_TRUE(cache.compute(library_, "count.comp").ok());
      EXPECT_THAT(calls.order, Not(HasSubstr("B"))) << at;
      EXPECT_EQ(cache.compiled(), 1u);
      EXPECT_EQ(read(), whole) << "the file is made anew";
    }
  }
}

TEST_F(ProgramBinariesGl, ThatTheDriverRefusesAreCompiledAnew) {
  ASSERT_TRUE(ProgramCache(context(), folder()).compute(library_, "count.comp").ok());
  ProgramFiles files(folder());
  const std::string key = only_file().stem().string(), whole = read();
  ProgramBinary binary = *files.load(key);
  std::ranges::fill(binary.bytes, 'x');
  files.store(key, binary);
  ProgramCache cache(context(), folder());
  const GlCalls calls;
  ASSERT_TRUE(cache.compute(library_, "count.comp").ok());
  EXPECT_THAT(calls.order, HasSubstr("B"));
  EXPECT_EQ(cache.compiled(), 1u);
  EXPECT_EQ(read(), whole);
  forgive_errors();
}

TEST_F(ProgramBinariesGl, FollowTheTextOfTheShader) {
  const test::TemporaryDirectory shaders;
  for (const char* const value : {"8", "16"}) {
    shaders.write("kernel.comp", std::string("layout(local_size_x = ") + value + ") in;\nvoid main() {}\n");
    ProgramCache cache(context(), folder());
    const auto program = cache.compute(ShaderLibrary(shaders.path()), "kernel.comp");
    ASSERT_TRUE(program.ok());
    EXPECT_EQ(std::to_string((*program)->group_size()[0]), value);
    EXPECT_EQ(cache.compiled(), 1u);
  }
}

/// What the driver of another card, or another version of the driver, answers.
const GLubyte* other_renderer(GLenum name) {
  static const auto real = reinterpret_cast<PFNGLGETSTRINGPROC>(eglGetProcAddress("glGetString"));
  return name == GL_RENDERER ? reinterpret_cast<const GLubyte*>("another renderer") : real(name);
}

TEST_F(ProgramBinariesGl, AreNotTakenFromAnotherRenderer) {
  ASSERT_TRUE(ProgramCache(context(), folder()).compute(library_, "count.comp").ok());
  auto own = Context::create_headless({.debug = true, .device = testing::test_device()});
  ASSERT_TRUE(own.ok()) << own.error().message();
  {
    ProgramCache same(**own, folder());
    ASSERT_TRUE(same.compute(library_, "count.comp").ok());
    EXPECT_EQ(same.loaded(), 1u);
    const auto adopted = Context::adopt_current([](const char* name) {
      return std::string_view(name) == "glGetString" ? reinterpret_cast<void (*)()>(other_renderer)
                                                     : eglGetProcAddress(name);
    });
    ASSERT_TRUE(adopted.ok()) << adopted.error().message();
    ProgramCache other(**adopted, folder());
    ASSERT_TRUE(other.compute(library_, "count.comp").ok());
    EXPECT_EQ(other.loaded(), 0u);
    EXPECT_EQ(other.compiled(), 1u);
  }
  own->reset();
  ASSERT_TRUE(context().make_current().ok());
  ASSERT_NE(gladLoadGL(eglGetProcAddress), 0);
}

}  // namespace
}  // namespace aspic::gl
