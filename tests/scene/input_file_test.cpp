#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "aspic/scene.h"
#include "support/model_building.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using ::testing::HasSubstr;

/// A cube of 27 particles with its top pinned, a cloth of 4 × 3, and a ball.
class InputFile : public ::testing::Test {
 protected:
  InputFile() {
    settings_ = test::cube_on_plane(3);
    settings_.cubes[0].pinned.names = {"top"};
    settings_.cloths.resize(1);
    settings_.cloths[0].particles = {4, 3};
    settings_.balls.resize(1);
    model_ = test::build(settings_);
  }
  Result<InputLog> parse(std::string_view text) const {
    return parse_inputs(text, "hands.toml", {settings_, model_});
  }
  InputLog accepted(std::string_view text) const {
    const auto log = parse(text);
    EXPECT_TRUE(log.ok()) << log.error().message();
    return log.ok() ? *log : InputLog();
  }
  std::string refusal(std::string_view text) const {
    const auto log = parse(text);
    EXPECT_FALSE(log.ok()) << text;
    if (log.ok()) return "";
    EXPECT_EQ(log.error().code, ErrorCode::scene_rejected);
    return log.error().message();
  }

  ModelSettings settings_;
  Model model_;
};

TEST_F(InputFile, IsReadAsWritten) {
  InputLog log;
  Inputs inputs;
  inputs.pulls = {{3, {0.1, -1e-300, 1.0 / 3.0}, 5e-324, 1.7976931348623157e308},
                  {0, {1, 2, 3}, 4.0, 0.0, true}};
  inputs.pinned = {0, 30};
  inputs.channels = {0.1, -2.0, 1e22};
  log.set(0, inputs);
  log.set(17, {.pulls = {{38, {}, 1.0, 0.0}}});
  log.set(9007199254740992u, {});
  const std::string text = to_toml(log, settings_.simulation.timestep);
  EXPECT_EQ(accepted(text), log) << text;
  EXPECT_EQ(accepted(text).hash(), log.hash());
  EXPECT_TRUE(accepted(to_toml({}, 0.001)).empty());
}

TEST_F(InputFile, NamesPartsOfBodiesAsScenesDo) {
  const InputLog log = accepted(
      "[[inputs]]\nstep = 4\npinned = [\"cloth[0].left\", 5, \"cloth[0].left-top\", \"cloth[0].left\"]\n"
      "released = [\"cube[0].top\"]\n");
  EXPECT_EQ(log.at(4).pinned, (std::vector<std::uint32_t>{5, 27, 28, 29}));
  ASSERT_EQ(log.at(4).released.size(), 9u);
  for (const std::uint32_t particle : log.at(4).released) EXPECT_EQ(model_.inverse_mass[particle], 0.0);
}

TEST_F(InputFile, KeepsTimesInARunWithAnotherTimeStep) {
  const std::string text = "timestep = 0.002\n[[inputs]]\nstep = 10\nchannels = [1]\n";
  ASSERT_EQ(settings_.simulation.timestep, 0.001);
  EXPECT_EQ(accepted(text).next_change(0), 20u);
  EXPECT_EQ(accepted(text.substr(text.find('\n') + 1)).next_change(0), 10u);
}

