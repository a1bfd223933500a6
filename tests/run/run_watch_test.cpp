// What is said of a run that would be spoilt in silence: at the start, and once of what comes about.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "aspic/run.h"
#include "support/model_building.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

ModelSettings row_of_cubes(int count, double apart) {
  ModelSettings settings;
  for (int i = 0; i < count; ++i) {
    CubeSettings& cube = settings.cubes.emplace_back();
    cube.particles_per_edge = 5;
    cube.edge_length = 2.0;
    cube.position = {i * apart, 3.0, 0.0};
  }
  return settings;
}

/// All sentences, one after the other.
std::string words(const std::vector<Diagnostic>& found) {
  std::string text;
  for (const Diagnostic& each : found) text += each.sentence() + " ";
  return text;
}

std::vector<std::string> ids_at_start(const ModelSettings& settings,
                                      Precision precision = Precision::single) {
  std::vector<std::string> ids;
  for (const Diagnostic& each : RunWatch(settings, test::build(settings), true, precision).at_start())
    ids.push_back(each.id);
  return ids;
}

TEST(RunWatch, NamesWhatOverlapsAtTheStart) {
  const ModelSettings settings = row_of_cubes(3, 1.9);
  const std::string text = words(RunWatch(settings, test::build(settings)).at_start());
  EXPECT_THAT(text, HasSubstr("2 pairs of bodies overlap at the start: cube[0] and cube[1] by 0.1 m, "));
  EXPECT_THAT(text, HasSubstr(" J; cube[1] and cube[2] by 0.1 m, "));
  EXPECT_THAT(text, HasSubstr("eased apart"));
  const ModelSettings apart = row_of_cubes(3, 2.1);
  EXPECT_THAT(words(RunWatch(apart, test::build(apart)).at_start()), IsEmpty());
}

TEST(RunWatch, NamesAFewOfManyPairs) {
  const ModelSettings settings = row_of_cubes(9, 1.9);
  const std::string text = words(RunWatch(settings, test::build(settings)).at_start());
  EXPECT_THAT(text, HasSubstr("8 pairs"));
  EXPECT_THAT(text, HasSubstr("; and 4 more."));
}

TEST(RunWatch, TellsOnceOfAPairThatIsTooDeep) {
  const ModelSettings settings = row_of_cubes(3, 3.0);
  const Model model = test::build(settings);
  RunWatch watch(settings, model);
  State state = initial_state(model, Precision::single);
  EXPECT_THAT(words(watch.look(model, state, false)), IsEmpty());
  const auto shift = [&](std::uint32_t body, double by) {
    for (std::uint32_t i = 0; i < 125; ++i) state.position[125 * body + i].x += by;
  };
  shift(0, 2.0);  // one metre below the surface of the second, D being 0.5 m
  state.step = 1200;
  const std::string text = words(watch.look(model, state, false));
  EXPECT_THAT(text, HasSubstr("cube[0] and cube[1]"));
  EXPECT_THAT(text, HasSubstr("step 1200 (t = 1.2 s)"));
  EXPECT_THAT(words(watch.look(model, state, false)), IsEmpty()) << "it was told";
  RunWatch other(settings, model);
  other.knows_what(watch);
  EXPECT_THAT(words(other.look(model, state, false)), IsEmpty());
  shift(2, -2.0);
  EXPECT_THAT(words(watch.look(model, state, false)), HasSubstr("cube[1] and cube[2]"));
}

TEST(RunWatch, LooksTenTimesASecond) {
  ModelSettings settings = row_of_cubes(2, 3.0);
  settings.simulation.timestep = 0.002;
  EXPECT_EQ(RunWatch(settings, test::build(settings)).next_step(0), 50u);
  EXPECT_EQ(RunWatch(settings, test::build(settings)).next_step(50), 100u);
  EXPECT_EQ(RunWatch(settings, test::build(settings)).next_step(149), 150u);
  settings.cubes.clear();
  settings.balls = {BallSettings{}};
  EXPECT_EQ(RunWatch(settings, test::build(settings)).next_step(0), std::uint64_t(-1));
}

TEST(RunWatch, NamesBodiesWithinTerrain) {
  ModelSettings settings = test::cube_on_plane(10, 0.0);
  settings.terrain[0].geometry["point"] = Vec3{0.0, -1.0, 0.0};
  const auto found = RunWatch(settings, test::build(settings)).at_start();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, "within-terrain");
  EXPECT_EQ(found[0].where, "cube[0]");
  EXPECT_THAT(found[0].sentence(),
              HasSubstr("within terrain at the start: cube[0] by 1 m. The first steps put "));
  EXPECT_THAT(found[0].advice, HasSubstr(" J in springs"));
  settings.cubes[0].position.y = 1.01;
  EXPECT_THAT(ids_at_start(settings), IsEmpty());
}

