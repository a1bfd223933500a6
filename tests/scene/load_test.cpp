#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "aspic/scene.h"
#include "base/files.h"
#include "base/memory.h"
#include "model/counts.h"
#include "model/model.h"
#include "scene/input_file.h"
#include "scene/scene_support.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using test::problems_in;
using testing::HasSubstr;
using testing::StartsWith;

const std::string smallest = "schema = 1\n[[cube]]\n";

TEST(Load, SaysThatAFileIsUtf16) {
  for (const char* mark : {"\xff\xfe", "\xfe\xff"}) {
    const auto read = parse_scene(mark + std::string("s\0c\0h\0", 6), "s.toml");
    ASSERT_FALSE(read.ok());
    EXPECT_THAT(read.error().message(), StartsWith("s.toml:1:1: this is UTF-16; save it as UTF-8"));
  }
  EXPECT_TRUE(parse_scene("\xef\xbb\xbf" + smallest, "s.toml").ok());
}

// The numbers are those of docs/scene-reference.md, written out once more.
TEST(Defaults, AreThoseOfTheFormat) {
  const Scene s = test::parsed("schema = 1\n[[terrain]]\n[[cube]]\n");
  const ModelSettings& m = s.model;
  EXPECT_EQ(s.name, "scene");
  EXPECT_EQ(m.simulation.integrator, Integrator::explicit_euler);
  EXPECT_EQ(m.simulation.timestep, 0.001);
  EXPECT_EQ(m.simulation.duration, 4.0);
  EXPECT_EQ(m.simulation.gravity, (Vec3{0.0, -9.8, 0.0}));
  EXPECT_EQ(m.simulation.steps_per_frame, 8);
  EXPECT_EQ(m.simulation.implicit.newton_iterations, 20);
  EXPECT_EQ(m.simulation.implicit.cg_iterations, 200);
  EXPECT_FALSE(m.simulation.implicit.tolerance.has_value());
  EXPECT_EQ(m.contact.model, ContactModel::coulomb);
  EXPECT_EQ(m.contact.distance, 0.01);
  EXPECT_EQ(m.contact.resting_speed, 0.01);
  EXPECT_EQ(m.contact.restitution, 0.8);
  EXPECT_EQ(m.contact.friction, 0.3);
  EXPECT_EQ(m.contact.ball_restitution, 1.0);
  EXPECT_EQ(m.contact.ball_friction, 0.3);
  EXPECT_TRUE(m.contact.spin);
  ASSERT_EQ(m.terrain.size(), 1u);
  EXPECT_EQ(m.terrain[0].shape, TerrainShape::plane);
  EXPECT_FALSE(m.terrain[0].mass || m.terrain[0].restitution || m.terrain[0].friction);
  ASSERT_EQ(m.cubes.size(), 1u);
  const CubeSettings& c = m.cubes[0];
  EXPECT_EQ(c.particles_per_edge, 10);
  EXPECT_EQ(c.edge_length, 4.0);
  EXPECT_EQ(c.position, (Vec3{0.0, 9.0, 0.0}));
  EXPECT_EQ(c.rotation.axis, (Vec3{1.0, 0.0, 1.0}));
  EXPECT_EQ(c.rotation.angle, 0.0);
  EXPECT_EQ(c.velocity, (Vec3{}));
  EXPECT_EQ(c.particle_mass, 1.0);
  for (const SpringSettings& springs : {c.structural, c.shear, c.bending}) {
    EXPECT_EQ(springs.stiffness, 2000.0);
    EXPECT_EQ(springs.damping, 60.0);
  }
  EXPECT_FALSE(c.material.has_value());
  EXPECT_TRUE(c.pinned.names.empty() && c.pinned.indices.empty());
  EXPECT_TRUE(s.view.aimed);
  EXPECT_EQ(CameraSettings().position, (Vec3{10.0, 6.0, 14.0}));
  EXPECT_EQ(CameraSettings().target, (Vec3{0.0, 2.0, 0.0}));
  EXPECT_EQ(s.view.camera.fov, 45.0);
  EXPECT_EQ(s.view.draw, (DrawSettings{true, false, false, false, false}));
  EXPECT_EQ(s.view.color, ViewColor::material);
}

