// The commands of every --help and of the documents, as they are written. All are parsed; those of --help
// that draw nothing are run in the suite Examples, all others in ExamplesInFull. A run is shortened by rule,
// never changed otherwise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <wordexp.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/process.h"
#include "command_line/arguments.h"
#include "page/live_facts.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

struct Example {
  std::string where;  ///< "README.md:33", "aspic run --help"
  std::string command;
  std::string line = {};  ///< of a page: all that stands there
};

/// Files of a reader's own: a page says in the line of the command that it needs them.
constexpr std::string_view own_files[] = {"Configuration.txt", "my-scene.toml", "bunny.obj", "part.stl"};

/// What is parsed but not run, and why.
struct Exclusion {
  std::string_view what;  ///< part of the command or of the place
  std::string_view reason;
};
constexpr Exclusion exclusions[] = {
    {"aspic view", "opens a window and stays there"},
    {"docs/performance.md", "measures, for minutes to hours"},
    {"--thorough", "measures for minutes"},
    {"GALLIUM_DRIVER=zink", "needs a second driver, which the tests of zink ask for"},
};

bool is_excluded(const Example& example) {
  return std::ranges::any_of(exclusions, [&](const Exclusion& e) {
    return example.command.find(e.what) != std::string::npos ||
           example.where.find(e.what) != std::string::npos;
  });
}

/// A command with words to be replaced, SCENE or …, is a form and no example.
bool is_form(const std::string& command) {
  static const std::regex placeholder(R"(…|\$|\b(SCENE|FILE|NAME|DIR|KEY|VALUE|N)\b)");
  return std::regex_search(command, placeholder);
}

const std::regex program(R"(^([A-Z_]+=\S+ )*(build/release/)?aspic )");

/// A command without what explains it, three spaces or more behind it.
std::string alone(const std::string& line) {
  const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
  return line.substr(first, line.find("   ", first) - first);
}

/// The examples below the options of a command.
std::vector<Example> examples_of_help(const Words& command) {
  Words words = command;
  words.emplace_back("--help");
  const std::string text = test::aspic(words).out;
  std::string where = "aspic";
  for (const std::string& word : words) where += " " + word;
  std::vector<Example> examples;
  const std::size_t from = text.find("\nExample");
  for (const std::string& line : test::lines(from == std::string::npos ? "" : text.substr(from))) {
    if (const std::string shown = alone(line); line.starts_with("  ") && std::regex_search(shown, program))
      examples.push_back({where, shown});
  }
  return examples;
}

std::vector<Example> examples_of_all_help() {
  std::vector<Example> examples;
  for (const Words& command : {Words{},
                               {"run"},
                               {"view"},
                               {"compare"},
                               {"verify"},
                               {"bench"},
                               {"report"},
                               {"sweep"},
                               {"scene"},
                               {"scene", "list"},
                               {"scene", "show"},
                               {"scene", "check"},
                               {"scene", "import"},
                               {"info"}}) {
    const auto more = examples_of_help(command);
    EXPECT_FALSE(more.empty()) << (command.empty() ? "aspic" : command.back());
    examples.insert(examples.end(), more.begin(), more.end());
  }
  return examples;
}

/// Lines of code blocks, and code within text that names a scene.
std::vector<Example> examples_of_page(const fs::path& page) {
  static const std::regex inline_code("`([^`]+)`"),
      with_scene(R"(aspic ((scene \w+|run|view|compare|report|sweep|bench) [^-]|verify --only ).*)");
  std::vector<Example> examples;
  std::ifstream file(page);
  const auto add = [&](int number, const std::string& text, const std::string& command) {
    if (std::regex_search(command, program) && !is_form(command))
      examples.push_back(
          {fs::relative(page, ASPIC_SOURCE_DIR).string() + ":" + std::to_string(number), command, text});
  };
  bool block = false;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    const int first = ++number;
    if (line.starts_with("```")) {
      block = !block;
    } else if (block || line.starts_with("    ")) {
      for (std::string more; line.ends_with('\\') && std::getline(file, more); ++number)
        line = line.substr(0, line.find_last_not_of(" \\") + 1) + " " +
               more.substr(std::min(more.find_first_not_of(' '), more.size()));
      add(first, line, alone(line));
    } else {
      for (std::sregex_iterator at(line.begin(), line.end(), inline_code), end; at != end; ++at)
        if (std::regex_match(at->str(1), with_scene))
          add(first, line, std::regex_replace(at->str(1), std::regex(R"(\\\|)"), "|"));  // in a table
    }
  }
  return examples;
}

