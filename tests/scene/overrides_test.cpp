#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "aspic/scene.h"
#include "base/printable.h"
#include "model/bodies.h"
#include "scene/reader.h"
#include "scene/scene_support.h"
#include "scene/write.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string launcher_box = " = { min = [-9, -9, -9], max = [9, 9, 9] }\n";
/// One element of every list.
const std::string base = [] {
  std::string text = "schema = 1\n";
  for (const SettingsList& list : settings_lists()) {
    text += fmt::format("[[{}]]\n", list.key);
    if (list.key == "material") text += "name = \"fat\"\n";
    if (list.key == "cube") text += "shear = { stiffness = 1000.0 }\n";
    if (list.key == "launcher") text += fmt::format("from{0}towards{0}", launcher_box);
  }
  text += "[view]\ncamera = { target = [0, 2, 0] }\n";  // not where bodies are
  return text;
}();

/// A legal value that is not the default.
Value other_value(const Parameter& p) {
  switch (p.type) {
    case ParameterType::boolean:
      return p.path == "goal-net[].cord" || p.path == "view.axes" || p.path == "contact.self";
    case ParameterType::integer:
      return p.path == "schema" ? std::int64_t{1} : std::int64_t{7};
    case ParameterType::number:
      return p.path == "view.camera.fov" ? 30.5 : 0.515625;
    case ParameterType::text:
      if (p.belonging == Belonging::material_name) return std::string("fat");
      if (p.path == "voxels[].skin") return std::string("AA");  // of no vertices
      if (p.path == "actuator[].phase.cells") return std::string("1 1 1: 0.5");
      return std::string(p.path == "view.follow" ? "cube[0]" : "other name");
    case ParameterType::word:
      return std::string(p.words.back());
    case ParameterType::words:
      if (p.path == "view.arrows") return std::vector<std::string>{"contacts", "net"};
      if (p.path == "actuator[].select.springs") return std::vector<std::string>{"structural", "bending"};
      return std::vector<std::string>{"solid", "bending"};
    case ParameterType::vector:
      return Vec3{0.5, p.range.min < 0.0 ? -0.25 : 0.25, 2.0};
    case ParameterType::counts:
      return p.components == 2 ? std::vector<int>{3, 4} : std::vector<int>{3, 4, 5};
    case ParameterType::numbers:
      return p.components == 2 ? std::vector<double>{0.5, 2.0} : std::vector<double>{0.5, 0.25, 2.0};
    case ParameterType::layers:
      return CellLayers{{"11", "1."}};
    case ParameterType::palette:
      return CellPalette{{"1", "fat"}};
    case ParameterType::pinned:
      return PinnedSettings{{"top", test::corner_of(*p.pins)}, {3}};
    case ParameterType::names:
      return std::vector<std::string>{p.key() == "body" ? "cube[0]" : "fat"};
    case ParameterType::points:
      return SignalTable{{0.0, 0.5}, {2.0, -0.25}};
  }
  return false;
}

/// Of an actuator, what has to fit to its bodies.
bool of_one_body(const Parameter& p) {
  return p.path == "actuator[].phase.cells" || p.path.starts_with("actuator[].select.");
}

bool of_material(const Parameter& p) {
  return p.belonging == Belonging::material || p.belonging == Belonging::material_numbers ||
         p.belonging == Belonging::material_name;
}

std::string argument_for(const Parameter& p) {
  std::string key(p.path);
  if (const std::size_t at = key.find("[]"); at != std::string::npos) key.replace(at, 2, "[0]");
  return fmt::format("{}={}", key, toml_value(other_value(p)));
}

TEST(Set, ReachesEveryKeyAndNoOther) {
  for (const Parameter& p : parameters()) {
    if (reader::is_cell_source(p.path) || reader::is_actuator_source(p.path)) continue;  // no scene has it
    if (of_one_body(p)) continue;  // ActuatorScene has them
    std::string text = base;
    if (p.belonging == Belonging::geometry) text += "[[terrain]]\n";
    std::vector<std::string> arguments;
    if (p.belonging == Belonging::geometry)
      arguments.push_back(fmt::format("terrain[0].shape={}", test::shape_with(p)));
    if (of_material(p)) arguments.push_back(fmt::format("{}.material={{}}", path_text(p.section(), 0)));
    if (p.belonging == Belonging::motion) arguments.emplace_back("terrain[0].motion={}");
    if (p.belonging == Belonging::box) arguments.emplace_back("cube[0].particles=[2, 2, 2]");
    if (p.belonging == Belonging::wave) arguments.emplace_back("actuator[0].phase.along=y");
    const Scene before = test::parsed(text, arguments);
    arguments.push_back(argument_for(p));
    const Scene after = test::parsed(text, arguments);
    const auto value = p.get(after, 0);
    ASSERT_TRUE(value.has_value()) << p.path;
    EXPECT_TRUE(test::same_bits(*value, other_value(p))) << p.path;
    // These decide which other keys there are.
    if (p.path == "terrain[].shape" || p.belonging == Belonging::material_name ||
        p.path == "voxels[].palette" || p.path.starts_with("actuator[]."))
      continue;
    test::expect_same_scene(before, after, p.path);
  }
}

