// The example program against the command.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "aspic/aspic.h"
#include "io/child_process.h"

namespace aspic {
namespace {

/// The word behind `label` in a text.
std::string word_after(const std::string& text, const std::string& label) {
  const std::size_t at = text.find(label);
  if (at == std::string::npos) return "";
  const std::size_t start = text.find_first_not_of(' ', at + label.size());
  return text.substr(start, text.find_first_of(" \n", start) - start);
}

TEST(Minimal, EndsWithTheStateOfTheCommand) {
  const auto example = output_of(ASPIC_MINIMAL, {"cube-bowl", "300"}, {});
  ASSERT_TRUE(example.ok()) << example.error().message();
  const auto command = output_of(ASPIC_PROGRAM, {"run", "cube-bowl", "--steps", "300"}, {});
  ASSERT_TRUE(command.ok()) << command.error().message();
  EXPECT_THAT(*example, testing::StartsWith("step 300 on "));
  EXPECT_EQ(word_after(*example, "state hash").size(), 16u);
  EXPECT_EQ(word_after(*example, "state hash"), word_after(*command, "state hash"));
  EXPECT_EQ(word_after(*example, "total energy"), word_after(*command, ", total"));
}

TEST(Minimal, SaysWhatIsWrong) {
  const auto example = output_of(ASPIC_MINIMAL, {"no-such-scene"}, {});
  ASSERT_FALSE(example.ok());
  EXPECT_EQ(example.error().message(), "the child process ended with exit code 3");
}

}  // namespace
}  // namespace aspic
