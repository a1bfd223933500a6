#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/process.h"

namespace aspic {
namespace {

using test::aspic;
using test::json_member;
using testing::HasSubstr;

TEST(Compare, ABackendEqualsItself) {
  const auto same =
      aspic({"compare", "cube-plane", "--backends", "reference,reference", "--steps", "50", "--json"});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  ASSERT_TRUE(test::is_json(same.out)) << same.out;
  EXPECT_EQ(json_member(same.out, "identical"), "true");
  EXPECT_EQ(json_member(same.out, "first_differing_step"), "null");
  EXPECT_EQ(json_member(same.out, "steps"), "50");
}

TEST(Compare, DifferenceIsMeasuredAndJudgedByTheTolerance) {
  const std::vector<std::string> words = {"compare", "cube-plane", "--backends", "reference,reference:double",
                                          "--steps", "100"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    return aspic(more);
  };
  const auto exact = with({"--json"});
  EXPECT_EQ(exact.exit_code, 1);
  ASSERT_TRUE(test::is_json(exact.out)) << exact.out;
  EXPECT_EQ(json_member(exact.out, "within_tolerance"), "false");
  const double largest = std::stod(json_member(exact.out, "largest_absolute"));
  EXPECT_GT(largest, 0.0);
  EXPECT_LT(largest, 1e-3);
  // The start is rounded already: lattice spacings of 4/9 m are not single-precision numbers.
  EXPECT_EQ(json_member(exact.out, "first_differing_step"), "0");
  EXPECT_EQ(with({"--tolerance", "0.01"}).exit_code, 0);
  const auto tight = with({"--tolerance", "1e-12"});
  EXPECT_EQ(tight.exit_code, 1);
  EXPECT_THAT(tight.out, HasSubstr("EXCEEDED"));
  EXPECT_THAT(tight.out, HasSubstr("ULP"));
  EXPECT_THAT(tight.err, HasSubstr("more than the tolerance"));
}

TEST(Compare, DivergenceOfBothIsReported) {
  const auto run = aspic({"compare", "cube-plane", "--backends", "reference,reference", "--steps", "100000",
                          "--set", "simulation.timestep=0.01"});
  EXPECT_EQ(run.exit_code, 5) << run.err;
  EXPECT_THAT(run.err, HasSubstr("both diverged in step"));
}

}  // namespace
}  // namespace aspic
