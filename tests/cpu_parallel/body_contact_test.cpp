// Contact of bodies on the cpu backend: the reference's bits, for any method, contact model, number of
// threads and instruction set, while bodies touch each other, the ground and themselves.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "analysis/contact_facts.h"
#include "aspic/inputs.h"
#include "cpu_parallel/cpu_solver.h"
#include "cpu_reference/reference_solver.h"
#include "support/contact_motions.h"
#include "support/integrator_names.h"
#include "support/pile.h"

namespace aspic {
namespace {

State after(const Model& model, std::uint64_t steps) {
  const auto solver = std::move(*make_reference_solver(model, Precision::single));
  EXPECT_FALSE((*solver->advance(steps)).divergence.has_value());
  return *solver->state();
}

std::string hash_on_cpu(const Model& model, std::uint64_t steps, unsigned threads) {
  const auto solver = std::move(*make_cpu_solver(model, {threads}));
  EXPECT_FALSE((*solver->advance(steps)).divergence.has_value());
  return state_hash_text(*solver->state());
}

class BodiesOnTheCpu : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(CpuSolver, BodiesOnTheCpu, testing::ValuesIn(all_integrators), test::by_integrator);

TEST_P(BodiesOnTheCpu, HaveTheReferencesBits) {
  for (const ContactModel contact : {ContactModel::coulomb, ContactModel::course}) {
    SCOPED_TRACE(name_of(contact));
    ModelSettings settings = test::pile(GetParam(), contact);
    const State expected = after(test::build(settings), 70);
    for (const unsigned threads : {1u, 2u, 5u})
      EXPECT_EQ(hash_on_cpu(test::build(settings), 70, threads), state_hash_text(expected));
    settings.contact.bodies = false;
    EXPECT_FALSE(after(test::build(settings), 70) == expected) << "nothing touches";
  }
}

TEST(BodiesOnTheCpu, HaveTheReferencesBitsOnEveryInstructionSet) {
  const Model model = test::build(test::pile(Integrator::velocity_verlet, ContactModel::coulomb));
  const std::string expected = state_hash_text(after(model, 70));
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    hwy::SetSupportedTargetsForTest(targets & -targets);
    EXPECT_EQ(hash_on_cpu(model, 70, 2), expected) << hwy::TargetName(targets & -targets);
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(BodiesOnTheCpu, HaveTheReferencesBitsInSelfContact) {
  ModelSettings settings = test::pile(Integrator::symplectic_euler, ContactModel::coulomb);
  settings.contact.self = true;
  const Model model = test::build(settings);
  EXPECT_EQ(hash_on_cpu(model, 200, 2), state_hash_text(after(model, 200)));
}

// The reference looks at every candidate in every step; this backend keeps lists for as long as they hold.
TEST(BodiesOnTheCpu, HaveTheReferencesBitsInEveryKindOfMotion) {
  for (test::ContactMotion& motion : test::contact_motions()) {
    SCOPED_TRACE(motion.name);
    if (motion.impact_share > 0.0) {
      const double limit = contact_facts(test::build(motion.settings)).pairings.at(0).speed();
      motion.settings.cubes[0].velocity.y = -motion.impact_share * limit;
    }
    const Model model = test::build(motion.settings);
    Inputs inputs;
    if (motion.pull > 0.0) inputs.pulls.push_back({0, {}, motion.pull, 10.0});
    const auto reference = std::move(*make_reference_solver(model, Precision::single));
    const auto cpu = std::move(*make_cpu_solver(model, {2}));
    for (Solver* const each : {reference.get(), cpu.get()}) {
      ASSERT_TRUE(each->set_inputs(inputs).ok());
      EXPECT_FALSE((*each->advance(motion.steps)).divergence.has_value());
    }
    const State end = *reference->state();
    EXPECT_EQ(*cpu->state(), end);
    motion.settings.contact.bodies = motion.settings.contact.self = false;
    EXPECT_FALSE(after(test::build(motion.settings), motion.steps) == end) << "nothing touches";

    // From this state on, a solver without lists.
    const auto resumed = std::move(*make_cpu_solver(model, {1}));
    ASSERT_TRUE(resumed->load(end).ok());
    ASSERT_TRUE(resumed->set_inputs(inputs).ok());
    for (Solver* const each : {cpu.get(), resumed.get()}) ASSERT_TRUE(each->advance(50).ok());
    EXPECT_EQ(*resumed->state(), *cpu->state());
  }
}

// Pins, pulls and other constants reach contact too.
TEST(BodiesOnTheCpu, HaveTheReferencesBitsUnderInputsAndOtherConstants) {
  ModelSettings settings = test::pile(Integrator::midpoint, ContactModel::coulomb);
  settings.balls.push_back({0.3, 2.0, {1.6, 2.2, 0.2}, {-3.0, -2.0, 0.5}, {3.0, 1.0, -2.0}});
  test::resist(settings, 0.7);
  const Model model = test::build(settings);
  settings.contact.body_friction = 0.9;
  settings.contact.body_gap = 0.15;
  const SharedModel other = shared(test::build(settings));
  Inputs inputs;
  inputs.pulls.push_back({30, {0.0, 2.0, 1.0}, 300.0, 10.0});
  std::vector<State> ends;
  for (const bool on_cpu : {false, true}) {
    const auto solver = on_cpu ? std::move(*make_cpu_solver(model, {2}))
                               : std::move(*make_reference_solver(model, Precision::single));
    ASSERT_TRUE(solver->set_inputs(inputs).ok());
    ASSERT_TRUE(solver->advance(60).ok());
    ASSERT_TRUE(solver->set_constants(other).ok());
    ASSERT_TRUE(solver->advance(60).ok());
    ends.push_back(*solver->state());
  }
  EXPECT_EQ(ends[0], ends[1]);
}

}  // namespace
}  // namespace aspic
