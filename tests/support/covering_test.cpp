#include "support/covering.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <tuple>

namespace aspic::test {
namespace {

using Pairs = std::set<std::tuple<std::size_t, std::size_t, std::size_t, std::size_t>>;

/// The pairs that occur in some row, counted in another way than the generator does.
Pairs pairs_of(const std::vector<CoveringRow>& rows) {
  Pairs pairs;
  for (const CoveringRow& row : rows) {
    for (std::size_t b = 0; b < row.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) pairs.emplace(a, row[a], b, row[b]);
    }
  }
  return pairs;
}

bool everything(const CoveringRow&) {
  return true;
}

TEST(Covering, LeavesNoPairOut) {
  for (const std::vector<std::size_t>& sizes :
       {std::vector<std::size_t>{2, 2, 2}, {3, 3, 3, 3}, {8, 6, 2, 4, 5}, {5, 1, 4}, {7, 3}}) {
    const auto rows = cover_pairs(sizes, everything);
    const Pairs pairs = pairs_of(rows);
    std::size_t expected = 0;
    for (std::size_t b = 0; b < sizes.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) expected += sizes[a] * sizes[b];
    }
    EXPECT_EQ(pairs.size(), expected);
    for (const CoveringRow& row : rows) {
      ASSERT_EQ(row.size(), sizes.size());
      for (std::size_t f = 0; f < sizes.size(); ++f) EXPECT_LT(row[f], sizes[f]);
    }
  }
}

TEST(Covering, AddsToRowsThatAreThereWhatANewValueNeeds) {
  const std::array<std::size_t, 4> before = {5, 4, 3, 2}, after = {5, 4, 4, 2};
  const auto first = cover_pairs(before, everything), rows = cover_pairs(after, everything, first);
  ASSERT_GT(rows.size(), first.size());
  EXPECT_LE(rows.size(), first.size() + 6u) << "each of five values meets the new one";
  EXPECT_TRUE(std::equal(first.begin(), first.end(), rows.begin()));
  EXPECT_EQ(pairs_of(rows), pairs_of(cover_pairs(after, everything)));
}

// 8 · 6 rows are the least, since that many pairs of the two largest factors meet in a row each.
TEST(Covering, HasFewRows) {
  const std::array<std::size_t, 5> sizes = {8, 6, 2, 4, 5};
  EXPECT_GE(cover_pairs(sizes, everything).size(), 48u);
  EXPECT_LE(cover_pairs(sizes, everything).size(), 60u) << "of " << all_rows(sizes, everything).size();
}

TEST(Covering, KeepsToWhatIsAllowed) {
  const std::array<std::size_t, 4> sizes = {4, 3, 4, 2};
  // The last value of the first factor goes with the first two of the third alone.
  const auto allowed = [](const CoveringRow& row) { return row[0] != 3 || row[2] < 2; };
  const auto rows = cover_pairs(sizes, allowed);
  for (const CoveringRow& row : rows) EXPECT_TRUE(allowed(row));
  EXPECT_EQ(pairs_of(rows), pairs_of(all_rows(sizes, allowed)));
  EXPECT_EQ(pairs_of(rows).size(), pairs_of(all_rows(sizes, everything)).size() - 2);
}

TEST(Covering, IsTheSameEveryTime) {
  const std::array<std::size_t, 3> sizes = {4, 3, 2};
  EXPECT_EQ(cover_pairs(sizes, everything), cover_pairs(sizes, everything));
  // These rows are kept by name in tests/data/hashes.json.
  EXPECT_THAT(
      cover_pairs(std::array<std::size_t, 2>{2, 2}, everything),
      ::testing::ElementsAre(CoveringRow{0, 0}, CoveringRow{0, 1}, CoveringRow{1, 0}, CoveringRow{1, 1}));
}

TEST(Covering, ListsTheProductInOrder) {
  EXPECT_THAT(
      all_rows(std::array<std::size_t, 2>{2, 3}, [](const CoveringRow& row) { return row[1] != 1; }),
      ::testing::ElementsAre(CoveringRow{0, 0}, CoveringRow{0, 2}, CoveringRow{1, 0}, CoveringRow{1, 2}));
}

}  // namespace
}  // namespace aspic::test
