// aspic run --html and --html-live: the files, of one run and of several.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/process.h"
#include "page/live_facts.h"
#include "page/page_reader.h"

namespace aspic {
namespace {

using test::aspic;
using test::json_member;
using testing::HasSubstr;
using Words = std::vector<std::string>;

/// A short run of a small cube with further words.
test::Finished run(const Words& more) {
  Words words = {"run",       "cube-plane", "--json", "--set", "cube[0].particles-per-edge=3",
                 "--backend", "reference"};
  words.insert(words.end(), more.begin(), more.end());
  return aspic(words);
}

TEST(RunPage, HoldsWhatTheSummarySaysAndTheCommand) {
  const test::TemporaryDirectory dir;
  const std::string path = dir.file("a b.html");
  const auto done = run({"--steps", "100", "--html", path, "--view", "color=strain", "--speed", "0.5"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr(path));
  const test::ReadPage page = test::read_page(dir.read("a b.html"));
  ASSERT_EQ(page.error, "");
  EXPECT_EQ(page.ends[0]["hash"], json_member(done.out, "state_hash"));
  EXPECT_EQ(page.ends[0]["steps"].back(), 100);
  EXPECT_EQ(page.images.size(), 13u);  // every 1/120 s
  EXPECT_EQ(page.facts["speed"], 0.5);
  EXPECT_EQ(page.facts["view"]["color"], "strain");
  EXPECT_EQ(
      page.facts["command"],
      "aspic run cube-plane --json --set 'cube[0].particles-per-edge=3' --backend reference --steps 100 "
      "--html '" +
          path + "' --view color=strain --speed 0.5");
  EXPECT_EQ(run({"--html", path}).exit_code, 6);  // it is there
}

TEST(RunPage, AResumedRunBeginsWhereItWasResumed) {
  const test::TemporaryDirectory dir;
  ASSERT_EQ(run({"--steps", "50", "--checkpoint", dir.file("c.aspic")}).exit_code, 0);
  const auto done =
      aspic({"run", "--resume", dir.file("c.aspic"), "--steps", "100", "--html", dir.file("p.html")});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const test::ReadPage page = test::read_page(dir.read("p.html"));
  ASSERT_EQ(page.error, "");
  EXPECT_EQ(page.ends[0]["steps"].front(), 50);
  EXPECT_EQ(page.ends[0]["steps"].back(), 100);
}

TEST(RunPage, ARunThatDivergesIsThereToItsLastGoodState) {
  const test::TemporaryDirectory dir;
  const auto done = run({"--set", "cube[0].structural.stiffness=1e7", "--html", dir.file("p.html")});
  EXPECT_EQ(done.exit_code, 5) << done.err;
  const test::ReadPage page = test::read_page(dir.read("p.html"));
  ASSERT_EQ(page.error, "");
  EXPECT_THAT(page.ends[0]["diverged"].get<std::string>(), HasSubstr("diverged in step"));
  EXPECT_EQ(page.ends[0]["steps"].back(), std::stoi(json_member(done.out, "steps")));
}

TEST(RunPage, RunsSideBySideShareOneThatIsNotNumbered) {
  const test::TemporaryDirectory dir;
  const auto done = run({"--duration", "0.1", "--variant", "h=0.002", "--variant", "k=1e7", "--html",
                         dir.file("p.html"), "--series", dir.file("e.csv")});
  EXPECT_EQ(done.exit_code, 5) << done.err;  // the third explodes
  EXPECT_EQ(dir.entries(), 4u);
  const test::ReadPage page = test::read_page(dir.read("p.html"));
  ASSERT_EQ(page.error, "");
  ASSERT_EQ(page.ends.size(), 3u);
  EXPECT_EQ(page.ends[0]["steps"].back(), 100);
  EXPECT_EQ(page.ends[1]["steps"].back(), 50);
  EXPECT_TRUE(page.ends[2].contains("diverged"));
  EXPECT_EQ(page.facts["runs"][1]["name"], "h 0.002 s");
  // The bits of the second run alone.
  const auto alone = run({"--duration", "0.1", "--set", "simulation.timestep=0.002"});
  EXPECT_EQ(page.ends[1]["hash"], json_member(alone.out, "state_hash"));
}

/// Tests of live pages need the module.
struct RunLivePage : testing::Test {
  void SetUp() override {
    if (const auto module = page::live_module(); !module) GTEST_SKIP() << module.error().message();
  }
  const test::TemporaryDirectory dir;
};

TEST_F(RunLivePage, HoldsTheSceneAndTheHashesOfItsImages) {
  const auto done = run({"--steps", "100", "--html-live", dir.file("p.html"), "--state", dir.file("s.csv")});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const test::ReadPage page = test::read_page(dir.read("p.html"));
  ASSERT_EQ(page.error, "");
  EXPECT_EQ(page.ends[0]["hash"], json_member(done.out, "state_hash"));
  EXPECT_EQ(page.ends[0]["hashes"].size(), 7u);  // every 1/60 s, and the last
  EXPECT_EQ(page.ends[0]["hashes"].back(), page.ends[0]["hash"]);
  EXPECT_EQ(page.ends[0]["steps"].back(), 100);
  EXPECT_THAT(page.facts["live"]["scene"].get<std::string>(), HasSubstr("particles-per-edge = 3\n"));
  EXPECT_EQ(page.start, "");
  EXPECT_EQ(page.module.substr(0, 4), std::string("\0asm", 4));
  EXPECT_THAT(dir.read("p.html"), HasSubstr("'wasm-unsafe-eval'; worker-src blob:"));
  EXPECT_EQ(dir.read("p.html").find("://"), std::string::npos);
  EXPECT_LT(dir.read("p.html").size(), 3000000u);
}

TEST_F(RunLivePage, LetsItsReaderChangeWhatIsLive) {
  ASSERT_EQ(run({"--steps", "1", "--html-live", dir.file("p.html")}).exit_code, 0);
  const test::ReadPage page = test::read_page(dir.read("p.html"));
  std::vector<std::string> paths;
  for (const auto& group : page.facts["live"]["controls"])
    for (const auto& row : group["rows"]) {
      paths.push_back(row["path"]);
      if (row.contains("min")) {
        EXPECT_TRUE(row["min"].is_number() && row["max"].is_number()) << row;
      }
    }
  EXPECT_THAT(paths,
              testing::IsSupersetOf({"simulation.integrator", "simulation.timestep", "simulation.gravity",
                                     "contact.friction", "cube[0].shear.damping"}));
  for (const std::string fixed : {"cube[0].position", "cube[0].particles-per-edge", "terrain[0].point",
                                  "view.axes", "simulation.duration"})
    EXPECT_THAT(paths, testing::Not(testing::Contains(fixed)));
}

TEST_F(RunLivePage, AResumedRunStartsWithItsState) {
  ASSERT_EQ(run({"--steps", "50", "--checkpoint", dir.file("c.aspic")}).exit_code, 0);
  const auto done =
      aspic({"run", "--resume", dir.file("c.aspic"), "--steps", "100", "--html-live", dir.file("p.html")});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const test::ReadPage page = test::read_page(dir.read("p.html"));
  ASSERT_EQ(page.error, "");
  EXPECT_EQ(page.ends[0]["steps"].front(), 50);
  EXPECT_EQ(page.start.size(), 27u * 6 * 4);
}

TEST_F(RunLivePage, RefusesWhatABrowserCannotRepeat) {
  const std::pair<Words, std::string> wrong[] = {
      {{"--precision", "double"}, "single precision"},
      {{"--variant", "h=0.002"}, "omit --variant"},
      {{"--html", dir.file("p.html")}, "would both write"},
      {{"--fps", "1000", "--duration", "100000"}, "and velocities"},
  };
  for (const auto& [words, sentence] : wrong) {
    Words all = {"--steps", "5", "--html-live", dir.file("p.html")};
    if (words.front() == "--fps") all.erase(all.begin(), all.begin() + 2);
    all.insert(all.end(), words.begin(), words.end());
    const auto done = run(all);
    EXPECT_EQ(done.exit_code, 2) << sentence;
    EXPECT_THAT(done.err, HasSubstr(sentence));
  }
  EXPECT_EQ(dir.entries(), 0u);
}

TEST(RunLivePageAnyhow, APageOfAProgramWithoutTheModuleSaysWhatMakesIt) {
  const auto module = page::live_module();
  const test::TemporaryDirectory dir;
  const auto done = run({"--steps", "5", "--html-live", dir.file("p.html")});
  EXPECT_EQ(done.exit_code, module ? 0 : 6) << done.err;
  if (!module) {
    EXPECT_THAT(done.err, HasSubstr("scripts/wasm.sh"));
  }
}

TEST(RunPage, ADiskThatFillsCostsThePageAlone) {
  const test::TemporaryDirectory dir;
  test::ProcessOptions options;
  options.file_size_limit = 20000;  // the page's program is longer
  const auto done = aspic({"run", "cube-plane", "--steps", "20", "--html", dir.file("p.html"), "--state",
                           dir.file("s.csv"), "--set", "cube[0].particles-per-edge=3"},
                          options);
  EXPECT_EQ(done.exit_code, 6) << done.err;
  EXPECT_THAT(done.err, HasSubstr("p.html"));
  EXPECT_EQ(dir.entries(), 1u);  // the state
}

}  // namespace
}  // namespace aspic
