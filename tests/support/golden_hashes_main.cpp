// Writes tests/data/hashes.json: golden_hashes FILE. scripts/hashes.sh builds and calls it.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "support/golden_runs.h"

int main(int count, char** words) {
  if (count != 2) {
    std::fputs("usage: golden_hashes FILE\n", stderr);
    return 2;
  }
  using namespace aspic::test;
  std::vector<GoldenRun> runs = scene_runs();
  for (GoldenRun& run : case_runs()) runs.push_back(std::move(run));
  const std::string text = golden_text(runs);
  // Assertions of what the runs are built with.
  if (testing::UnitTest::GetInstance()->ad_hoc_test_result().Failed()) return 1;
  std::ofstream out(words[1], std::ios::binary);
  out << text;
  out.close();
  if (!out) {
    std::fprintf(stderr, "%s cannot be written\n", words[1]);
    return 6;
  }
  std::printf("%zu hashes\n", runs.size());
}
