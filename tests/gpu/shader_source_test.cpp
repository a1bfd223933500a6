#include "gpu/shader_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "support/temporary_directory.h"

namespace aspic::gl {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const ShaderLibrary& test_library() {
  static const ShaderLibrary library{ASPIC_TEST_SHADERS};
  return library;
}

FlatShader flatten(const char* path, std::vector<Define> defines = {}) {
  auto flat = test_library().flatten(path, defines);
  EXPECT_TRUE(flat.ok()) << flat.error().message();
  return flat ? std::move(flat).value() : FlatShader();
}

std::string error_of(const char* path) {
  const auto flat = test_library().flatten(path);
  EXPECT_FALSE(flat.ok());
  if (flat.ok()) return {};
  EXPECT_EQ(flat.error().code, ErrorCode::io);
  return flat.error().message();
}

TEST(EmbeddedShaders, AreTheFilesByteForByte) {
  const std::filesystem::path root = ASPIC_SHADERS;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file()) continue;
    const std::string path = entry.path().lexically_relative(root).generic_string();
    EXPECT_TRUE(find_embedded(embedded_shaders(), path)) << path;
  }
  EXPECT_TRUE(std::ranges::is_sorted(embedded_shaders(), {}, &EmbeddedFile::name));
  for (const EmbeddedFile& shader : embedded_shaders()) {
    std::ifstream stream(root / shader.name, std::ios::binary);
    ASSERT_TRUE(stream.is_open()) << shader.name;
    const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    EXPECT_EQ(shader.text, text) << shader.name;
  }
}

TEST(ShaderLibrary, PutsVersionAndTheDefinesThatAreReadInFront) {
  // The comment of the file says "line"; LINES and one are words of their own.
  const FlatShader flat = flatten("include/inner.glsl", {{"one", "2"},
                                                         {"line", "three + four"},
                                                         {"LINES", "1"},
                                                         {"four", "4"},
                                                         {"three4", "x"},
                                                         {"inne", "y"}});
  EXPECT_EQ(flat.text(),
            "#version 430 core\n#define line three + four\n#define four 4\n// line 1 of inner\n"
            "// line 2 of inner\n");
  EXPECT_EQ(flat.path(), "include/inner.glsl");
}

TEST(ShaderLibrary, IncludesEachFileOnceAndKnowsEveryLinesOrigin) {
  const FlatShader flat = flatten("include/outer.comp", {{"outer", "1"}});
  EXPECT_EQ(flat.text().find("include"), std::string::npos);
  const struct {
    const char* file;
    int line;
  } expected[] = {{"defines", 1},
                  {"defines", 2},
                  {"include/outer.comp", 1},
                  {"include/middle.glsl", 1},
                  {"include/inner.glsl", 1},
                  {"include/inner.glsl", 2},
                  {"include/middle.glsl", 3},
                  {"include/outer.comp", 3},
                  {"include/outer.comp", 5}};
  ASSERT_EQ(std::ranges::count(flat.text(), '\n'), std::ssize(expected));
  for (int i = 0; i < std::ssize(expected); ++i) {
    EXPECT_EQ(flat.origin(i + 1).file, expected[i].file) << i;
    EXPECT_EQ(flat.origin(i + 1).line, expected[i].line) << i;
  }
  EXPECT_EQ(flat.origin(0).line, 0);
  EXPECT_EQ(flat.origin(99).line, 0);
}

TEST(ShaderLibrary, PrefersTheDirectoryAndFallsBackToTheProgram) {
  const auto faulty = test_library().read("compute/device_arithmetic.glsl");
  const auto real = ShaderLibrary().read("compute/device_arithmetic.glsl");
  ASSERT_TRUE(faulty.ok() && real.ok());
  EXPECT_THAT(*faulty, HasSubstr("FAULT_DIV"));
  EXPECT_THAT(*real, ::testing::Not(HasSubstr("FAULT_DIV")));
  const auto fallen_back = test_library().read("compute/exact.glsl");
  ASSERT_TRUE(fallen_back.ok());
  EXPECT_EQ(*fallen_back, *ShaderLibrary().read("compute/exact.glsl"));
}

