// Contact of bodies on the device: the reference's bits for every method and force path, while lists
// are made again, with balls among the bodies, from a state in mid-contact on, and without what is asked for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "aspic/inputs.h"
#include "cpu_reference/reference_solver.h"
#include "gpu_solver/force_paths.h"
#include "gpu_solver/gpu_solver.h"
#include "support/contact_motions.h"
#include "support/gl_fixture.h"
#include "support/integrator_names.h"
#include "support/pile.h"
#include "support/value_of.h"

namespace aspic {
namespace {

using test::pile;

State by_reference(const Model& model, std::uint64_t steps) {
  const auto solver = std::move(*make_reference_solver(model, Precision::single));
  EXPECT_FALSE((*solver->advance(steps)).divergence.has_value());
  return *solver->state();
}

class BodyContactOnTheDevice : public testing::GlTest {
 protected:
  std::unique_ptr<GpuSolver> gpu(const Model& model, ForcePath path = ForcePath::automatic) {
    GpuOptions options;
    options.force_path = path;
    return test::value_of(make_gpu_solver(context(), model, options));
  }
  State by_device(const Model& model, std::uint64_t steps, ForcePath path = ForcePath::automatic) {
    const auto solver = gpu(model, path);
    const auto advanced = solver->advance(steps);
    EXPECT_TRUE(advanced.ok()) << (advanced.ok() ? "" : advanced.error().message());
    return *solver->state();
  }
  void expect_the_references_bits(const ForcePathRow& path, ContactModel contact);
};

// Methods take turns with paths and contact models.
TEST_F(BodyContactOnTheDevice, HasTheReferencesBitsUnderEveryMethodAndOnEveryPath) {
  std::size_t n = 0;
  for (const Integrator integrator : explicit_integrators) {
    const ForcePathRow& path = force_paths()[n++ % force_paths().size()];
    const ContactModel contact = n % 3 == 0 ? ContactModel::course : ContactModel::coulomb;
    SCOPED_TRACE(fmt::format("{}, {}, {}", name_of(integrator), path.name, name_of(contact)));
    ModelSettings settings = pile(integrator, contact);
    const Model model = test::build(settings);
    const State expected = by_reference(model, 35);
    EXPECT_EQ(by_device(model, 35, path.path), expected);
    settings.contact.bodies = false;
    EXPECT_FALSE(by_reference(test::build(settings), 35) == expected) << "nothing touches";
  }
}

// Few steps, since they are long; what moves fast wants other lists soon.
void BodyContactOnTheDevice::expect_the_references_bits(const ForcePathRow& path, ContactModel contact) {
  SCOPED_TRACE(fmt::format("{}, {}", path.name, name_of(contact)));
  ModelSettings settings = pile(Integrator::implicit_euler, contact);
  settings.simulation.timestep = 0.005;
  const Model model = test::build(settings);
  const State expected = by_reference(model, 15);
  EXPECT_EQ(by_device(model, 15, path.path), expected);
  settings.contact.bodies = false;
  EXPECT_FALSE(by_reference(test::build(settings), 15) == expected) << "nothing touches";
}

TEST_F(BodyContactOnTheDevice, HasTheReferencesBitsUnderImplicitEulerOnEveryPath) {
  std::size_t n = 0;
  for (const ForcePathRow& path : force_paths())
    if (path.implicit)
      expect_the_references_bits(path, n++ % 2 == 0 ? ContactModel::coulomb : ContactModel::course);
}

TEST_F(BodyContactOnTheDevice, HasTheReferencesBitsUnderImplicitEulerOnEveryPathWithEveryContactModel) {
  for (const ForcePathRow& path : force_paths()) {
    if (!path.implicit) continue;
    for (const ContactModel contact : {ContactModel::coulomb, ContactModel::course})
      expect_the_references_bits(path, contact);
  }
}

// Bodies that overlap at the start, without friction; then states in mid-contact, other constants, and steps
// asked for one by one.
TEST_F(BodyContactOnTheDevice, IsSolvedFromAnywhere) {
  ModelSettings settings = pile(Integrator::implicit_euler, ContactModel::coulomb);
  settings.simulation.timestep = 0.005;
  settings.contact.self = true;
  settings.contact.body_friction = 0.0;
  settings.cubes[1].position.y -= 0.3;
  const Model model = test::build(settings);
  EXPECT_EQ(by_device(model, 10), by_reference(model, 10));
  settings.contact.body_gap = 0.15;
  settings.contact.body_friction = 0.8;
  const SharedModel other = shared(test::build(settings));
  Inputs inputs;
  inputs.pulls.push_back({30, {0.0, 2.0, 1.0}, 300.0, 10.0});
  inputs.pinned.push_back(40);
  const auto expected = std::move(*make_reference_solver(model, Precision::single));
  const auto solver = gpu(model);
  const State start = by_reference(model, 15);
  for (Solver* const each : {expected.get(), static_cast<Solver*>(solver.get())}) {
    ASSERT_TRUE(each->load(start).ok());
    for (int n = 0; n < 5; ++n) ASSERT_TRUE(each->advance(1).ok());
    ASSERT_TRUE(each->set_constants(other).ok());
    ASSERT_TRUE(each->advance(8).ok());
    ASSERT_TRUE(each->set_inputs(inputs).ok());
    ASSERT_TRUE(each->advance(8).ok());
  }
  EXPECT_EQ(*solver->state(), *expected->state());
}

TEST_F(BodyContactOnTheDevice, HasTheReferencesBitsOfSelfContactWithoutFriction) {
  ModelSettings settings = pile(Integrator::symplectic_euler, ContactModel::coulomb);
  settings.contact.self = true;
  settings.contact.body_friction = 0.0;
  const Model model = test::build(settings);
  EXPECT_EQ(by_device(model, 60), by_reference(model, 60));
}

// Of two bodies the smaller friction counts; of one none at all.
TEST_F(BodyContactOnTheDevice, HasTheReferencesBitsOfBodiesWithFrictionOfTheirOwn) {
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::implicit_euler}) {
    ModelSettings settings = pile(integrator, ContactModel::coulomb);
    if (integrator == Integrator::implicit_euler) settings.simulation.timestep = 0.005;
    const std::uint64_t steps = integrator == Integrator::implicit_euler ? 15 : 60;
    const State alike = by_reference(test::build(settings), steps);
    settings.cubes[0].friction = 0.7;
    settings.cubes[1].friction = 0.05;
    settings.cloths[0].friction = 0.0;
    const Model model = test::build(settings);
    const State expected = by_reference(model, steps);
    EXPECT_FALSE(expected == alike);
    EXPECT_EQ(by_device(model, steps), expected) << name_of(integrator);
  }
}

