// docs/README.md lists all pages; it is the navigation of the site that scripts/docs.sh builds.
#include <gtest/gtest.h>

#include "repository/text_lint.h"

namespace aspic::testing {
namespace {

TEST(PageList, NamesEveryPage) {
  const std::filesystem::path source = ASPIC_SOURCE_DIR;
  const std::string list = contents(source / "docs/README.md");
  for (const std::filesystem::path& file : written_files(source)) {
    const std::string name = file.filename().string();
    if (file.parent_path() != "docs" || file.extension() != ".md" || name == "README.md") continue;
    EXPECT_TRUE(list.find("](" + name + ")") != std::string::npos)
        << "docs/README.md does not list " << file << '.';
  }
}

}  // namespace
}  // namespace aspic::testing
