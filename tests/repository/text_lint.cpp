#include "repository/text_lint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace aspic::testing {
namespace {

namespace fs = std::filesystem;

/// Directories and files that people write.
constexpr std::string_view written[] = {".ci",
                                        "CHANGELOG.md",
                                        "CMakeLists.txt",
                                        "CMakePresets.json",
                                        "CONTRIBUTING.md",
                                        "README.md",
                                        "SECURITY.md",
                                        "assets",
                                        "bench",
                                        "cmake",
                                        "docs",
                                        "examples",
                                        "include",
                                        "python",
                                        "scripts",
                                        "shaders",
                                        "src",
                                        "tests"};
/// Data, results of measurements, and the offenses planted for this lint.
constexpr std::string_view left_out[] = {"tests/repository", "bench/results", "tests/data",
                                         "tests/fuzz/regressions"};
/// Rooms that every program may use.
constexpr std::string_view library_rooms[] = {
    "analysis", "base",  "cpu_parallel", "cpu_reference", "device", "gpu", "gpu_solver",
    "io",       "model", "page",         "playback",      "render", "run", "scene"};
constexpr std::string_view extensions[] = {"",      ".cpp",   ".h",    ".glsl", ".comp", ".vert",
                                           ".frag", ".md",    ".txt",  ".sh",   ".py",   ".js",
                                           ".html", ".cmake", ".toml", ".json", ".supp"};

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

/// A heading as links name it: lower case, letters, digits, hyphens and underscores, spaces as hyphens.
std::string anchor_of(std::string_view heading) {
  std::string result;
  for (const char c : lower(heading)) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == ' ') result += '-';
    if (std::isalnum(byte) || c == '-' || c == '_' || byte >= 0x80) result += c;
  }
  return result;
}

std::vector<std::string> headings(const fs::path& page) {
  std::vector<std::string> result;
  std::istringstream lines(contents(page));
  for (std::string line; std::getline(lines, line);) {
    const auto text = line.find_first_not_of('#');
    if (text == 0 || text == std::string::npos || line[text] != ' ') continue;
    result.push_back(line.substr(text + 1));
  }
  return result;
}

/// All matches of a pattern in a line.
std::vector<std::smatch> matches(const std::string& line, const std::regex& pattern) {
  return {std::sregex_iterator(line.begin(), line.end(), pattern), std::sregex_iterator()};
}

/// Whether a file is code of the library that speaks to all front ends.
bool speaks_to_all(const fs::path& file) {
  const std::string extension = file.extension().string(), stem = file.stem().string();
  if ((extension != ".h" && extension != ".cpp") || file == "src/base/wording.cpp" || stem.ends_with("_main"))
    return false;
  auto part = file.begin();
  return *part == "src" && std::ranges::find(library_rooms, (++part)->string()) != std::end(library_rooms);
}

/// Looks at one line of one file.
class Line {
 public:
  Line(const fs::path& root, const fs::path& file, int number, const std::string& text,
       std::vector<Offense>& found)
      : root_(root), file_(file), number_(number), text_(text), found_(found) {}

  void outside() {
    static const std::regex pages(R"(\bspec §|\bspec\.md|\(spec |\bof the spec |\bshared/[a-z]+\.md)",
                                  std::regex::icase);
    if (lower(text_).find("spec") == std::string::npos && text_.find("shared/") == std::string::npos) return;
    for (const std::smatch& match : matches(text_, pages)) add("outside", match.str());
  }

