#include "repository/text_lint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <utility>

#include "support/temporary_directory.h"

namespace aspic::testing {
namespace {

const std::filesystem::path root = ASPIC_SOURCE_DIR;

std::vector<std::string> rules_broken(const char* file, const std::string& text) {
  std::vector<std::string> rules;
  for (const Offense& offense : lint(root, file, text))
    rules.push_back(std::to_string(offense.line) + ": " + offense.rule);
  return rules;
}

TEST(TextLint, FindsEveryPlantedOffense) {
  EXPECT_THAT(
      rules_broken("src/x.h", "// Contact, spec §2.5.\n// none\n// see shared/page.md\n// (spec of balls)\n"),
      ::testing::ElementsAre("1: outside", "3: outside", "4: outside"));
  EXPECT_THAT(rules_broken("src/x.h",
                           "// docs/no-such-page.md\n// docs/physics.md, section 99\n"
                           "// docs/contact.md, \"Friction\"\n// docs/contact.md, \"None\"\n"),
              ::testing::ElementsAre("1: path", "2: section", "4: section"));
  EXPECT_THAT(rules_broken("src/x.cpp", "if (method.stages.empty())\n  solve(row->stages().empty());\n"),
              ::testing::ElementsAre("1: kind", "2: kind"));
  const std::string options = "fail(\"use --fps\");\n--count;  // \"--fps\"\nadd(\"--{}\", \"a--\", n--);\n";
  EXPECT_THAT(rules_broken("src/io/x.cpp", options), ::testing::ElementsAre("1: option", "3: option"));
  for (const char* file : {"src/cli/x.cpp", "src/scene/x_main.cpp", "src/base/wording.cpp", "tests/io/x.cpp"})
    EXPECT_THAT(rules_broken(file, options), ::testing::IsEmpty()) << file;
  EXPECT_THAT(rules_broken("docs/physics.md",
                           "`src/no/such/file.h` [a](no-such.md)\n[b](physics.md#no-such-heading)\n"),
              ::testing::ElementsAre("1: path", "1: link", "2: anchor"));
}

TEST(TextLint, AcceptsWhatIsThere) {
  EXPECT_THAT(rules_broken("src/x.h", "// The damped spring (docs/physics.md, section 1).\n"),
              ::testing::IsEmpty());
  EXPECT_THAT(rules_broken("docs/physics.md",
                           "`src/model/springs.h` [a](files.md) [b](physics.md#4-implicit-euler)\n"),
              ::testing::IsEmpty());
  EXPECT_THAT(rules_broken("docs/physics.md", "[c](../README.md#try-it) [d](https://example.org/)\n"),
              ::testing::IsEmpty());
}

TEST(TextLint, TheTableOfIntegratorsMayAskItsStages) {
  EXPECT_THAT(rules_broken("src/model/integrator.h", "static_assert(!row.stages.empty());\n"),
              ::testing::IsEmpty());
}

TEST(TextLint, RepositoryIsClean) {
  const auto files = written_files(root);
  EXPECT_GE(files.size(), 400u);
  for (const auto& file : files) {
    for (const Offense& offense : lint(root, file, contents(root / file)))
      ADD_FAILURE() << file.generic_string() << ":" << offense.line << ": " << offense.rule << " ("
                    << offense.text << ")";
  }
}

TEST(FileSizes, LargeFilesAreFound) {
  const test::TemporaryDirectory dir;
  dir.write("small.jpg", std::string(most_file_bytes, 'x'));
  dir.write("large.jpg", std::string(most_file_bytes + 1, 'x'));
  dir.write("large.webp", std::string(most_animation_bytes + 1, 'x'));
  dir.write("small.webp", std::string(most_animation_bytes, 'x'));
  EXPECT_THAT(too_large(dir.path(), tracked_files(dir.path())),
              ::testing::ElementsAre("large.jpg: 150001 bytes", "large.webp: 1000001 bytes"));
}

TEST(FileSizes, EveryTrackedFileIsSmall) {
  const auto files = tracked_files(root);
  EXPECT_GE(files.size(), 900u);
  EXPECT_THAT(too_large(root, files), ::testing::IsEmpty())
      << "make it smaller: fewer pixels, fewer colors, or stronger compression";
}

/// The room that implements a public header.
std::string room_of_public(const std::string& header) {
  if (header == "error" || header == "export" || header == "version") return "base";
  if (header == "files") return "io";
  if (header == "parameters") return "scene";
  if (header == "sweep") return "variants";
  return std::filesystem::is_directory(root / "src" / header) ? header : "model";
}

/// The rooms that a directory of src includes headers of, its own left out.
std::set<std::string> included_rooms(const std::string& room) {
  static const std::regex include(R"re(#include "([a-z_]+)/([a-z_]+))re");
  std::set<std::string> rooms;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "src" / room)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".h" && extension != ".cpp") continue;
    const std::string text = contents(entry.path());
    for (std::sregex_iterator match(text.begin(), text.end(), include), end; match != end; ++match) {
      const std::string other = match->str(1) == "aspic" ? room_of_public(match->str(2)) : match->str(1);
      if (other != room && std::filesystem::is_directory(root / "src" / other)) rooms.insert(other);
    }
  }
  return rooms;
}