TEST(Defaults, OfTerrainFollowItsShape) {
  const Scene s = test::parsed(smallest +
                               "[[terrain]]\nshape = \"tilted-plane\"\n[[terrain]]\nshape = \"sphere\"\n"
                               "[[terrain]]\nshape = \"bowl\"\n[[terrain]]\n");
  const auto value = [&](std::string_view key, std::size_t index) {
    return find_parameter(key)->get(s, index);
  };
  EXPECT_EQ(std::get<Vec3>(*value("terrain[].point", 0)), (Vec3{0.0, 0.0, 0.0}));
  EXPECT_EQ(std::get<Vec3>(*value("terrain[].normal", 0)), (Vec3{1.0, 1.0, 0.0}));
  EXPECT_EQ(std::get<Vec3>(*value("terrain[].center", 1)), (Vec3{0.0, -1.0, 0.0}));
  EXPECT_EQ(std::get<double>(*value("terrain[].radius", 1)), 3.0);
  EXPECT_EQ(std::get<Vec3>(*value("terrain[].center", 2)), (Vec3{2.0, 7.0, 1.0}));
  EXPECT_EQ(std::get<double>(*value("terrain[].radius", 2)), 7.0);
  EXPECT_EQ(std::get<Vec3>(*value("terrain[].point", 3)), (Vec3{0.0, -1.0, 0.0}));
  EXPECT_FALSE(value("terrain[].radius", 0).has_value());
  EXPECT_FALSE(value("terrain[].normal", 1).has_value());
}

TEST(Defaults, OfAnEmptyMaterialAreThoseOfTheFormat) {
  const Scene s = test::parsed(smallest + "material = {}\n");
  ASSERT_TRUE(s.model.cubes[0].material.has_value());
  EXPECT_EQ(s.model.cubes[0].material->density, 16.0);
  EXPECT_EQ(s.model.cubes[0].material->youngs_modulus, 33000.0);
  EXPECT_EQ(s.model.cubes[0].material->damping_ratio, 0.95);
}

TEST(Parse, TakesWholeNumbersForNumbers) {
  EXPECT_EQ(test::parsed(smallest + "[simulation]\ngravity = [0, -10, 0]\n").model.simulation.gravity,
            (Vec3{0.0, -10.0, 0.0}));
}

TEST(Parse, ShowsTheMisspeltKeyOfTheFormatsExample) {
  std::string text = "schema = 1\n";
  for (int line = 2; line < 19; ++line) text += "\n";
  text += "[[cube]]\nshear = { stifness = 1 }\n";
  EXPECT_EQ(test::rejection(text),
            "scene.toml:20:11: unknown key 'stifness' in [cube.shear]; did you mean 'stiffness'?\n"
            "  20 | shear = { stifness = 1 }\n"
            "     |           ^");
}

TEST(Parse, KnowsTheTableAMisplacedKeyBelongsTo) {
  EXPECT_THAT(test::rejection("schema = 1\ntimestep = 0.1\n[[cube]]\n"),
              HasSubstr("did you mean simulation.timestep?"));
}

TEST(Parse, ShowsLongLinesInPart) {
  std::string numbers = "0";
  for (int i = 1; i < 200; ++i) numbers += fmt::format(", {}", i);
  const std::string message = test::rejection(smallest + "pinned = [" + numbers + ", \"tap\", 5, 6]\n");
  const std::size_t second = message.find('\n') + 1, third = message.find('\n', second) + 1;
  // Columns count characters; an ellipsis is one character of three bytes.
  const std::string shown = message.substr(second, third - 1 - second);
  EXPECT_LT(shown.size(), 130u);
  EXPECT_EQ(shown.find("\"tap\"") - 2, message.find('^', third) - third);
}

