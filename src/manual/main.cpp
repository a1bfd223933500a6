// aspic-manual COMMANDS.md DIRECTORY DATE: writes manual pages and completion below the directory.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "manual/manual.h"

namespace {

int write(const std::string& page, const std::filesystem::path& directory, const std::string& date) {
  using namespace aspic::manual;
  std::ifstream file(page);
  const std::string markdown{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const aspic::CommandFacts aspic = aspic::describe_commands();
  std::vector<TextFile> files = manual_pages(aspic, sections_of(markdown), date);
  for (const auto& completion : {bash_completion(aspic), zsh_completion(aspic), fish_completion(aspic)})
    files.insert(files.end(), completion.begin(), completion.end());
  std::filesystem::remove_all(directory);
  for (const TextFile& made : files) {
    const std::filesystem::path path = directory / made.path;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream out(path);
    out << made.text << std::flush;
    if (out) continue;
    std::fprintf(stderr, "%s cannot be written.\n", path.c_str());
    return 6;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: aspic-manual COMMANDS.md DIRECTORY DATE\n", stderr);
    return 2;
  }
  try {
    return write(argv[1], argv[2], argv[3]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 6;
  }
}