TEST(ShaderLibrary, RefusesWithFileAndLine) {
  EXPECT_THAT(error_of("include/missing.comp"), StartsWith("include/missing.comp:2: "));
  EXPECT_THAT(error_of("include/missing.comp"), HasSubstr("\"include/nowhere.glsl\""));
  EXPECT_THAT(
      error_of("include/cycle_a.glsl"),
      StartsWith("include/cycle_a.glsl:1 → include/cycle_b.glsl:2: the include of \"include/cycle_a.glsl\" "
                 "closes a cycle"));
  EXPECT_THAT(error_of("include/angled.comp"), StartsWith("include/angled.comp:1: "));
  EXPECT_THAT(error_of("include/versioned.comp"),
              StartsWith("include/versioned.comp:2: the program adds #version"));
  EXPECT_THAT(error_of("no/such.comp"), HasSubstr("There is no shader file \"no/such.comp\""));
}

TEST(FlatShader, RewritesTheLogsOfFourDrivers) {
  const FlatShader flat = flatten("broken/kernel.comp");
  const std::string& text = flat.text();
  const auto at = text.find("precise float x = misspelt");
  ASSERT_NE(at, std::string::npos);
  const auto line =
      std::to_string(1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
  EXPECT_EQ(flat.rewrite_log("0:" + line + "(21): error: `misspelt' undeclared\n"),
            "broken/part.glsl:3: error: `misspelt' undeclared\n"
            "    precise float x = misspelt;\n"
            "                      ^\n");
  EXPECT_EQ(flat.rewrite_log("0(" + line + ") : error C1503: undefined variable \"misspelt\"\n"),
            "broken/part.glsl:3: error C1503: undefined variable \"misspelt\"\n"
            "    precise float x = misspelt;\n");
  EXPECT_EQ(flat.rewrite_log("ERROR: 0:" + line + ": 'misspelt' : undeclared identifier\n"),
            "broken/part.glsl:3: error: 'misspelt' : undeclared identifier\n"
            "    precise float x = misspelt;\n");
  EXPECT_EQ(flat.rewrite_log("WARNING: 0:" + line + ": odd"),
            "broken/part.glsl:3: warning: odd\n"
            "    precise float x = misspelt;\n");
}

TEST(FlatShader, LeavesOtherLinesOfALogAlone) {
  const FlatShader flat = flatten("broken/kernel.comp");
  const char* log =
      "Compilation failed: 2 errors\n0:9999(1): error: beyond the end\n12 things\nERROR: 3 compilation "
      "errors\n";
  EXPECT_EQ(flat.rewrite_log(log), log);
  EXPECT_EQ(flat.rewrite_log(""), "");
  // A column past the line's end is not worth a caret.
  EXPECT_EQ(flat.rewrite_log("0:1(500): error: x"), "defines:1: error: x\n  #version 430 core\n");
}

TEST(ShaderLibrary, RefusesWhatIsNoShaderFile) {
  const test::TemporaryDirectory dir;
  const ShaderLibrary library{dir.file("")};
  std::filesystem::create_directories(dir.file("compute/gather.comp"));
  const auto directory = library.flatten("compute/gather.comp");
  ASSERT_FALSE(directory.ok());
  EXPECT_THAT(directory.error().message(), HasSubstr("Is a directory"));
  std::filesystem::create_symlink("/dev/zero", dir.file("compute/endless.comp"));
  EXPECT_FALSE(library.flatten("compute/endless.comp").ok());
  std::ofstream(dir.file("compute/large.comp")) << std::string((4 << 20) + 1, '\n');
  EXPECT_THAT(library.flatten("compute/large.comp").error().message(), HasSubstr("4 MiB"));
}

TEST(ShaderLibrary, IncludesAreNestedToADepth) {
  const test::TemporaryDirectory dir;
  const int files = 20000;
  for (int i = 0; i < files; ++i)
    std::ofstream(dir.file(std::to_string(i)))
        << (i + 1 < files ? "#include \"" + std::to_string(i + 1) + "\"\n" : "");
  const ShaderLibrary library{dir.file("")};
  const auto deep = library.flatten("0");
  ASSERT_FALSE(deep.ok());
  EXPECT_THAT(deep.error().message(), HasSubstr("nested more than 32 deep"));
  EXPECT_LT(deep.error().message().size(), 300u);
  EXPECT_TRUE(library.flatten(std::to_string(files - 32)).ok());
}

}  // namespace
}  // namespace aspic::gl
