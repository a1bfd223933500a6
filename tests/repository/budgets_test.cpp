// The lines of each module and the words of each page, against tests/repository/budgets.txt.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <sstream>

#include "repository/text_lint.h"

namespace aspic::testing {
namespace {

const std::filesystem::path checkout = ASPIC_SOURCE_DIR;

struct Budget {
  std::size_t first = 0;  ///< when it was set
  std::size_t now = 0;
  bool explained = false;  ///< whether the row says what a raise buys
};

std::map<std::string, Budget> budgets() {
  std::map<std::string, Budget> found;
  std::istringstream rows(contents(checkout / "tests/repository/budgets.txt"));
  for (std::string row; std::getline(rows, row);) {
    std::istringstream columns(row);
    std::string name;
    Budget budget;
    if (row.starts_with('#') || !(columns >> name >> budget.first >> budget.now)) continue;
    std::string reason;
    budget.explained = static_cast<bool>(columns >> reason);
    found[name] = budget;
  }
  return found;
}

/// `src/model` of src/model/state.h, `shaders` of all below it; a page is a module of its own.
std::string module_of(const std::filesystem::path& file) {
  if (file.extension() == ".md")
    return file.begin()->string() == "docs" || file == "README.md" || file == "CONTRIBUTING.md"
               ? file.string()
               : "";
  const std::string first = file.begin()->string();
  if (first == "shaders" || first == "include" || first == "python" || first == "scripts") return first;
  if (first != "src" && first != "tests") return "";
  const auto second = std::next(file.begin());
  return std::next(second) == file.end() ? first : first + "/" + second->string();
}

std::size_t size_of(const std::filesystem::path& file) {
  const std::string text = contents(checkout / file);
  if (file.extension() != ".md") return static_cast<std::size_t>(std::ranges::count(text, '\n'));
  std::istringstream words(text);
  return static_cast<std::size_t>(
      std::distance(std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()));
}

TEST(Budgets, HoldForEveryModuleAndPage) {
  std::map<std::string, std::size_t> sizes;
  for (const std::filesystem::path& file : written_files(checkout))
    if (const std::string name = module_of(file); !name.empty()) sizes[name] += size_of(file);
  const auto rows = budgets();
  std::ostringstream missing;
  for (const auto& [name, size] : sizes) {
    const auto row = rows.find(name);
    if (row == rows.end()) {
      missing << name << ' ' << size << ' ' << size << '\n';
      continue;
    }
    const auto [first, now, explained] = row->second;
    EXPECT_LE(size, now) << name << ": delete some, or raise the second number in "
                         << "tests/repository/budgets.txt and say at the end of the row what that buys.";
    EXPECT_GE(size + size / 10 + 50, now) << name << ": lower the budget to " << size << '.';
    EXPECT_TRUE(now <= first || explained)
        << name << ": say at the end of its row in tests/repository/budgets.txt what the raise buys.";
  }
  EXPECT_EQ(missing.str(), "") << "rows that tests/repository/budgets.txt lacks";
  for (const auto& [name, budget] : rows) EXPECT_TRUE(sizes.contains(name)) << name << " has gone.";
}

}  // namespace
}  // namespace aspic::testing
