#pragma once
// A lint of everything written: what a text points at has to be in the repository.
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aspic::testing {

/// A line that breaks a rule.
struct Offense {
  int line;          ///< from 1
  std::string rule;  ///< `outside`, `path`, `section`, `kind`, `option`, `link` or `anchor`
  std::string text;  ///< what points nowhere
};

/// Offenses of one text in the order of lines. `file` is its path below `root`, the repository.
/// outside: a page that is not part of the repository, as a section or a file.
/// path: `docs/PAGE.md` anywhere, or a path in backticks in a Markdown page, that does not exist.
/// section: `docs/PAGE.md, section N` where that page has no heading `## N.`, `docs/PAGE.md, "H"` without H.
/// kind: what a method is, asked of its stages instead of its row (`stages.empty()` outside of
/// src/model/integrator.h).
/// option: a string of a library room that names an option of the command line (`--x`), outside of the words
/// of src/base/wording.cpp and of programs (`*_main.cpp`). link, anchor: a Markdown link to a file, or to a
/// heading, that does not exist.
std::vector<Offense> lint(const std::filesystem::path& root, const std::filesystem::path& file,
                          std::string_view text);

/// Every text file of the repository that people write, as a path below `root`, in alphabetical order. Build
/// directories, data, images and results of measurements are left out.
std::vector<std::filesystem::path> written_files(const std::filesystem::path& root);

/// Every file that git tracks below `root`, as a path below it; where git has no answer, as in an unpacked
/// archive, every file outside of `build`, `out` and hidden directories.
std::vector<std::filesystem::path> tracked_files(const std::filesystem::path& root);

/// The most bytes that a tracked file may have: what is replaced stays in the repository's history for good.
constexpr std::uintmax_t most_file_bytes = 150'000;
/// The same for an animation (.webp).
constexpr std::uintmax_t most_animation_bytes = 1'000'000;

/// Those of the files that are larger, with their sizes, as `docs/a.jpg: 157896 bytes`.
std::vector<std::string> too_large(const std::filesystem::path& root,
                                   const std::vector<std::filesystem::path>& files);

/// The contents of a file.
std::string contents(const std::filesystem::path& path);

}  // namespace aspic::testing
