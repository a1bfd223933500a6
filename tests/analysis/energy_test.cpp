#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "aspic/analysis.h"
#include "model/model.h"
#include "support/pile.h"

namespace aspic {
namespace {

/// Two particles and one spring, all figures small integers so that every sum is exact.
Model pair(bool cord) {
  Model model;
  model.simulation.gravity = {0.0, -10.0, 0.0};
  model.mass = {2.0, 4.0};
  model.inverse_mass = {0.5, 0.25};
  model.spring_classes = {{SpringType::structural, 8.0, 1.0, 2.0, cord}};
  model.listed_springs = {{0, 1, 0}};
  return model;
}

State state_at(double distance) {
  State state;
  state.position = {{0.0, 3.0, 0.0}, {distance, 1.0 + 2.0, 0.0}};
  state.velocity = {{1.0, 2.0, 2.0}, {0.0, -1.0, 0.0}};
  return state;
}

TEST(Energy, SumsOfAPairByHand) {
  const Measures m = measure(pair(false), state_at(5.0));
  EXPECT_EQ(m.kinetic, 0.5 * 2.0 * 9.0 + 0.5 * 4.0 * 1.0);
  EXPECT_EQ(m.elastic, 0.5 * 8.0 * 9.0);
  EXPECT_EQ(m.gravitational, 2.0 * 10.0 * 3.0 + 4.0 * 10.0 * 3.0);
  EXPECT_EQ(m.total(), 11.0 + 36.0 + 180.0);
  EXPECT_EQ(m.momentum, (Vec3{2.0, 0.0, 4.0}));
  EXPECT_EQ(m.max_speed, 3.0);
  EXPECT_EQ(m.min_height, 3.0);
}

TEST(Energy, SlackCordHoldsNone) {
  EXPECT_EQ(measure(pair(true), state_at(1.0)).elastic, 0.0);
  EXPECT_EQ(measure(pair(false), state_at(1.0)).elastic, 4.0);
  EXPECT_EQ(measure(pair(true), state_at(5.0)).elastic, 36.0);
}

/// Elastic energy of a cube of n³ particles a meter apart, k = 1, stretched by a share along a direction.
double stretched(int n, const Vec3& along, double share) {
  ModelSettings settings;
  CubeSettings& cube = settings.cubes.emplace_back();
  cube.particles_per_edge = n;
  cube.edge_length = n - 1;
  cube.structural = cube.shear = cube.bending = {1.0, 0.0};
  const Model model = test::build(settings);
  State state = initial_state(model, Precision::double_);
  for (Vec3& x : state.position) x = x + share * dot(x, along) * along;
  return measure(model, state).elastic;
}

// docs/physics.md, section 2: ½ε²·C with C = 25/3, 23/3 and 67/9 k/s; what surfaces lack is taken off by two
// sizes: the third difference of U over n is that of a volume.
TEST(Energy, OfALatticeDependsOnTheDirection) {
  const double share = 1e-4;
  const std::pair<Vec3, double> cases[] = {
      {{1.0, 0.0, 0.0}, 25.0 / 3}, {{1.0, 1.0, 0.0}, 23.0 / 3}, {{1.0, 1.0, 1.0}, 67.0 / 9}};
  for (const auto& [direction, C] : cases) {
    const Vec3 along = (1.0 / length(direction)) * direction;
    const auto U = [&](int n) { return stretched(n, along, share); };
    const double per_volume = (U(9) - 3.0 * U(8) + 3.0 * U(7) - U(6)) / 6.0;
    EXPECT_NEAR(per_volume / (0.5 * share * share * C), 1.0, 0.01);
  }
}

TEST(Energy, PinnedParticleHasPotentialButNoMotion) {
  Model model = pair(false);
  model.inverse_mass.set(0, 0.0);
  State state = state_at(5.0);
  state.velocity[0] = {};
  const Measures m = measure(model, state);
  EXPECT_EQ(m.kinetic, 2.0);
  EXPECT_EQ(m.momentum, (Vec3{0.0, -4.0, 0.0}));
  EXPECT_EQ(m.max_speed, 1.0);
  EXPECT_EQ(m.gravitational, 180.0);
  EXPECT_EQ(m.elastic, 36.0);
}

TEST(Energy, BallsCountOnceTheyAreLaunched) {
  Model model;
  model.simulation.gravity = {0.0, -10.0, 0.0};
  model.balls.push_back({0.5, 2.0, 7, {}, {}, {}});
  State state;
  state.ball_position = {{0.0, 3.0, 0.0}};
  state.ball_velocity = {{4.0, 0.0, 0.0}};
  state.ball_angular_velocity = {{0.0, 0.0, 10.0}};
  state.step = 6;
  EXPECT_EQ(measure(model, state).total(), 0.0);
  EXPECT_EQ(measure(model, state).min_height, 0.0);
  state.step = 7;
  const Measures m = measure(model, state);
  // ½·2·16 + ½·(2/5·2·0.25)·100
  EXPECT_NEAR(m.kinetic, 26.0, 1e-14);
  EXPECT_NEAR(m.gravitational, 60.0, 1e-13);
  EXPECT_EQ(m.momentum, (Vec3{8.0, 0.0, 0.0}));
  EXPECT_EQ(m.max_speed, 4.0);
  EXPECT_EQ(m.min_height, 3.0);
}

TEST(Energy, MotionNeedsNeitherSpringsNorContacts) {
  Model model = test::build(test::pile(Integrator::symplectic_euler, ContactModel::coulomb));
  const State state = initial_state(model, Precision::double_);
  const Measures all = measure(model, state);
  model.spring_classes.clear();
  model.bodies.clear();  // with their surfaces
  const Measures motion = measure_motion(model, state);
  EXPECT_TRUE(motion.kinetic == all.kinetic && motion.gravitational == all.gravitational);
  EXPECT_TRUE(motion.momentum == all.momentum && motion.max_speed == all.max_speed);
  EXPECT_TRUE(motion.min_height == all.min_height && motion.elastic == 0.0 && !motion.contact && all.contact);
}

// Bodies are squeezed into each other by and by, moved far apart, turned into no numbers and brought back.
TEST(Energy, MeterThatKeepsItsSearchGivesTheBitsOfAFreshOne) {
  const Model model = test::build(test::pile(Integrator::symplectic_euler, ContactModel::coulomb));
  const State start = initial_state(model, Precision::double_);
  Meter kept(model);
  int in_contact = 0;
  const auto compare = [&](std::uint64_t step, double squeeze, const Vec3& second) {
    State state = start;
    state.step = step;
    for (Vec3& x : state.position) x.y *= squeeze;
    const Body& body = model.bodies[1];
    for (Vec3& x : std::span(state.position).subspan(body.first_particle, body.particle_count))
      x = x + second;
    const Measures one = kept.measure(state), fresh = measure(model, state);
    EXPECT_TRUE(*one.contact == *fresh.contact && one.elastic == fresh.elastic) << step;
    in_contact += *fresh.contact > 0.0 ? 1 : 0;
  };
  for (std::uint64_t step = 0; step < 40; ++step) compare(step, 1.0 - 0.01 * static_cast<double>(step), {});
  compare(500, 0.8, {0.0, 30.0, 0.0});
  compare(501, 0.8, {1.7, -2.0, 0.3});
  State wrong = start;
  wrong.position[7].x = std::numeric_limits<double>::quiet_NaN();
  (void)kept.measure(wrong);
  compare(2, 0.8, {});  // earlier, as after going back
  EXPECT_GE(in_contact, 30);
}

TEST(Energy, EmptyModelIsAllZero) {
  const Measures m = measure(Model{}, State{});
  EXPECT_EQ(m.total(), 0.0);
  EXPECT_EQ(m.min_height, 0.0);
}

}  // namespace
}  // namespace aspic