TEST(Parse, ShowsNoControlCharacters) {
  const std::string message = test::rejection("schema = 1\n\tx\x1b[31m = 1\n");
  EXPECT_EQ(message.find('\x1b', message.find('\n')), std::string::npos);
}

TEST(Parse, RefusesWhatMemoryCannotHold) {
  const std::string text = "schema = 1\n[[cube]]\n[[cube]]\nparticles-per-edge = 64\n";
  ModelSettings settings;
  settings.cubes.resize(2);
  settings.cubes[1].particles_per_edge = 64;
  const std::uint64_t needed = run_bytes(predict_counts(settings));
  EXPECT_TRUE(parse_scene(text, "scene.toml", {}, {needed}).ok());
  const std::string message = test::rejection(text, {}, {needed - 1});
  EXPECT_THAT(message, StartsWith("scene.toml:4:22: the scene has 263144 particles"));
  EXPECT_THAT(message, HasSubstr("are available"));
}

TEST(Parse, RefusesMoreThanIndicesName) {
  std::string text = "schema = 1\n";
  for (int i = 0; i < 16; ++i) text += "[[cube]]\nparticles-per-edge = 512\n";
  EXPECT_THAT(test::rejection(text), HasSubstr("more than 32-bit indices can name"));
}

TEST(AvailableMemory, IsKnownOnThisSystem) {
  const auto bytes = available_memory();
  ASSERT_TRUE(bytes.has_value());
  EXPECT_GT(*bytes, std::uint64_t{1} << 20);
}

// ---- files that must be refused; each says itself with what ----

std::vector<std::string> bad_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(ASPIC_TEST_DATA "/bad")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().stem().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class BadFile : public testing::TestWithParam<std::string> {};

TEST_P(BadFile, IsRefusedWithWhatItExpects) {
  const std::string path = std::string(ASPIC_TEST_DATA "/bad/") + GetParam() + ".toml";
  std::ifstream file(path);
  std::vector<std::string> expected;
  const std::string marker = "# expect: ";
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(marker)) expected.push_back(line.substr(marker.size()));
  }
  ASSERT_FALSE(expected.empty()) << path << " has no line that starts with " << marker;
  const auto scene = load_scene(path, {}, test::unlimited);
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error().code, ErrorCode::scene_rejected);
  const std::vector<std::string> problems = problems_in(scene.error().message());
  ASSERT_EQ(problems.size(), expected.size()) << scene.error().message();
  for (std::size_t i = 0; i < problems.size(); ++i)
    EXPECT_THAT(problems[i], StartsWith(fmt::format("{}:{}", path, expected[i])));
}

