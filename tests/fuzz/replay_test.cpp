// Every input that once broke something, and every seed, through the functions that the fuzzers call.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "fuzz/targets.h"

namespace aspic::fuzz {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Replay : public ::testing::TestWithParam<const Target*> {};

TEST_P(Replay, RegressionsAreTaken) {
  const fs::path directory = fs::path(ASPIC_FUZZ_REGRESSIONS) / GetParam()->name;
  if (!fs::exists(directory)) return;
  for (const auto& entry : fs::directory_iterator(directory)) {
    SCOPED_TRACE(entry.path().filename().string());
    EXPECT_NO_THROW(GetParam()->run(read(entry.path())));
  }
}

TEST_P(Replay, SeedsAreTaken) {
  const auto seeds = GetParam()->seeds();
  EXPECT_FALSE(seeds.empty());
  for (const std::string& seed : seeds) EXPECT_NO_THROW(GetParam()->run(seed)) << seed.substr(0, 200);
}

/// A regular walk over cuts and changed bytes: what a fuzzer tries first, without one.
void take_damaged_seeds(const Target& target, std::size_t places) {
  for (const std::string& seed : target.seeds()) {
    const std::size_t stride = std::max<std::size_t>(1, seed.size() / places);
    for (std::size_t at = 0; at < seed.size(); at += stride) {
      SCOPED_TRACE(at);
      EXPECT_NO_THROW(target.run(std::string_view(seed).substr(0, at)));
      for (const char byte : {'\0', '\xff', '9', '"', '['}) {
        std::string damaged = seed;
        damaged[at] = byte;
        EXPECT_NO_THROW(target.run(damaged));
      }
    }
  }
}

TEST_P(Replay, DamagedSeedsAreTaken) {
  take_damaged_seeds(*GetParam(), 5);
}

TEST_P(Replay, ManyDamagedSeedsAreTaken) {
  take_damaged_seeds(*GetParam(), 24);
}

TEST(FuzzTargets, EveryDirectoryOfRegressionsBelongsToATarget) {
  for (const auto& entry : fs::directory_iterator(ASPIC_FUZZ_REGRESSIONS)) {
    if (entry.is_directory()) {
      EXPECT_NE(find_target(entry.path().filename().string()), nullptr) << entry.path();
    }
  }
}

std::vector<const Target*> all_targets() {
  std::vector<const Target*> all;
  for (const Target& target : targets()) all.push_back(&target);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Replay, ::testing::ValuesIn(all_targets()), [](const auto& chosen) {
  std::string name(chosen.param->name);
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace aspic::fuzz
