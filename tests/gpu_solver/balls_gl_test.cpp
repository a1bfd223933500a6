// Balls on the device end with the same bits as on the reference, however partners are found.
#include <gtest/gtest.h>

#include "cpu_reference/reference_solver.h"
#include "gpu_solver/gpu_solver.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/value_of.h"

namespace aspic {
namespace {

class BallsOnTheDevice : public aspic::testing::GlTest {
 protected:
  static std::unique_ptr<GpuSolver> solver_for(const Model& model, BallSearch search,
                                               ForcePath path = ForcePath::gather) {
    GpuOptions options;
    options.ball_search = search;
    options.force_path = path;
    return test::value_of(make_gpu_solver(context(), model, options));
  }

  static void expect_equal(const Model& model, std::uint64_t steps,
                           std::initializer_list<BallSearch> searches = {BallSearch::all_pairs,
                                                                         BallSearch::grid}) {
    auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    ASSERT_FALSE((*reference->advance(steps)).divergence.has_value());
    const State expected = *reference->state();
    for (const BallSearch search : searches) {
      auto solver = solver_for(model, search);
      ASSERT_FALSE((*solver->advance(steps)).divergence.has_value());
      const State state = *solver->state();
      EXPECT_EQ(state_hash_text(state), state_hash_text(expected))
          << name_of(model.simulation.integrator) << ", " << name_of(model.contact.model) << ", search "
          << static_cast<int>(search);
      EXPECT_EQ(state, expected);
    }
  }