INSTANTIATE_TEST_SUITE_P(Data, BadFile, testing::ValuesIn(bad_files()), [](const auto& instance) {
  std::string name = instance.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// ---- built-in scenes and files ----

/// Particles and balls.
std::pair<std::uint32_t, std::uint32_t> expected_sizes(const std::string& scene) {
  if (scene == "large-cube") return {262144, 0};
  if (scene == "goal-net") return {1357, 1};
  if (scene == "penalty") return {1357, 10};
  if (scene == "course-2018") return {1357, 8};
  if (scene == "flag") return {36 * 24, 0};
  if (scene == "curtain") return {41 * 33, 2};
  if (scene == "bridge") return {690, 2};
  if (scene == "swing") return {21 * 4 * 9, 0};
  if (scene == "jelly-figure") return {1566, 0};
  if (scene == "worm") return {164, 0};
  if (scene == "walker") return {183, 0};
  if (scene == "ball-pit") return {0, 1000};
  if (scene == "cube-and-balls") return {1000, 3};
  if (scene == "cubes-stack") return {3 * 1000, 0};
  if (scene == "cubes-tower") return {8 * 1000, 0};
  if (scene == "heap") return {28 * 64, 0};
  if (scene == "squeeze") return {2 * 512, 0};
  if (scene == "jelly-in-net") return {744 + 216, 0};
  if (scene == "knot") return {660, 0};
  return {1000, 0};
}

TEST(Builtin, ScenesLoadAndBuild) {
  std::vector<std::string> names;
  for (const BuiltinScene& builtin : list_builtin_scenes()) {
    names.emplace_back(builtin.name);
    EXPECT_FALSE(builtin.description.empty());
    const auto scene = load_scene(names.back());
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    EXPECT_EQ(scene->name, names.back());
    const auto model = build_model(scene->model);
    ASSERT_TRUE(model.ok()) << model.error().message();
    const std::pair<std::uint32_t, std::uint32_t> sizes = {model->particle_count(), model->ball_count()};
    EXPECT_EQ(sizes, expected_sizes(names.back())) << names.back();
    // No particle starts in the ground.
    for (const Vec3& x : model->initial_position) {
      for (const Terrain& t : model->terrain) ASSERT_GT(signed_distance(t, x), 0.05);
    }
  }
  EXPECT_THAT(
      names, testing::ElementsAre("cube-plane", "cube-tilted-plane", "cube-sphere", "cube-bowl", "cube-torus",
                                  "cube-hole", "elevator", "cubes-stack", "cubes-tower", "heap", "squeeze",
                                  "jelly-in-net", "knot", "goal-net", "penalty", "flag", "curtain", "bridge",
                                  "swing", "jelly-figure", "worm", "walker", "ball-pit", "cube-and-balls",
                                  "large-cube", "course-2021-plane", "course-2021-tilted-plane",
                                  "course-2021-sphere", "course-2021-bowl", "course-2018"));
}

TEST(Builtin, ScenesOfAGroupFollowOneAnother) {
  std::vector<std::string> groups;
  for (const BuiltinScene& builtin : list_builtin_scenes())
    if (groups.empty() || groups.back() != builtin.group) groups.emplace_back(builtin.group);
  EXPECT_THAT(groups,
              testing::ElementsAre("Cubes", "Bodies that touch", "Nets and cloth", "Cells of materials",
                                   "Robots of cells", "Balls", "Large", "University course"));
}

// Limit of symplectic Euler (−γ + √(γ² + 4κ))/κ at the largest operator eigenvalue 17.63.
TEST(Builtin, LargeCubeStepsBelowItsStabilityLimit) {
  const auto scene = load_scene("large-cube");
  ASSERT_TRUE(scene.ok());
  const auto model = build_model(scene->model);
  ASSERT_TRUE(model.ok());
  const SpringClass& spring = model->spring_classes[0];
  const double gamma = 17.63 * spring.damping / model->mass[0],
               kappa = 17.63 * spring.stiffness / model->mass[0];
  const double limit = (-gamma + std::sqrt(gamma * gamma + 4.0 * kappa)) / kappa;
  ASSERT_EQ(scene->model.simulation.integrator, Integrator::symplectic_euler);
  EXPECT_LT(scene->model.simulation.timestep, 0.85 * limit);
  EXPECT_GT(scene->model.simulation.timestep, 0.7 * limit);
}

TEST(Load, SuggestsTheNearestBuiltin) {
  const auto scene = load_scene("cube-plnae");
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error().code, ErrorCode::scene_rejected);
  EXPECT_THAT(scene.error().message(), HasSubstr("large-cube"));
  EXPECT_THAT(scene.error().message(), HasSubstr("did you mean 'cube-plane'?"));
}

TEST(Load, TellsACheckpointFromAScene) {
  const test::TemporaryDirectory dir;
  dir.write("c.aspic", std::string(checkpoint_mark) + "\x02\x01");
  const auto scene = load_scene(dir.file("c.aspic"));
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error().code, ErrorCode::scene_rejected);
  const std::string path = dir.file("c.aspic");
  EXPECT_EQ(scene.error().message(),
            path + ": this is a checkpoint, not a scene. Read " + path + " with read_checkpoint().");
  EXPECT_EQ(worded(scene.error(), FrontEnd::command_line),
            path + ": this is a checkpoint, not a scene. Continue its run: aspic run --resume " + path + ".");
}

