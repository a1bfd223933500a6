#include "support/value_of.h"

#include <gmock/gmock.h>

namespace aspic::test {
namespace {

// GoogleTest makes a failure of the test of it, and runs the next one.
TEST(ValueOf, ThrowsTheMessageOfAnError) {
  EXPECT_EQ(value_of(Result<int>(7)), 7);
  const Result<int> none = Error{ErrorCode::no_device, "The shader does not compile."};
  EXPECT_THAT([&] { (void)value_of(none); },
              ::testing::ThrowsMessage<std::runtime_error>(none.error().message()));
}

}  // namespace
}  // namespace aspic::test
