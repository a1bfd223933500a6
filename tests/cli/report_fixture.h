#pragma once
// The report of a small cube, and its files.
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "cli/process.h"

namespace aspic::test {

using Row = std::vector<std::string>;

inline std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The fields of a CSV line.
inline Row fields(const std::string& line) {
  Row result(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted) {
      result.emplace_back();
    } else if (c != '"') {
      result.back() += c;
    }
  }
  return result;
}

/// The report of a small cube, made once for all tests of a class.
class Report : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory = std::make_unique<TemporaryDirectory>();
    finished = std::make_unique<Finished>(aspic(
        {"report", "cube-plane", "--set", "cube[0].particles-per-edge=4", "--out", directory->file("r")}));
  }
  static void TearDownTestSuite() {
    directory.reset();
    finished.reset();
  }
  void SetUp() override { ASSERT_EQ(finished->exit_code, 0) << finished->err; }

  static std::string path(const std::string& name) { return directory->file("r/" + name); }
  static std::string read(const std::string& name) { return content(path(name)); }
  /// Rows of a CSV without its header.
  static std::vector<Row> table(const std::string& name) {
    std::vector<Row> rows;
    for (const std::string& line : lines(read("data/" + name + ".csv"))) rows.push_back(fields(line));
    if (!rows.empty()) rows.erase(rows.begin());
    return rows;
  }

  inline static std::unique_ptr<TemporaryDirectory> directory;
  inline static std::unique_ptr<Finished> finished;
};

}  // namespace aspic::test