std::vector<fs::path> documents() {
  std::vector<fs::path> pages = {fs::path(ASPIC_SOURCE_DIR) / "README.md"};
  for (const auto& entry : fs::directory_iterator(fs::path(ASPIC_SOURCE_DIR) / "docs"))
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  std::ranges::sort(pages);
  return pages;
}

std::vector<Example> examples_of_pages() {
  std::vector<Example> examples;
  for (const fs::path& page : documents()) {
    const auto more = examples_of_page(page);
    examples.insert(examples.end(), more.begin(), more.end());
  }
  return examples;
}

/// The command without what the shell does with it: redirection, pipe, comment.
std::string without_shell(const std::string& command) {
  static const std::regex shell(R"(\s+([>|#]|&&).*$)");
  return std::regex_replace(command, shell, "");
}

Words words_of(const std::string& command) {
  wordexp_t expanded = {};
  EXPECT_EQ(::wordexp(command.c_str(), &expanded, WRDE_NOCMD), 0) << command;
  Words words(expanded.we_wordv, expanded.we_wordv + expanded.we_wordc);
  ::wordfree(&expanded);
  while (!words.empty() && words.front().find('=') != std::string::npos) words.erase(words.begin());
  return words;
}

void expect_parsed(const Example& example) {
  const Words words = words_of(without_shell(example.command));
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  const auto parsed = parse_arguments(static_cast<int>(argv.size()), argv.data());
  EXPECT_TRUE(parsed.ok()) << example.where << ": " << example.command << "\n" << parsed.error().message();
}

/// The value of an option divided, at least `least`; nothing where it is not given.
std::string divided(const std::string& command, const std::string& option, double divisor, double least) {
  const std::regex given(option + R"(( |=)([0-9.e-]+))");
  std::smatch found;
  if (!std::regex_search(command, found, given)) return "";
  std::ostringstream value;
  value << std::max(std::stod(found.str(2)) / divisor, least);
  return std::string(found.prefix()) + option + found.str(1) + value.str() + std::string(found.suffix());
}

struct Block {
  std::string where;     ///< "README.md:33", its first line
  std::string language;  ///< "toml"; empty: none is said
  std::string text;
  std::string before;  ///< the last line of text above it
};

/// The fenced blocks of a page.
std::vector<Block> blocks_of_page(const fs::path& page) {
  std::vector<Block> blocks;
  std::ifstream file(page);
  bool within = false;
  int number = 0;
  std::string before;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.starts_with("```")) {
      within = !within;
      if (within)
        blocks.push_back({fs::relative(page, ASPIC_SOURCE_DIR).string() + ":" + std::to_string(number),
                          line.substr(3), "", before});
    } else if (within) {
      blocks.back().text += line + "\n";
    } else if (!line.empty()) {
      before = line;
    }
  }
  return blocks;
}

/// The name under which a page says to save a block of TOML; empty: it does not.
std::string file_of(const Block& block) {
  static const std::regex named("as `([^`]+)`");
  std::smatch name;
  return block.language == "toml" && std::regex_search(block.before, name, named) ? name.str(1) : "";
}

/// What becomes of `aspic verify` when an example is run.
enum class Checks { listed, run };

