// aspic run --replay: a log of inputs repeats a run to the bit, on every backend and over a resume.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "cli/process.h"

namespace aspic {
namespace {

using test::aspic;
using test::json_member;
using testing::HasSubstr;
using Words = std::vector<std::string>;

/// Two pulls on one particle and one elsewhere, pins in mid-air, and nothing from step 400 on.
constexpr const char* log_text = R"(timestep = 0.001
[[inputs]]
step = 50
pulls = [{ particle = 0, anchor = [3.0, 12.0, 1.0], stiffness = 900.0, damping = 20.0 },
         { particle = 999, anchor = [-3.0, 12.0, 1.0], stiffness = 700.0, damping = 20.0 },
         { particle = 0, anchor = [0.0, 14.0, 0.1], stiffness = 500.0 }]
channels = [0.25]
[[inputs]]
step = 300
pinned = ["cube[0].left"]
[[inputs]]
step = 400
)";

class Replay : public ::testing::Test {
 protected:
  Replay() { std::ofstream(log()) << log_text; }
  std::string log() const { return dir_.file("hands.toml"); }
  std::string hash_of(const Words& more) const {
    Words words = {"run", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = aspic(words);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.exit_code == 0 ? json_member(run.out, "state_hash") : "";
  }
  test::TemporaryDirectory dir_;
};

TEST_F(Replay, HasTheSameBitsOnEveryBackend) {
  const std::string expected =
      hash_of({"cube-plane", "--backend", "reference", "--steps", "600", "--replay", log()});
  EXPECT_EQ(hash_of({"cube-plane", "--backend", "cpu", "--steps", "600", "--replay", log()}), expected);
  EXPECT_NE(hash_of({"cube-plane", "--backend", "cpu", "--steps", "600"}), expected);
}

TEST_F(Replay, ResumesInTheMiddleOfAPull) {
  const std::string whole = hash_of({"cube-plane", "--backend", "cpu", "--steps", "600", "--replay", log()});
  for (const char* const at : {"120", "300", "400"}) {
    SCOPED_TRACE(at);
    (void)hash_of({"cube-plane", "--backend", "cpu", "--steps", at, "--replay", log(), "--checkpoint",
                   dir_.file("half.aspic"), "--force"});
    EXPECT_EQ(hash_of({"--resume", dir_.file("half.aspic"), "--backend", "reference", "--steps", "600"}),
              whole);
    EXPECT_EQ(hash_of({"--resume", dir_.file("half.aspic"), "--backend", "cpu", "--steps", "600", "--replay",
                       log()}),
              whole);
  }
}

TEST_F(Replay, ACheckpointTakesNoOtherPast) {
  (void)hash_of({"cube-plane", "--backend", "cpu", "--steps", "120", "--replay", log(), "--checkpoint",
                 dir_.file("half.aspic")});
  std::ofstream(dir_.file("other.toml")) << "[[inputs]]\nstep = 60\nchannels = [1]\n";
  const auto run = aspic({"run", "--resume", dir_.file("half.aspic"), "--replay", dir_.file("other.toml")});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("has other inputs before step 120"));
  // Another future is its right.
  std::ofstream(dir_.file("future.toml"))
      << std::string(log_text).substr(0, std::string(log_text).find("step = 300")) << "step = 200\n";
  EXPECT_NE(hash_of({"--resume", dir_.file("half.aspic"), "--backend", "cpu", "--steps", "600", "--replay",
                     dir_.file("future.toml")}),
            "");
}

TEST_F(Replay, IsToldInTheSummary) {
  const auto text = aspic({"run", "cube-plane", "--backend", "cpu", "--steps", "60", "--replay", log()});
  EXPECT_THAT(text.out, HasSubstr("inputs       3 entries, hash "));
  const auto json =
      aspic({"run", "cube-plane", "--backend", "cpu", "--steps", "60", "--replay", log(), "--json"});
  EXPECT_EQ(json_member(json.out, "entries"), "3");
  EXPECT_THAT(aspic({"run", "cube-plane", "--backend", "cpu", "--steps", "60"}).out,
              Not(HasSubstr("inputs")));
}

TEST_F(Replay, KeepsItsTimesWithAnotherTimeStep) {
  const auto finer = [&](const std::string& file) {
    return hash_of({"cube-plane", "--backend", "cpu", "--steps", "200", "--set", "simulation.timestep=0.0005",
                    "--replay", file});
  };
  std::ofstream(dir_.file("first.toml")) << "timestep = 0.001\n[[inputs]]\nstep = 50\npinned = [0]\n";
  std::ofstream(dir_.file("second.toml")) << "timestep = 0.0005\n[[inputs]]\nstep = 100\npinned = [0]\n";
  std::ofstream(dir_.file("third.toml")) << "[[inputs]]\nstep = 50\npinned = [0]\n";
  EXPECT_EQ(finer(dir_.file("first.toml")), finer(dir_.file("second.toml")));
  EXPECT_NE(finer(dir_.file("first.toml")), finer(dir_.file("third.toml")));
}

TEST_F(Replay, RunsSideBySideHaveItAtTheSameTime) {
  const auto beside = aspic({"run", "cube-plane", "--backend", "cpu", "--steps", "200", "--replay", log(),
                             "--variant", "simulation.timestep=0.0005", "--state", dir_.file("s.csv")});
  ASSERT_EQ(beside.exit_code, 0) << beside.err;
  const auto state = [&](const std::string& steps, const std::string& timestep) {
    (void)hash_of({"cube-plane", "--backend", "cpu", "--steps", steps, "--set",
                   "simulation.timestep=" + timestep, "--replay", log(), "--state", dir_.file("alone.csv"),
                   "--force"});
    return dir_.read("alone.csv");
  };
  EXPECT_EQ(dir_.read("s-1.csv"), state("200", "0.001"));
  EXPECT_EQ(dir_.read("s-2.csv"), state("400", "0.0005"));
}

TEST_F(Replay, ComparesBackends) {
  const auto compared =
      aspic({"compare", "cube-plane", "--backends", "reference,cpu", "--steps", "320", "--replay", log()});
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_THAT(compared.out, HasSubstr("no step differs"));
  const auto pulled = aspic(
      {"compare", "cube-plane", "--backends", "reference,cpu", "--steps", "60", "--json", "--replay", log()});
  const auto free =
      aspic({"compare", "cube-plane", "--backends", "reference,cpu", "--steps", "60", "--json"});
  EXPECT_NE(json_member(pulled.out, "state_hash"), json_member(free.out, "state_hash"));
}

TEST_F(Replay, WrongLogsAreRefused) {
  std::ofstream(dir_.file("wrong.toml")) << "[[inputs]]\nstep = 60\npinned = [1000]\n";
  const auto wrong = aspic({"run", "cube-plane", "--replay", dir_.file("wrong.toml")});
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("wrong.toml:3:"));
  EXPECT_EQ(aspic({"run", "cube-plane", "--replay", dir_.file("none.toml")}).exit_code, 6);
  std::ofstream(dir_.file("large.toml"))
      << "[[inputs]]\nstep = 60\npulls = [{ particle = 0, anchor = [0, 1, 0], stiffness = 1e39 }]\n";
  const auto large = aspic({"run", "cube-plane", "--backend", "cpu", "--replay", dir_.file("large.toml")});
  EXPECT_EQ(large.exit_code, 2);
  EXPECT_THAT(large.err, HasSubstr("inputs from step 60 on: pulls[0]"));
}

