// Other programs with the same lattice. Only the textbook's loop needs nothing that would have to be
// installed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/process.h"

namespace aspic {
namespace {

using nlohmann::json;
using test::aspic;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// A copy of the program with a table of peers of its own.
class Peers : public testing::Test {
 protected:
  test::Finished run(const std::string& table, std::vector<std::string> words) {
    fs::create_directories(directory_.path() / "bench/peers");
    directory_.write("bench/peers/peers.txt", table);
    fs::copy_file(ASPIC_PEERS, directory_.file("aspic-peers"), fs::copy_options::overwrite_existing);
    words.insert(words.begin(), {"--backend", "reference", "--duration", "0.02", "--repeats", "2"});
    return copied(words);
  }

  test::Finished copied(const std::vector<std::string>& words) {
    test::ProcessOptions options;
    options.program = directory_.file("aspic-peers");
    return aspic(words, options);
  }

  test::TemporaryDirectory directory_;
};

TEST_F(Peers, TheTextbookMovesAsTheReferenceDoes) {
  test::ProcessOptions options;
  options.program = ASPIC_PEERS;
  const auto ran = aspic({"--backend", "reference", "--size", "4,6", "--duration", "0.3", "--repeats", "2",
                          "--peer", "textbook", "--json"},
                         options);
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json rows = json::parse(ran.out)["measurements"];
  ASSERT_EQ(rows.size(), 4u);
  for (const json& row : {rows[1], rows[3]}) {
    EXPECT_EQ(row["name"], "textbook");
    EXPECT_EQ(row["check"]["passed"], true) << row;
    // Single precision's own differences, which the bound is far above.
    EXPECT_GT(row["check"]["deviation"], 0.0);
    EXPECT_LT(row["check"]["deviation"], 1e-5);
    EXPECT_LT(row["check"]["bound"], 1e-3);
    EXPECT_GT(row["ratio"], 0.0);
    EXPECT_TRUE(row["bytes"].is_null());
  }
  EXPECT_EQ(rows[1]["springs"], rows[0]["springs"]);
}

TEST_F(Peers, APeerThatMovesOtherwiseIsNotCounted) {
  // What aspic says later is not heard. Dampers are what a peer says they are.
  for (const char* const wrong : {"--stiffness 2040", "--gravity 10", "--timestep 0.00102"}) {
    const auto ran = run(std::string("wrong 10 " ASPIC_TEXTBOOK " ") + wrong + "\n", {"--size", "4"});
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_THAT(ran.out, HasSubstr("not counted: after 50 steps")) << wrong;
  }
  const auto ran = run("wrong 10 " ASPIC_TEXTBOOK " --stiffness 2040\n", {"--size", "4", "--json"});
  const json row = json::parse(ran.out)["measurements"][1];
  EXPECT_EQ(row["check"]["passed"], false);
  EXPECT_FALSE(row.contains("spring_evaluations_per_second"));
}

TEST_F(Peers, OneThatCannotRunLeavesTheOthersTheirRows) {
  const auto ran =
      run("absent 10 {source}/no-such-program\n"
          "silent 10 true\n"
          "babbler 10 echo hello\n"
          "other 10 " ASPIC_TEXTBOOK
          " --size 5\n"
          "small 3 " ASPIC_TEXTBOOK
          "\n"
          "good 10 " ASPIC_TEXTBOOK "\n",
          {"--size", "4"});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("skipped absent: "));
  EXPECT_THAT(ran.err, HasSubstr("scripts/peers.sh"));
  EXPECT_THAT(ran.err, HasSubstr("skipped silent: it ended instead of answering"));
  EXPECT_THAT(ran.err, HasSubstr("skipped babbler: it answered what is no JSON object: hello"));
  EXPECT_THAT(ran.err, HasSubstr("skipped other: it answered 375 coordinates for 216 particles"));
  EXPECT_THAT(ran.err, HasSubstr("skipped small at 4 particles per edge"));
  EXPECT_THAT(ran.out, HasSubstr("good: textbook Eigen"));
}

TEST_F(Peers, CtrlCLeavesWhatWasMeasured) {
  // The second size's peer interrupts the program that started it.
  directory_.write("stop.sh", "kill -INT $PPID\n");
  const auto ran = run("stop 4 sh {source}/stop.sh\n", {"--size", "6,4", "--json"});
  EXPECT_EQ(ran.exit_code, 130);
  EXPECT_THAT(ran.err, HasSubstr("interrupted; the rows have the measurements made before"));
  const json report = json::parse(ran.out);
  EXPECT_EQ(report["interrupted"], true);
  ASSERT_EQ(report["measurements"].size(), 1u);
  EXPECT_EQ(report["measurements"][0]["size"], 6);
}

TEST_F(Peers, AreRefusedWhereTheyCannotBeCompared) {
  const auto refused = [&](std::vector<std::string> words, const char* why) {
    words.insert(words.end(), {"--size", "4"});
    const auto ran = run("good 10 " ASPIC_TEXTBOOK "\n", words);
    EXPECT_EQ(ran.exit_code, 2) << why;
    EXPECT_THAT(ran.err, HasSubstr(why));
  };
  refused({"--integrator", "midpoint"}, "--integrator explicit-euler");
  refused({"cube-and-balls"}, "other bodies");
  refused({"--set", "cube[0].shear.stiffness=10"}, "its springs differ");
  refused({"--set", "cube[0].velocity=[0,1,0]"}, "start at rest");
  refused({"--set", "simulation.gravity=[1,0,0]"}, "gravity");
  refused({"--set", "cube[0].position=[0,1,0]"}, "touch the ground");
  refused({"--peer", "tortoise"}, "--peer does not know \"tortoise\"; allowed: good.");
  fs::remove_all(directory_.path() / "bench");
  const auto elsewhere = copied({});
  EXPECT_EQ(elsewhere.exit_code, 2);
  EXPECT_THAT(elsewhere.err, HasSubstr("checkout"));
}

}  // namespace
}  // namespace aspic
