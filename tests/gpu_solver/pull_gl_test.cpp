// Pulling a particle ends with the same bits on the device as on the reference.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "cpu_reference/reference_solver.h"
#include "gpu_solver/gpu_solver.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/value_of.h"

namespace aspic {
namespace {

/// From this step on.
struct Input {
  std::uint64_t step;
  std::optional<Pull> pull;
};

class PullOnTheDevice : public aspic::testing::GlTest {
 protected:
  static std::unique_ptr<GpuSolver> solver_for(const Model& model, ForcePath path = ForcePath::gather) {
    GpuOptions options;
    options.force_path = path;
    return test::value_of(make_gpu_solver(context(), model, options));
  }

  /// The state at `steps`, with every input given at its step.
  static State run(Solver& solver, const std::vector<Input>& inputs, std::uint64_t steps) {
    std::uint64_t at = solver.state()->step;
    for (const Input& input : inputs) {
      EXPECT_FALSE((*solver.advance(input.step - at)).divergence.has_value());
      EXPECT_TRUE(solver.set_inputs(inputs_of(input.pull)).ok());
      at = input.step;
    }
    EXPECT_FALSE((*solver.advance(steps - at)).divergence.has_value());
    return *solver.state();
  }

  /// A tilted cube at the ground, with a corner of it pinned.
  static ModelSettings low_cube(Integrator integrator, ContactModel contact) {
    ModelSettings settings = test::cube_on_plane(4, 1.9);
    settings.cubes[0].rotation = {{1.0, 0.3, 0.7}, 25.0};
    settings.cubes[0].velocity = {1.0, -1.0, 0.5};
    settings.cubes[0].pinned.names = {"left-top-back"};
    settings.simulation.integrator = integrator;
    if (integrator == Integrator::implicit_euler) settings.simulation.timestep = 0.005;
    settings.contact.model = contact;
    return settings;
  }

