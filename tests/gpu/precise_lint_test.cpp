#include "gpu/precise_lint.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace aspic::testing {
namespace {

std::string contents(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  EXPECT_TRUE(stream.is_open()) << path;
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

TEST(PreciseLint, FindsEveryPlantedOffenseAndNothingElse) {
  const std::string text = contents(std::filesystem::path(ASPIC_TEST_SHADERS) / "lint/planted.glsl");
  std::vector<std::string> expected;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const auto mark = line.find("// offense:");
    if (mark == std::string::npos) continue;
    std::istringstream rules(line.substr(mark + 11));
    for (std::string rule; rules >> rule;) expected.push_back(std::to_string(number) + ": " + rule);
  }
  ASSERT_GE(expected.size(), 25u);
  std::vector<std::string> found;
  for (const Offense& offense : lint("lint/planted.glsl", text))
    found.push_back(std::to_string(offense.line) + ": " + offense.rule);
  EXPECT_EQ(found, expected);
}

TEST(PreciseLint, OptsOutWithAReasonInTheFirstLineOnly) {
  EXPECT_TRUE(opted_out("// not-exact: counts only\nfloat x;"));
  EXPECT_FALSE(opted_out("// not-exact:\nfloat x;"));
  EXPECT_FALSE(opted_out("float x;\n// not-exact: too late"));
}

TEST(PreciseLint, AllowsFmaAndInverseRootsInOneFile) {
  const std::string text = contents(std::filesystem::path(ASPIC_SHADERS) / "compute/device_arithmetic.glsl");
  EXPECT_TRUE(lint("compute/device_arithmetic.glsl", text).empty());
  const auto elsewhere = lint("compute/other.glsl", text);
  ASSERT_EQ(elsewhere.size(), 3u);
  EXPECT_EQ(elsewhere.front().rule, "forbidden");
  EXPECT_EQ(elsewhere.back().rule, "fma");
}

TEST(PreciseLint, ComputeShadersAreClean) {
  const std::filesystem::path root = ASPIC_SHADERS;
  int files = 0;
  for (const char* directory : {"compute", "shapes"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / directory)) {
      if (!entry.is_regular_file()) continue;
      ++files;
      const std::string text = contents(entry.path());
      if (opted_out(text)) continue;
      const std::string path = entry.path().lexically_relative(root).generic_string();
      for (const Offense& offense : lint(path, text))
        ADD_FAILURE() << path << ":" << offense.line << ": " << offense.rule << " (" << offense.text << ")";
    }
  }
  EXPECT_GE(files, 4);
}

}  // namespace
}  // namespace aspic::testing
