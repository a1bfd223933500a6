#include "app/cell_layers.h"

#include <gtest/gtest.h>

#include <set>

#include "model/rotation.h"

namespace aspic::app {
namespace {

CellLayers empty_layers(int columns, int layers, int rows) {
  return CellLayers(static_cast<std::size_t>(layers),
                    std::vector<std::string>(static_cast<std::size_t>(rows),
                                             std::string(static_cast<std::size_t>(columns), empty_cell)));
}

TEST(CellLayers, AStrokeLeavesNoGapAndStaysInItsLayer) {
  for (const auto& [to_row, to_column] :
       {std::pair(0, 9), std::pair(7, 9), std::pair(2, 9), std::pair(9, 1)}) {
    CellLayers layers = empty_layers(10, 2, 10);
    paint(layers, 1, {1, 1}, {to_row, to_column}, '#');
    EXPECT_EQ(cell_at(layers, 1, {1, 1}), '#');
    EXPECT_EQ(cell_at(layers, 1, {to_row, to_column}), '#');
    int painted = 0;
    for (int row = 0; row < 10; ++row) {
      for (int column = 0; column < 10; ++column) {
        EXPECT_EQ(cell_at(layers, 0, {row, column}), empty_cell);
        painted += cell_at(layers, 1, {row, column}) == '#';
      }
    }
    // One for each step along the longer way.
    EXPECT_EQ(painted, std::max(std::abs(to_row - 1), std::abs(to_column - 1)) + 1);
    CellLayers back = empty_layers(10, 2, 10);
    paint(back, 1, {to_row, to_column}, {1, 1}, '#');
    EXPECT_EQ(back, layers) << "the same cells either way";
  }
}

TEST(CellLayers, AStrokeThatLeavesTheGridPaintsWhatIsInIt) {
  CellLayers layers = empty_layers(3, 1, 2);
  paint(layers, 0, {0, 1}, {-5, 1}, 'a');
  paint(layers, 0, {1, 2}, {1, 40}, 'b');
  EXPECT_EQ(layers, (CellLayers{{".a.", "..b"}}));
}

/// Where the middle of a cell is in the world.
Vec3 place(const VoxelsSettings& v, int layer, int row, int column) {
  const auto [nx, ny, nz] = size_of(v.layers);
  const Vec3 local = v.size * Vec3{column + 0.5 - 0.5 * nx, layer + 0.5 - 0.5 * ny, row + 0.5 - 0.5 * nz};
  return v.position + rotated(local, v.rotation.axis, v.rotation.angle);
}

TEST(CellLayers, GrowingAndShrinkingLeaveCellsWhereTheyAre) {
  const std::pair<CellSide, std::array<int, 3>> sides[] = {
      {CellSide::left, {0, 0, 1}},  {CellSide::right, {0, 0, 0}},  {CellSide::back, {0, 1, 0}},
      {CellSide::front, {0, 0, 0}}, {CellSide::bottom, {1, 0, 0}}, {CellSide::top, {0, 0, 0}}};
  for (const auto& [side, moved] : sides) {
    VoxelsSettings v;
    v.size = 0.25;
    v.rotation = {{1.0, 2.0, 0.5}, 33.0};
    v.layers = {{"ab", "cd", "ef"}, {"gh", "ij", "kl"}};
    const VoxelsSettings before = v;
    grow(v, side);
    const auto [nx, ny, nz] = size_of(v.layers);
    EXPECT_EQ(nx * ny * nz, 12 + (moved[0] || side == CellSide::top ? 6 : 0) +
                                (moved[1] || side == CellSide::front ? 4 : 0) +
                                (moved[2] || side == CellSide::right ? 6 : 0));
    for (int layer = 0; layer < 2; ++layer) {
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 2; ++column) {
          const int l = layer + moved[0], r = row + moved[1], c = column + moved[2];
          EXPECT_EQ(cell_at(v.layers, l, {r, c}), cell_at(before.layers, layer, {row, column}));
          // A few roundings of numbers near 6.
          EXPECT_LT(length(place(v, l, r, c) - place(before, layer, row, column)), 1e-14);
        }
      }
    }
    EXPECT_TRUE(shrink(v, side));
    EXPECT_EQ(v.layers, before.layers);
    EXPECT_LT(length(v.position - before.position), 1e-14);
  }
}

TEST(CellLayers, TheLastRowColumnAndLayerStay) {
  VoxelsSettings v;
  v.layers = {{"1"}};
  const Vec3 before = v.position;
  for (const CellSide side :
       {CellSide::left, CellSide::right, CellSide::back, CellSide::front, CellSide::bottom, CellSide::top})
    EXPECT_FALSE(shrink(v, side));
  EXPECT_EQ(v.layers, (CellLayers{{"1"}}));
  EXPECT_EQ(v.position, before);
}

TEST(CellLayers, ALayerIsCopiedUpAndOverTheTopmost) {
  VoxelsSettings v;
  v.layers = {{"11", "1."}, {"..", ".."}};
  copy_up(v, 0);
  EXPECT_EQ(v.layers, (CellLayers{{"11", "1."}, {"11", "1."}}));
  fill(v.layers, 1, '2');
  copy_up(v, 1);
  EXPECT_EQ(v.layers, (CellLayers{{"11", "1."}, {"22", "22"}, {"22", "22"}}));
}

}  // namespace
}  // namespace aspic::app
