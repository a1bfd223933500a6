#include "scene/write.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "model/bodies.h"
#include "model/integrator.h"
#include "model/skin_text.h"
#include "scene/scene_support.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using testing::Not;

void expect_round_trip(const Scene& scene) {
  const std::string text = to_toml(scene);
  const auto again = parse_scene(text, "scene.toml", {}, test::unlimited);
  ASSERT_TRUE(again.ok()) << again.error().message() << "\n" << text;
  test::expect_same_scene(scene, *again);
  EXPECT_EQ(to_toml(*again), text);
  const std::string brief = to_short_toml(scene);
  const auto same = parse_scene(brief, "scene.toml", {}, test::unlimited);
  ASSERT_TRUE(same.ok()) << same.error().message() << "\n" << brief;
  EXPECT_EQ(to_toml(*same), text) << brief;
  EXPECT_EQ(to_short_toml(*same), brief);
}

TEST(Write, RoundTripsBuiltins) {
  for (const BuiltinScene& builtin : list_builtin_scenes()) {
    const auto scene = load_scene(std::string(builtin.name));
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    expect_round_trip(*scene);
  }
}

/// Any legal value, with all the digits a double can have.
Value random_value(const Parameter& p, std::mt19937_64& random) {
  const auto number = [&] {
    // The widest ranges would hardly ever give a small number, so magnitudes are drawn first.
    const double least = std::max(p.range.min, -1e3), most = std::min(p.range.max, 1e3);
    const double x = std::uniform_real_distribution<double>(least, most)(random);
    return x == p.range.min ? most : x;
  };
  const auto chance = [&] { return std::uniform_int_distribution<int>(0, 1)(random) == 1; };
  switch (p.type) {
    case ParameterType::boolean:
      return chance();
    case ParameterType::integer:
      return std::uniform_int_distribution<std::int64_t>(
          static_cast<std::int64_t>(p.range.min),
          static_cast<std::int64_t>(std::min(p.range.max, 40.0)))(random);
    case ParameterType::number:
      return number();
    case ParameterType::text:
      if (p.path == "view.follow") return std::string("cube[0]");  // there is always one
      if (p.path == "voxels[].skin")
        return to_skin_text(
            {{{static_cast<double>(random() % 9), 0.5, 1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.25}},
             {{0, 1, 2}}});
      if (p.key() == "name" && !p.section().empty()) return fmt::format("name \"{}\"", random());
      return std::string("a \"name\" with \\ and \t and \x7f and é");
    case ParameterType::word: {
      const auto words = p.words;
      return std::string(words[std::uniform_int_distribution<std::size_t>(0, words.size() - 1)(random)]);
    }
    case ParameterType::words: {
      std::vector<std::string> words;
      for (const std::string_view word : p.words) {
        if (chance()) words.emplace_back(word);
      }
      return words;
    }
    case ParameterType::vector:
      return Vec3{number(), number(), chance() && p.range.min < 0.0 ? -0.0 : number()};
    case ParameterType::counts:
      return std::vector<int>(p.components, std::uniform_int_distribution<int>(2, 40)(random));
    case ParameterType::numbers: {
      std::vector<double> numbers(p.components);
      std::ranges::generate(numbers, number);
      return numbers;
    }
    case ParameterType::layers:
      return chance() ? CellLayers{{"1.a", "111"}} : CellLayers{{"##", "#."}, {" 0", "1."}, {"11", "11"}};
    case ParameterType::palette:
      return CellPalette{};  // of no material
    case ParameterType::pinned:
      return PinnedSettings{{std::string(p.words.back()), test::corner_of(*p.pins)}, {0, 2, 3}};
    case ParameterType::names:
      return std::vector<std::string>{"cube[0]"};
    case ParameterType::points:
      return SignalTable{{0.0, number()}, {0.1, number()}, {1.0 / 3.0, 0.5}};
  }
  return false;
}

TEST(Write, RoundTripsRandomScenes) {
  std::mt19937_64 random(20210611);
  for (int trial = 0; trial < 200; ++trial) {
    Scene scene;
    scene.model.terrain.resize(static_cast<std::size_t>(trial % 4));
    scene.model.cubes.resize(1 + static_cast<std::size_t>(trial % 3));
    if (trial % 2 == 0) scene.model.cubes[0].material.emplace();
    scene.model.materials.resize(static_cast<std::size_t>(trial % 3));
    for (std::size_t kind = 1; kind < body_rows().size(); ++kind) {
      const SettingsList& list = body_rows()[kind].list;
      while (list.size(scene.model) < static_cast<std::size_t>(trial) % (kind + 1)) list.append(scene.model);
    }
    for (const Parameter& p : parameters()) {
      for (std::size_t i = 0; i < index_count(p, scene); ++i) {
        // Some keys stay absent or at their defaults.
        const bool left_out = std::uniform_int_distribution<int>(0, 3)(random) == 0;
        if (applies(p, scene, i) && !left_out) p.set(scene, i, random_value(p, random));
      }
    }
    // Corners are drawn apart from each other; a box has them in order.
    for (LauncherSettings& launcher : scene.model.launchers) {
      for (BoxSettings* box : {&launcher.from, &launcher.towards}) {
        for (int axis = 0; axis < 3; ++axis) {
          if (box->max[axis] < box->min[axis]) std::swap(box->min[axis], box->max[axis]);
        }
      }
    }
    expect_round_trip(scene);
  }
}

