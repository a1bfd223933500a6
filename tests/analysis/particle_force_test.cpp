#include "analysis/particle_force.h"

#include <gtest/gtest.h>

#include <random>

#include "cpu_reference/terms.h"
#include "model/springs.h"
#include "support/model_building.h"

namespace aspic {
namespace {

using physics::Field;

/// A cube with a pinned face, a net with all types of springs whose own are cords, and a ball of ground.
ModelSettings cube_and_net() {
  ModelSettings settings = test::cube_on_plane(6, 1.0);
  settings.cubes[0].pinned.names = {"top"};
  GoalNetSettings net;
  net.particles = {4, 5, 6};
  net.cord = true;
  net.shear = {300.0, 20.0};
  net.bending = {200.0, 10.0};
  settings.goal_nets.push_back(net);
  TerrainSettings globe;
  globe.shape = TerrainShape::sphere;
  globe.geometry["center"] = Vec3{0.0, -1.0, 0.0};
  settings.terrain.push_back(globe);
  return settings;
}

/// The initial state, every particle moved a little and in slow motion.
State shaken(const Model& model, double distance, double speed) {
  State state = initial_state(model, Precision::double_);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto off = [&](double size) { return size * Vec3{any(random), any(random), any(random)}; };
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    state.position[i] = state.position[i] + off(distance);
    state.velocity[i] = state.velocity[i] + off(speed);
  }
  return state;
}

void expect_references_force(const Model& model, const State& state, const std::optional<Pull>& pull = {}) {
  const auto count = static_cast<Eigen::Index>(model.particle_count());
  Field<double> x(3, count), v(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    x.col(i) = physics::rounded<double>(state.position[static_cast<std::size_t>(i)]);
    v.col(i) = physics::rounded<double>(state.velocity[static_cast<std::size_t>(i)]);
  }
  reference::Dynamics<double> dynamics(model);
  dynamics.set_inputs(inputs_of(pull));
  Field<double> f = reference::Terms<double>(dynamics).force(x, v);
  dynamics.add_contact_force(x, v, f);
  const SpringFinder incident(model);
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    const ParticleForce force = particle_force(model, incident, state, i, inputs_of(pull));
    // The same operations in the same order.
    const Vec3 expected = {f(0, i), f(1, i), f(2, i)};
    EXPECT_EQ(force.applied, expected) << "particle " << i;
  }
}

TEST(ParticleForceTest, IsTheReferencesInTheCoulombModel) {
  const Model model = test::build(cube_and_net());
  expect_references_force(model, shaken(model, 0.2, 3.0));
}

TEST(ParticleForceTest, IsTheReferencesInTheCourseModel) {
  ModelSettings settings = cube_and_net();
  settings.contact.model = ContactModel::course;
  // Slow, and down to the ground: contact forces act.
  settings.cubes[0].position = {0.0, 0.9, 0.0};
  settings.cubes[0].edge_length = 3.8;
  const Model model = test::build(settings);
  const State state = shaken(model, 0.02, 0.004);
  expect_references_force(model, state);
  const SpringFinder incident(model);
  int in_contact = 0;
  for (std::uint32_t i = 0; i < model.particle_count(); ++i)
    in_contact += particle_force(model, incident, state, i).contact != Vec3{};
  EXPECT_GT(in_contact, 10) << "else nothing was compared";
}

TEST(ParticleForceTest, CountsThePullOfAHand) {
  const Model model = test::build(cube_and_net());
  const State state = shaken(model, 0.2, 3.0);
  const Pull pull = {123, {1.0, 5.0, -2.0}, 700.0, 30.0};
  expect_references_force(model, state, pull);
  const SpringFinder incident(model);
  EXPECT_NE(particle_force(model, incident, state, 123, inputs_of(pull)).pull, Vec3{});
  EXPECT_EQ(particle_force(model, incident, state, 124, inputs_of(pull)).pull, Vec3{});
}

TEST(ParticleForceTest, PartsByHand) {
  Model model = test::particles({{0, 0, 0}, {3, 0, 0}, {3, 4, 0}}, {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, 2.0);
  model.simulation.gravity = {0.0, -10.0, 0.0};
  model.spring_classes = {{SpringType::structural, 8.0, 2.0, 2.0, false},
                          {SpringType::bending, 8.0, 2.0, 5.0, true}};
  model.listed_springs = {{0, 1, 0}, {1, 2, 1}};
  const State state = initial_state(model, Precision::double_);
  const SpringFinder incident(model);
  const ParticleForce force = particle_force(model, incident, state, 1);
  EXPECT_EQ(force.gravity, (Vec3{0.0, -20.0, 0.0}));
  // Stretched by 1 m and growing by 1 m/s; the cord to particle 2 hangs slack.
  EXPECT_EQ(force.springs, (Vec3{-10.0, 0.0, 0.0}));
  EXPECT_EQ(force.contact, Vec3{});
  EXPECT_EQ(force.net, (Vec3{-10.0, -20.0, 0.0}));
}

TEST(SpringFinderTest, AreAllThatEndAtAParticle) {
  ModelSettings with_box = cube_and_net();
  with_box.cubes[0].particles = {3, 2, 5};
  for (const Model& model : {test::build(cube_and_net()), test::build(with_box)}) {
    const SpringFinder incident(model);
    std::vector<std::vector<Spring>> expected(model.particle_count());
    for (const Spring& s : springs_of(model)) {
      expected[s.a].push_back(s);
      expected[s.b].push_back(s);
    }
    for (std::uint32_t i = 0; i < model.particle_count(); ++i) EXPECT_EQ(incident.of(model, i), expected[i]);
  }
  const Model loose = test::particles({{0, 0, 0}}, {{0, 0, 0}});
  EXPECT_TRUE(SpringFinder(loose).of(loose, 0).empty());
}

}  // namespace
}  // namespace aspic
