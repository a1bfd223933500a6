// fuzz_seeds DIRECTORY: writes DIRECTORY/TARGET/seed-N for every target, and DIRECTORY/TARGET.dict.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "fuzz/targets.h"

namespace {

bool write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.flush();
  if (!file) fmt::print(stderr, "Cannot write {}.\n", path.string());
  return static_cast<bool>(file);
}

/// A line of libFuzzer's dictionaries.
std::string dictionary_line(const std::string& word) {
  std::string line = "\"";
  for (const char c : word) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      line += fmt::format("\\{}", c);
    } else if (byte < 0x20 || byte >= 0x7f) {
      line += fmt::format("\\x{:02X}", static_cast<unsigned>(byte));
    } else {
      line += c;
    }
  }
  return line + "\"\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: fuzz_seeds DIRECTORY\n");
    return 2;
  }
  const std::filesystem::path root = argv[1];
  for (const aspic::fuzz::Target& target : aspic::fuzz::targets()) {
    const std::filesystem::path directory = root / target.name;
    std::filesystem::create_directories(directory);
    std::size_t n = 0;
    for (const std::string& seed : target.seeds())
      if (!write(directory / fmt::format("seed-{}", n++), seed)) return 6;
    std::string dictionary;
    for (const std::string& word : target.words()) dictionary += dictionary_line(word);
    if (!write(root / fmt::format("{}.dict", target.name), dictionary)) return 6;
  }
  return 0;
}