TEST_F(InputFile, SaysWhereAndHowToMendIt) {
  const std::string message =
      refusal("[[inputs]]\nstep = 3\npulls = [{ particle = 3, anchor = [0, 1, 0], stifness = 9 }]\n");
  EXPECT_THAT(message, HasSubstr("hands.toml:3:"));
  EXPECT_THAT(message, HasSubstr("unknown key 'stifness' in a pull; did you mean 'stiffness'?"));
  EXPECT_THAT(message, HasSubstr("a pull needs 'stiffness'"));
  EXPECT_THAT(message, HasSubstr("^"));
  EXPECT_THAT(refusal("[[input]]\nstep = 3\n"), HasSubstr("did you mean 'inputs'?"));
  EXPECT_THAT(refusal("[[inputs]]\n"), HasSubstr("needs 'step'"));
  EXPECT_THAT(refusal("[[inputs]]\nstep = 5\n[[inputs]]\nstep = 5\n"),
              HasSubstr("must exceed that before, 5"));
  EXPECT_THAT(refusal("[[inputs]]\nstep = -1\n"), HasSubstr("0 or more"));
  EXPECT_THAT(refusal("[[inputs]]\nstep = 0.5\n"), HasSubstr("'step' must be an integer, not a number with"));
  EXPECT_THAT(refusal("inputs = 3\n"), HasSubstr("must be a list of tables"));
  EXPECT_THAT(refusal("timestep = 0\n"), HasSubstr("above 0"));
  const auto with = [](const std::string& line) { return "[[inputs]]\nstep = 1\n" + line + "\n"; };
  EXPECT_THAT(refusal(with("pulls = [{ anchor = [0, 1, 0], stiffness = 1 }]")),
              HasSubstr("'particle' or 'ball'"));
  EXPECT_THAT(refusal(with("pulls = [{ particle = 1, ball = 0, anchor = [0, 1, 0], stiffness = 1 }]")),
              HasSubstr("not both"));
  EXPECT_THAT(refusal(with("pulls = [{ particle = 1, anchor = [0, 1], stiffness = 1 }]")),
              HasSubstr("three numbers"));
  EXPECT_THAT(refusal(with("pulls = [{ particle = 39, anchor = [0, 1, 0], stiffness = 1 }]")),
              HasSubstr("pulls[0]: particle 39 cannot be pulled: the scene has 39"));
  EXPECT_THAT(refusal(with("pulls = [{ ball = 4294967296, anchor = [0, 1, 0], stiffness = 1 }]")),
              HasSubstr("cannot be pulled"));
  EXPECT_THAT(refusal(with("pulls = [{ particle = 1, anchor = [0, 1, 0], stiffness = -1 }]")),
              HasSubstr("neither may be negative"));
  EXPECT_THAT(refusal(with("pulls = [{ particle = 1, anchor = [0, inf, 0], stiffness = 1 }]")),
              HasSubstr("numbers"));
  EXPECT_THAT(refusal(with("pinned = [39]")), HasSubstr("no particle 39; the scene has 39"));
  EXPECT_THAT(refusal(with("pinned = [\"cube[0].up\"]")), HasSubstr("neither a face"));
  EXPECT_THAT(refusal(with("pinned = [\"top\"]")), HasSubstr("write cube[0] or cloth[0], a dot"));
  EXPECT_THAT(refusal(with("pinned = [true]")),
              HasSubstr("a list of indices and names, not of true or false"));
  EXPECT_THAT(refusal(with("released = [0]")), HasSubstr("particle 0 is already free"));
  EXPECT_THAT(refusal(with("channels = [nan]")), HasSubstr("finite numbers"));
  EXPECT_THAT(refusal("[[inputs]\n"), HasSubstr("not valid TOML"));
}

TEST_F(InputFile, AFileThatIsNoneAtAllHasAShortMessage) {
  std::string text;
  for (int n = 0; n < 10000; ++n) text += "key" + std::to_string(n) + " = 1\n";
  EXPECT_LT(refusal(text).size(), 10000u);
}

TEST_F(InputFile, IsReadFromDisk) {
  const test::TemporaryDirectory dir;
  std::ofstream(dir.file("hands.toml")) << "[[inputs]]\nstep = 2\nchannels = [1]\n";
  EXPECT_EQ(read_inputs(dir.file("hands.toml"), {settings_, model_})->next_change(0), 2u);
  EXPECT_EQ(read_inputs(dir.file("none.toml"), {settings_, model_}).error().code, ErrorCode::io);
}

}  // namespace
}  // namespace aspic