TEST(Load, TellsInputsFromAScene) {
  const test::TemporaryDirectory dir;
  dir.write("hands.toml", "timestep = 0.001\n[[inputs]]\nstep = 3\n");
  const auto scene = load_scene(dir.file("hands.toml"));
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(worded(scene.error(), FrontEnd::command_line),
            dir.file("hands.toml") +
                ": these are inputs of a run, not a scene. Replay them in a scene: aspic run "
                "SCENE --replay " +
                dir.file("hands.toml") + ".");
  EXPECT_TRUE(is_input_log("timestep = 1.0  # s\n"));
  for (const char* text : {"", "schema = 1\n", "schema = 1\n[[inputs]]\n", "inputs = [", "[[cube]]\n"})
    EXPECT_FALSE(is_input_log(text)) << text;
}

// What is wrong is shown as it was typed, after the words that its caller has for where it was.
TEST(Load, NamesTheOptionThatAnArgumentIsOf) {
  const std::vector<std::string> arguments = {"color=stress"};
  for (const std::string origin : {"", "--view"}) {
    const auto wrong = with_view(Scene{}, arguments, {.origin = origin});
    ASSERT_FALSE(wrong.ok());
    EXPECT_THAT(wrong.error().message(), HasSubstr("\n\n" + origin + (origin.empty() ? "" : " ") +
                                                   "color=stress: 'view.color' has the unknown value"));
    EXPECT_THAT(wrong.error().message(), testing::EndsWith("\n  color=stress\n        ^"));
  }
}

TEST(Load, SaysWhichFileItCannotRead) {
  for (const std::string path : {"no/such/scene.toml", ASPIC_TEST_DATA}) {
    const auto scene = load_scene(path);
    ASSERT_FALSE(scene.ok());
    EXPECT_EQ(scene.error().code, ErrorCode::io);
    EXPECT_THAT(scene.error().message(), HasSubstr(path));
  }
}

TEST(Load, NamesAnUnnamedSceneAfterItsFile) {
  const std::string path = testing::TempDir() + "aspic-unnamed.toml";
  std::ofstream(path) << smallest;
  const auto scene = load_scene(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  EXPECT_EQ(scene->name, "aspic-unnamed");
}

TEST(Parse, RefusesDeepNestingButNotDotsInStringsAndComments) {
  std::string key = "a", dots = ".";
  for (int i = 1; i < 32; ++i) key += ".a";
  for (int i = 1; i < 100; ++i) dots += " .";
  // 32 parts are an unknown key like any other; 33 are too many.
  EXPECT_THAT(test::rejection(smallest + key + " = 1\n"), HasSubstr("unknown key 'a'"));
  EXPECT_THAT(test::rejection(smallest + key + " . a = 1\n"), HasSubstr("a key has more than 32 parts"));
  EXPECT_THAT(test::rejection(smallest + "[" + key + ".a]\n"), HasSubstr("a key has more than 32 parts"));
  EXPECT_THAT(test::rejection(smallest + std::string(33, '[') + "\n"),
              HasSubstr("more than 32 arrays and tables"));
  for (const std::string& harmless :
       {fmt::format("# {}\n", dots), fmt::format("name = \"{0} \\\" # {0}\"\n", dots),
        fmt::format("name = '{}\\'\n", dots), fmt::format("name = \"\"\"\n{0}\n\"\"{0}\"\"\"\"\n", dots),
        fmt::format("name = '''{0}'' {0}'''''\n", dots),
        fmt::format("name = \"{}\" # {}\n", std::string(100, '['), std::string(100, '{'))}) {
    const auto scene = parse_scene("schema = 1\n" + harmless + "[[cube]]\n", "scene.toml");
    EXPECT_TRUE(scene.ok()) << harmless << (scene ? "" : scene.error().message());
  }
  // What ends a string or a comment for one parser and not for another hides nothing.
  for (const char* begin : {"# \r", "# \v", "name = \"\r", "name = '\f"})
    EXPECT_THAT(test::rejection(fmt::format("{}{}{}.a = 1\n", smallest, begin, key)),
                HasSubstr("a key has more than 32 parts"));
}

}  // namespace
}  // namespace aspic