// The log that docs/files.md shows names bodies of several kinds.
TEST_F(Replay, ReadsTheLogOfItsPage) {
  std::ifstream file(ASPIC_SOURCE_DIR "/docs/files.md");
  const std::string page{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::string opening = "```toml\n";
  const std::size_t from = page.find(opening) + opening.size();
  ASSERT_NE(page.find(opening), std::string::npos);
  dir_.write("page.toml", page.substr(from, page.find("```", from) - from));
  const auto scene = aspic({"scene", "show", "cube-and-balls"});
  dir_.write("scene.toml", scene.out + R"(
[[cloth]]
particles = [4, 4]
size = [1.0, 1.0]
position = [0.0, 9.0, 6.0]
particle-mass = 0.01
structural = { stiffness = 100.0, damping = 0.1 }
pinned = ["top"]
)");
  const auto hash = [&](const char* backend) {
    return hash_of({dir_.file("scene.toml"), "--backend", backend, "--steps", "210", "--replay",
                    dir_.file("page.toml")});
  };
  EXPECT_EQ(hash("cpu"), hash("reference"));
  EXPECT_NE(hash("cpu"), hash_of({dir_.file("scene.toml"), "--backend", "cpu", "--steps", "210"}));
}

}  // namespace
}  // namespace aspic