TEST(Set, RefusesWhatTheFileCouldNotSayEither) {
  for (const Parameter& p : parameters()) {
    const std::string argument =
        fmt::format("{}=1979-05-27", argument_for(p).substr(0, argument_for(p).find('=')));
    std::vector<std::string> arguments;
    if (p.belonging == Belonging::geometry)
      arguments.push_back(fmt::format("terrain[0].shape={}", test::shape_with(p)));
    if (of_material(p)) arguments.push_back(fmt::format("{}.material={{}}", path_text(p.section(), 0)));
    if (p.belonging == Belonging::motion) arguments.emplace_back("terrain[0].motion={}");
    arguments.push_back(argument);
    const std::string message = test::rejection(base, arguments);
    EXPECT_THAT(message, StartsWith(fmt::format("{}: ", argument))) << message;
    EXPECT_EQ(test::problems_in(message).size(), 1u) << message;
  }
}

TEST(Set, TakesTheFormsOfTheFormat) {
  const Scene s =
      test::parsed(base, {"simulation.timestep=0.002", "cube[0].shear.stiffness=10", "contact.model=course",
                          "cube[0].pinned=[\"top\",3]", "terrain[0].normal=[0,1,0]", "view.color=strain",
                          "terrain[0].mass=10", "name=\"two words\""});
  EXPECT_EQ(s.model.simulation.timestep, 0.002);
  EXPECT_EQ(s.model.cubes[0].shear.stiffness, 10.0);
  EXPECT_EQ(s.model.contact.model, ContactModel::course);
  EXPECT_EQ(s.model.cubes[0].pinned.names, std::vector<std::string>{"top"});
  EXPECT_EQ(s.model.cubes[0].pinned.indices, std::vector<std::int64_t>{3});
  EXPECT_EQ(s.model.terrain[0].geometry.at("normal"), GeometryValue(Vec3{0.0, 1.0, 0.0}));
  EXPECT_EQ(s.model.terrain[0].mass, 10.0);
  EXPECT_EQ(s.view.color, ViewColor::strain);
  EXPECT_EQ(s.name, "two words");
}

TEST(Set, NumbersAndNamesAreWordsWhereTextIsMeant) {
  for (const char* author : {"0356611", "42", "7A_7", "true", "Zoë", "李明", "Anne-Marie", "B.Lee"})
    EXPECT_EQ(test::parsed(base, {std::string("author=") + author}).author, author);
  EXPECT_EQ(test::parsed(base, {"author=\"Ada Lovelace\""}).author, "Ada Lovelace");
  EXPECT_EQ(test::parsed(base, {"author='Ada'"}).author, "Ada");
}

TEST(Set, LastOneWins) {
  EXPECT_EQ(test::parsed(base, {"simulation.timestep=0.002", "simulation.timestep=0.003"})
                .model.simulation.timestep,
            0.003);
}

TEST(Set, MergesTables) {
  const Scene s = test::parsed(base, {"cube[0].shear={damping=5}", "cube[0]={position=[1,2,3]}"});
  EXPECT_EQ(s.model.cubes[0].shear.stiffness, 1000.0);
  EXPECT_EQ(s.model.cubes[0].shear.damping, 5.0);
  EXPECT_EQ(s.model.cubes[0].position, (Vec3{1.0, 2.0, 3.0}));
}