/// A hundredth of its steps or duration, or 5 steps; checks are listed, measurements take a moment.
std::string shortened(const std::string& command, Checks checks) {
  const std::string bare = without_shell(command), rest = command.substr(bare.size());
  std::smatch name;
  if (!std::regex_search(bare, name, std::regex(R"(aspic (\w+))"))) return command;
  const std::string verb = name.str(1);
  if (verb == "run" || verb == "compare" || verb == "sweep") {
    for (const auto& [option, least] : {std::pair{"--steps", 1.0}, {"--duration", 0.0}})
      if (const std::string shorter = divided(bare, option, 100.0, least); !shorter.empty())
        return shorter + rest;
    return bare + " --steps 5" + rest;
  }
  if (verb == "verify") return checks == Checks::run ? command : bare + " --list" + rest;
  if (verb == "report") {
    const bool net = bare.find("course-2018") != std::string::npos;
    return bare + " --set simulation.duration=0.05 --set " +
           (net ? "'goal-net[0].particles=[3,3,3]'" : "'cube[0].particles-per-edge=3'") + rest;
  }
  if (verb != "bench") return command;
  const std::string shorter = divided(bare, "--seconds", 1000.0, 0.001),
                    whole = divided(bare, "--duration", 100.0, 0.0);
  return (!shorter.empty() ? shorter
          : !whole.empty() ? whole
                           : bare + " --seconds 0.001") +
         (bare.find("--repeats") == std::string::npos ? " --repeats 1 --warm-up 0" : "") + rest;
}

bool draws(const Example& example) {
  return std::regex_search(example.command, std::regex("--(video|frames|images)\\b|aspic report"));
}

/// Runs examples in the order in which they stand, in a directory with the files that a reader would have.
class Reader {
 public:
  Reader() {
    fs::create_directory(dir_.file("bin"));
    fs::create_symlink(ASPIC_PROGRAM, dir_.file("bin/aspic"));
    fs::create_directories(dir_.file("build/release"));
    fs::create_symlink(ASPIC_PROGRAM, dir_.file("build/release/aspic"));
    fs::copy_file(fs::path(ASPIC_SOURCE_DIR) / "tests/data/import/Configuration.txt",
                  dir_.file("Configuration.txt"));
    const auto scene = test::aspic({"scene", "show", "cube-plane", "--set", "cube[0].particles-per-edge=4"});
    dir_.write("my-scene.toml", scene.out);
    fs::copy_file(fs::path(ASPIC_SOURCE_DIR) / "assets/meshes/rabbit.obj", dir_.file("bunny.obj"));
    // A tetrahedron in millimeters.
    std::string part = "solid part\n";
    for (const char* const corners :
         {"vertex 0 0 0 vertex 0 90 0 vertex 90 0 0", "vertex 0 0 0 vertex 90 0 0 vertex 0 0 90",
          "vertex 0 0 0 vertex 0 0 90 vertex 0 90 0", "vertex 90 0 0 vertex 0 90 0 vertex 0 0 90"})
      part += std::string("facet normal 0 0 0\nouter loop\n") + corners + "\nendloop\nendfacet\n";
    dir_.write("part.stl", part + "endsolid part\n");
    dir_.write("hands.toml", "[[inputs]]\nstep = 5\npinned = [0]\n");
    for (const fs::path& page : documents())
      for (const Block& block : blocks_of_page(page))
        if (const std::string name = file_of(block); !name.empty()) dir_.write(name, block.text);
  }

  /// What `aspic scene check` says of a file that is here for the moment.
  test::Finished check(const std::string& name, const std::string& text) {
    dir_.write(name, text);
    test::ProcessOptions shell;
    shell.program = "/bin/sh";
    auto done =
        test::aspic({"-c", "cd '" + dir_.path().string() + "' && bin/aspic scene check " + name}, shell);
    fs::remove(dir_.file(name));
    return done;
  }

  void run(const Example& example, Checks checks = Checks::listed) {
    // What one example wrote may be in the way of the next; scenes and checkpoints are meant for it.
    for (const auto& entry : fs::directory_iterator(dir_.path())) {
      const std::string ending = entry.path().extension().string(), name = entry.path().filename().string();
      if (name == "bunny.obj" || name == "part.stl") continue;
      if (entry.is_regular_file() && ending != ".toml" && ending != ".aspic" && ending != ".txt")
        fs::remove(entry.path());
    }
    for (const char* const made : {"out", "report", "part", "map", "rest", "mine", "outline"})
      fs::remove_all(dir_.file(made));
    const std::string command = shortened(example.command, checks);
    test::ProcessOptions shell;
    shell.program = "/bin/sh";
    const char* const path = std::getenv("PATH");
    shell.environment = {{"PATH", dir_.file("bin") + ":" + (path ? path : "/usr/bin:/bin")}};
    const auto done = test::aspic({"-c", "cd '" + dir_.path().string() + "' && " + command}, shell);
    // A program without the module of scripts/wasm.sh says how to get it.
    const bool lacks_module = command.find("--html-live") != std::string::npos && !page::live_module();
    EXPECT_EQ(done.exit_code, lacks_module ? 6 : 0)
        << example.where << ": " << example.command << "\nrun as " << command << "\n"
        << done.err << done.out;
    if (lacks_module) {
      EXPECT_THAT(done.err, testing::HasSubstr("Run scripts/wasm.sh"));
    }
  }

