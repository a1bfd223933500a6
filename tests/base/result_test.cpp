#include "base/result.h"

#include <gtest/gtest.h>

#include <memory>

namespace aspic {
namespace {

TEST(Result, HoldsValueOrError) {
  const Result<int> seven = 7;
  ASSERT_TRUE(seven.ok());
  EXPECT_EQ(*seven, 7);
  const Result<int> none = Error{ErrorCode::io, "no such file"};
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().code, ErrorCode::io);
  EXPECT_EQ(none.error().message(), "no such file");
}

TEST(Result, MovesItsValueOut) {
  Result<std::unique_ptr<int>> result = std::make_unique<int>(3);
  const std::unique_ptr<int> taken = std::move(result).value();
  EXPECT_EQ(*taken, 3);
}

TEST(Status, IsOkUnlessAnError) {
  EXPECT_TRUE(Status().ok());
  EXPECT_FALSE(Status(Error{ErrorCode::usage, "x"}).ok());
}

// In every build: what is not there is not read.
TEST(ResultDeathTest, ReadingWhatItDoesNotHoldEndsTheProgramWithASentence) {
  const Result<int> none = Error{ErrorCode::io, "no such file"};
  EXPECT_DEATH((void)*none, "no such file");
  EXPECT_DEATH((void)none.value(), "no such file");
  const Result<int> seven = 7;
  EXPECT_DEATH((void)seven.error(), "holds a value");
  EXPECT_DEATH((void)Status().error(), "holds a value");
}

Result<std::unique_ptr<int>> half(int number) {
  if (number % 2 != 0) return Error{ErrorCode::usage, "odd"};
  return std::make_unique<int>(number / 2);
}

Result<int> quarter(int number) {
  ASPIC_TRY(const auto once, half(number));
  int result = 0;
  ASPIC_TRY(const auto twice, half(*once));
  ASPIC_TRY(result, Result<int>(*twice));
  return result;
}

Status check_quarter(int number) {
  ASPIC_CHECK(number > 0 ? Status() : Status(Error{ErrorCode::io, "not above 0"}));
  if (number < 100) ASPIC_CHECK(quarter(number).ok() ? Status() : Status(quarter(number).error()));
  return {};
}

TEST(Try, HandsOnTheValueOrTheError) {
  EXPECT_EQ(*quarter(12), 3);
  EXPECT_EQ(quarter(6).error().message(), "odd");
  EXPECT_TRUE(check_quarter(8).ok());
  EXPECT_TRUE(check_quarter(101).ok());
  EXPECT_EQ(check_quarter(0).error().code, ErrorCode::io);
  EXPECT_EQ(check_quarter(3).error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace aspic
