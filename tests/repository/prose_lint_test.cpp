#include "repository/prose_lint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>

namespace aspic::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> rules_broken(const std::string& page, Readers readers = Readers::users) {
  std::vector<std::string> rules;
  for (const Offense& offense : lint_prose(page, readers))
    rules.push_back(std::to_string(offense.line) + ": " + offense.rule);
  return rules;
}

std::string repeated(const std::string& word, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += word + " ";
  return text;
}

TEST(ProseLint, FindsTermsInProseAlone) {
  const auto found = lint_prose("A step.\nTwo *large* pictures, by the clock.\n", Readers::users);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].text, "by the clock: wall-clock time");
  EXPECT_EQ(found[1].text, "pictures: image or frame");
  EXPECT_THAT(rules_broken("It goes on\nRubbing, or a Film.\n| no | that many |\n"),
              ElementsAre("1: term", "2: term", "2: term", "3: term"));
  EXPECT_THAT(rules_broken("`pictures` [a](pictures.md) *Film* roomy pictured\n\n    film\n```\nfilm\n```\n"),
              IsEmpty());
}

TEST(ProseLint, FindsOpenings) {
  EXPECT_THAT(rules_broken("## What is said\nA. Of these\n- **So** it is\n| a | Refused |\n"),
              ElementsAre("1: opening", "2: opening", "3: opening", "4: opening"));
  EXPECT_THAT(rules_broken("Software and Offers. Whatever\nSay what is so.\n"), IsEmpty());
}

TEST(ProseLint, CountsWordsOfSentencesOfUserPages) {
  const std::string long_one = repeated("word", 31), two = repeated("word", 16) + ". " + repeated("word", 16);
  EXPECT_THAT(rules_broken(long_one), ElementsAre("1: length"));
  EXPECT_THAT(rules_broken("| " + long_one + " | a |\n"), ElementsAre("1: length"));
  EXPECT_THAT(rules_broken(long_one, Readers::developers), IsEmpty());
  EXPECT_THAT(rules_broken(two), IsEmpty());
  EXPECT_THAT(rules_broken(repeated("word", 30) + repeated("x₀ = √2 −", 9)), IsEmpty());
}

TEST(ProseLint, FindsUnquotedBracketsInCommands) {
  EXPECT_THAT(rules_broken("    aspic run a --set cube[0].edge-length=2\n`aspic view --view x={a=1}`\n"),
              ElementsAre("1: bracket", "2: bracket"));
  EXPECT_THAT(rules_broken("```sh\nA=1 build/release/aspic run a \\\n  --set b[0]=1\n```\n"),
              ElementsAre("2: bracket"));
  EXPECT_THAT(
      rules_broken(
          "    aspic run a --set 'cube[0].x=2' \"{\"   # [0]\n    x = [1]\n`cube[0]` `aspic view [SCENE]`\n"),
      IsEmpty());
}

TEST(ProseLint, FindsOutputsOfTheSameName) {
  EXPECT_THAT(
      rules_broken("    aspic run a --video a.mp4\n\n`aspic run b --frames a.mp4`\n    aspic x > a.mp4\n"),
      ElementsAre("3: output", "4: output"));
  EXPECT_THAT(
      rules_broken("    aspic run a --checkpoint a.aspic\n    aspic run --resume a.aspic --state b\n"),
      IsEmpty());
}

TEST(ProseLint, FindsOffensesInStringLiterals) {
  const auto lines_of = [](std::string_view code, Language language = Language::cpp) {
    std::vector<int> lines;
    for (const Offense& offense : lint_strings(code, language)) lines.push_back(offense.line);
    return lines;
  };
  const std::string long_one = repeated("word", 31);
  EXPECT_THAT(lines_of("f(1'000,\n  \"a \\\"film\\\"\"\n  \" here\");\n\"goes \"  // x\n\"on\";\n"),
              ElementsAre(2, 4));
  EXPECT_THAT(lines_of("R\"x(Done.\nWhat (\"is\") this)x\", \"Step.\\nOf these\""), ElementsAre(2, 2));
  EXPECT_THAT(lines_of("f(\"" + long_one + "\");"), ElementsAre(1));
  EXPECT_THAT(lines_of("\"film\" '\"'  // \"a film\"\n\"a\", \"film\""), IsEmpty());
  EXPECT_THAT(lines_of("# a film\nf('a film')\n\"\"\"A \"step\".\n\n  So it is.\n\"\"\"\n", Language::python),
              ElementsAre(2, 5));
  EXPECT_THAT(lines_of("// a film\nf(`a film`, 'a film')\n\"a\", \"film\"", Language::javascript),
              ElementsAre(2, 2));
  EXPECT_THAT(lines_of("<p id=\"film\">a step</p>\n<p title=\"a film\">a film</p>", Language::html),
              ElementsAre(2, 2));
}