 private:
  test::TemporaryDirectory dir_;
};

TEST(Examples, MayHaveFormerNames) {
  const char* const view[] = {"aspic", "view", "--layout", "film"};
  EXPECT_EQ(std::get<ViewOptions>(*parse_arguments(4, view)).layout, "video");
  const char* const bench[] = {"aspic", "bench", "--pictures", "64x48"};
  EXPECT_EQ(std::get<BenchOptions>(*parse_arguments(4, bench)).images, (ImageSize{64, 48}));
}

TEST(Examples, AllAreUnderstood) {
  const auto pages = examples_of_pages(), help = examples_of_all_help();
  // Fewer than there are means that they are no longer found.
  EXPECT_GE(pages.size(), 100u);
  EXPECT_GE(help.size(), 40u);
  for (const Example& example : pages) expect_parsed(example);
  for (const Example& example : help) expect_parsed(example);
  for (const Exclusion& exclusion : exclusions) {
    const auto meant = [&](const Example& example) {
      return example.command.find(exclusion.what) != std::string::npos ||
             example.where.find(exclusion.what) != std::string::npos;
    };
    EXPECT_TRUE(std::ranges::any_of(pages, meant) || std::ranges::any_of(help, meant)) << exclusion.what;
  }
}

TEST(Examples, OfPagesSayWhatElseTheyNeed) {
  std::set<std::string> made;
  std::string page;
  for (const Example& example : examples_of_pages()) {
    const std::string here = example.where.substr(0, example.where.find(':'));
    if (std::exchange(page, here) != here) made.clear();
    const std::string bare = without_shell(example.command);
    for (const std::string_view name : own_files) {
      if (bare.find(name) != std::string::npos && !made.contains(std::string(name))) {
        EXPECT_THAT(example.line, testing::HasSubstr("your " + std::string(name))) << example.where;
      }
      if (example.command.find("> " + std::string(name)) != std::string::npos) made.emplace(name);
    }
    if (bare.find("--html-live") != std::string::npos) {
      EXPECT_THAT(example.line, testing::HasSubstr("scripts/wasm.sh")) << example.where;
    }
  }
}

TEST(Examples, OfHelpRun) {
  Reader reader;
  for (const Example& example : examples_of_all_help())
    if (!is_excluded(example) && !draws(example)) reader.run(example);
}

TEST(Examples, ScenesOfDocumentsAreAccepted) {
  Reader reader;
  int scenes = 0;
  for (const fs::path& page : documents())
    for (const Block& block : blocks_of_page(page)) {
      // Inputs are files of their own.
      if (block.language != "toml" || block.text.find("[[inputs]]") != std::string::npos) continue;
      ++scenes;
      const bool complete = block.text.find("schema = ") != std::string::npos;
      const auto done = reader.check("block.toml", (complete ? "" : "schema = 1\n") + block.text);
      EXPECT_EQ(done.exit_code, 0) << block.where << "\n" << done.err;
    }
  EXPECT_GE(scenes, 2);
}

