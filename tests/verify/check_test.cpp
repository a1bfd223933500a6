#include "verify/check.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <set>

namespace aspic::verify {
namespace {

using testing::HasSubstr;

Check check_that(std::string name, bool passes, bool needs_gpu = false) {
  return {std::move(name), "a claim",
          "a bound",       false,
          needs_gpu,       [=](const Subject&) -> Result<Finding> { return Finding{passes, "a figure"}; }};
}

TEST(Battery, NamesAreUniqueAndEveryRowIsComplete) {
  std::set<std::string> names;
  for (const Check& check : battery()) {
    EXPECT_TRUE(names.insert(check.name).second) << check.name;
    EXPECT_FALSE(check.claim.empty() || check.bound.empty() || !check.run) << check.name;
  }
}

TEST(Battery, CoversEveryIntegrator) {
  const auto checks = battery();
  for (const char* group :
       {"order", "closed-form/damped", "closed-form/undamped", "conservation/double", "conservation/single",
        "contact/stick", "contact/slide", "contact/restitution", "contact/cone", "rest", "rest/turned",
        "rest/groove", "rest/corner", "energy", "equality"}) {
    for (const IntegratorRow& row : integrator_table) {
      const std::vector<std::string> name = {fmt::format("{}/{}", group, row.name)};
      EXPECT_TRUE(select(checks, name, false).ok()) << name[0];
    }
  }
}

// Rows that are core tests as well: contact of a particle and a cube with terrain, under every method.
TEST(Battery, ContactWithTerrainHoldsOnTheReference) {
  const std::vector<std::string> names = {"contact/bounce",
                                          "contact/resist",
                                          "contact/order",
                                          "contact/projection",
                                          "contact/stick",
                                          "contact/slide",
                                          "contact/pull",
                                          "contact/restitution",
                                          "rest/bottom",
                                          "contact/cone/midpoint",
                                          "contact/cone/implicit-euler"};
  const auto checks = select(battery(), names, false);
  ASSERT_TRUE(checks.ok());
  for (const Check& check : *checks) {
    const Row row = evaluate(check, product(nullptr, ""));
    EXPECT_EQ(row.verdict, Verdict::passed) << row.name << ": " << row.measured << ", bound " << row.bound;
  }
}

TEST(Select, TakesNamesAndGroupsButNoHalfWords) {
  const std::vector<Check> checks = {check_that("rest/a", true), check_that("rest/b", true),
                                     check_that("restless", true)};
  const auto names = [&](std::vector<std::string> only) {
    std::vector<std::string> result;
    const auto selected = select(checks, only, false);
    for (const Check& check : *selected) result.push_back(check.name);
    return result;
  };
  EXPECT_EQ(names({}).size(), 3u);
  EXPECT_THAT(names({"rest"}), testing::ElementsAre("rest/a", "rest/b"));
  EXPECT_THAT(names({"rest/b", "restless"}), testing::ElementsAre("rest/b", "restless"));
  const std::vector<std::string> unknown = {"res"};
  const auto refused = select(checks, unknown, false);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::usage);
  EXPECT_THAT(refused.error().message(), HasSubstr("did you mean 'rest'"));
}

TEST(Select, NothingQuickAmongTheNamedIsSaid) {
  const std::vector<std::string> only = {"slow"};
  const auto refused = select({check_that("slow", true)}, only, true);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::usage);
}

TEST(Evaluate, PassFailErrorAndNoDevice) {
  const Subject no_device = product(nullptr, "");
  EXPECT_EQ(evaluate(check_that("a", true), no_device).verdict, Verdict::passed);
  EXPECT_EQ(evaluate(check_that("a", false), no_device).verdict, Verdict::failed);
  EXPECT_EQ(evaluate(check_that("a", true, true), no_device).verdict, Verdict::not_run);
  Check broken = check_that("a", true);
  broken.run = [](const Subject&) -> Result<Finding> { return Error{ErrorCode::check_failed, "it broke."}; };
  const Row row = evaluate(broken, no_device);
  EXPECT_EQ(row.verdict, Verdict::failed);
  EXPECT_EQ(row.measured, "it broke.");
}

TEST(Evaluate, AllRowsComeInOrderAndAreCounted) {
  Subject subject = product(nullptr, "");
  std::vector<std::size_t> counted;
  const auto rows = evaluate_all({check_that("a", true), check_that("b", true, true), check_that("c", false)},
                                 subject, [&](std::size_t done) { counted.push_back(done); });
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].name, "a");
  EXPECT_EQ(rows[1].verdict, Verdict::not_run);
  EXPECT_EQ(rows[2].verdict, Verdict::failed);
  EXPECT_THAT(counted, testing::ElementsAre(1, 2, 3));
}

TEST(Evaluate, WhatHadNotEndedWhenAllWasStoppedHasNoRow) {
  std::atomic<bool> stopped = false;
  Check last = check_that("b", true);
  last.run = [&](const Subject&) -> Result<Finding> {
    stopped = true;
    return Finding{false, "it lost its processes"};
  };
  const auto rows = evaluate_all(
      {check_that("a", true), last, check_that("c", true)}, product(nullptr, ""), [](std::size_t) {},
      [&] { return stopped.load(); });
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].name, "a");
}

TEST(AtMost, NotANumberFails) {
  EXPECT_TRUE(at_most(1.0, 1.0).passed);
  EXPECT_FALSE(at_most(1.0000001, 1.0).passed);
  EXPECT_FALSE(at_most(std::nan(""), 1.0).passed);
}

}  // namespace
}  // namespace aspic::verify