TEST(Set, BoxTakesThePlaceOfTheFilesCubeAndTheOtherWayRound) {
  const std::string cube = "schema = 1\n[[cube]]\nparticles-per-edge = 5\n",
                    a_box = "schema = 1\n[[cube]]\nparticles = [5, 6, 7]\n";
  for (const std::string& text : {base, cube, a_box})
    EXPECT_EQ(test::parsed(text, {"cube[0].particles=[8,4,3]"}).model.cubes[0].lattice(),
              (std::array{8, 4, 3}));
  const Scene again = test::parsed(a_box, {"cube[0].particles-per-edge=6"});
  EXPECT_FALSE(again.model.cubes[0].particles);
  EXPECT_EQ(again.model.cubes[0].lattice(), (std::array{6, 6, 6}));
  EXPECT_THAT(to_toml(again), HasSubstr("\nparticles-per-edge = 6\n"));
  const std::string shown = to_toml(test::parsed(a_box));
  EXPECT_THAT(shown, HasSubstr("\nparticles = [5, 6, 7]\n"));
  EXPECT_THAT(shown, testing::Not(HasSubstr("per-edge")));
  EXPECT_THAT(to_toml(test::parsed(cube)), testing::Not(HasSubstr("particles = ")));
  // In a scene that was never text, the last one counts.
  EXPECT_EQ(with_overrides(test::parsed(cube), std::vector<std::string>{"cube[0].particles=[2,3,4]"})
                ->model.cubes[0]
                .lattice(),
            (std::array{2, 3, 4}));
  EXPECT_THAT(test::rejection(cube, {"cube[0].particles=[2,3,4]", "cube[0].particles-per-edge=3"}),
              HasSubstr("a cube has either 'particles-per-edge' or, as a box, 'particles'"));
}

TEST(Set, MaterialTakesThePlaceOfTheFilesSprings) {
  const Scene s = test::parsed(base, {"cube[0].material.density=20"});
  ASSERT_TRUE(s.model.cubes[0].material.has_value());
  EXPECT_EQ(s.model.cubes[0].material->density, 20.0);
  EXPECT_EQ(s.model.cubes[0].material->youngs_modulus, 33000.0);
}

TEST(Set, SpringsTakeThePlaceOfAMaterialOnlyWhole) {
  const std::string text = "schema = 1\n[[cube]]\nmaterial = { density = 8.0 }\n";
  EXPECT_THAT(test::rejection(text, {"cube[0].shear.stiffness=10"}), HasSubstr("this cube has a material"));
  const Scene s = test::parsed(
      text, {"cube[0].structural={stiffness=10,damping=1}", "cube[0].shear={stiffness=10,damping=1}",
             "cube[0].bending={stiffness=10,damping=1}", "cube[0].particle-mass=2"});
  EXPECT_FALSE(s.model.cubes[0].material.has_value());
  EXPECT_EQ(s.model.cubes[0].particle_mass, 2.0);
  EXPECT_EQ(s.model.cubes[0].bending.damping, 1.0);
}

TEST(Set, DoesNotMendAFileThatGivesBoth) {
  const std::string text = "schema = 1\n[[cube]]\nmaterial = { density = 8.0 }\nparticle-mass = 1.0\n";
  EXPECT_THAT(test::rejection(text, {"cube[0].material.density=20"}), StartsWith("scene.toml:3:1: "));
}

TEST(Set, ANewShapeDropsTheFilesOtherGeometry) {
  const Scene s =
      test::parsed("schema = 1\n[[cube]]\n[[terrain]]\npoint = [0, 5, 0]\n", {"terrain[0].shape=bowl"});
  EXPECT_EQ(s.model.terrain[0].shape, TerrainShape::bowl);
  EXPECT_TRUE(s.model.terrain[0].geometry.empty());
  EXPECT_THAT(test::rejection(base, {"terrain[0].shape=bowl", "terrain[0].point=[0,5,0]"}),
              HasSubstr("a bowl has no 'point'"));
}

struct Refused {
  std::string argument;
  std::size_t column;  // of the caret, from 1
  std::string fragment;
};

