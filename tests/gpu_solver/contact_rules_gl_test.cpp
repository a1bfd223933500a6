// The rules that keep rounding from deciding about contact, on the device.
#include <gtest/gtest.h>

#include "cpu_reference/reference_solver.h"
#include "gpu_solver/gpu_solver.h"
#include "support/contact_rules.h"
#include "support/gl_fixture.h"
#include "support/value_of.h"

namespace aspic {
namespace {

class ContactRules : public aspic::testing::GlTest {
 protected:
  std::unique_ptr<Solver> solver(const Model& model) {
    return test::value_of(make_gpu_solver(context(), model, {}));
  }
};

TEST_F(ContactRules, WithoutRestitutionALandingComesToRest) {
  test::expect_landing_to_rest([this](const Model& model) { return solver(model); });
}

TEST_F(ContactRules, OfPlanesInOneTheOneWithMoreFrictionHolds) {
  test::expect_more_friction_to_hold([this](const Model& model) { return solver(model); });
}

TEST_F(ContactRules, HaveTheReferencesBits) {
  const auto expect_equal = [this](const Model& model, std::uint64_t steps) {
    const auto gpu = solver(model);
    const auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    ASSERT_FALSE((*gpu->advance(steps)).divergence.has_value());
    ASSERT_FALSE((*reference->advance(steps)).divergence.has_value());
    EXPECT_EQ(*gpu->state(), *reference->state());
  };
  expect_equal(test::cube_on_slope(std::array{0.1, 0.0, 0.5, 0.2}), 60);
  ModelSettings settings = test::low_cube(4, Integrator::explicit_euler, ContactModel::coulomb);
  settings.contact.restitution = 0.0;
  expect_equal(test::build(settings), 400);
  for (const ContactModel contact : {ContactModel::coulomb, ContactModel::course})
    for (const Model& landing : test::landings(contact)) expect_equal(landing, 200);
}

}  // namespace
}  // namespace aspic