  static void expect_the_references_bits(bool every_path);
  static void expect_the_references_bits_of_balls(bool both_spins);
};

/// Every path, or one after the other in turn.
void PullOnTheDevice::expect_the_references_bits(bool every_path) {
  std::size_t turn = 0;
  for (const Integrator integrator : all_integrators) {
    const std::uint64_t s = integrator == Integrator::implicit_euler ? 6 : 30;
    const std::vector<Input> inputs = {
        {0, Pull{63, {3.0, 4.0, 2.0}, 900.0, 20.0}},                // a corner
        {2 * s, Pull{63, {3.1, 4.5, -2.0}, 900.0, 20.0}},           // the hand moves
        {3 * s, Pull{21, {-0.0, 0.7, 1.0 / 3.0}, 1e4 / 3.0, 0.0}},  // another particle, inside
        {4 * s, std::nullopt},                                      // let go
        {5 * s, Pull{0, {9.0, 9.0, 9.0}, 500.0, 5.0}},              // the lowest index
        {6 * s + 1, Pull{3, {0.0, -5.0, 0.0}, 200.0, 50.0}}};       // down, on the ground
    for (const ContactModel contact : {ContactModel::coulomb, ContactModel::course}) {
      const Model model = test::build(low_cube(integrator, contact));
      auto reference = std::move(make_reference_solver(model, Precision::single)).value();
      const State expected = run(*reference, inputs, 8 * s);
      auto untouched = std::move(make_reference_solver(model, Precision::single)).value();
      ASSERT_FALSE((*untouched->advance(8 * s)).divergence.has_value());
      double moved = 0.0;
      for (std::size_t i = 0; i < expected.position.size(); ++i)
        moved = std::max(moved, length(expected.position[i] - untouched->state()->position[i]));
      ASSERT_GT(moved, 0.1);
      std::vector<ForcePath> paths = {ForcePath::lattice, ForcePath::gather, ForcePath::per_spring};
      std::erase_if(paths, [&](ForcePath path) { return !works_with(path, integrator); });  // refused by name
      if (!every_path) paths = {paths[turn++ % paths.size()]};
      for (const ForcePath path : paths) {
        auto solver = solver_for(model, path);
        const State state = run(*solver, inputs, 8 * s);
        EXPECT_EQ(state_hash_text(state), state_hash_text(expected))
            << name_of(integrator) << ", " << name_of(contact) << ", " << name_of(path);
        EXPECT_EQ(state, expected);
      }
    }
  }
}

TEST_F(PullOnTheDevice, EveryIntegratorAndContactModel) {
  expect_the_references_bits(false);
}

TEST_F(PullOnTheDevice, EveryIntegratorContactModelAndForcePath) {
  expect_the_references_bits(true);
}

/// With and without spin, or in turn.
void PullOnTheDevice::expect_the_references_bits_of_balls(bool both_spins) {
  std::size_t turn = 0;
  for (const Integrator integrator : all_integrators) {
    for (const ContactModel contact : {ContactModel::coulomb, ContactModel::course}) {
      for (const bool spin : {true, false}) {
        if (!both_spins && spin != (turn++ % 4 < 2)) continue;
        ModelSettings settings = low_cube(integrator, contact);
        settings.contact.spin = spin;
        settings.balls.push_back({0.3, 2.0, {3.0, 0.4, 0.2}, {-1.0, -2.0, 0.5}, {3.0, 1.0, -2.0}});
        settings.balls.push_back({0.5, 1.0, {3.2, 1.6, 0.1}, {0.0, 0.0, 0.0}, {}});
        const std::uint64_t s = integrator == Integrator::implicit_euler ? 6 : 30;
        const std::vector<Input> inputs = {{0, Pull{0, {0.0, 3.0, 0.0}, 400.0, 20.0, true}},
                                           {2 * s, Pull{0, {5.0, -1.0, 1.0}, 400.0, 20.0, true}},
                                           {3 * s, Pull{1, {3.0, 2.0, 1.0 / 3.0}, 1e3 / 3.0, 0.0, true}},
                                           {4 * s, Pull{1, {3.0, 4.0, 0.0}, 900.0, 20.0}},
                                           {5 * s, std::nullopt}};
        const Model model = test::build(settings);
        auto reference = std::move(make_reference_solver(model, Precision::single)).value();
        const State expected = run(*reference, inputs, 6 * s);
        auto solver = solver_for(model);
        EXPECT_EQ(run(*solver, inputs, 6 * s), expected)
            << name_of(integrator) << ", " << name_of(contact) << ", spin " << spin;
        auto untouched = std::move(make_reference_solver(model, Precision::single)).value();
        ASSERT_FALSE((*untouched->advance(6 * s)).divergence.has_value());
        for (std::size_t b = 0; b < 2; ++b)
          EXPECT_GT(length(expected.ball_position[b] - untouched->state()->ball_position[b]), 0.05);
      }
    }
  }
}

TEST_F(PullOnTheDevice, BallsFeelItToo) {
  expect_the_references_bits_of_balls(false);
}

TEST_F(PullOnTheDevice, BallsFeelItWithAndWithoutSpin) {
  expect_the_references_bits_of_balls(true);
}

// How the steps between two inputs are queued changes nothing, nor does a load in between.
TEST_F(PullOnTheDevice, HoldsOverBatchesAndLoad) {
  for (const Integrator integrator : {Integrator::runge_kutta_4, Integrator::implicit_euler}) {
    const Model model = test::build(low_cube(integrator, ContactModel::coulomb));
    const Pull pull{63, {3.0, 4.0, 2.0}, 900.0, 20.0};
    auto whole = solver_for(model), split = solver_for(model);
    ASSERT_TRUE(whole->set_inputs(inputs_of(pull)).ok());
    ASSERT_TRUE(split->set_inputs(inputs_of(pull)).ok());
    ASSERT_FALSE((*whole->advance(60)).divergence.has_value());
    for (const std::uint64_t steps : {1u, 7u, 22u})
      ASSERT_FALSE((*split->advance(steps)).divergence.has_value());
    ASSERT_TRUE(split->load(*split->state()).ok());
    ASSERT_FALSE((*split->advance(30)).divergence.has_value());
    EXPECT_EQ(*split->state(), *whole->state());
  }
}

// A pull that throws its particle out of the range of sane speeds.
TEST_F(PullOnTheDevice, DivergesWhereTheReferenceDoes) {
  for (const Integrator integrator :
       {Integrator::explicit_euler, Integrator::runge_kutta_4, Integrator::implicit_euler}) {
    Model model = test::build(low_cube(integrator, ContactModel::coulomb));
    const Pull pull{42, {1e6, 0.0, 0.0}, 500.0, 0.0};
    auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    auto solver = solver_for(model);
    for (Solver* each : {static_cast<Solver*>(reference.get()), static_cast<Solver*>(solver.get())}) {
      ASSERT_FALSE((*each->advance(5)).divergence.has_value());
      ASSERT_TRUE(each->set_inputs(inputs_of(pull)).ok());
    }
    const auto expected = reference->advance(100)->divergence, found = solver->advance(100)->divergence;
    ASSERT_TRUE(expected && found) << name_of(integrator);
    EXPECT_EQ(found->step, expected->step);
    EXPECT_EQ(found->particle, expected->particle);
    // Methods that see the whole step drag its neighbors along within it.
    if (integrator == Integrator::explicit_euler) {
      EXPECT_EQ(found->particle, 42u);
    }
    EXPECT_EQ(*solver->state(), *reference->state());
  }
}

TEST_F(PullOnTheDevice, AtItsAnchorAndOnAPinnedParticleItDoesNothing) {
  for (const Integrator integrator : {Integrator::explicit_euler, Integrator::implicit_euler}) {
    ModelSettings settings = low_cube(integrator, ContactModel::coulomb);
    settings.cubes[0].velocity = {};
    const Model model = test::build(settings);
    std::uint32_t pinned = 0;
    while (model.inverse_mass[pinned] != 0.0) ++pinned;
    const State start = initial_state(model, Precision::single);
    auto free = solver_for(model), held = solver_for(model);
    ASSERT_TRUE(held->set_inputs({{Pull{pinned, {50.0, 3.0, 0.0}, 1000.0, 10.0}}}).ok());
    ASSERT_FALSE((*free->advance(20)).divergence.has_value());
    ASSERT_FALSE((*held->advance(20)).divergence.has_value());
    EXPECT_EQ(held->state()->position[pinned], start.position[pinned]);
    EXPECT_EQ(*held->state(), *free->state());

    Model still = test::particles({{1.0, 2.0, 3.0}}, {{0.0, 0.0, 0.0}});
    still.simulation.gravity = {};
    still.simulation.integrator = integrator;
    auto alone = solver_for(still);
    ASSERT_TRUE(alone->set_inputs({{Pull{0, {1.0, 2.0, 3.0}, 1e6, 1e3}}}).ok());
    ASSERT_FALSE((*alone->advance(10)).divergence.has_value());
    EXPECT_EQ(alone->state()->position, initial_state(still, Precision::single).position);
  }
}

TEST_F(PullOnTheDevice, RefusedPullLeavesTheOneBefore) {
  const Model model = test::build(low_cube(Integrator::explicit_euler, ContactModel::coulomb));
  const Pull pull{63, {3.0, 4.0, 2.0}, 900.0, 20.0};
  auto solver = solver_for(model), other = solver_for(model);
  ASSERT_TRUE(solver->set_inputs(inputs_of(pull)).ok());
  ASSERT_TRUE(other->set_inputs(inputs_of(pull)).ok());
  EXPECT_EQ(solver->set_inputs({{Pull{64, {}, 1.0, 1.0}}}).error().code, ErrorCode::usage);
  EXPECT_EQ(solver->set_inputs({{Pull{1, {}, -1.0, 1.0}}}).error().code, ErrorCode::usage);
  ASSERT_FALSE((*solver->advance(30)).divergence.has_value());
  ASSERT_FALSE((*other->advance(30)).divergence.has_value());
  EXPECT_EQ(*solver->state(), *other->state());
}

}  // namespace
}  // namespace aspic
