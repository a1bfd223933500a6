// What is said of a run that would be spoilt in silence: at the start, and once of what comes about.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "aspic/run.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

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
  EXPECT_THAT(text, HasSubstr("They separate slowly"));
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
  EXPECT_THAT(words(watch.look(model, state, {}, false)), IsEmpty());
  const auto shift = [&](std::uint32_t body, double by) {
    for (std::uint32_t i = 0; i < 125; ++i) state.position[125 * body + i].x += by;
  };
  shift(0, 2.0);  // one meter below the surface of the second, D being 0.5 m
  state.step = 1200;
  const std::string text = words(watch.look(model, state, {}, false));
  EXPECT_THAT(text, HasSubstr("cube[0] and cube[1]"));
  EXPECT_THAT(text, HasSubstr("step 1200 (t = 1.2 s)"));
  EXPECT_THAT(words(watch.look(model, state, {}, false)), IsEmpty()) << "it was told";
  RunWatch other(settings, model);
  other.knows_what(watch);
  EXPECT_THAT(words(other.look(model, state, {}, false)), IsEmpty());
  shift(2, -2.0);
  EXPECT_THAT(words(watch.look(model, state, {}, false)), HasSubstr("cube[1] and cube[2]"));
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
              HasSubstr("within terrain at the start: cube[0] by 1 m. The first steps move "));
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
  settings.contact.distance = 0.01;
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
  EXPECT_THAT(watch.look(model, state, {}, false), IsEmpty());
  state.step = 100;
  for (std::size_t i = 0; i < 64; ++i) state.position[i].y = -1.0;
  auto found = watch.look(model, state, {}, false);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, "flat-cells");
  EXPECT_THAT(found[0].text, HasSubstr("cells are flat or inverted at step 100 (t = 0.1 s): 27 of cube[0]"));
  for (std::size_t i = 64; i < state.position.size(); ++i) state.position[i].x = -state.position[i].x;
  found = watch.look(model, state, {}, false);
  ASSERT_EQ(found.size(), 1u) << "the cube was told";
  EXPECT_THAT(found[0].text, HasSubstr(": 3 of voxels[0]"));
}

TEST(RunWatch, TellsOnceOfEnergyFromNowhere) {
  const ModelSettings settings = row_of_cubes(2, 3.0);
  const Model model = test::build(settings);
  State state = initial_state(model, Precision::single);
  RunWatch watch(settings, model), changed(settings, model);
  state.step = 100;
  EXPECT_THAT(watch.look(model, state, {}, false), IsEmpty());
  for (std::size_t i = 0; i < 125; ++i) state.velocity[i].z = 2.0;  // 250 J
  EXPECT_THAT(changed.look(model, state, {}, true), IsEmpty());
  state.step = 200;
  EXPECT_THAT(changed.look(model, state, {}, false), IsEmpty());
  const auto found = watch.look(model, state, {}, false);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, "energy");
  EXPECT_THAT(found[0].text, HasSubstr("250 J more than at the start"));
  EXPECT_THAT(watch.look(model, state, {}, false), IsEmpty());
  for (std::size_t i = 0; i < 125; ++i) state.velocity[i].z = 4.0;
  EXPECT_THAT(words(changed.look(model, state, {}, false)),
              HasSubstr("750 J more than at step 100, without"));
}

/// Sentences on energy of a run that is looked at ten times a second; at the step `kicked` all particles
/// become faster by 500 m/s.
std::vector<std::string> energy_words(const ModelSettings& settings, const InputLog& inputs, double duration,
                                      std::uint64_t kicked = 0) {
  const Model model = test::build(settings);
  const auto solver = test::solver_for(model, Precision::single);
  RunWatch watch(settings, model);
  std::vector<std::string> found;
  const auto last = static_cast<std::uint64_t>(duration / model.simulation.timestep);
  for (std::uint64_t step = 0; step < last;) {
    const std::uint64_t next = watch.next_step(step);
    if (aspic::advance(*solver, inputs, step, next - step)->divergence) break;
    State state = *solver->state();
    if (step = next; step == kicked) {
      for (Vec3& v : state.velocity) v.z += 500.0;
      EXPECT_TRUE(solver->load(state).ok());
    }
    for (const Diagnostic& each : watch.look(model, state, inputs, false))
      if (each.id == "energy") found.push_back(each.sentence());
  }
  return found;
}