/// The table of docs/architecture.md: rooms and those they use, in the order of the rows.
std::vector<std::pair<std::string, std::set<std::string>>> documented_rooms() {
  static const std::regex row(R"(\| `src/([a-z_]+)` \|[^|]*\|([^|]*)\|)");
  static const std::regex name("[a-z_]+");
  const std::string page = contents(root / "docs/architecture.md");
  std::vector<std::pair<std::string, std::set<std::string>>> rooms;
  for (std::sregex_iterator match(page.begin(), page.end(), row), end; match != end; ++match) {
    const std::string uses = match->str(2);
    std::set<std::string> used;
    for (std::sregex_iterator word(uses.begin(), uses.end(), name); word != end; ++word)
      used.insert(word->str());
    rooms.emplace_back(match->str(1), std::move(used));
  }
  return rooms;
}

TEST(Rooms, UseWhatTheArchitectureSaysAndNothingBelowThem) {
  const auto documented = documented_rooms();
  std::set<std::string> seen;
  for (const auto& [room, uses] : documented) {
    EXPECT_EQ(included_rooms(room), uses) << "src/" << room;
    for (const std::string& used : uses)
      EXPECT_TRUE(seen.contains(used)) << room << " uses " << used << ", which comes later";
    seen.insert(room);
  }
  std::set<std::string> present;
  for (const auto& entry : std::filesystem::directory_iterator(root / "src"))
    if (entry.is_directory()) present.insert(entry.path().filename().string());
  EXPECT_EQ(seen, present);
}

// The reference proves the other solvers, so it must be short and share no search with them.
TEST(Reference, IsShortWithoutThreadsCachesAndVectorCode) {
  static const std::regex banned(
      R"(collision/|<thread>|<mutex>|<future>|<condition_variable>|hwy|highway|thread_local|atomic_ref|fetch_add)");
  std::size_t lines = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "src/cpu_reference")) {
    if (entry.path().extension() == ".txt" || !entry.is_regular_file()) continue;
    std::istringstream text(contents(entry.path()));
    for (std::string line; std::getline(text, line); ++lines)
      EXPECT_FALSE(std::regex_search(line, banned)) << entry.path() << ": " << line;
  }
  EXPECT_GT(lines, 1000u);
  EXPECT_LE(lines, 2800u);
}

/// What the public headers may not have: other libraries, the program's rooms, and a device's types.
std::vector<std::string> not_public(const std::string& text) {
  static const std::regex include(R"re(#include\s+(<[a-z_]+>|"aspic/[a-z_]+\.h")?[^\n]*)re");
  static const std::regex device(R"(\bgl::|\bGL[a-z]*_|\bGpuSolver\b|\bEgl|\.glsl\b|\bfmt::|\bEigen::)");
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), include), end; match != end; ++match)
    if (!(*match)[1].matched) found.push_back(match->str());
  for (std::sregex_iterator match(text.begin(), text.end(), device), end; match != end; ++match)
    found.push_back(match->str());
  return found;
}

TEST(PublicHeaders, WhatIsNotPublicIsFound) {
  EXPECT_THAT(not_public("#include <vector>\n#include \"aspic/model.h\"\nstruct Model;  // OpenGL\n"),
              ::testing::IsEmpty());
  EXPECT_THAT(
      not_public("#include <fmt/core.h>\n#include \"model/model.h\"\n#include <stdio.h>\ngl::Context* c;\n"),
      ::testing::SizeIs(4));
}

TEST(PublicHeaders, AreFewAndIncludeTheStandardLibraryAndEachOther) {
  std::size_t lines = 0;
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(root / "include/aspic")) {
    const std::string text = contents(entry.path());
    lines += static_cast<std::size_t>(std::ranges::count(text, '\n'));
    names.insert(entry.path().filename().string());
    EXPECT_THAT(not_public(text), ::testing::IsEmpty()) << entry.path();
  }
  // Room for what every front end says of an error and for the threads of every class; 115 are batch.h, 135
  // sweep.h, 25 what watches bodies that come to be within each other, 70 actuators.
  EXPECT_LE(lines, 2150u) << "a user reads them all";
  names.insert("version.h");  // generated
  const std::string all = contents(root / "include/aspic/aspic.h");
  names.erase("aspic.h");
  names.erase("export.h");
  for (const std::string& name : names)
    EXPECT_NE(all.find("\"aspic/" + name + "\""), std::string::npos) << "aspic.h leaves out " << name;
}

}  // namespace
}  // namespace aspic::testing