TEST(Set, PointsAtWhatIsWrongInAnArgument) {
  const std::vector<Refused> cases = {
      {"cube[1].edge-length=2", 1, "the scene has only one [[cube]]: cube[0]"},
      {"goal-nets=2", 1, "did you mean 'goal-net'?"},
      {"cube.shear.stiffness=10", 1, "did you mean 'cube[0].shear.stiffness'?"},
      {"cube[0].shear.stifness=10", 15, "did you mean 'stiffness'?"},
      {"cube[0].shear={stifness=1}", 16, "did you mean 'stiffness'?"},
      {"cube[zero].edge-length=2", 6, "an index is an integer"},
      {"cube[-1].edge-length=2", 6, "an index is an integer"},
      {"cube[0]x.edge-length=2", 6, "an index is an integer"},
      {"simulation[0].timestep=2", 1, "takes no index"},
      {"simulation.gravity.y=2", 20, "is a value and has no keys"},
      {"simulation..timestep=2", 12, "a part of the key is missing"},
      {"=2", 1, "a part of the key is missing"},
      {"simulation.timestep", 1, "KEY=VALUE"},
      // Numbers as people write them: with a unit, a decimal comma, without brackets.
      {"simulation.timestep=1 ms", 21, "write the number alone, in s"},
      {"simulation.timestep=0,001", 21, "numbers have a decimal point, 0.001;"},
      {"simulation.duration=4s", 21, "write the number alone, in s"},
      {"cube[0].edge-length=4m", 21, "write the number alone, in m"},
      {"contact.friction=30%", 18, "write 0.3 for 30%"},
      {"cube[0].velocity=1,0,0", 18, "a list needs brackets, [1,0,0]"},
      {"simulation.gravity=0.5,-9.8", 20, "a list needs brackets, [0.5,-9.8]"},
      {"cube[0].particles-per-edge=1e1", 28, "not a number with a decimal point or an exponent"},
      {"simulation.gravity=-9.8", 20,
       "must be three numbers [x, y, z], each -10000 … 10000 m/s², not a number"},
      {"cube.0.shear.stiffness=10", 1, "did you mean 'cube[0].shear.stiffness'?"},
      {"cube[0].particles=20", 19, "did you mean 'particles-per-edge'?"},
      {"cube[0].particles-per-edge=[8,4,4]", 28, "did you mean 'particles'?"},
      {"cube[0].particles=[8,4]", 19, "'cube.particles' must be three integers [along x, y, z]"},
      {"cube[0].particles=[8,1,4]", 22, "'cube.particles' is out of range: 1; allowed: "},
      {"cube[0].particles=[4096,4096,64]", 19, "1073741824 particles; allowed: 134217728"},
      {"simulation.integrator=rk4", 23, "did you mean 'runge-kutta-4'?"},
      {"simulation.integrator=verlet", 23, "did you mean 'velocity-verlet'?"},
      {"k=500", 1, "such as 'cube[0].structural.stiffness'"},
      {"h=0.001", 1, "such as 'simulation.timestep'"},
      {"shear.stiffness=500", 1, "cube[0].shear.stiffness"},
      {"name=2 cubes", 6, "needs quotation marks"},
      {"simulation.timestep=", 21, "neither a TOML value nor a single word"},
      {"name=two words", 6, "needs quotation marks"},
      {"name=\"a\"\nschema=2", 6, "the value ends with its first line"},
      {"simulation.timestep=5", 21, "out of range"},
      {"simulation.timestep=nan", 21, "must be finite"},
      {"simulation=3", 12, "must be a table"},
      {"schema=2", 8, "unknown schema version 2"},
      {"cube[0]=2", 9, "is a table"},
      {"cube=[]", 1, "needs an index"},
      {"cube[0].pinned=[\"tap\"]", 17, "did you mean 'top'?"},
  };
  for (const Refused& c : cases) {
    const std::string message = test::rejection(base, {c.argument});
    // Line feeds of an argument are shown as escapes.
    EXPECT_THAT(message, StartsWith(fmt::format("{}: ", printable_line(c.argument))));
    EXPECT_THAT(message, HasSubstr(c.fragment));
    const std::string last = message.substr(message.rfind('\n') + 1);
    EXPECT_EQ(last, fmt::format("{:>{}}", "^", c.column + 2)) << message;
  }
}

TEST(Set, ReportsAllArgumentsAfterTheFile) {
  const std::string message =
      test::rejection("schema = 1\n[[cube]]\nedge = 1\n", {"a=1", "simulation.timestep=0"});
  const std::vector<std::string> problems = test::problems_in(message);
  ASSERT_EQ(problems.size(), 3u) << message;
  EXPECT_THAT(problems[0], StartsWith("scene.toml:3:1: "));
  EXPECT_THAT(problems[1], StartsWith("a=1: "));
  EXPECT_THAT(problems[2], StartsWith("simulation.timestep=0: "));
}

TEST(Set, AppliesToASceneWithoutBodies) {
  EXPECT_THAT(test::rejection("schema = 1\n", {"cube[0].edge-length=2"}),
              HasSubstr("the scene has no [[cube]]"));
}

}  // namespace
}  // namespace aspic
