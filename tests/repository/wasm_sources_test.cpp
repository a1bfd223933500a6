// scripts/wasm.sh lists the sources of the module by name; a file that some of them come to use must not be
// missed, since the module is linked in few builds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace aspic::testing {
namespace {

namespace fs = std::filesystem;
const fs::path source_tree = ASPIC_SOURCE_DIR;

std::string text_in(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::vector<std::string> matches(const std::string& text, const char* pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
    found.push_back(match->str(1));
  return found;
}

/// `src/a/{b,c}.cpp` and `src/a/*.cpp` as the shell reads them, without endings.
std::set<std::string> expanded(const std::string& pattern) {
  const fs::path directory = fs::path(pattern).parent_path();
  const std::string name = fs::path(pattern).stem().string();
  std::set<std::string> files;
  if (name == "*") {
    for (const auto& entry : fs::directory_iterator(source_tree / directory))
      if (entry.path().extension() == ".cpp") files.insert((directory / entry.path().stem()).string());
    return files;
  }
  for (const std::string& part : matches(name, "([a-z_]+)")) files.insert((directory / part).string());
  return files;
}

std::set<std::string> listed_sources() {
  const std::string script = text_in(source_tree / "scripts/wasm.sh");
  const std::size_t begin = script.find("sources=("), end = script.find(")\n", begin);
  std::set<std::string> all;
  for (const std::string& pattern : matches(script.substr(begin, end - begin), R"((src/\S+\.cpp))"))
    all.merge(expanded(pattern));
  return all;
}

/// Sources beside the headers that these include, directly or through others.
std::set<std::string> used_sources(const std::set<std::string>& sources) {
  std::set<std::string> used, seen;
  std::vector<std::string> left;
  for (const std::string& source : sources) left.push_back(source + ".cpp");
  while (!left.empty()) {
    const std::string file = left.back();
    left.pop_back();
    if (!seen.insert(file).second) continue;
    for (const std::string& header :
         matches(text_in(source_tree / file), R"re(#include "([a-z_/]+)\.h")re")) {
      const bool own = fs::exists(source_tree / "src" / (header + ".h"));
      left.push_back((own ? "src/" : "include/") + header + ".h");
      if (own && fs::exists(source_tree / "src" / (header + ".cpp"))) used.insert("src/" + header);
    }
  }
  return used;
}

TEST(WasmSources, HaveEverySourceThatTheyUse) {
  const std::set<std::string> listed = listed_sources();
  EXPECT_THAT(listed, ::testing::IsSupersetOf({"src/base/result", "src/model/cube", "src/live/exports",
                                               "src/scene/write", "src/analysis/energy"}));
  for (const std::string& source : listed) EXPECT_TRUE(fs::exists(source_tree / (source + ".cpp"))) << source;
  for (const std::string& source : used_sources(listed)) {
    // Cells come to a page as layers: nothing is made of meshes there. src/live/no_files.cpp knows of memory.
    if (source.starts_with("src/mesh/") || source == "src/base/memory") continue;
    EXPECT_TRUE(listed.contains(source)) << source << ".cpp: name it in scripts/wasm.sh";
  }
  // Rows of tables are used without a header of their own.
  for (const auto& entry : fs::directory_iterator(source_tree / "src/scene")) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() == ".cpp" && name.ends_with("_rows")) {
      EXPECT_TRUE(listed.contains("src/scene/" + name)) << name;
    }
  }
  // One that is left out is noticed.
  std::set<std::string> fewer = listed;
  fewer.erase("src/scene/follow");
  EXPECT_TRUE(used_sources(fewer).contains("src/scene/follow"));
}

}  // namespace
}  // namespace aspic::testing