  /// A net into which balls of two sizes are thrown so fast after each other that they meet.
  static ModelSettings net_under_fire(int balls, double interval) {
    ModelSettings settings;
    settings.terrain.emplace_back();
    settings.terrain[0].restitution = 0.5;
    settings.goal_nets.emplace_back();
    for (int l = 0; l < 2; ++l) {
      LauncherSettings launcher;
      launcher.seed = 7 + l;
      launcher.count = balls / 2;
      launcher.interval = interval;
      launcher.from = {{1.5, 0.0, -1.0}, {4.0, 2.0, 1.0}};
      launcher.towards = {{-1.0, 0.0, -1.0}, {-1.0, 1.0, 1.0}};
      launcher.speed_factor = 3.0;
      launcher.ball = {0.3 - 0.12 * l, 1.0 - 0.5 * l};
      settings.launchers.push_back(launcher);
    }
    return settings;
  }
};

TEST_F(BallsOnTheDevice, AHundredInTheNetOverTwoThousandSteps) {
  const Model model = test::build(net_under_fire(100, 0.03));
  ASSERT_EQ(model.ball_count(), 100u);
  expect_equal(model, 2000);
}

TEST_F(BallsOnTheDevice, EveryIntegratorAndContactModel) {
  for (const Integrator integrator : all_integrators) {
    for (const ContactModel contact : {ContactModel::coulomb, ContactModel::course}) {
      ModelSettings settings = net_under_fire(20, 0.01);
      settings.simulation.integrator = integrator;
      settings.contact.model = contact;
      settings.contact.spin = contact == ContactModel::coulomb;
      settings.goal_nets[0].particles = {4, 6, 8};
      expect_equal(test::build(settings), row_of(integrator).traits.long_steps ? 150 : 500);
    }
  }
}

TEST_F(BallsOnTheDevice, ACubeBetweenTerrains) {
  ModelSettings settings = test::cube_on_plane(5, 1.5);
  settings.cubes[0].pinned.names = {"left-bottom-back"};
  settings.contact.ball_restitution = 0.4;
  TerrainSettings sphere;
  sphere.shape = TerrainShape::sphere;
  sphere.geometry["center"] = Vec3{3.0, -1.0, 0.0};
  sphere.geometry["radius"] = 1.5;
  settings.terrain.push_back(sphere);
  settings.balls.push_back({1.0, 40.0, {0.3, 5.0, 0.1}, {0.0, -4.0, 0.0}, {1.0, 9.0, -4.0}});
  settings.balls.push_back({0.5, 2.0, {3.2, 3.0, 0.3}, {0.0, -4.0, 0.0}, {}});
  settings.balls.push_back({0.5, 2.0, {3.2, 3.0, 0.3}, {0.0, -4.0, 0.0}, {}});  // in the same place
  for (const bool spin : {true, false}) {
    settings.contact.spin = spin;
    expect_equal(test::build(settings), 600);
  }
}

// Balls that bounce, roll and rest where three terrains meet, long enough for reactions in every stage.
TEST_F(BallsOnTheDevice, AtRestInACornerUnderEveryIntegrator) {
  for (const Integrator integrator : all_integrators) {
    for (const bool spin : {true, false}) {
      ModelSettings settings;
      settings.simulation.integrator = integrator;
      settings.contact.spin = spin;
      for (const Vec3& normal : {Vec3{0.6, 0.8, 0.0}, Vec3{-0.5, 0.7, -0.1}, Vec3{0.0, 0.1, 1.0}}) {
        TerrainSettings side;
        side.geometry["point"] = Vec3{};
        side.geometry["normal"] = normal;
        side.restitution = 0.3;
        settings.terrain.push_back(side);
      }
      settings.terrain[0].mass = 20.0;
      settings.balls.push_back({0.3, 2.0, {0.2, 1.0, 0.6}, {0.2, 0.0, -0.5}, {3.0, 1.0, -2.0}});
      settings.balls.push_back({0.2, 1.0, {0.3, 2.0, 0.9}, {0.0, 0.0, -0.5}, {0.0, 1.0, 5.0}});
      expect_equal(test::build(settings), 2500);
    }
  }
}

TEST_F(BallsOnTheDevice, APitWithMorePartnersThanOneList) {
  ModelSettings settings;
  settings.terrain.emplace_back();
  settings.terrain[0].shape = TerrainShape::bowl;
  LauncherSettings small;
  small.count = 300;
  small.interval = 0.0;
  small.from = {{0.5, 3.0, -0.5}, {3.5, 5.0, 2.5}};
  small.towards = {{1.9, 2.0, 0.9}, {2.1, 2.0, 1.1}};
  small.speed_factor = 1.0;
  small.ball = {0.1, 0.1};
  settings.launchers.push_back(small);
  // A large one among small ones: more than 32 partners at once.
  settings.balls.push_back({1.0, 20.0, {2.0, 4.0, 1.0}, {}, {0.0, 3.0, 0.0}});
  const Model model = test::build(settings);
  const State start = initial_state(model, Precision::single);
  int overlapping = 0;
  for (std::size_t b = 1; b < start.ball_position.size(); ++b) {
    overlapping += length(start.ball_position[b] - start.ball_position[0]) < 1.1;
  }
  ASSERT_GT(overlapping, 40);
  expect_equal(model, 120);
}

TEST_F(BallsOnTheDevice, ImplicitEulerWithoutParticles) {
  ModelSettings settings;
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.terrain.emplace_back();
  settings.balls.resize(2);
  settings.balls[1].position = {7.2, 3.1, 2.0};
  expect_equal(test::build(settings), 400);
}

TEST_F(BallsOnTheDevice, SwitchingBackendsInMidRunChangesNothing) {
  for (const Integrator integrator : {Integrator::explicit_euler, Integrator::implicit_euler}) {
    ModelSettings settings = net_under_fire(12, 0.02);
    settings.goal_nets[0].particles = {4, 6, 8};
    settings.simulation.integrator = integrator;
    const Model model = test::build(settings);
    auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    ASSERT_FALSE((*reference->advance(200)).divergence.has_value());
    const State expected = *reference->state();
    auto first = std::move(make_reference_solver(model, Precision::single)).value();
    ASSERT_FALSE((*first->advance(57)).divergence.has_value());
    auto second = solver_for(model, BallSearch::automatic);
    ASSERT_TRUE(second->load(*first->state()).ok());
    for (int part = 0; part < 11; ++part) ASSERT_FALSE((*second->advance(13)).divergence.has_value());
    EXPECT_EQ(*second->state(), expected);
  }
}

TEST_F(BallsOnTheDevice, PerSpringPathCarriesThemToo) {
  ModelSettings settings = net_under_fire(12, 0.02);
  settings.goal_nets[0].particles = {4, 6, 8};
  const Model model = test::build(settings);
  auto gather = solver_for(model, BallSearch::automatic);
  auto springs = solver_for(model, BallSearch::automatic, ForcePath::per_spring);
  ASSERT_FALSE((*gather->advance(300)).divergence.has_value());
  ASSERT_FALSE((*springs->advance(300)).divergence.has_value());
  EXPECT_EQ(*gather->state(), *springs->state());
}

// A ball that gains speed beyond all bounds: the last good state stays on the device, and both name it alike.
TEST_F(BallsOnTheDevice, DivergenceNamesTheBallAndKeepsTheLastGoodState) {
  for (const Integrator integrator : {Integrator::explicit_euler, Integrator::implicit_euler}) {
    ModelSettings settings = net_under_fire(4, 0.0);
    settings.goal_nets[0].particles = {4, 6, 8};
    settings.simulation.integrator = integrator;
    settings.balls.resize(2);
    settings.balls[1].position = {100.0, 50.0, 0.0};
    settings.balls[1].velocity = {0.0, 0.0, 999.9};
    settings.simulation.gravity = {0.0, -9.8, 30.0};
    settings.simulation.timestep = 0.0005;
    const Model model = test::build(settings);
    auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    const auto expected = reference->advance(100)->divergence;
    ASSERT_TRUE(expected.has_value());
    EXPECT_EQ(body_text(*expected), "ball 1");
    for (const BallSearch search : {BallSearch::all_pairs, BallSearch::grid}) {
      auto solver = solver_for(model, search);
      const auto divergence = solver->advance(100)->divergence;
      ASSERT_TRUE(divergence.has_value());
      EXPECT_EQ(divergence->step, expected->step);
      EXPECT_EQ(body_text(*divergence), "ball 1");
      EXPECT_TRUE(divergence->finite);
      EXPECT_EQ(*solver->state(), *reference->state());
    }
  }
}

TEST_F(BallsOnTheDevice, TheirBufferIsWhatItSays) {
  const Model model = test::build(net_under_fire(6, 0.01));
  auto solver = solver_for(model, BallSearch::automatic);
  ASSERT_FALSE((*solver->advance(15)).divergence.has_value());
  const State state = *solver->state();
  const DeviceState where = solver->device_state();
  const auto numbers = where.balls->download_items<float>(std::uint64_t{16} * model.ball_count(),
                                                          std::uint64_t{16} * where.first_ball);
  for (std::size_t b = 0; b < model.balls.size(); ++b) {
    const float* ball = numbers.data() + 16 * b;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(double{ball[axis]}, state.ball_position[b][axis]);
      EXPECT_EQ(double{ball[4 + axis]}, state.ball_velocity[b][axis]);
      EXPECT_EQ(double{ball[8 + axis]}, state.ball_angular_velocity[b][axis]);
    }
    EXPECT_EQ(ball[3], static_cast<float>(model.balls[b].radius));
    EXPECT_EQ(ball[7] != 0.0f, model.balls[b].launched(14)) << b;
  }
}

}  // namespace
}  // namespace aspic
