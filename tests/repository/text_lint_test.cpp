#include "repository/text_lint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace aspic::testing {
namespace {

const std::filesystem::path root = ASPIC_SOURCE_DIR;

std::vector<std::string> rules_broken(const char* file, const std::string& text) {
  std::vector<std::string> rules;
  for (const Offence& offence : lint(root, file, text))
    rules.push_back(std::to_string(offence.line) + ": " + offence.rule);
  return rules;
}

TEST(TextLint, FindsEveryPlantedOffence) {
  EXPECT_THAT(
      rules_broken("src/x.h", "// Contact, spec §2.5.\n// none\n// see shared/x.txt\n// (spec of balls)\n"),
      ::testing::ElementsAre("1: outside", "3: outside", "4: outside"));
  EXPECT_THAT(rules_broken("src/x.h", "// docs/no-such-page.md\n// docs/physics.md, section 99\n"),
              ::testing::ElementsAre("1: path", "2: section"));
  EXPECT_THAT(rules_broken("docs/physics.md",
                           "`src/no/such/file.h` [a](no-such.md)\n[b](physics.md#no-such-heading)\n"),
              ::testing::ElementsAre("1: path", "1: link", "2: anchor"));
}

TEST(TextLint, AcceptsWhatIsThere) {
  EXPECT_THAT(rules_broken("src/x.h", "// The damped spring (docs/physics.md, section 1).\n"),
              ::testing::IsEmpty());
  EXPECT_THAT(
      rules_broken("docs/physics.md", "`src/model/model.h` [a](files.md) [b](physics.md#4-implicit-euler)\n"),
      ::testing::IsEmpty());
  EXPECT_THAT(rules_broken("docs/physics.md", "[c](../README.md#two-commands) [d](https://example.org/)\n"),
              ::testing::IsEmpty());
}

TEST(TextLint, RepositoryIsClean) {
  const auto files = written_files(root);
  EXPECT_GE(files.size(), 400u);
  for (const auto& file : files) {
    for (const Offence& offence : lint(root, file, contents(root / file)))
      ADD_FAILURE() << file.generic_string() << ":" << offence.line << ": " << offence.rule << " ("
                    << offence.text << ")";
  }
}

}  // namespace
}  // namespace aspic::testing
