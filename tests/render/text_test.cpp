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
  Scene scene;
  ModelSettings& settings = scene.model;
  settings.terrain.emplace_back().shape = TerrainShape::tilted_plane;
  settings.simulation.integrator = Integrator::runge_kutta_4;
  settings.simulation.timestep = 0.0005;
  CubeSettings cube;
  cube.position = {0.0, -2.5, 1.0};
  cube.rotation.angle = 30.0;
  cube.shear = {10.0, 0.5};
  settings.cubes.push_back(cube);
  const auto lines = overlay_lines(scene, 1.23456);
  EXPECT_EQ(value_of(lines, "terrain"), "tilted plane");
  EXPECT_EQ(value_of(lines, "contact"), "e 0.8   μ 0.3   Coulomb");
  EXPECT_EQ(value_of(lines, "integrator"), "Runge–Kutta 4");
  EXPECT_EQ(value_of(lines, "time step h"), "0.5 ms");
  EXPECT_EQ(value_of(lines, "structural"), "k 2000 N/m   c 60 N·s/m");
  EXPECT_EQ(value_of(lines, "shear"), "k 10 N/m   c 0.5 N·s/m");
  EXPECT_EQ(value_of(lines, "offset"), "(0, −2.5, 1) m");
  EXPECT_EQ(value_of(lines, "rotation"), "30° about (1, 0, 1)");
  EXPECT_EQ(value_of(lines, "time"), "1.235 s");
}

TEST(Text, MaterialGivesItsSpringConstants) {
  Scene scene;
  scene.model.cubes.emplace_back().material = MaterialSettings{};
  // k = E·s/7.3125 with s = 4/9 m: 2005.7 N/m.
  EXPECT_TRUE(value_of(overlay_lines(scene, 0.0), "springs").starts_with("k 2006 N/m"));
}

TEST(Text, SaysWhatBodiesOfANamedMaterialAreOf) {
  Scene scene;
  MaterialSettings& firm = scene.model.materials.emplace_back();
  firm.name = "firm";
  firm.youngs_modulus = 20 * 32906.25;
  firm.density = 16.0;
  firm.damping_ratio = 0.5;
  MaterialSettings named;
  named.name = "firm";
  const std::string numbers = "E 658125 Pa   ρ 16 kg/m³   ζ 0.5";
  scene.model.cloths.emplace_back().material = named;
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "firm"), numbers);
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "structural"), "(none)");
  scene.model.goal_nets.emplace_back().material = firm;
  scene.model.goal_nets.back().material->name.clear();
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "material"), numbers);
  scene.model.cubes.emplace_back().material = named;
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "springs"), "k 40000 N/m   c 143.1 N·s/m");
}

std::vector<std::string> labels(const Scene& scene) {
  std::vector<std::string> all;
  for (const OverlayLine& line : overlay_lines(scene, 0.0)) all.push_back(line.label);
  return all;
}

TEST(Text, LeavesOutWhatSaysNothingNew) {
  Scene scene;
  EXPECT_EQ(labels(scene), (std::vector<std::string>{"integrator", "time step h", "time"}));
  scene.model.cubes.emplace_back();
  EXPECT_EQ(labels(scene),
            (std::vector<std::string>{"integrator", "time step h", "springs", "offset", "rotation", "time"}));
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "rotation"), "0°");
  scene.model.cubes.emplace_back();
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "offset"), "(0, 9, 0) m   (first of 2 cubes)");
  scene.author = "";
  EXPECT_EQ(labels(scene).front(), "integrator");
}

TEST(Text, ContactIsThatOfTheTerrain) {
  Scene scene;
  ContactSettings& contact = scene.model.contact;
  contact.model = ContactModel::course;
  contact.restitution = 0.25;
  TerrainSettings& first = scene.model.terrain.emplace_back();
  first.mass = 10.0;
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "contact"), "e 0.25   μ 0.3   M 10 kg   course");
  TerrainSettings& second = scene.model.terrain.emplace_back();
  second.restitution = 1.0;
  second.friction = 0.0;
  // A mass that one of them has alone would say something wrong of the other.
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "contact"), "e 0.25–1   μ 0–0.3   course");
}

