#include <gmock/gmock.h>

#include "gpu/pass.h"
#include "gpu/program.h"
#include "support/gl_fixture.h"
#include "support/program_reflection.h"
#include "support/temporary_directory.h"

namespace aspic::gl {
namespace {

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
  // A debug context hears of the compile error as a message of high severity.
  EXPECT_GE(forgive_errors(), 1);
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
  EXPECT_EQ(Reflection(*program).storage_block_data_size("Items"), 64);
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
  EXPECT_GE(forgive_errors(), 1);
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

}  // namespace
}  // namespace aspic::gl
