// The device's rows, given a device that computes another model than it was asked for.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "support/gl_fixture.h"
#include "verify/check.h"

namespace aspic::verify {
namespace {

class FaultyDevice : public aspic::testing::GlTest {
 protected:
  static Row row_of(const std::string& name, const Subject& subject) {
    const std::vector<std::string> names = {name};
    const auto checks = select(battery(), names, false);
    EXPECT_TRUE(checks.ok()) << name;
    return evaluate(checks->front(), subject);
  }
};

TEST_F(FaultyDevice, AnotherStiffnessOrIntegratorIsNoticed) {
  Subject subject = product(&context(), ASPIC_PROGRAM);
  EXPECT_EQ(row_of("equality/force", subject).verdict, Verdict::passed);
  // The models must outlive the solvers made of them.
  std::vector<std::unique_ptr<Model>> models;
  subject.gpu = [&, right = subject.gpu](const Model& model, const GpuOptions& options) {
    models.push_back(std::make_unique<Model>(model));
    for (SpringClass& s : models.back()->spring_classes) s.stiffness *= 1 + 1e-5;
    return right(*models.back(), options);
  };
  EXPECT_EQ(row_of("equality/force", subject).verdict, Verdict::failed);
  const Row equality = row_of("equality/implicit-euler", subject);
  EXPECT_EQ(equality.verdict, Verdict::failed) << equality.measured;
}

TEST_F(FaultyDevice, AWorkGroupOrARunOfItsOwnIsNoticed) {
  Subject subject = product(&context(), ASPIC_PROGRAM);
  std::vector<std::unique_ptr<Model>> models;
  subject.gpu = [&, right = subject.gpu](const Model& model, const GpuOptions& options) {
    models.push_back(std::make_unique<Model>(model));
    if (options.group_size == 128) models.back()->simulation.gravity.y = -9.80001;
    return right(*models.back(), options);
  };
  EXPECT_EQ(row_of("repeat/group-sizes", subject).verdict, Verdict::failed);
  subject.program = "/nonexistent/aspic";
  EXPECT_EQ(row_of("repeat/driver-threads", subject).verdict, Verdict::failed);
}

}  // namespace
}  // namespace aspic::verify
