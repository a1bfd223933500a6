#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "cli/process.h"

namespace aspic {
namespace {

using test::aspic;
using test::json_member;
using testing::HasSubstr;
using testing::SizeIs;
using Words = std::vector<std::string>;

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The rows without their last column, the seconds.
Words without_seconds(const std::string& path) {
  Words rows = test::lines(content(path));
  for (std::string& row : rows) row.resize(row.rfind(','));
  return rows;
}

std::string field(const std::string& row, std::size_t index) {
  std::istringstream in(row);
  std::string text;
  for (std::size_t i = 0; i <= index; ++i) std::getline(in, text, ',');
  return text;
}

/// A small cube; twelve runs, of which those with the larger step diverge.
Words sweep(const std::string& out, const Words& more = {}) {
  Words words = {"sweep",      "cube-plane",
                 "--backend",  "cpu",
                 "--set",      "cube[0].particles-per-edge=4",
                 "--vary",     "h=0.001,0.01",
                 "--vary",     "k=2000:8000:3:log",
                 "--vary",     "integrator=explicit-euler,midpoint",
                 "--duration", "1",
                 "--out",      out};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(Sweep, TheFirstRejectionIsSaid) {
  const test::TemporaryDirectory dir;
  const auto done = aspic({"sweep", "cube-plane", "--steps", "2", "--backend", "reference", "--vary",
                           "integrator=rk4,midpoint,rk5", "--out", dir.file("s.csv")});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("1 ok, 0 diverged, 2 rejected"));
  EXPECT_THAT(done.err, HasSubstr("warning: run 0 (integrator=rk4) was rejected: "));
  EXPECT_THAT(done.err, HasSubstr("did you mean 'runge-kutta-4'?"));
  EXPECT_THAT(done.err, testing::Not(HasSubstr("rk5")));
}

TEST(Sweep, DivergedRunsAreRowsWithTheirReason) {
  const test::TemporaryDirectory dir;
  const auto done = aspic(sweep(dir.file("s.csv"), {"--json"}));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  ASSERT_TRUE(test::is_json(done.out)) << done.out;
  EXPECT_EQ(json_member(done.out, "runs"), "12");
  EXPECT_EQ(json_member(done.out, "ok"), "6");
  EXPECT_EQ(json_member(done.out, "diverged"), "6");
  const Words rows = test::lines(content(dir.file("s.csv")));
  ASSERT_THAT(rows, SizeIs(13));
  EXPECT_EQ(rows[0].substr(0, 36), "run,h,k,integrator,outcome,reason,st");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_EQ(field(rows[i], 0), std::to_string(i - 1));
    const bool diverged = field(rows[i], 1) == "0.01";
    EXPECT_EQ(field(rows[i], 4), diverged ? "diverged" : "ok") << rows[i];
    const std::string reason = field(rows[i], 5);
    EXPECT_EQ(reason.find("became faster than 1000 m/s in step") != std::string::npos, diverged) << reason;
    EXPECT_EQ(reason.empty(), !diverged) << reason;
  }
  EXPECT_FALSE(std::filesystem::exists(dir.file("s.csv.partial")));
}

TEST(Sweep, RowsAreThoseOfRun) {
  const test::TemporaryDirectory dir;
  ASSERT_EQ(aspic(sweep(dir.file("s.csv"))).exit_code, 0);
  const auto run = aspic({"run", "cube-plane", "--backend", "reference", "--duration", "1", "--json", "--set",
                          "cube[0].particles-per-edge=4", "--set", "simulation.integrator=midpoint", "--set",
                          "cube[0].structural.stiffness=8000", "--set", "cube[0].shear.stiffness=8000",
                          "--set", "cube[0].bending.stiffness=8000"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string row = test::lines(content(dir.file("s.csv")))[6];
  EXPECT_THAT(row, HasSubstr("5,0.001,8000,midpoint,ok,,1000,1,"));
  EXPECT_THAT(row, HasSubstr(fmt::format(",{},", json_member(run.out, "state_hash"))));
  EXPECT_THAT(row, HasSubstr(fmt::format(",{},", json_member(run.out, "kinetic"))));
}

TEST(Sweep, JobsAndPartsChangeNoRow) {
  const test::TemporaryDirectory dir;
  ASSERT_EQ(aspic(sweep(dir.file("one.csv"), {"--jobs", "1"})).exit_code, 0);
  ASSERT_EQ(aspic(sweep(dir.file("three.csv"), {"--jobs", "3"})).exit_code, 0);
  const Words whole = without_seconds(dir.file("one.csv"));
  EXPECT_EQ(whole, without_seconds(dir.file("three.csv")));
  Words joined = {whole.front()};
  for (int i = 1; i <= 5; ++i) {
    const std::string file = dir.file("part.csv");
    ASSERT_EQ(aspic(sweep(file, {"--force", "--part", fmt::format("{}/5", i)})).exit_code, 0);
    const Words part = without_seconds(file);
    EXPECT_EQ(part.front(), whole.front());
    EXPECT_GE(part.size(), 3u);
    joined.insert(joined.end(), part.begin() + 1, part.end());
  }
  EXPECT_EQ(joined, whole);
}

TEST(Sweep, ContinuesAfterAKill) {
  const test::TemporaryDirectory dir;
  ASSERT_EQ(aspic(sweep(dir.file("whole.csv"))).exit_code, 0);
  const std::string out = dir.file("s.csv"), partial = out + ".partial";
  // Killed once its first rows are there. Should this process have slept until all were there, again.
  for (int attempt = 0; attempt < 20; ++attempt) {
    std::filesystem::remove(out);
    test::Process running(sweep(out, {"--jobs", "1"}));
    while (test::lines(content(partial)).size() < 3 && !std::filesystem::exists(out))
      std::this_thread::yield();
    running.send(SIGKILL);
    EXPECT_EQ(running.wait().signal, std::filesystem::exists(out) ? 0 : SIGKILL);
    if (!std::filesystem::exists(out)) break;
  }
  ASSERT_FALSE(std::filesystem::exists(out));
  const std::string kept = content(partial);
  ASSERT_GE(test::lines(kept).size(), 3u);
  std::ofstream(partial, std::ios::app) << "11,0.01,8000,midp";  // a row that a kill cut short

  const auto other = aspic(sweep(out, {"--vary", "c=60"}));
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("rows of another sweep"));
  EXPECT_THAT(other.err, HasSubstr("--vary c=60"));
  const auto other_part = aspic(sweep(out, {"--part", "1/2"}));
  EXPECT_EQ(other_part.exit_code, 2) << other_part.err;

  const auto resumed = aspic(sweep(out, {"--json"}));
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_GE(std::stoi(json_member(resumed.out, "resumed")), 2);
  EXPECT_EQ(without_seconds(out), without_seconds(dir.file("whole.csv")));
  for (const std::string& row : test::lines(kept)) {
    if (row.starts_with("#")) continue;
    EXPECT_THAT(content(out), HasSubstr(fmt::format("{}\n", row)));
  }
  EXPECT_FALSE(std::filesystem::exists(partial));
  const auto again = aspic(sweep(out));
  EXPECT_EQ(again.exit_code, 6);
  EXPECT_THAT(again.err, HasSubstr("exists"));
}

TEST(Sweep, CtrlCKeepsTheRowsThatAreThere) {
  const test::TemporaryDirectory dir;
  const std::string out = dir.file("s.csv");
  // The second run would take days.
  const Words words = {"sweep", "cube-plane", "--backend", "cpu", "--vary", "simulation.duration=0.1,1000000",
                       "--out", out,          "--jobs",    "1"};
  test::Process running(words);
  while (test::lines(content(out + ".partial")).size() < 2) std::this_thread::yield();
  running.send(SIGINT);
  const auto ended = running.wait();
  EXPECT_EQ(ended.exit_code, 130);
  EXPECT_THAT(ended.err, HasSubstr("interrupted after 1 of 2 runs"));
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_THAT(test::lines(content(out + ".partial")), SizeIs(2));
}

std::vector<std::filesystem::path> files_in(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() != ".tmp") files.push_back(entry.path());  // not complete yet
  std::ranges::sort(files);
  return files;
}

TEST(Sweep, RunsInAFolderAreMadeOnce) {
  const test::TemporaryDirectory dir;
  const std::string folder = dir.file("deep/runs");
  ASSERT_EQ(aspic(sweep(dir.file("whole.csv"))).exit_code, 0);
  // Half of them, and one that another program left half-written.
  const auto part = aspic(sweep(dir.file("part.csv"), {"--runs", folder, "--part", "1/2", "--json"}));
  ASSERT_EQ(part.exit_code, 0) << part.err;
  EXPECT_EQ(json_member(part.out, "resumed"), "0");
  EXPECT_FALSE(std::filesystem::exists(dir.file("part.csv.partial")));
  const auto files = files_in(folder + "/runs");
  ASSERT_THAT(files, SizeIs(6));
  ASSERT_THAT(files_in(folder + "/scenes"), SizeIs(1));
  EXPECT_THAT(content(files_in(folder + "/scenes")[0]), HasSubstr("particles-per-edge = 4"));
  for (const auto& file : files) {
    ASSERT_TRUE(test::is_json(content(file))) << file;
    EXPECT_EQ(json_member(content(file), "key"), file.stem().string());
  }
  std::ofstream(files[0]) << content(files[0]).substr(0, 200);
  std::ofstream(files[1]) << content(files[2]);

  Words words = sweep(dir.file("s.csv"), {"--runs", folder, "--json"});
  const auto resumed = aspic(words);
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(json_member(resumed.out, "resumed"), "4");
  EXPECT_THAT(files_in(folder + "/runs"), SizeIs(12));
  EXPECT_EQ(without_seconds(dir.file("s.csv")), without_seconds(dir.file("whole.csv")));
  // A table of what is there, seconds too; and a run that another grid has in common with this one.
  words[words.size() - 4] = dir.file("again.csv");
  ASSERT_EQ(aspic(words).exit_code, 0);
  EXPECT_EQ(content(dir.file("again.csv")), content(dir.file("s.csv")));
  const auto other =
      aspic({"sweep", "cube-plane", "--backend", "cpu", "--set", "cube[0].particles-per-edge=4", "--set",
             "view.color=strain", "--vary", "integrator=midpoint", "--vary", "k=8000.0,9000", "--vary",
             "h=1e-3", "--duration", "1", "--runs", folder, "--json"});
  ASSERT_EQ(other.exit_code, 0) << other.err;
  EXPECT_EQ(json_member(other.out, "resumed"), "1");
}

/// The process that makes runs for a sweep whose arguments name `path` and has computed for half a second;
/// 0: there is none.
pid_t busy_worker(const std::string& path) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string words = content(entry.path() / "cmdline");
    if (words.find(path) == std::string::npos || words.find("--worker") == std::string::npos) continue;
    const std::string stat = content(entry.path() / "stat");  // proc(5): after the name, fields 3 and on
    std::istringstream fields(stat.substr(std::min(stat.rfind(')') + 1, stat.size())));
    std::string skipped;
    for (int field = 3; field < 14; ++field) fields >> skipped;
    long user = 0, system = 0;
    if (fields >> user >> system && user + system > ::sysconf(_SC_CLK_TCK) / 2)
      return static_cast<pid_t>(std::stoi(entry.path().filename()));
  }
  return 0;
}

