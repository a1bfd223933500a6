// Manual pages and completion as they are installed, against what the programs say of themselves in --help.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli/process.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::UnorderedElementsAreArray;
using Words = std::vector<std::string>;

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

struct Helped {
  Words command;  ///< "scene", "list"; none for the program itself
  Words options;
  Words commands;  ///< below it
};

/// What the --help of a command lists.
Helped help_of(const Words& command) {
  Helped found{command, {}, {}};
  Words words = command;
  words.emplace_back("--help");
  bool commands = false;
  for (const std::string& line : test::lines(test::aspic(words).out)) {
    commands = line == "Subcommands:" || (commands && line.starts_with("  "));
    if (!line.starts_with("  ") || line.starts_with("   ")) continue;
    const std::string first = line.substr(2, line.find_first_of(" =", 2) - 2);
    if (commands) found.commands.push_back(first);
    if (!first.starts_with('-')) continue;
    std::istringstream names(first);
    for (std::string name; std::getline(names, name, ',');) found.options.push_back(name);
  }
  return found;
}

void collect_help(const Words& command, std::vector<Helped>& all) {
  all.push_back(help_of(command));
  for (const std::string& below : Words(all.back().commands)) {
    Words words = command;
    words.push_back(below);
    collect_help(words, all);
  }
}

/// The program and all of its commands, in the order of --help.
const std::vector<Helped>& everything() {
  static const std::vector<Helped> all = [] {
    std::vector<Helped> found;
    collect_help({}, found);
    return found;
  }();
  return all;
}

/// The page that has a command: those below `scene` are in that of scene.
std::string page_of(const Words& command) {
  return text_of(fs::path(ASPIC_MANUAL) / ("aspic" + (command.empty() ? "" : "-" + command.front()) + ".1"));
}

/// Without what roff needs.
std::string plain(const std::string& roff) {
  return std::regex_replace(roff, std::regex(R"(\\f[A-Z]|\\,|\\/|\\)"), "");
}

/// Output lines of a shell that was given a script and arguments.
Words shell(const std::string& program, const Words& arguments) {
  static const test::TemporaryDirectory home;
  test::ProcessOptions options;
  options.program = program;
  options.environment = {{"HOME", home.path().string()}};
  const auto done = test::aspic(arguments, options);
  EXPECT_EQ(done.exit_code, 0) << program << " ended with " << done.err;
  EXPECT_THAT(done.err, IsEmpty()) << program;
  return test::lines(done.out);
}

fs::path script(const std::string& name) {
  return fs::path(ASPIC_SOURCE_DIR) / "assets/shell" / name;
}

/// Words of a command line as they are typed, with the program's path in place of its name.
Words typed(Words words) {
  words.front() = std::string(ASPIC_PROGRAM) + words.front().substr(std::string_view("aspic").size());
  return words;
}

/// What bash offers for the last of these words.
Words bash(const Words& words) {
  Words arguments = {"--norc", "-c",
                     "compopt() { :; }; source '" + script("aspic.bash").string() +
                         "'; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _aspic; "
                         "printf '%s\\n' \"${COMPREPLY[@]}\"",
                     "bash"};
  const Words line = typed(words);
  arguments.insert(arguments.end(), line.begin(), line.end());
  return shell("/bin/bash", arguments);
}

/// What fish offers at the end of a line, without descriptions.
Words fish(const std::string& line) {
  const std::string folder = fs::path(ASPIC_PROGRAM).parent_path().string();
  Words offered =
      shell("/usr/bin/fish", {"--no-config", "-c",
                              "set -p PATH '" + folder + "'; source '" + script("aspic.fish").string() +
                                  "'; complete -C '" + line + "'"});
  for (std::string& word : offered) word = word.substr(0, word.find('\t'));
  return offered;
}

TEST(Manual, HasEveryCommandAndOption) {
  ASSERT_GE(everything().size(), 14u);
  for (const Helped& helped : everything()) {
    const std::string page = plain(page_of(helped.command));
    ASSERT_FALSE(helped.options.empty());
    for (const std::string& option : helped.options) EXPECT_THAT(page, HasSubstr(option));
    for (const std::string& below : helped.commands)
      EXPECT_THAT(page,
                  HasSubstr(helped.command.empty() ? "aspic-" + below + " (1)"
                                                   : ".SS aspic " + helped.command.front() + " " + below));
  }
}

TEST(Manual, PagesHaveTheirSections) {
  for (const Helped& helped : everything()) {
    const std::string page = page_of(helped.command);
    for (const char* const section :
         {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS", "ENVIRONMENT", "EXAMPLES", "SEE ALSO"})
      EXPECT_TRUE(std::regex_search(page, std::regex(std::string("\n\\.SH \"?") + section + "\"?\n")))
          << section;
    EXPECT_FALSE(std::regex_search(page, std::regex(R"(`|\]\(|\*\*)"))) << "marks of Markdown";
  }
}

TEST(Manual, HasExitCodesOfHelp) {
  const std::string help = test::aspic({"--help"}).out;
  const std::string codes = help.substr(help.find("Exit codes:"));
  const std::regex code(R"(\b([0-9]+) )");
  const std::string page = page_of({});
  int found = 0;
  for (std::sregex_iterator at(codes.begin(), codes.end(), code), end; at != end; ++at, ++found)
    EXPECT_THAT(page, HasSubstr(".TP\n\\fB" + at->str(1) + "\\fR\n"));
  EXPECT_GE(found, 9);
}

TEST(Manual, HasEveryVariableOfTheSources) {
  const std::string page = page_of({});
  const std::regex reading(R"(getenv\("((ASPIC|XDG)_\w+)\"\))");
  std::set<std::string> variables;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(ASPIC_SOURCE_DIR) / "src")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator at(text.begin(), text.end(), reading), end; at != end; ++at)
      variables.insert(at->str(1));
  }
  EXPECT_GE(variables.size(), 5u);
  for (const std::string& variable : variables) EXPECT_THAT(page, HasSubstr("\\fB" + variable + "\\fR"));
}

