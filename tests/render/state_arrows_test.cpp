#include "render/state_arrows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "analysis/particle_contact.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

std::size_t count(const ArrowSet& set, ArrowKind kind) {
  return static_cast<std::size_t>(std::ranges::count(set.arrows, kind, &Arrow::kind));
}

TEST(StateArrows, ShowTheForcesOfParticles) {
  const Model model = test::build(test::low_cube(5, Integrator::explicit_euler, ContactModel::coulomb));
  State state = initial_state(model, Precision::single);
  for (std::size_t i = 0; i < state.position.size(); i += 3) state.position[i].x += 0.05;
  const Pull pull = {.particle = 7, .anchor = {1.0, 2.0, 3.0}, .stiffness = 50.0, .damping = 1.0};
  const ArrowSet set =
      arrows_of(model, state, {.springs = true, .external = true, .net = true}, inputs_of(pull));
  ASSERT_EQ(set.arrows.size(), 3u * 125u);
  const SpringFinder springs(model);
  for (std::uint32_t i = 0; i < 125; ++i) {
    const ParticleForce f = particle_force(model, springs, state, i, inputs_of(pull));
    const std::size_t first = std::size_t{3} * i;
    EXPECT_EQ(set.arrows[first], (Arrow{state.position[i], f.springs, ArrowKind::springs}));
    EXPECT_EQ(set.arrows[first + 1], (Arrow{state.position[i], f.gravity + f.pull, ArrowKind::external}));
    EXPECT_EQ(set.arrows[first + 2], (Arrow{state.position[i], f.net, ArrowKind::net}));
  }
  EXPECT_TRUE(arrows_of(model, state, {}).arrows.empty());
}

TEST(StateArrows, ShowNormalsAndForcesOfContacts) {
  ModelSettings settings = test::low_cube(4, Integrator::explicit_euler, ContactModel::coulomb);
  settings.cubes[0].rotation.angle = 0.0;
  settings.cubes[0].position = {0.0, 1.0, 0.0};
  settings.cubes[0].velocity = {};
  const Model model = test::build(settings);
  const State state = initial_state(model, Precision::single);
  const ArrowSet set = arrows_of(model, state, {.contacts = true});
  EXPECT_EQ(count(set, ArrowKind::normal), 16u);
  EXPECT_EQ(count(set, ArrowKind::contact), 16u);
  const auto contacts = contacts_of(model, SpringFinder(model), state);
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    EXPECT_EQ(set.arrows[2 * k].value, contacts[k].normal);
    EXPECT_EQ(set.arrows[2 * k + 1].value, contacts[k].force);
  }
}

TEST(StateArrows, ThinLargeCubesEvenly) {
  ModelSettings settings = test::cube_on_plane(30, 1.0);
  const Model model = test::build(settings);
  const State state = initial_state(model, Precision::single);
  const ArrowSet net = arrows_of(model, state, {.net = true});
  EXPECT_EQ(net.arrows.size(), 1000u);
  std::set<double> heights;
  for (const Arrow& arrow : net.arrows) heights.insert(arrow.from.y);
  EXPECT_EQ(heights.size(), 10u);
  EXPECT_EQ(count(arrows_of(model, state, {.contacts = true}), ArrowKind::normal), 100u);
}

TEST(StateArrows, ThinBoxesAlikeInAllDirections) {
  ModelSettings settings = test::cube_on_plane(2, 1.0);
  settings.cubes[0].particles = {30, 4, 7};
  const Model model = test::build(settings);
  // Every third particle along each edge.
  const ArrowSet net = arrows_of(model, initial_state(model, Precision::single), {.net = true});
  EXPECT_EQ(net.arrows.size(), 10u * 2u * 3u);
}

// Newton's second law: what rests has no net force, and no arrow of it.
TEST(StateArrows, ShowNoNetForceOfABodyAtRest) {
  for (const Integrator method :
       {Integrator::explicit_euler, Integrator::implicit_euler, Integrator::runge_kutta_4}) {
    ModelSettings settings = test::cube_on_plane(5, 2.05);
    settings.simulation.integrator = method;
    const Model model = test::build(settings);
    const State state = test::after(model, 4400, Precision::single);
    ASSERT_LT(length(state.velocity[0]), 2e-4);
    const ArrowSet net = arrows_of(model, state, {.net = true});
    double most = 0.0;
    for (const Arrow& arrow : net.arrows) most = std::max(most, length(arrow.value));
    EXPECT_LT(most, net.noise);
    EXPECT_EQ(arrow_scale({}, net), 0.0);
    const ArrowSet springs = arrows_of(model, state, {.springs = true});
    EXPECT_GT(arrow_scale({}, springs), 0.0) << "which carry weight";
  }
}

// A cube that falls turned has springs of their rest length but for rounding.
TEST(StateArrows, DoNotEnlargeRoundingErrors) {
  ModelSettings settings = test::cube_on_plane(6, 9.0);
  settings.cubes[0].rotation.angle = 33.0;
  settings.cubes[0].velocity = {0.0, -4.0, 0.0};
  const Model model = test::build(settings);
  State state = test::after(model, 200, Precision::single);
  const ArrowSet falling = arrows_of(model, state, {.springs = true});
  EXPECT_TRUE(std::ranges::any_of(falling.arrows, [](const Arrow& a) { return a.value != Vec3{}; }));
  EXPECT_EQ(arrow_scale({}, falling), 0.0);
  EXPECT_GT(arrow_scale({}, arrows_of(model, state, {.external = true})), 0.0);
  state.position[0].x += 0.01;
  EXPECT_GT(arrow_scale({}, arrows_of(model, state, {.springs = true})), 0.0);
}

TEST(StateArrows, HaveALegendOfTheirScale) {
  ViewSettings view;
  EXPECT_TRUE(arrow_legend(view, {}).empty());
  view.arrows.springs = true;
  ArrowSet set{{{{}, {0.0, 3.0, 4.0}, ArrowKind::springs}}, 1.3};
  // 5 N find room in 1.3 m with 5 N/m, not with 2.
  EXPECT_EQ(arrow_scale(view, set), 5.0);
  EXPECT_EQ(arrow_legend(view, set).title, "arrows: 1 m = 5 N");
  set.room = 0.3;
  EXPECT_EQ(arrow_legend(view, set).title, "arrows: 1 cm = 0.2 N");
  ASSERT_EQ(arrow_legend(view, set).entries.size(), 1u);
  EXPECT_EQ(arrow_legend(view, set).entries[0].name, "springs");
  view.arrow_scale = 40.0;
  EXPECT_EQ(arrow_legend(view, set).title, "arrows: 1 cm = 0.4 N");
  // Normals have no length in newtons.
  EXPECT_EQ(arrow_scale({}, {{{{}, {0.0, 1.0, 0.0}, ArrowKind::normal}}, 1.0}), 0.0);
}

}  // namespace
}  // namespace aspic