TEST(Sweep, ARunThatIsLostIsARowAndTriedAgain) {
  const test::TemporaryDirectory dir;
  const std::string folder = dir.file("runs");
  const Words words = {
      "sweep",  "cube-plane",     "--backend", "cpu", "--vary", "simulation.duration=0.1,1000000",
      "--runs", dir.file("runs"), "--jobs",    "1"};
  test::Process running(words);
  // The first run takes a moment, the second one would take days.
  pid_t worker = 0;
  while ((worker = busy_worker(folder)) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ASSERT_EQ(::kill(worker, SIGKILL), 0);
  const auto ended = running.wait();
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("1 ok, 0 diverged, 0 rejected, 1 failed"));
  EXPECT_THAT(ended.err, HasSubstr("signal 9 ended the process"));
  const auto files = files_in(folder + "/runs");
  ASSERT_THAT(files, SizeIs(2));
  const auto outcome = [](const auto& file) { return json_member(content(file), "outcome"); };
  const bool second = outcome(files[0]) == "ok";
  EXPECT_EQ(outcome(files[second ? 0 : 1]), "ok");
  EXPECT_EQ(outcome(files[second ? 1 : 0]), "failed");

  // What failed is no run that is there.
  const Words one = {"sweep",  "cube-plane", "--backend", "cpu", "--vary", "simulation.duration=0.1",
                     "--runs", folder,       "--json"};
  EXPECT_EQ(json_member(aspic(one).out, "resumed"), "1");
  std::string text = content(files[second ? 0 : 1]);
  text.replace(text.find("\"ok\""), 4, "\"failed\"");
  std::ofstream(files[second ? 0 : 1]) << text;
  const auto again = aspic(one);
  EXPECT_EQ(json_member(again.out, "resumed"), "0");
  EXPECT_EQ(json_member(again.out, "ok"), "1");
}