TEST(Manual, RendersWithoutWarnings) {
  int pages = 0;
  for (const auto& entry : fs::directory_iterator(ASPIC_MANUAL)) {
    test::ProcessOptions options;
    options.program = "/usr/bin/man";
    options.environment = {{"LC_ALL", "C.UTF-8"}, {"MANROFFSEQ", ""}, {"MANWIDTH", "80"}};
    const auto done =
        test::aspic({"--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", entry.path().string()}, options);
    EXPECT_EQ(done.exit_code, 0) << entry.path();
    EXPECT_THAT(done.err, IsEmpty()) << entry.path();
    EXPECT_THAT(done.out, HasSubstr("SEE")) << entry.path();
    ++pages;
  }
  EXPECT_EQ(pages, 10);
}

TEST(Completion, BashOffersEveryOptionOfItsCommand) {
  for (const Helped& helped : everything()) {
    Words words = {"aspic"};
    words.insert(words.end(), helped.command.begin(), helped.command.end());
    words.emplace_back("-");
    EXPECT_THAT(bash(words), UnorderedElementsAreArray(helped.options)) << testing::PrintToString(words);
    if (helped.commands.empty()) continue;
    words.back() = "";
    EXPECT_THAT(bash(words), UnorderedElementsAreArray(helped.commands));
  }
  EXPECT_THAT(bash({"aspic-view", "-"}), UnorderedElementsAreArray(help_of({"view"}).options));
}

TEST(Completion, BashOffersValues) {
  EXPECT_EQ(bash({"aspic", "run", "--backend", "r"}), Words{"reference"});
  EXPECT_EQ(bash({"aspic", "run", "cube-plane", "--backend", "=", "c"}), Words{"cpu"});
  EXPECT_EQ(bash({"aspic", "run", "--precision", "="}), (Words{"single", "double"}));
  EXPECT_EQ(bash({"aspic", "run", "cube-bo"}), Words{"cube-bowl"});
  EXPECT_EQ(bash({"aspic-view", "--layout", "le"}), Words{"lecture"});
  EXPECT_EQ(bash({"aspic", "run", "--set", "simulation.times"}), Words{"simulation.timestep="});
  EXPECT_THAT(bash({"aspic", "sweep", "cube-plane", "--vary", ""}),
              IsSupersetOf({"k=", "mu=", "cube[0].position="}));
  EXPECT_EQ(bash({"aspic", "report", "--only", "sta"}), Words{"stability"});
  EXPECT_THAT(bash({"aspic", "verify", "--only", "o"}), Contains("order"));
  EXPECT_EQ(bash({"aspic", "run", "--frames-format", ""}), (Words{"png", "jpg"}));
}

TEST(Completion, BashOffersFiles) {
  const test::TemporaryDirectory directory;
  directory.write("a scene.toml", "");
  directory.write("a table.csv", "");
  fs::create_directory(directory.file("a folder"));
  const std::string start = directory.file("a ");
  EXPECT_THAT(bash({"aspic", "scene", "check", start}),
              testing::UnorderedElementsAre(start + "scene.toml", start + "folder"));
  EXPECT_EQ(bash({"aspic", "run", "--state", start}).size(), 3u);
  EXPECT_EQ(bash({"aspic", "run", "--frames", start}), Words{start + "folder"});
}

TEST(Completion, FishOffersOptionsAndValues) {
  for (const Helped& helped : everything()) {
    std::string line = "aspic";
    for (const std::string& word : helped.command) line += " " + word;
    EXPECT_THAT(fish(line + " -"), IsSupersetOf(helped.options)) << line;
    if (helped.commands.empty()) continue;
    EXPECT_THAT(fish(line + " "), IsSupersetOf(helped.commands));
  }
  EXPECT_EQ(fish("aspic run --backend r"), Words{"reference"});
  EXPECT_THAT(fish("aspic scene show cube-b"), Contains("cube-bowl"));
  EXPECT_THAT(fish("aspic-view --layout "), IsSupersetOf({"standard", "lecture"}));
  EXPECT_THAT(fish("aspic run --set cube"), Contains("cube[0].position="));
}

// zsh completes only at a terminal: its own module plays one.
TEST(Completion, ZshOffersOptionsAndValues) {
  const test::TemporaryDirectory home;
  const Words found = shell("/usr/bin/zsh", {ASPIC_ZSH_SCRIPT, script("").string(), home.path().string(),
                                             fs::path(ASPIC_PROGRAM).parent_path().string()});
  EXPECT_EQ(found,
            (Words{"aspic run --backend=reference", "aspic run --checkpoint-every", "aspic scene import",
                   "aspic-view --layout=lecture", "aspic run cube-bowl",
                   "aspic run --set simulation.timestep=", "aspic bench --integrator velocity-verlet"}));
}

}  // namespace
}  // namespace aspic
