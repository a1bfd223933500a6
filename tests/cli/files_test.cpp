#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <thread>

#include "cli/process.h"
#include "io/checkpoint.h"
#include "io/series_csv.h"
#include "support/state_csv_reader.h"

namespace aspic {
namespace {

using test::aspic;
using test::json_member;
using testing::HasSubstr;
using Words = std::vector<std::string>;

/// "run cube-plane" on the reference with further words.
Words run_words(const Words& more) {
  Words words = {"run", "cube-plane", "--backend", "reference", "--json"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(Files, StateReadsBackToTheHashOfTheSummary) {
  for (const Precision precision : {Precision::single, Precision::double_}) {
    const test::TemporaryDirectory dir;
    const auto run = aspic(run_words(
        {"--steps", "1500", "--precision", std::string(name_of(precision)), "--state", dir.file("s.csv")}));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto state = test::read_state_csv(dir.file("s.csv"), precision);
    ASSERT_TRUE(state.ok()) << state.error().message();
    EXPECT_EQ(state_hash_text(*state), json_member(run.out, "state_hash"));
    EXPECT_EQ(dir.entries(), 1u);
  }
}

TEST(Files, StatesTakeTheFormatOfTheirEnding) {
  const test::TemporaryDirectory dir;
  const auto run = aspic({"run", "flag", "--backend", "reference", "--steps", "25", "--state",
                          dir.file("out.vtp"), "--state-every", "10"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* name : {"out-00000000.vtp", "out-00000010.vtp", "out-00000020.vtp", "out-00000025.vtp"})
    EXPECT_THAT(dir.read(name), testing::HasSubstr("<VTKFile type=\"PolyData\"")) << name;
  EXPECT_EQ(dir.entries(), 4u);
}

TEST(Files, SeriesHasStartEveryNthAndFinalStep) {
  const test::TemporaryDirectory dir;
  ASSERT_EQ(aspic(run_words({"--steps", "25", "--series", dir.file("e.csv"), "--every", "10"})).exit_code, 0);
  const auto rows = test::lines(dir.read("e.csv"));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0], series_csv_header);
  EXPECT_THAT(rows[1], testing::StartsWith("0,0,"));
  EXPECT_THAT(rows[2], testing::StartsWith("10,0.01,"));
  EXPECT_THAT(rows[3], testing::StartsWith("20,0.02,"));
  EXPECT_THAT(rows[4], testing::StartsWith("25,0.025,"));
}

// The summary has the work of actuators as the series books it; without a series nobody looks on the way.
TEST(Files, WorkOfActuatorsIsThatOfTheSeries) {
  const test::TemporaryDirectory dir;
  const Words words = {"run", "worm", "--backend", "cpu", "--steps", "250", "--json"};
  Words with = words;
  with.insert(with.end(), {"--series", dir.file("e.csv"), "--every", "20"});
  const auto booked = aspic(with), alone = aspic(words);
  ASSERT_EQ(booked.exit_code, 0) << booked.err;
  const auto rows = test::lines(dir.read("e.csv"));
  EXPECT_EQ(rows[0].substr(rows[0].rfind(',')), series_csv_work_header);
  const std::string work = json_member(booked.out, "actuator_work");
  EXPECT_GT(std::stod(work), 0.0);
  EXPECT_EQ(std::stod(rows.back().substr(rows.back().rfind(',') + 1)), std::stod(work));
  EXPECT_THAT(alone.out, testing::Not(HasSubstr("actuator_work")));
  std::erase(with, "--json");
  with.emplace_back("--force");
  EXPECT_THAT(aspic(with).out, HasSubstr("actuators    work "));
}

TEST(Files, ExistingFilesAreKeptWithoutForce) {
  for (const char* option : {"--state", "--series", "--checkpoint"}) {
    const test::TemporaryDirectory dir;
    dir.write("f", "precious");
    const auto refused = aspic(run_words({"--steps", "5", option, dir.file("f")}));
    EXPECT_EQ(refused.exit_code, 6);
    EXPECT_THAT(refused.err, HasSubstr("--force"));
    EXPECT_THAT(refused.out, testing::IsEmpty());
    EXPECT_EQ(dir.read("f"), "precious");
    EXPECT_EQ(dir.entries(), 1u);
    EXPECT_EQ(aspic(run_words({"--steps", "5", "--force", option, dir.file("f")})).exit_code, 0);
    EXPECT_NE(dir.read("f"), "precious");
    EXPECT_EQ(dir.entries(), 1u);
  }
}

// The check comes before the work: a run of a thousand million steps would outlast any test.
TEST(Files, PlacesThatCannotBeWrittenAreRefusedBeforeSimulating) {
  const test::TemporaryDirectory dir;
  const auto run = aspic(run_words({"--steps", "1000000000", "--state", dir.file("none/s.csv")}));
  EXPECT_EQ(run.exit_code, 6);
  EXPECT_THAT(run.err, HasSubstr(dir.file("none/s.csv")));
  EXPECT_THAT(run.err, HasSubstr("No such file or directory"));
}

TEST(Files, FullDiskIsAnErrorAndLeavesNoFile) {
  const test::TemporaryDirectory dir;
  for (const char* option : {"--state", "--series", "--checkpoint"}) {
    const auto full = aspic(run_words({"--steps", "5", option, "/dev/full"}));
    EXPECT_EQ(full.exit_code, 6);
    EXPECT_THAT(full.err, HasSubstr("No space left on device"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));

    test::ProcessOptions limited;
    limited.file_size_limit = 4096;  // the summary fits, a thousand particles do not
    const auto cut = aspic(run_words({"--steps", "50", option, dir.file("f")}), limited);
    EXPECT_EQ(cut.exit_code, 6) << cut.err;
    EXPECT_EQ(dir.entries(), 0u);
  }
}

TEST(Files, OneThatFailsDoesNotCostTheOthers) {
  const test::TemporaryDirectory dir;
  const auto run = aspic(run_words({"--steps", "5", "--state", dir.file("s.csv"), "--series", "/dev/full",
                                    "--checkpoint", dir.file("c")}));
  EXPECT_EQ(run.exit_code, 6);
  EXPECT_TRUE(test::read_state_csv(dir.file("s.csv"), Precision::single).ok());
  EXPECT_TRUE(read_checkpoint(dir.file("c")).ok());
}

TEST(Files, FullDiskBehindStdoutIsAnError) {
  test::ProcessOptions full;
  full.stdout_file = "/dev/full";
  EXPECT_EQ(aspic(run_words({"--steps", "5"}), full).exit_code, 6);
  EXPECT_EQ(aspic({"scene", "show", "cube-plane"}, full).exit_code, 6);
  EXPECT_EQ(aspic({"--help"}, full).exit_code, 6);
}

TEST(Files, ResumeGivesTheBitsOfAnUninterruptedRun) {
  for (const char* precision : {"single", "double"}) {
    const test::TemporaryDirectory dir;
    const Words common = {"--set", "cube[0].position=[0.0, 1.05, 0.0]", "--precision", precision};
    const auto with = [&](Words more) {
      more.insert(more.end(), common.begin(), common.end());
      return aspic(run_words(more));
    };
    const auto whole = with({"--steps", "400"});
    const auto half = with({"--steps", "150", "--checkpoint", dir.file("c")});
    ASSERT_EQ(half.exit_code, 0) << half.err;
    EXPECT_NE(json_member(half.out, "state_hash"), json_member(whole.out, "state_hash"));
    const auto rest =
        aspic({"run", "--backend", "reference", "--resume", dir.file("c"), "--steps", "400", "--json"});
    ASSERT_EQ(rest.exit_code, 0) << rest.err;
    EXPECT_EQ(json_member(rest.out, "steps"), "400");
    EXPECT_EQ(json_member(rest.out, "first_step"), "150");
    EXPECT_EQ(json_member(rest.out, "precision"), precision);
    EXPECT_EQ(json_member(rest.out, "state_hash"), json_member(whole.out, "state_hash"));
    // The same scene named again is welcome.
    EXPECT_EQ(with({"--steps", "400", "--resume", dir.file("c")}).exit_code, 0);
  }
}

TEST(Files, ResumeExplainsWhatDoesNotFit) {
  const test::TemporaryDirectory dir;
  ASSERT_EQ(aspic(run_words({"--steps", "20", "--checkpoint", dir.file("c")})).exit_code, 0);
  const auto changed =
      aspic(run_words({"--steps", "40", "--resume", dir.file("c"), "--set", "simulation.timestep=0.0005"}));
  EXPECT_EQ(changed.exit_code, 3);
  EXPECT_THAT(changed.err, HasSubstr("0.0005"));
  EXPECT_THAT(changed.err, HasSubstr("Omit SCENE and --set"));
  const auto past = aspic(run_words({"--steps", "10", "--resume", dir.file("c")}));
  EXPECT_EQ(past.exit_code, 2);
  EXPECT_THAT(past.err, HasSubstr("already at step 20"));
  EXPECT_EQ(aspic(run_words({"--steps", "40", "--resume", dir.file("c"), "--precision", "double"})).exit_code,
            2);

  const std::string bytes = dir.read("c");
  dir.write("cut", bytes.substr(0, bytes.size() - 100));
  const auto cut = aspic({"run", "--resume", dir.file("cut")});
  EXPECT_EQ(cut.exit_code, 6);
  EXPECT_THAT(cut.err, HasSubstr("damaged or truncated"));
  dir.write("foreign", "hello");
  EXPECT_EQ(aspic({"run", "--resume", dir.file("foreign")}).exit_code, 6);
  EXPECT_EQ(aspic({"run", "--resume", dir.file("missing")}).exit_code, 6);
}

/// Starts a run that no one could wait for, with all its files open.
class Endless {
 public:
  Endless()
      : process_(run_words({"--steps", "1000000000", "--state", dir.file("s.csv"), "--series",
                            dir.file("e.csv"), "--every", "7", "--checkpoint", dir.file("c")})) {
    while (dir.entries() < 3) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  test::Process& process() { return process_; }

  const test::TemporaryDirectory dir;

 private:
  test::Process process_;
};

TEST(Files, InterruptClosesThemWhole) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Endless run;
    run.process().send(signal);
    const auto finished = run.process().wait();
    EXPECT_EQ(finished.exit_code, 130) << finished.err;
    ASSERT_TRUE(test::is_json(finished.out)) << finished.out;
    EXPECT_EQ(json_member(finished.out, "interrupted"), "true");
    EXPECT_EQ(run.dir.entries(), 3u);
    const auto state = test::read_state_csv(run.dir.file("s.csv"), Precision::single);
    ASSERT_TRUE(state.ok()) << state.error().message();
    EXPECT_EQ(state_hash_text(*state), json_member(finished.out, "state_hash"));
    const auto checkpoint = read_checkpoint(run.dir.file("c"));
    ASSERT_TRUE(checkpoint.ok()) << checkpoint.error().message();
    EXPECT_EQ(std::to_string(checkpoint->state.step), json_member(finished.out, "steps"));
    const std::string series = run.dir.read("e.csv");
    EXPECT_EQ(series.back(), '\n');
    for (const std::string& row : test::lines(series))
      EXPECT_EQ(std::count(row.begin(), row.end(), ','), 10) << row;
    // Going on from there is the same as never having stopped.
    const std::string end = std::to_string(checkpoint->state.step + 50);
    EXPECT_EQ(json_member(aspic({"run", "--resume", run.dir.file("c"), "--backend", "reference", "--steps",
                                 end, "--json"})
                              .out,
                          "state_hash"),
              json_member(aspic(run_words({"--steps", end})).out, "state_hash"));
  }
}

TEST(Files, SecondInterruptEndsAtOnceAndLeavesNothing) {
  Endless run;
  // Both arrive while the process is held, so no time passes between them.
  run.process().send(SIGSTOP);
  run.process().send(SIGTERM);
  run.process().send(SIGINT);
  run.process().send(SIGCONT);
  const auto finished = run.process().wait();
  EXPECT_NE(finished.signal, 0);
  EXPECT_EQ(run.dir.entries(), 0u);
}

}  // namespace
}  // namespace aspic