// The page of commands shows what an error in line 20 looks like.
TEST(Examples, ErrorOfCommandsPageIsWhatItSays) {
  const auto blocks = blocks_of_page(fs::path(ASPIC_SOURCE_DIR) / "docs/commands.md");
  const auto shown = std::ranges::find_if(
      blocks, [](const Block& b) { return b.text.starts_with("aspic: jelly.toml:20:16:"); });
  ASSERT_NE(shown, blocks.end());
  const std::string line = test::lines(shown->text).at(1);
  ASSERT_TRUE(line.starts_with("  20 | "));
  Reader reader;
  const auto done = reader.check("jelly.toml", "schema = 1\n" + std::string(17, '\n') + "[[cube]]\n" +
                                                   line.substr(std::string_view("  20 | ").size()) + "\n");
  EXPECT_EQ(done.exit_code, 3);
  EXPECT_EQ(done.err, shown->text);
}

// The page of the assignments sends its reader to rows of aspic verify, which have to pass.
TEST(Examples, OfCoursePageRun) {
  Reader reader;
  std::set<std::string> done;
  std::size_t rows = 0;
  for (const Example& example : examples_of_page(fs::path(ASPIC_SOURCE_DIR) / "docs/course.md")) {
    if (draws(example) || !done.insert(example.command).second) continue;
    rows += example.command.starts_with("aspic verify");
    reader.run(example, Checks::run);
  }
  EXPECT_GE(rows, 15u);
}

/// The line of "README.md:33".
int line_of(const std::string& where) {
  return std::stoi(where.substr(where.find(':') + 1));
}

/// A summary without the lines that differ between machines.
Words same_everywhere(const std::string& summary) {
  Words kept = test::lines(summary);
  std::erase_if(kept, [](const std::string& line) {
    return std::ranges::any_of(Words{"device ", "took "},
                               [&](const std::string& word) { return line.starts_with(word); });
  });
  return kept;
}

// Commands below the README's set-up, in its order, in one folder that only they and the scene of the page
// fill. Where the page shows an output, the program's equals it.
TEST(Examples, OfReadmeRunInOrderInAnEmptyFolder) {
  const fs::path readme = fs::path(ASPIC_SOURCE_DIR) / "README.md";
  const auto blocks = blocks_of_page(readme);
  const auto examples = examples_of_page(readme);
  EXPECT_GE(examples.size(), 15u);
  // An interactive zsh takes what follows # for arguments.
  for (const Block& block : blocks)
    EXPECT_TRUE(block.language != "sh" || block.text.find('#') == std::string::npos) << block.where;
  Words shells = {"/bin/bash"};
  if (fs::exists("/usr/bin/zsh")) shells.emplace_back("/usr/bin/zsh");
  for (const std::string& program : shells) {
    const test::TemporaryDirectory programs, folder;
    fs::create_symlink(ASPIC_PROGRAM, programs.file("aspic"));
    test::ProcessOptions shell;
    shell.program = program;
    shell.environment = {{"PATH", programs.path().string() + ":/usr/bin:/bin"}};
    for (std::size_t i = 0; i < examples.size(); ++i) {
      const int line = line_of(examples[i].where),
                next = i + 1 < examples.size() ? line_of(examples[i + 1].where) : line + 1000;
      const Block* output = nullptr;
      for (const Block& block : blocks) {
        if (const std::string name = file_of(block); !name.empty() && line_of(block.where) < line)
          folder.write(name, block.text);
        if (block.language == "text" && line_of(block.where) > line && line_of(block.where) < next)
          output = &block;
      }
      if (is_excluded(examples[i])) continue;
      const std::string command =
          output ? examples[i].command : shortened(examples[i].command, Checks::listed);
      const auto done = test::aspic({"-c", "cd '" + folder.path().string() + "' && " + command}, shell);
      EXPECT_EQ(done.exit_code, 0) << program << ", " << examples[i].where << ": " << command << "\n"
                                   << done.err << done.out;
      if (output) {
        EXPECT_EQ(same_everywhere(done.out), same_everywhere(output->text));
      }
    }
  }
}

TEST(ExamplesInFull, OfHelpDraw) {
  Reader reader;
  for (const Example& example : examples_of_all_help())
    if (!is_excluded(example) && draws(example)) reader.run(example);
}

TEST(ExamplesInFull, OfPagesRun) {
  Reader reader;
  std::set<std::string> done;  // some stand on several pages
  for (const Example& example : examples_of_pages())
    if (!is_excluded(example) && done.insert(example.command).second) reader.run(example);
}

}  // namespace
}  // namespace aspic
