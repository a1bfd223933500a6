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
  EXPECT_EQ(none.error().message, "no such file");
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

}  // namespace
}  // namespace aspic
