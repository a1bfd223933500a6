#include <gtest/gtest.h>

#include <algorithm>

#include "render/font.h"
#include "render/overlay_text.h"

namespace aspic {
namespace {

std::string value_of(const std::vector<OverlayLine>& lines, const std::string& label) {
  for (const OverlayLine& line : lines)
    if (line.label == label) return line.value;
  return "(none)";
}

TEST(Text, SaysWhatTheSceneIs) {
  ModelSettings settings;
  settings.terrain.emplace_back().shape = TerrainShape::tilted_plane;
  settings.simulation.integrator = Integrator::runge_kutta_4;
  settings.simulation.timestep = 0.0005;
  CubeSettings cube;
  cube.position = {0.0, -2.5, 1.0};
  cube.rotation.angle = 30.0;
  cube.shear = {10.0, 0.5};
  settings.cubes.push_back(cube);
  const auto lines = overlay_lines(settings, 1.23456);
  EXPECT_EQ(value_of(lines, "terrain"), "tilted plane");
  EXPECT_EQ(value_of(lines, "integrator"), "Runge–Kutta 4");
  EXPECT_EQ(value_of(lines, "time step h"), "0.5 ms");
  EXPECT_EQ(value_of(lines, "structural"), "k 2000 N/m   c 60 N·s/m");
  EXPECT_EQ(value_of(lines, "shear"), "k 10 N/m   c 0.5 N·s/m");
  EXPECT_EQ(value_of(lines, "offset"), "(0, −2.5, 1) m");
  EXPECT_EQ(value_of(lines, "rotation"), "30° about (1, 0, 1)");
  EXPECT_EQ(value_of(lines, "time"), "1.235 s");
}

TEST(Text, MaterialGivesItsSpringConstants) {
  ModelSettings settings;
  CubeSettings cube;
  cube.material = MaterialSettings{};
  settings.cubes.push_back(cube);
  // k = E·s/7.3125 with s = 4/9 m: 2005.7 N/m.
  EXPECT_TRUE(value_of(overlay_lines(settings, 0.0), "shear").starts_with("k 2006 N/m"));
}

TEST(Text, ReadsUtf8) {
  std::string_view text = "a°–";
  EXPECT_EQ(next_character(text), U'a');
  EXPECT_EQ(next_character(text), U'°');
  EXPECT_EQ(next_character(text), U'–');
  EXPECT_TRUE(text.empty());
  std::string_view broken = "\xc3";
  EXPECT_EQ(next_character(broken), char32_t{0xfffd});
  EXPECT_TRUE(broken.empty());
}

TEST(Font, HasEverySignOfTheOverlay) {
  const Font font(17);
  for (const char32_t c : std::u32string(U"azAZ09°·–−≥%√²"))
    EXPECT_NE(&font.glyph(c), &font.glyph(U'?')) << static_cast<unsigned>(c);
  EXPECT_EQ(&font.glyph(0x4e00), &font.glyph(U'?'));
}

TEST(Font, GlyphsLieApartInTheAtlasAndHaveInk) {
  const Font font(20);
  const Glyph& g = font.glyph(U'H');
  ASSERT_GT(g.width, 5);
  int ink = 0;
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x) {
      const int pixel = (g.atlas_y + y) * font.atlas_width() + g.atlas_x + x;
      ink += std::to_integer<int>(font.atlas()[static_cast<std::size_t>(pixel)]) > 128;
    }
  // Two stems and a bar: some two fifths of the box.
  EXPECT_GT(ink, g.width * g.height / 5);
  EXPECT_LT(ink, g.width * g.height * 3 / 4);
  EXPECT_NEAR(font.width_of("HH"), 2 * g.advance, 1e-4f);
}

TEST(Font, ScalesWithItsHeight) {
  EXPECT_NEAR(Font(40).width_of("aspic"), 2.0f * Font(20).width_of("aspic"), 0.01f);
}

}  // namespace
}  // namespace aspic