TEST(ProseLint, FindsBritishSpellings) {
  EXPECT_THAT(rules_broken("A grey body.\nNeighbours normalise it\nThe optimisation of two metres\n"),
              ElementsAre("1: spelling", "2: spelling", "2: spelling", "3: spelling", "3: spelling"));
  EXPECT_THAT(
      rules_broken("A precise rise of parameters otherwise raises `colour` and promises characteristics\n"),
      IsEmpty());
}

TEST(ProseLint, FindsDocstringsThatAreNotImperative) {
  const auto lines_of = [](std::string_view code) {
    std::vector<int> lines;
    for (const Offense& offense : lint_docstrings(code)) lines.push_back(offense.line);
    return lines;
  };
  EXPECT_THAT(lines_of("def f(\n    a,\n) -> int:\n    \"\"\"The sum.\"\"\"\n\n\n"
                       "async def g():\n    \"\"\"Returns it.\"\"\"\n"),
              ElementsAre(4, 8));
  EXPECT_THAT(
      lines_of("class A:\n    \"\"\"A thing.\"\"\"\n\n    @property\n    def b(self) -> int:\n"
               "        \"\"\"Bytes.\"\"\"\n\n    def c(self) -> int:\n        \"\"\"Return it.\"\"\"\n"),
      IsEmpty());
}

TEST(ProseLint, FindsLongTooltips) {
  const std::string words = repeated("word", 12);
  EXPECT_EQ(lint_tooltips("f(\"Adds " + words + ".\");").size(), 1u);
  EXPECT_EQ(lint_tooltips("f(\"Adds a body. Sets " + words + ".\\n\\nScene key: a\");").size(), 1u);
  EXPECT_THAT(lint_tooltips("f(\"Adds a body. Key: B.\\n" + words + words + "\", \"The " + words + ".\");"),
              IsEmpty());
}

TEST(ProseLint, StringLiteralsAreClean) {
  const std::map<std::string, Language> languages = {{".cpp", Language::cpp},
                                                     {".h", Language::cpp},
                                                     {".py", Language::python},
                                                     {".js", Language::javascript},
                                                     {".html", Language::html}};
  std::map<Language, int> files;
  for (const std::filesystem::path& file : written_files(ASPIC_SOURCE_DIR)) {
    const std::string path = file.generic_string();
    const auto language = languages.find(file.extension().string());
    const bool example = path.starts_with("examples/python/");
    if (language == languages.end() || !(path.starts_with("src/") || path.starts_with("python/aspic/") ||
                                         path.starts_with("python/src/") || example))
      continue;
    ++files[language->second];
    const std::string code = contents(ASPIC_SOURCE_DIR / file);
    std::vector<Offense> offenses = lint_strings(code, language->second);
    if (language->second == Language::python)
      std::ranges::move(lint_docstrings(code), std::back_inserter(offenses));
    if (path.starts_with("src/app/")) std::ranges::move(lint_tooltips(code), std::back_inserter(offenses));
    for (const Offense& offense : offenses)
      ADD_FAILURE() << path << ":" << offense.line << ": " << offense.rule << " (" << offense.text << ")";
  }
  EXPECT_GE(files[Language::cpp], 500);
  EXPECT_GE(files[Language::python], 30);
  EXPECT_GE(files[Language::javascript], 10);
  EXPECT_GE(files[Language::html], 1);
}

TEST(ProseLint, PagesAreClean) {
  const auto pages = prose_pages(ASPIC_SOURCE_DIR);
  EXPECT_GE(pages.size(), 30u);
  for (const auto& [file, readers] : pages)
    for (const Offense& offense : lint_prose(contents(ASPIC_SOURCE_DIR / file), readers))
      ADD_FAILURE() << file.generic_string() << ":" << offense.line << ": " << offense.rule << " ("
                    << offense.text << ")";
}

}  // namespace
}  // namespace aspic::testing
