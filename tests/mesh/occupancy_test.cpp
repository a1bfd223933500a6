#include "mesh/occupancy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

OccupancyGrid grid_of(std::array<int, 3> cells, std::initializer_list<std::array<int, 3>> full) {
  OccupancyGrid grid;
  grid.cells = cells;
  grid.size = 0.5;
  grid.full.assign(static_cast<std::size_t>(cells[0] * cells[1] * cells[2]), 0);
  for (const auto& [i, j, k] : full) grid.full[grid.index(i, j, k)] = 1;
  return grid;
}

TEST(Occupancy, CellsAreInTheOrderOfTheLattice) {
  const OccupancyGrid grid = grid_of({2, 3, 4}, {{1, 2, 3}, {0, 1, 0}});
  for (std::size_t i = 0; i < grid.full.size(); ++i) {
    const auto [a, b, c] = grid.place(i);
    EXPECT_EQ(grid.index(a, b, c), i);
  }
  EXPECT_EQ(grid.full_count(), 2u);
  EXPECT_DOUBLE_EQ(grid.volume(), 0.25);
  EXPECT_EQ(grid.center(1, 0, 2), (Vec3{0.75, 0.25, 1.25}));
  const Lattice lattice = lattice_of(grid);
  EXPECT_THAT(lattice.particles, ElementsAre(3, 4, 5));
  EXPECT_TRUE(lattice.full({1, 2, 3}) && lattice.full({0, 1, 0}) && !lattice.full({0, 0, 0}));
  EXPECT_TRUE(lattice_of(grid_of({1, 1, 1}, {{0, 0, 0}})).all_full());
}

TEST(Occupancy, PiecesHangTogetherByFaces) {
  // Three in a row, one at an edge of the last, and two apart.
  const auto make = [] {
    return grid_of({4, 2, 4}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 1, 0}, {0, 0, 3}, {0, 1, 3}});
  };
  OccupancyGrid grid = make();
  EXPECT_THAT(*keep_pieces(grid, Pieces::all), ElementsAre(3, 2, 1));
  EXPECT_EQ(grid.full, make().full);
  EXPECT_THAT(*keep_pieces(grid, Pieces::largest), ElementsAre(3, 2, 1));
  EXPECT_EQ(grid.full_count(), 3u);
  EXPECT_TRUE(grid.is_full(2, 0, 0) && !grid.is_full(3, 1, 0) && !grid.is_full(0, 0, 3));
  EXPECT_THAT(*keep_pieces(grid, Pieces::refuse), ElementsAre(3));
  grid = make();
  const auto refused = keep_pieces(grid, Pieces::refuse);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().what, HasSubstr("3 pieces that share no face: of 3, 2, 1 cells"));
  EXPECT_FALSE(refused.error().remedies.empty());
}

TEST(Occupancy, HingesAreEdgesAndPointsWithoutACommonFace) {
  EXPECT_EQ(count_hinges(grid_of({2, 2, 1}, {{0, 0, 0}, {1, 1, 0}})), 1u) << "an edge";
  EXPECT_EQ(count_hinges(grid_of({2, 2, 2}, {{0, 0, 0}, {1, 1, 1}})), 1u) << "a point";
  EXPECT_EQ(count_hinges(grid_of({2, 2, 1}, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}})), 0u) << "an L";
  EXPECT_EQ(count_hinges(grid_of({2, 2, 2}, {{0, 0, 0}, {0, 0, 1}, {1, 1, 0}, {1, 1, 1}})), 2u)
      << "two edges in a row";
  EXPECT_EQ(count_hinges(grid_of({3, 1, 1}, {{0, 0, 0}, {2, 0, 0}})), 0u) << "nothing common";
  EXPECT_EQ(count_hinges(grid_of({1, 2, 2}, {{0, 0, 1}, {0, 1, 0}})), 1u) << "the other diagonal";
}

}  // namespace
}  // namespace aspic