TEST_F(BodyContactOnTheDevice, HasTheReferencesBitsWithBallsAndInputs) {
  ModelSettings settings = pile(Integrator::midpoint, ContactModel::coulomb);
  settings.balls.push_back({0.3, 2.0, {1.6, 2.2, 0.2}, {-3.0, -2.0, 0.5}, {3.0, 1.0, -2.0}});
  test::resist(settings, 0.7);
  const Model model = test::build(settings);
  Inputs inputs;
  inputs.pulls.push_back({30, {0.0, 2.0, 1.0}, 300.0, 10.0});
  inputs.pinned.push_back(40);
  const auto expected = std::move(*make_reference_solver(model, Precision::single));
  const auto solver = gpu(model);
  for (Solver* const each : {expected.get(), static_cast<Solver*>(solver.get())}) {
    ASSERT_TRUE(each->advance(20).ok());
    ASSERT_TRUE(each->set_inputs(inputs).ok());
    ASSERT_TRUE(each->advance(50).ok());
  }
  EXPECT_EQ(*solver->state(), *expected->state());
}

// Lists are made on the host for many steps; the reference looks at every candidate in every step.
TEST_F(BodyContactOnTheDevice, HasTheReferencesBitsInEveryKindOfMotion) {
  for (test::ContactMotion& motion : test::contact_motions()) {
    SCOPED_TRACE(motion.name);
    if (motion.impact_share > 0.0) motion.settings.cubes[0].velocity.y = -20.0;
    const std::uint64_t steps = std::min<std::uint64_t>(motion.steps, 200);
    const Model model = test::build(motion.settings);
    Inputs inputs;
    if (motion.pull > 0.0) inputs.pulls.push_back({0, {}, motion.pull, 10.0});
    const auto expected = std::move(*make_reference_solver(model, Precision::single));
    const auto solver = gpu(model);
    State late;  // bodies that meet late have just met
    if (motion.steps > 1000) {
      const auto before = std::move(*make_reference_solver(model, Precision::single));
      ASSERT_TRUE(before->advance(motion.steps - steps).ok());
      late = *before->state();
    }
    for (Solver* const each : {expected.get(), static_cast<Solver*>(solver.get())}) {
      if (motion.steps > 1000) {
        ASSERT_TRUE(each->load(late).ok());
      }
      ASSERT_TRUE(each->set_inputs(inputs).ok());
      ASSERT_TRUE(each->advance(steps).ok());
    }
    EXPECT_EQ(*solver->state(), *expected->state());
  }
}

// A state in mid-contact, other constants, and steps asked for one by one.
TEST_F(BodyContactOnTheDevice, GoesOnFromAnywhere) {
  ModelSettings settings = pile(Integrator::velocity_verlet, ContactModel::coulomb);
  const Model model = test::build(settings);
  settings.contact.body_gap = 0.15;
  settings.contact.body_friction = 0.8;
  const SharedModel other = shared(test::build(settings));
  const auto expected = std::move(*make_reference_solver(model, Precision::single));
  const auto solver = gpu(model);
  ASSERT_TRUE(solver->load(by_reference(model, 40)).ok());
  ASSERT_TRUE(expected->load(by_reference(model, 40)).ok());
  for (Solver* const each : {expected.get(), static_cast<Solver*>(solver.get())}) {
    for (int n = 0; n < 10; ++n) ASSERT_TRUE(each->advance(1).ok());
    ASSERT_TRUE(each->set_constants(other).ok());
    ASSERT_TRUE(each->advance(30).ok());
  }
  EXPECT_EQ(*solver->state(), *expected->state());
}

}  // namespace
}  // namespace aspic