  void pages() {
    if (text_.find("docs/") == std::string::npos) return;
    static const std::regex page(R"re((docs/[a-z-]+\.md)(, sections? (\d+)|, "([^"]+)")?)re");
    for (const std::smatch& match : matches(text_, page)) {
      const fs::path path = root_ / match.str(1);
      if (!fs::exists(path)) {
        add("path", match.str(1));
      } else if (match[2].matched && std::ranges::none_of(headings(path), [&](const std::string& heading) {
                   return match[3].matched ? heading.starts_with(match.str(3) + ". ")
                                           : heading == match.str(4);
                 })) {
        add("section", match.str(0));
      }
    }
  }

  void kinds() {
    static const std::regex question(R"(\bstages(\(\))?(\.|->)empty\(\))");
    const bool code = file_.extension() == ".h" || file_.extension() == ".cpp";
    if (!code || file_ == "src/model/integrator.h" || text_.find("stages") == std::string::npos) return;
    for (const std::smatch& match : matches(text_, question)) add("kind", match.str());
  }

  void options() {
    if (text_.find("--") == std::string::npos || !speaks_to_all(file_)) return;
    bool inside = false;
    for (std::size_t i = 0; i + 2 < text_.size(); ++i) {
      if (!inside && text_.compare(i, 2, "//") == 0) return;
      if (inside && text_[i] == '\\')
        ++i;
      else if (text_[i] == '"')
        inside = !inside;
      const auto next = static_cast<unsigned char>(text_[i + 2]);
      if (inside && text_.compare(i, 2, "--") == 0 && (std::isalpha(next) || next == '{'))
        add("option", text_.substr(i));
    }
  }

  void paths() {
    if (text_.find('`') == std::string::npos) return;
    static const std::regex quoted(R"(`((src|shaders|tests|scripts|bench|examples|cmake|assets)/[\w./-]+)`)");
    for (const std::smatch& match : matches(text_, quoted))
      // NAME in a path is what the reader fills in.
      if (match.str(1).find("NAME") == std::string::npos && !fs::exists(root_ / match.str(1)))
        add("path", match.str(1));
  }

  void links() {
    if (text_.find("](") == std::string::npos) return;
    static const std::regex link(R"(\]\(([^)#\s]*)(#([^)\s]*))?\))");
    for (const std::smatch& match : matches(text_, link)) {
      if (match.str(1).find("://") != std::string::npos) continue;
      const fs::path here = root_ / file_;
      const fs::path target = match.length(1) == 0 ? here : here.parent_path() / match.str(1);
      if (!fs::exists(target)) {
        add("link", match.str(1));
      } else if (match[3].matched && std::ranges::none_of(headings(target), [&](const std::string& heading) {
                   return anchor_of(heading) == match.str(3);
                 })) {
        add("anchor", match.str(0));
      }
    }
  }

 private:
  void add(std::string rule, std::string text) {
    found_.push_back({number_, std::move(rule), std::move(text)});
  }

  const fs::path& root_;
  const fs::path& file_;
  int number_;
  const std::string& text_;
  std::vector<Offense>& found_;
};

}  // namespace

std::string contents(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  EXPECT_TRUE(stream.is_open()) << path;
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::vector<Offense> lint(const fs::path& root, const fs::path& file, std::string_view text) {
  std::vector<Offense> found;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    Line looked_at(root, file, ++number, line, found);
    looked_at.outside();
    looked_at.pages();
    looked_at.kinds();
    looked_at.options();
    if (file.extension() != ".md") continue;
    looked_at.paths();
    looked_at.links();
  }
  return found;
}

std::vector<fs::path> written_files(const fs::path& root) {
  std::vector<fs::path> files;
  const auto take = [&](const fs::path& path) {
    if (std::ranges::find(extensions, path.extension().string()) == std::end(extensions)) return;
    const fs::path relative = path.lexically_relative(root);
    const std::string name = relative.generic_string();
    if (std::ranges::none_of(left_out, [&](std::string_view prefix) { return name.starts_with(prefix); }))
      files.push_back(relative);
  };
  for (const std::string_view name : written) {
    const fs::path path = root / name;
    if (fs::is_regular_file(path)) take(path);
    if (!fs::is_directory(path)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(path))
      if (entry.is_regular_file()) take(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::vector<fs::path> tracked_files(const fs::path& root) {
  std::vector<fs::path> files;
  const std::string command = "git -C '" + root.string() + "' ls-files -z 2>/dev/null";
  if (std::FILE* const git = ::popen(command.c_str(), "r")) {
    std::string name;
    for (int c = std::fgetc(git); c != EOF; c = std::fgetc(git)) {
      if (c != 0) {
        name += static_cast<char>(c);
        continue;
      }
      files.emplace_back(name);
      name.clear();
    }
    if (::pclose(git) == 0 && !files.empty()) return files;
  }
  files.clear();
  for (auto entry = fs::recursive_directory_iterator(root); entry != fs::recursive_directory_iterator();
       ++entry) {
    const std::string name = entry->path().filename().string();
    const bool ours = name == ".ci" || !(name.starts_with(".") || name == "build" || name == "out");
    if (entry->is_directory() && !ours) entry.disable_recursion_pending();
    if (entry->is_regular_file()) files.push_back(entry->path().lexically_relative(root));
  }
  std::ranges::sort(files);
  return files;
}

std::vector<std::string> too_large(const fs::path& root, const std::vector<fs::path>& files) {
  std::vector<std::string> found;
  for (const fs::path& file : files) {
    if (!fs::is_regular_file(root / file)) continue;  // removed, and not yet committed
    const std::uintmax_t bytes = fs::file_size(root / file);
    if (bytes > (file.extension() == ".webp" ? most_animation_bytes : most_file_bytes))
      found.push_back(file.generic_string() + ": " + std::to_string(bytes) + " bytes");
  }
  return found;
}

}  // namespace aspic::testing
