// Numbers as one writes them down.
#include "app/arithmetic.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>

namespace aspic::app {
namespace {

using testing::HasSubstr;

TEST(Arithmetic, NumbersAndTheirCombinations) {
  const auto value = [](const char* text) {
    const auto result = evaluate(text);
    EXPECT_TRUE(result.ok()) << text << ": " << (result.ok() ? "" : result.error().message());
    return result.ok() ? *result : -12345.0;
  };
  EXPECT_EQ(value("9.8"), 9.8);
  EXPECT_EQ(value(" -0.5 "), -0.5);
  EXPECT_EQ(value("1e-3"), 1e-3);
  EXPECT_EQ(value("1E3"), 1000.0);
  EXPECT_EQ(value(".25"), 0.25);
  EXPECT_EQ(value("+4"), 4.0);
  EXPECT_EQ(value("2*9.8"), 2 * 9.8);
  EXPECT_EQ(value("1/60"), 1.0 / 60.0);
  EXPECT_EQ(value("1e-3*4"), 1e-3 * 4);
  EXPECT_EQ(value("1+2*3-4/2"), 5.0);
  EXPECT_EQ(value("10-4-3"), 3.0) << "from left to right";
  EXPECT_EQ(value("16/4/2"), 2.0) << "from left to right";
  EXPECT_EQ(value("2*-3"), -6.0);
  EXPECT_EQ(value("--3"), 3.0);
  EXPECT_EQ(value("(1 + 2) * (3 - 4)"), -3.0);
  EXPECT_EQ(value("-(2)"), -2.0);
  EXPECT_EQ(value("((7))"), 7.0);
}

TEST(Arithmetic, ErrorsSayWhatAndWhere) {
  const auto wrong = [](const char* text, const char* what, std::size_t column) {
    const auto result = evaluate(text);
    ASSERT_FALSE(result.ok()) << text;
    EXPECT_EQ(result.error().code, ErrorCode::usage);
    EXPECT_THAT(result.error().message(), HasSubstr(what)) << text;
    EXPECT_TRUE(result.error().message().ends_with(fmt::format("\n{}\n{:>{}}", text, "^", column + 1)))
        << result.error().message();
  };
  wrong("", "number is missing", 0);
  wrong("2*", "number is missing", 2);
  wrong("2*(3+1", "closing parenthesis", 6);
  wrong("2)", "no opening one", 1);
  wrong("2 3", "between two numbers", 2);
  wrong("2*k", "expected a number", 2);
  wrong("nan", "expected a number", 0);
  wrong("inf", "expected a number", 0);
  wrong("1,5", "point", 1);
  wrong("1/ 0", "division by 0", 3);
  wrong("1e999", "out of range", 0);
  wrong("1e300*1e300", "finite", 0);
  EXPECT_THAT(evaluate(std::string(200, '(')).error().message(), HasSubstr("nested too deeply"));
  EXPECT_THAT(evaluate(std::string(200, '-') + "1").error().message(), HasSubstr("nested too deeply"));
  EXPECT_TRUE(evaluate(std::string(90, '(') + "1" + std::string(90, ')')).ok());
}

}  // namespace
}  // namespace aspic::app