TEST(Sweep, AFullDiskFailsRunsAndNotTheOthers) {
  const test::TemporaryDirectory dir;
  test::ProcessOptions options;
  options.file_size_limit = 300;
  const Words words = {"sweep",  "cube-plane",    "--steps", "2",
                       "--vary", "mu=0.1,0.2",    "--set",   "cube[0].particles-per-edge=3",
                       "--runs", dir.file("runs")};
  ASSERT_EQ(aspic(words).exit_code, 0);
  for (const auto& file : files_in(dir.file("runs/runs"))) std::filesystem::remove(file);
  const auto full = aspic(words, options);
  EXPECT_EQ(full.exit_code, 0) << full.err;
  EXPECT_THAT(full.out, HasSubstr("0 ok, 0 diverged, 0 rejected, 2 failed"));
  EXPECT_THAT(full.err, HasSubstr("Cannot write"));
  EXPECT_TRUE(std::filesystem::is_empty(dir.file("runs/runs")));
}

TEST(Sweep, LeavesNoTemporaryFilesWhenInterrupted) {
  const test::TemporaryDirectory dir;
  dir.write("one.toml", "schema = 1\n[[cube]]\nparticles-per-edge = 2\n");
  int round = 0;
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGTERM}) {
    const std::string folder = dir.file(fmt::format("runs-{}", round++));
    test::Process running({"sweep", dir.file("one.toml"), "--backend", "cpu", "--vary", "k=500:4000:2000:log",
                           "--steps", "1", "--runs", folder});
    while (!std::filesystem::exists(folder + "/runs") || files_in(folder + "/runs").empty())
      std::this_thread::yield();
    running.send(signal);
    EXPECT_EQ(running.wait().exit_code, 130);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      EXPECT_NE(entry.path().extension(), ".tmp") << "after signal " << signal;
  }
}

