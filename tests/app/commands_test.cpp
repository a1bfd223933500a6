#include "app/commands.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace aspic::app {
namespace {

TEST(PrintedKey, IsTheLetterThatTheLayoutPrints) {
  EXPECT_EQ(printed_key(GLFW_KEY_Y, "z"), GLFW_KEY_Z);                  // German
  EXPECT_EQ(printed_key(GLFW_KEY_Q, "a"), GLFW_KEY_A);                  // French
  EXPECT_EQ(printed_key(GLFW_KEY_M, ","), GLFW_KEY_COMMA);              // French
  EXPECT_EQ(printed_key(GLFW_KEY_SEMICOLON, "m"), GLFW_KEY_M);          // French
  EXPECT_EQ(printed_key(GLFW_KEY_RIGHT_BRACKET, "+"), GLFW_KEY_EQUAL);  // German
  EXPECT_EQ(printed_key(GLFW_KEY_SLASH, "-"), GLFW_KEY_MINUS);          // German
}

TEST(PrintedKey, IsTheKeyItselfWithoutAsciiOrText) {
  EXPECT_EQ(printed_key(GLFW_KEY_Z, "\u044f"), GLFW_KEY_Z);  // Russian
  EXPECT_EQ(printed_key(GLFW_KEY_Z, nullptr), GLFW_KEY_Z);
  EXPECT_EQ(printed_key(GLFW_KEY_Z, ""), GLFW_KEY_Z);
  EXPECT_EQ(printed_key(GLFW_KEY_KP_ADD, "+"), GLFW_KEY_KP_ADD);
  EXPECT_EQ(printed_key(GLFW_KEY_SPACE, " "), GLFW_KEY_SPACE);
  EXPECT_EQ(printed_key(GLFW_KEY_F5, nullptr), GLFW_KEY_F5);
}

}  // namespace
}  // namespace aspic::app