// Cases Z5, Z4 and C24, Z1, Z3 of bodies that pass a small sphere, do not move, hover, stay flat.
TEST(RunWatch, NamesWhatIsNotResolved) {
  ModelSettings settings;
  ClothSettings& cloth = settings.cloths.emplace_back();
  cloth.particles = {4, 4};
  cloth.size = {3.0, 3.0};
  settings.terrain.emplace_back().shape = TerrainShape::sphere;
  settings.terrain[0].geometry["radius"] = 0.3;
  const auto fine = RunWatch(settings, test::build(settings)).at_start();
  ASSERT_EQ(fine.size(), 1u);
  EXPECT_EQ(fine[0].id, "fine-terrain");
  EXPECT_THAT(fine[0].sentence(), HasSubstr("holds up to 600 m/s"));
  cloth.particles = {31, 31};
  EXPECT_THAT(ids_at_start(settings), IsEmpty());

  settings = test::cube_on_plane(4);
  settings.terrain.clear();
  settings.simulation.timestep = 0.0001;
  for (const double x : {1000.0, 10000.0, 100000.0}) {
    settings.cubes[0].position.x = x;
    settings.cubes[0].edge_length = 1.0;
    settings.cubes[0].velocity = {1.0, 1.0, 0.0};
    EXPECT_THAT(ids_at_start(settings), testing::ElementsAre("far-from-origin")) << x;
    EXPECT_THAT(ids_at_start(settings, Precision::double_), IsEmpty());
    settings.simulation.timestep = 0.001;
  }
  settings.cubes[0].position.x = 0.0;
  EXPECT_THAT(ids_at_start(settings), IsEmpty());
  settings.simulation.timestep = 1e-6;
  EXPECT_THAT(ids_at_start(settings), testing::ElementsAre("far-from-origin"));

  settings = test::cube_on_plane(5);
  settings.cubes[0].edge_length = 0.02;
  settings.cubes[0].position.y = 0.02;
  settings.contact.epsilon = 0.01;
  settings.simulation.gravity = {};  // no impact
  EXPECT_THAT(ids_at_start(settings), testing::ElementsAre("resting-distance"));

  settings = test::cube_on_plane(10);
  settings.cubes[0].velocity.y = -50.0;
  EXPECT_THAT(ids_at_start(settings), IsEmpty());
  settings.cubes[0].velocity.y = -100.0;
  EXPECT_THAT(ids_at_start(settings), testing::ElementsAre("impact-speed"));
}

TEST(RunWatch, TellsOnceOfFlatCells) {
  ModelSettings settings = test::cube_on_plane(4);
  VoxelsSettings& angle = settings.voxels.emplace_back();
  angle.layers = {{"11"}, {"1."}};
  const Model model = test::build(settings);
  RunWatch watch(settings, model);
  State state = initial_state(model, Precision::single);
  EXPECT_THAT(watch.look(model, state, false), IsEmpty());
  state.step = 100;
  for (std::size_t i = 0; i < 64; ++i) state.position[i].y = -1.0;
  auto found = watch.look(model, state, false);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, "flat-cells");
  EXPECT_THAT(found[0].text,
              HasSubstr("cells are flat or inside out at step 100 (t = 0.1 s): 27 of cube[0]"));
  for (std::size_t i = 64; i < state.position.size(); ++i) state.position[i].x = -state.position[i].x;
  found = watch.look(model, state, false);
  ASSERT_EQ(found.size(), 1u) << "the cube was told";
  EXPECT_THAT(found[0].text, HasSubstr(": 3 of voxels[0]"));
}

TEST(RunWatch, TellsOnceOfEnergyFromNowhere) {
  const ModelSettings settings = row_of_cubes(2, 3.0);
  const Model model = test::build(settings);
  State state = initial_state(model, Precision::single);
  RunWatch watch(settings, model), pulled(settings, model);
  state.step = 100;
  EXPECT_THAT(watch.look(model, state, false), IsEmpty());
  for (std::size_t i = 0; i < 125; ++i) state.velocity[i].z = 2.0;  // 250 J
  EXPECT_THAT(pulled.look(model, state, true), IsEmpty());
  EXPECT_THAT(pulled.look(model, state, false), IsEmpty()) << "it was driven before";
  const auto found = watch.look(model, state, false);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, "energy");
  EXPECT_THAT(found[0].text, HasSubstr("250 J more than at the start"));
  EXPECT_THAT(watch.look(model, state, false), IsEmpty());
}

}  // namespace
}  // namespace aspic
