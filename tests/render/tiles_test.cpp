#include "render/tiles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace aspic {
namespace {

using ::testing::ElementsAre;

TEST(Tiles, TextReportsADivergence) {
  Divergence divergence;
  divergence.step = 40;
  const auto lines = comparison_text("k 1 N/m", 1, 0.039, 0.001, divergence);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].label, "k 1 N/m");
  EXPECT_EQ(lines[0].value, "0.039 s");
  EXPECT_EQ(lines[0].tint, run_tint(1));
  EXPECT_FALSE(lines[0].alarm);
  EXPECT_EQ(lines[1].value, "at 0.040 s");
  EXPECT_TRUE(lines[1].alarm);
  EXPECT_EQ(comparison_text("k 1 N/m", 1, 0.039, 0.001, {}).size(), 1u);
}

TEST(Tiles, FirstTextHasTheAuthorAboveIt) {
  Scene scene;
  EXPECT_EQ(below_author(scene, {{"a", "1 s"}}).size(), 1u);
  scene.author = "Ada Lovelace";
  const auto lines = below_author(scene, {{"a", "1 s"}});
  ASSERT_EQ(lines.size(), 2u);
  // One label, which may take several lines.
  EXPECT_EQ(lines[0].label, "author Ada Lovelace");
  EXPECT_EQ(lines[0].value, "");
  EXPECT_EQ(lines[1].label, "a");
}

TEST(Tiles, AreEqualAndApart) {
  EXPECT_THAT(tiles_of({640, 360}, 1), ElementsAre(Tile{0, 0, 640, 360}));
  EXPECT_THAT(tiles_of({640, 360}, 2), ElementsAre(Tile{0, 0, 319, 360}, Tile{321, 0, 319, 360}));
  EXPECT_THAT(tiles_of({360, 640}, 2), ElementsAre(Tile{0, 0, 360, 319}, Tile{0, 321, 360, 319}));
  EXPECT_THAT(tiles_of({641, 361}, 4), ElementsAre(Tile{0, 0, 319, 179}, Tile{322, 0, 319, 179},
                                                   Tile{0, 182, 319, 179}, Tile{322, 182, 319, 179}));
  EXPECT_EQ(tiles_of({640, 360}, 3).size(), 3u);
}

}  // namespace
}  // namespace aspic