TEST(Sweep, RefusesDamagedRowsOfItsJournal) {
  const test::TemporaryDirectory dir;
  const std::string out = dir.file("s.csv"), partial = out + ".partial";
  const Words words = sweep(out);
  {
    test::Process running(words);
    while (test::lines(content(partial)).size() < 2 && !std::filesystem::exists(out))
      std::this_thread::yield();
    running.send(SIGKILL);
    ASSERT_EQ(running.wait().signal, SIGKILL);
  }
  const Words kept = test::lines(content(partial));
  ASSERT_GE(kept.size(), 2u);
  const std::string whole = kept[1], cut = whole.substr(0, whole.size() / 2);
  const auto without_values = "0,1,2,3" + whole.substr(whole.find(",ok,"));
  std::string other_outcome = whole;
  other_outcome.replace(whole.find(",ok,"), 4, ",no,");
  for (const std::string& row :
       {std::string("0,2,3"), std::string("1,hello"), std::string("2,"), std::string("12,0.01,8000,midpoint"),
        cut, without_values, other_outcome, whole + ",1"}) {
    std::ofstream(partial) << kept[0] << '\n' << row << '\n';
    const auto again = aspic(words);
    EXPECT_EQ(again.exit_code, 6) << row;
    EXPECT_THAT(again.err, HasSubstr("s.csv.partial:2: not a row of this sweep; start over with --force."))
        << row;
  }
  std::ofstream(partial) << kept[0] << '\n' << whole << '\n';
  EXPECT_EQ(aspic(words).exit_code, 0);
}

TEST(Sweep, ReplacesAPipeAndRefusesADirectoryInARunsPlace) {
  const test::TemporaryDirectory dir;
  const Words words = {"sweep",  "cube-plane",  "--steps", "2",
                       "--vary", "mu=0.1,0.2",  "--set",   "cube[0].particles-per-edge=3",
                       "--runs", dir.file("r"), "--json"};
  ASSERT_EQ(aspic(words).exit_code, 0);
  const std::string file = files_in(dir.file("r/runs"))[0];
  std::filesystem::remove(file);
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  const auto again = aspic(words);
  EXPECT_EQ(json_member(again.out, "ok"), "2") << again.err;
  EXPECT_EQ(json_member(again.out, "resumed"), "1");
  EXPECT_TRUE(std::filesystem::is_regular_file(file));

  std::filesystem::remove(file);
  std::filesystem::create_directory(file);
  const auto refused = aspic(words);
  EXPECT_EQ(refused.exit_code, 6) << refused.out;
  EXPECT_THAT(refused.err, HasSubstr("is a directory in the place of a run"));
}

TEST(Sweep, EndsWithTinyTimeSteps) {
  const test::TemporaryDirectory dir;
  const auto done =
      aspic({"sweep", "cubes-stack", "--backend", "cpu", "--set", "cube[0].particles-per-edge=2", "--vary",
             "h=1e-20,9e-22", "--steps", "3", "--out", dir.file("s.csv")});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("2 ok"));
}

TEST(Sweep, RejectedValuesAreRowsToo) {
  const test::TemporaryDirectory dir;
  const auto done = aspic({"sweep", "cube-plane", "--backend", "cpu", "--vary",
                           "cube[0].particles-per-edge=1,3", "--steps", "10", "--out", dir.file("s.csv")});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("1 ok, 0 diverged, 1 rejected, 0 failed"));
  const Words rows = test::lines(content(dir.file("s.csv")));
  ASSERT_THAT(rows, SizeIs(3));
  EXPECT_THAT(rows[1], HasSubstr("0,1,rejected,\"cube[0].particles-per-edge=1: "));
  EXPECT_THAT(rows[2], HasSubstr("1,3,ok,,10,0.01,"));
}

}  // namespace
}  // namespace aspic
