// Input that means harm, or comes from a broken disk: the program ends with its exit code and a sentence,
// soon, and nothing of what it was given reaches the terminal as it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

#include "aspic/scene.h"
#include "base/printable.h"
#include "cli/process.h"
#include "io/checkpoint.h"
#include "model/model.h"

namespace aspic {
namespace {

using test::aspic;
using test::json_member;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Words = std::vector<std::string>;

void write_file(const std::string& path, std::string_view content) {
  std::ofstream(path, std::ios::binary) << content;
}

/// Only line feeds and characters that stand for themselves.
void expect_printable(const std::string& text) {
  for (const char c : text)
    EXPECT_TRUE(c == '\n' || (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f)) << text;
  EXPECT_THAT(text, Not(HasSubstr("\xc2\x9b")));
  EXPECT_THAT(text, Not(HasSubstr("\xe2\x80\xae")));
  EXPECT_THAT(text, Not(HasSubstr("\xff")));
}

TEST(Hostile, NumbersBeyondTheirTypeAreRefusedAtOnce) {
  for (const char* number :
       {"9007199254740993", "9223372036854775808", "18446744073709551615", "18446744073709551616",
        "99999999999999999999", "1e3", "0x10", "ten", "-1", " 5", "5 "}) {
    for (const char* option : {"--steps", "--every"}) {
      Words words = {"run", "cube-plane", "--backend", "reference", std::string(option) + "=" + number};
      if (std::string(option) == "--every")
        words.insert(words.end(), {"--series", "/dev/null", "--steps", "0"});
      const auto run = aspic(words);
      EXPECT_EQ(run.exit_code, 2) << option << ' ' << number << ": " << run.err;
      EXPECT_THAT(run.err, HasSubstr(option));
    }
  }
  for (const Words& words : {Words{"run", "cube-plane", "--duration=1e999"},
                             {"run", "cube-plane", "--duration=nan"},
                             {"run", "cube-plane", "--duration=1e308"},
                             {"run", "cube-plane", "--duration=0x"},
                             {"run", "cube-plane", "--fps=1e999"},
                             {"run", "cube-plane", "--speed=-1e999"},
                             {"compare", "cube-plane", "--steps=18446744073709551616"},
                             {"compare", "cube-plane", "--tolerance=1e999"},
                             {"bench", "--size=99999999999"},
                             {"bench", "--size=-5"},
                             {"bench", "--repeats=99999999999999999999"},
                             {"bench", "--seconds=1e300"},
                             {"bench", "--duration=1e300"},
                             {"view", "--size=99999999999x5"}}) {
    const auto run = aspic(words);
    EXPECT_EQ(run.exit_code, 2) << words.back() << ": " << run.err;
  }
  // Leading zeros are no octal number.
  EXPECT_EQ(
      json_member(aspic({"run", "cube-plane", "--backend", "reference", "--steps", "010", "--json"}).out,
                  "steps"),
      "10");
}

TEST(Hostile, DeepNestingIsRefusedWhereItBegins) {
  const test::TemporaryDirectory dir;
  std::string key = "a";
  for (int i = 1; i < 100000; ++i) key += ".a";
  const std::string lists = std::string(100000, '[') + std::string(100000, ']');
  for (const std::string& line :
       {key + " = 1\n", "[" + key + "]\n", "x = { " + key + " = 1 }\n", "x = " + lists + "\n"}) {
    write_file(dir.file("s.toml"), "schema = 1\n# a comment, . . .\n" + line);
    const auto check = aspic({"scene", "check", dir.file("s.toml")});
    EXPECT_EQ(check.exit_code, 3) << check.signal;
    EXPECT_THAT(check.err, HasSubstr("s.toml:3:"));
    EXPECT_THAT(check.err, HasSubstr("more than 32"));
    EXPECT_LT(check.err.size(), 2000u);
  }
  for (const char* option : {"--set", "--view"}) {
    const auto run = aspic(
        {"run", "cube-plane", "--video", dir.file("v.mp4"), option, "x={" + key.substr(0, 100000) + "=1}"});
    EXPECT_EQ(run.exit_code, 3) << run.signal;
    EXPECT_THAT(run.err, HasSubstr("more than 32"));
    EXPECT_LT(run.err.size(), 2000u);
    EXPECT_EQ(aspic({"run", "cube-plane", "--video", dir.file("v.mp4"), option, key.substr(0, 100000) + "=1"})
                  .exit_code,
              3);
  }
}

class HostileCheckpoint : public testing::Test {
 protected:
  /// A true checkpoint of a small cube at step 0, to be spoilt.
  static Checkpoint checkpoint() {
    const auto scene = load_scene("cube-plane", std::vector<std::string>{"cube[0].particles-per-edge=3"});
    const auto model = build_model(scene->model);
    return {"0.2.0", to_toml(*scene), scene->model.simulation.timestep,
            initial_state(*model, Precision::single)};
  }
  test::Finished resume(const Checkpoint& checkpoint) const {
    write_file(dir.file("c"), encode_checkpoint(checkpoint));
    return aspic({"run", "--resume", dir.file("c"), "--steps", "2", "--backend", "reference"});
  }
  static std::string with(std::string text, const std::string& what, const std::string& instead) {
    return text.replace(text.find(what), what.size(), instead);
  }
  const test::TemporaryDirectory dir;
};
using MemoryLimitOnCheckpoint = HostileCheckpoint;

TEST_F(HostileCheckpoint, AsItIsItGoesOn) {
  EXPECT_EQ(resume(checkpoint()).exit_code, 0);
}

TEST_F(MemoryLimitOnCheckpoint, FilesWithoutAnEndAreNotRead) {
  for (const char* path : {"/dev/zero", "/dev/full", "/dev/urandom", "/dev/null", "/proc/self"}) {
    test::ProcessOptions small;
    small.address_space_limit = std::uint64_t{512} << 20;
    const auto run = aspic({"run", "--resume", path}, small);
    EXPECT_EQ(run.exit_code, 6) << path;
    EXPECT_THAT(run.err, HasSubstr(path));
  }
  // Longer than any memory, and no byte of it on the disk.
  write_file(dir.file("sparse"), encode_checkpoint(checkpoint()));
  std::filesystem::resize_file(dir.file("sparse"), std::uint64_t{1} << 42);
  EXPECT_THAT(aspic({"run", "--resume", dir.file("sparse")}).err, HasSubstr("bytes of memory are free"));
}

TEST_F(HostileCheckpoint, TheTimeStepIsTheScenes) {
  for (const double timestep : {std::numeric_limits<double>::quiet_NaN(), 0.0, -1.0, 0.5, 1e300}) {
    Checkpoint spoilt = checkpoint();
    spoilt.timestep = timestep;
    const auto run = resume(spoilt);
    EXPECT_EQ(run.exit_code, 6) << timestep;
    EXPECT_THAT(run.out, IsEmpty());
  }
}

TEST_F(HostileCheckpoint, TheVersionTextIsShortAndPlain) {
  for (const std::string& version :
       {std::string(1 << 20, 'x'), std::string("\x1b[31m0.1"), std::string("0.1\n0.2")}) {
    Checkpoint spoilt = checkpoint();
    spoilt.program_version = version;
    spoilt.scene = "not = a scene";  // the message that would name the version
    const auto run = resume(spoilt);
    EXPECT_EQ(run.exit_code, 6);
    EXPECT_THAT(run.err, HasSubstr("damaged"));
    EXPECT_LT(run.err.size(), 1000u);
  }
}

TEST_F(MemoryLimitOnCheckpoint, ItsSceneIsHeldAgainstItsStateBeforeItIsBuilt) {
  test::ProcessOptions small;
  small.address_space_limit = std::uint64_t{512} << 20;
  Checkpoint spoilt = checkpoint();
  for (const char* edge : {"400", "4"}) {
    spoilt.scene =
        with(checkpoint().scene, "particles-per-edge = 3", std::string("particles-per-edge = ") + edge);
    write_file(dir.file("c"), encode_checkpoint(spoilt));
    const auto run = aspic({"run", "--resume", dir.file("c"), "--steps", "2"}, small);
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_THAT(run.err, testing::AnyOf(HasSubstr("the file was changed"), HasSubstr("available")));
  }
  std::string key = "a";
  for (int i = 1; i < 100000; ++i) key += ".a";
  spoilt.scene = checkpoint().scene + key + " = 1\n";
  EXPECT_EQ(resume(spoilt).exit_code, 3);
}

TEST_F(HostileCheckpoint, StepsBeyondCountingAreRefused) {
  Checkpoint spoilt = checkpoint();
  spoilt.state.step = ~std::uint64_t{0};
  EXPECT_EQ(resume(spoilt).exit_code, 6);
}

// 10⁷ balls need 2.4 GiB: with one GiB to have they are refused before any is made.
TEST(MemoryLimit, ScenesThatNeedMoreMemoryThanThereIsAreRefusedBeforeTheyAreBuilt) {
  const test::TemporaryDirectory dir;
  test::ProcessOptions small;
  small.address_space_limit = std::uint64_t{512} << 20;
  write_file(dir.file("s.toml"), "schema = 1\n[[launcher]]\ncount = 10000000\n");
  const auto balls = aspic({"run", dir.file("s.toml"), "--backend", "reference", "--steps", "0"}, small);
  EXPECT_EQ(balls.exit_code, 3);
  EXPECT_THAT(balls.err,
              HasSubstr("s.toml:3:9: the scene has 0 particles, 0 springs and 10000000 balls: they need"));
}

TEST(Hostile, NothingFromOutsideReachesTheTerminalAsItIs) {
  const test::TemporaryDirectory dir;
  const std::string evil =
      "\x1b[31m\a\xc2\x9b"
      "2J\xe2\x80\xae\xff\x7f\n";
  write_file(dir.file("key.toml"), "schema = 1\n\"k\\u001B[31m\\u202E\\n\" = 1\n[[cube]]\n");
  write_file(dir.file("raw.toml"), "schema = 1\nname = \"" + evil + "\"\n[[cube]]\n");
  write_file(dir.file("comment.toml"),
             "schema = 1 # \xe2\x80\xae\xc2\x9b\nnonsense = 2 # \xe2\x80\xae\xc2\x9b\n[[cube]]\n");
  write_file(dir.file("configuration.txt"), "*" + evil + "Key\n" + evil + "\n*StudentID\n\x1b\xff\n");
  write_file(dir.file("name.toml"), "schema = 1\nname = \"\\u001B[31m\\u009B\\u202E\"\n[[cube]]\n");
  for (const Words& words :
       {Words{"run", evil},
        {"run", "cube-plane", "--" + evil},
        {evil},
        {"run", "cube-plane", "--backend", evil},
        {"run", "cube-plane", "--size", evil},
        {"run", "cube-plane", "--steps", evil},
        {"run", "cube-plane", "--set", evil},
        {"run", "cube-plane", "--set", evil + "=1"},
        {"run", "cube-plane", "--set", "name=" + evil},
        {"run", "cube-plane", "--view", evil + "=1"},
        {"run", "cube-plane", "--resume", evil},
        {"run", "cube-plane", "--steps", "0", "--state", evil + "/s"},
        {"verify", "--only", evil},
        {"scene", "check", dir.file("key.toml")},
        {"scene", "check", dir.file("raw.toml")},
        {"scene", "check", dir.file("comment.toml")},
        {"scene", "check", dir.file("name.toml")},
        {"scene", "show", dir.file("name.toml")},
        {"run", dir.file("name.toml"), "--backend", "reference", "--steps", "0"},
        {"run", dir.file("name.toml"), "--backend", "reference", "--steps", "0", "--json"},
        {"scene", "import", dir.file("configuration.txt")},
        {"scene", "import", dir.file(evil.substr(0, evil.size() - 1))}}) {
    const auto run = aspic(words);
    SCOPED_TRACE(words.front() + " … " + printable_line(words.back()));
    EXPECT_EQ(run.signal, 0);
    expect_printable(run.err);
    expect_printable(run.out);
  }
  test::ProcessOptions environment;
  environment.environment = {{"ASPIC_SHADER_DIR", evil}, {"ASPIC_EGL_DEVICE", evil}};
  expect_printable(aspic({"run", "cube-plane", "--backend", "gpu", "--steps", "0"}, environment).err);
}

TEST(Hostile, WhatIsImportedCanBeLoaded) {
  const test::TemporaryDirectory dir;
  write_file(dir.file("c.txt"),
             "*StudentID\n\xb1\x61\xa5\xcd\x1b \xe2\x80\xae\n*Unk\xff\n\x80\n*DeltaT # \xa4\n0.001\n");
  const auto imported = aspic({"scene", "import", dir.file("c.txt")});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  write_file(dir.file("s.toml"), imported.out);
  const auto check = aspic({"scene", "check", dir.file("s.toml")});
  EXPECT_EQ(check.exit_code, 0) << check.err;
}

TEST(Hostile, MistakesOfASceneAreCountedAfterTheFirstTwenty) {
  const test::TemporaryDirectory dir;
  std::string pinned = "schema = 1\n[[cube]]\nparticles-per-edge = 2\npinned = [99";
  for (int n = 1; n < 30000; ++n) pinned += ",99";
  write_file(dir.file("pinned.toml"), pinned + "]\n");
  std::string keys = "schema = 1\n[[cube]]\nparticles-per-edge = 2\n";
  for (int n = 0; n < 30000; ++n) keys += "k" + std::to_string(n) + " = 1\n";
  write_file(dir.file("keys.toml"), keys);
  for (const char* name : {"pinned.toml", "keys.toml"}) {
    const auto check = aspic({"scene", "check", dir.file(name)});
    EXPECT_EQ(check.exit_code, 3);
    EXPECT_THAT(check.err, testing::EndsWith("\n\nand 29980 more\n"));
    EXPECT_LT(check.err.size(), 10000u);
  }
}

TEST(Hostile, BodiesInOnePlaceAreCheckedInTheMemoryOfAFew) {
  const test::TemporaryDirectory dir;
  std::string scene = "schema = 1\n";
  for (int c = 0; c < 300; ++c) scene += "[[cube]]\nparticles-per-edge = 2\n";
  write_file(dir.file("s.toml"), scene);
  test::ProcessOptions options;
  options.address_space_limit = std::uint64_t{512} << 20;
  const auto check = aspic({"scene", "check", dir.file("s.toml")}, options);
  EXPECT_EQ(check.exit_code, 0) << check.err;
}

// A large lattice takes seconds: they can be broken off.
TEST(Hostile, StableStepsAnswerCtrlC) {
  test::Process check({"scene", "check", "cube-plane", "--set", "cube[0].particles-per-edge=100"});
  while (!check.catches(SIGINT)) std::this_thread::yield();
  check.send(SIGINT);
  const auto finished = check.wait();
  EXPECT_EQ(finished.exit_code, 130) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("interrupted"));
  EXPECT_THAT(finished.out, IsEmpty());
}

// Every cube has a spectrum of its own, none with one ratio of damping to stiffness; all of them once took
// minutes.
TEST(Hostile, StableStepsOfManyBodiesTakeBoundedWork) {
  const test::TemporaryDirectory dir;
  std::string scene = "schema = 1\n";
  for (int c = 0; c < 300; ++c) {
    scene += "[[cube]]\nparticles-per-edge = 5\nposition = [" + std::to_string(10 * c) +
             ", 9, 0]\nshear = { stiffness = " + std::to_string(100 + c) + ", damping = 1 }\n";
  }
  write_file(dir.file("s.toml"), scene);
  const auto check =
      aspic({"scene", "check", dir.file("s.toml")});  // its limit of time is that of all programs here
  EXPECT_EQ(check.exit_code, 0) << check.signal << check.err;
  EXPECT_THAT(check.out, HasSubstr("at least"));
}

}  // namespace
}  // namespace aspic
