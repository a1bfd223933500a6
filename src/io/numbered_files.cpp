#include "io/numbered_files.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "base/printable.h"

namespace aspic {

std::string with_ending(const std::string& path, std::string_view ending) {
  const std::string own = std::filesystem::path(path).extension().string();
  return path.substr(0, path.size() - own.size()) + std::string(ending);
}

std::string numbered(const std::string& path, std::string_view step) {
  return with_ending(path, fmt::format("-{}{}", step, std::filesystem::path(path).extension().string()));
}

std::string numbered(const std::string& path, std::uint64_t step) {
  return numbered(path, fmt::format("{:08}", step));
}

Status refuse_later_files(const std::string& pattern, std::uint64_t step) {
  const std::filesystem::path first = numbered(pattern, "");  // "end-.csv"
  const std::string stem = first.stem().string(), ending = first.extension().string();
  const std::filesystem::path directory = first.has_parent_path() ? first.parent_path() : ".";
  std::error_code failed;
  for (std::filesystem::directory_iterator it(directory, failed), end; !failed && it != end;
       it.increment(failed)) {
    const std::string name = it->path().filename().string();
    if (name.size() < stem.size() + 8 + ending.size() || !name.starts_with(stem) || !name.ends_with(ending))
      continue;
    const std::string_view digits =
        std::string_view(name).substr(stem.size(), name.size() - stem.size() - ending.size());
    std::uint64_t found = 0;
    const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), found);
    if (error != std::errc() || rest != digits.data() + digits.size() || found < step) continue;
    return advised(
        fail(ErrorCode::io, "{} already exists, and the run may reach that step. It was not changed.",
             printable_line((directory / name).string())),
        {advice("choose another name"), {RemedyKind::overwrite}});
  }
  return {};
}

}  // namespace aspic