TEST(Text, NetClothAndBalls) {
  Scene scene;
  ModelSettings& settings = scene.model;
  ClothSettings& cloth = settings.cloths.emplace_back();
  cloth.shear.damping = 7.0;
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "shear"), "k 200 N/m   c 7 N·s/m");
  GoalNetSettings& net = settings.goal_nets.emplace_back();
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "springs"), "k 1500 N/m   c 50 N·s/m");
  net.bending = {20.0, 5.0};
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "structural"), "k 1500 N/m   c 50 N·s/m");
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "bending"), "k 20 N/m   c 5 N·s/m");
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "shear"), "(none)");
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "balls"), "(none)");
  settings.balls.resize(3);
  settings.launchers.resize(2);
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "balls"), "23   e 1   μ 0.3");
  settings.contact.spin = false;
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "balls"), "23   e 1   μ 0");
}

TEST(Text, MaterialsOfCellsAndActuators) {
  Scene scene;
  ModelSettings& settings = scene.model;
  settings.voxels.emplace_back().material = {500.0, 2e4, 0.4, ""};
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "cells"), "E 20000 Pa   ρ 500 kg/m³   ζ 0.4");
  settings.materials = {{1000.0, 2e5, 0.3, "muscle"}, {900.0, 1e5, 0.5, "skin"}, {1.0, 1.0, 1.0, "unused"}};
  settings.voxels[0].palette = {{"1", "skin"}, {"2", "muscle"}};
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "cells"), "(none)");
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "muscle"), "E 200000 Pa   ρ 1000 kg/m³   ζ 0.3");
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "skin"), "E 100000 Pa   ρ 900 kg/m³   ζ 0.5");
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "unused"), "(none)");
  settings.actuators.resize(2);
  settings.actuators[0].name = "wave";
  settings.actuators[0].frequency = 1.5;
  settings.actuators[1].signal = Signal::input;
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "wave"), "a 0.1   sine   f 1.5 Hz");
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "actuator[1]"), "a 0.1   input");
  // Those that are alike share a line.
  settings.materials[1] = settings.materials[0];
  settings.materials[1].name = "skin";
  settings.actuators[1] = settings.actuators[0];
  settings.actuators.push_back(settings.actuators[0]);
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "muscle + 1"), "E 200000 Pa   ρ 1000 kg/m³   ζ 0.3");
  EXPECT_EQ(value_of(overlay_lines(scene, 0.0), "wave + 2"), "a 0.1   sine   f 1.5 Hz");
}

TEST(Text, NamesTheAuthorOnOneLine) {
  Scene scene;
  scene.author = "0356611";
  EXPECT_EQ(overlay_lines(scene, 0.0).front().label, "author");
  EXPECT_EQ(overlay_lines(scene, 0.0).front().value, "0356611");
  scene.author = "two\nlines, and " + std::string(1000, 'x');
  const std::string shown = author_lines(scene).front().value;
  EXPECT_TRUE(shown.starts_with("two\\nlines, and xxx") && shown.ends_with("…"));
  EXPECT_LT(shown.size(), 50u);
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
  for (const char32_t c : std::u32string(U"azAZ09°·–−≥%√²³μρζ…"))
    EXPECT_NE(&font.glyph(c), &font.glyph(U'?')) << static_cast<unsigned>(c);
  // Names of people, too.
  for (const char32_t c : std::u32string(U"ŽižkaŁódźŞahinȚepeșΆννηЁжикЇжакґ’"))
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

TEST(Text, LongLabelsTakeSeveralLines) {
  const std::vector<OverlayLine> lines = {
      {"explicit Euler, h 0.001 s", "1.500 s", false, Color{1.0f, 0.5f, 0.0f}}, {"diverged", "at 2 s", true}};
  const auto letters = [](std::string_view text) { return static_cast<float>(text.size()); };
  EXPECT_EQ(fitted_lines(lines, 40.0f, letters), lines);
  const std::vector<OverlayLine> two = fitted_lines(lines, 16.0f, letters);
  ASSERT_EQ(two.size(), 3u);
  EXPECT_EQ(two[0].label, "explicit Euler,");
  EXPECT_EQ(two[0].value, "");
  EXPECT_EQ(two[0].tint, lines[0].tint);
  EXPECT_EQ(two[1].label, "h 0.001 s");
  EXPECT_EQ(two[1].value, "1.500 s");
  EXPECT_EQ(two[2], lines[1]);
  EXPECT_EQ(fitted_lines(lines, 1.0f, letters).size(), 6u) << "a word stays whole";
}

}  // namespace
}  // namespace aspic