/// A cube of 4³ that swells and shrinks near its own frequency, as an input says it.
ModelSettings swelling_cube() {
  ModelSettings settings = test::cube_on_plane(4, 2.1);
  settings.cubes[0].structural.damping = settings.cubes[0].shear.damping = 2.0;
  ActuatorSettings& swell = settings.actuators.emplace_back();
  swell.amplitude = 0.2;
  swell.frequency = 7.0;
  ActuatorSettings& hand = settings.actuators.emplace_back();
  hand.signal = Signal::input;
  hand.amplitude = 0.1;
  return settings;
}

/// Jumps of the input, and a pull whose anchor flies about.
InputLog busy_hand() {
  InputLog log;
  for (std::uint64_t step = 50; step < 1000; step += 10) {
    Inputs inputs = {.channels = {step % 100 < 50 ? 1.0 : -1.0}};
    const double t = 0.001 * static_cast<double>(step);
    if (step > 200) inputs.pulls = {{7, {5.0 * t, 3.0 + 3.0 * std::sin(20.0 * t), 2.0 * t}, 5000.0, 50.0}};
    log.set(step, inputs);
  }
  return log;
}

/// A cube that walls squeeze on ground that is shaken, and a ball.
ModelSettings shaken_cube() {
  ModelSettings settings = test::cube_on_plane(4, 2.1);
  settings.terrain[0].motion = TerrainMotion{{0.3, 1.0, 0.0}, 0.1, 2.0, 0.0};
  for (const double side : {-1.0, 1.0}) {
    TerrainSettings& wall = settings.terrain.emplace_back();
    wall.geometry["point"] = Vec3{3.0 * side, 0.0, 0.0};
    wall.geometry["normal"] = Vec3{-side, 0.0, 0.0};
    wall.motion = TerrainMotion{{side, 0.0, 0.0}, 1.2, 0.5, 0.25};
  }
  settings.balls.emplace_back().position = {0.0, 6.0, 0.0};
  return settings;
}

TEST(RunWatch, KeepsQuietAboutWorkThatInputsDo) {
  EXPECT_THAT(energy_words(swelling_cube(), busy_hand(), 1.0), IsEmpty());
  EXPECT_THAT(energy_words(shaken_cube(), {}, 1.0), IsEmpty());
  EXPECT_THAT(energy_words(test::cube_on_plane(4, -20.0), {}, 1.0), IsEmpty()) << "told at the start";
  ModelSettings still = swelling_cube();
  still.actuators.clear();
  const InputLog all = busy_hand();
  InputLog pulls;
  for (const InputLog::Entry& each : all.entries()) pulls.set(each.step, {.pulls = each.inputs.pulls});
  EXPECT_THAT(energy_words(still, pulls, 1.0), IsEmpty());
}

TEST(RunWatch, TellsOfMoreEnergyThanInputsCanAdd) {
  const auto driven = testing::ElementsAre(testing::AllOf(
      HasSubstr("at step 700 (t = 0.7 s)"), HasSubstr("J above that of step 600 plus an upper bound")));
  EXPECT_THAT(energy_words(swelling_cube(), busy_hand(), 1.0, 700), driven);
  EXPECT_THAT(energy_words(shaken_cube(), {}, 1.0, 700), driven);
  // An actuated body beyond its stable step, and the same with a step that is stable.
  ModelSettings steady = swelling_cube();
  steady.simulation.integrator = Integrator::symplectic_euler;
  steady.actuators[0].amplitude = 0.05;
  steady.actuators[0].frequency = 1.0;
  EXPECT_THAT(energy_words(steady, {}, 2.0), IsEmpty());
  steady.simulation.timestep = 0.0095;
  EXPECT_THAT(energy_words(steady, {}, 2.0), testing::SizeIs(1));
}

}  // namespace
}  // namespace aspic