TEST(Write, LeavesOutWhatIsAbsent) {
  const Scene scene = test::parsed("schema = 1\n[[terrain]]\n[[cube]]\n");
  const std::string text = to_toml(scene);
  EXPECT_THAT(text, HasSubstr("\n# mass: infinite\n"));
  EXPECT_THAT(text, Not(HasSubstr("\nmass")));
  EXPECT_THAT(text, HasSubstr("\n# restitution: that of [contact]\n"));
  EXPECT_THAT(text, Not(HasSubstr("material =")));
}

TEST(Write, NamesMaterialsAndShowsCellsLayerByLayer) {
  const std::string long_row(60, '1');
  const Scene scene = test::parsed(fmt::format(
      "schema = 1\n[material]\nfat = {{ density = 900.0 }}\nbone = {{ youngs-modulus = 1e6 }}\n[[cube]]\n"
      "material = \"fat\"\n[[voxels]]\npalette = {{ 1 = \"bone\", \"#\" = \"fat\" }}\n"
      "layers = [[\"{0}\"], [\"{0}\"]]\n",
      long_row));
  const std::string text = to_toml(scene);
  EXPECT_THAT(text, HasSubstr("\n[[material]]\nname = \"fat\"\n"));
  EXPECT_THAT(text, HasSubstr("\nmaterial = \"fat\"\n"));
  EXPECT_THAT(text, HasSubstr("\npalette = { \"#\" = \"fat\", 1 = \"bone\" }\n"));
  EXPECT_THAT(text, HasSubstr(fmt::format("\nlayers = [\n  [\"{0}\"],\n  [\"{0}\"],\n]\n", long_row)));
  expect_round_trip(scene);
}

TEST(Write, AShortFileHasWhatIsNotDefault) {
  EXPECT_EQ(to_short_toml(test::parsed("schema = 1\nname = \"a\"\n[[terrain]]\n[[cube]]\n")),
            "schema = 1\nname = \"a\"\n\n[[terrain]]\n\n[[cube]]\n");
  const Scene scene = test::parsed(
      "schema = 1\nname = \"worm\"\n[simulation]\ntimestep = 0.0005\ngravity = [0, -9.8, 0]\n"
      "[material]\nfat = { density = 900.0 }\n\"two words\" = { youngs-modulus = 1e5 }\n"
      "[[terrain]]\nshape = \"bowl\"\nradius = 3\n[[cube]]\nparticles = [3, 2, 2]\nmaterial = {}\n"
      "[[voxels]]\nsize = 0.25\npalette = { 1 = \"fat\", \"#\" = \"two words\" }\n"
      "layers = [[\"11.11\", \"11.11\"], [\"#####\", \"#...#\"]]\npinned = [\"left\"]\n");
  EXPECT_EQ(to_short_toml(scene), R"(schema = 1
name = "worm"

[simulation]
timestep = 0.0005  # s

[[terrain]]
shape = "bowl"
radius = 3.0  # m

[material]
fat = { density = 900.0, youngs-modulus = 33000.0, damping-ratio = 0.95 }
"two words" = { density = 16.0, youngs-modulus = 100000.0, damping-ratio = 0.95 }

[[cube]]
particles = [3, 2, 2]
material = { density = 16.0 }  # kg/m³

[[voxels]]
size = 0.25  # m
palette = { "#" = "two words", 1 = "fat" }
layers = [
  ["11.11",
   "11.11"],
  ["#####",
   "#...#"],
]
pinned = ["left"]
)");
  expect_round_trip(scene);
}

TEST(Write, LooksLikeAFileOfAPerson) {
  const std::string text = to_toml(test::parsed("schema = 1\n[[cube]]\n"));
  EXPECT_THAT(text, HasSubstr("[simulation]\n"));
  EXPECT_THAT(text, HasSubstr("\nshear = { stiffness = 2000.0, damping = 60.0 }"));
  EXPECT_THAT(text, HasSubstr("# m/s²\n"));
}

}  // namespace
}  // namespace aspic
