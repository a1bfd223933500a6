// Pages that simulate, in Chromium and Firefox: the bits of every scene and method, and what a reader can do.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/process.h"
#include "cpu_reference/reference_solver.h"
#include "page/builtin_scenes.h"
#include "page/live_facts.h"
#include "support/golden_runs.h"

namespace aspic {
namespace {

using nlohmann::json;

/// As WebAssembly ends a run, which cannot flush denormal numbers.
test::GoldenEnd end_with_denormals(const test::GoldenRun& run) {
  auto solver = make_reference_solver(shared(run.model()), Precision::single, Denormals::kept);
  EXPECT_TRUE(solver.ok());
  EXPECT_TRUE((*solver)->advance(run.steps).ok());
  const State state = *(*solver)->state();
  return {state.step, state_hash_text(state)};
}

class LivePagesInBrowsers : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (const auto module = page::live_module(); !module) GTEST_SKIP() << module.error().message();
  }
  std::string page_of(const std::vector<std::string>& words) {
    const std::string path = dir_.file("page-" + std::to_string(++pages_) + ".html");
    std::vector<std::string> all = {"run"};
    all.insert(all.end(), words.begin(), words.end());
    all.insert(all.end(), {"--html-live", path});
    const auto done = test::aspic(all);
    EXPECT_TRUE(done.exit_code == 0 || done.exit_code == 5) << done.err;
    return path;
  }
  void drive(const json& job) {
    test::ProcessOptions python;
    python.program = ASPIC_PYTHON;
    python.environment = {{"PYTHONDONTWRITEBYTECODE", "1"}};
    const auto driven = test::aspic({ASPIC_DRIVE_LIVE, GetParam(), job.dump()}, python);
    EXPECT_EQ(driven.exit_code, 0) << driven.out << driven.err;
    std::cout << driven.out;
  }
  test::TemporaryDirectory dir_;

 private:
  int pages_ = 0;
};

TEST_P(LivePagesInBrowsers, HaveTheKnownBitsOfEverySceneAndMethod) {
  json runs = json::array();
  const auto known = test::scene_runs();
  for (const test::GoldenRun& run : known) {
    Scene scene;
    scene.model = run.settings();
    runs.push_back({{"scene", to_toml(scene)}, {"steps", run.steps}});
  }
  std::ofstream(dir_.file("runs.json")) << runs;
  drive({{"page", page_of({"cube-plane", "--steps", "1"})},
         {"runs", dir_.file("runs.json")},
         {"results", dir_.file("results.json")}});
  const json results = json::parse(dir_.read("results.json"));
  ASSERT_EQ(results.size(), known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    auto end = test::golden_end(known[i]);
    ASSERT_TRUE(end) << known[i].scene;
    const ModelSettings settings = known[i].settings();
    if (!settings.cloths.empty() || !settings.goal_nets.empty()) end = end_with_denormals(known[i]);
    EXPECT_EQ(results[i], json({end->step, end->hash})) << known[i].scene << ", " << name_of(known[i].method);
  }
}

TEST_P(LivePagesInBrowsers, ObeyTheReaderAndAskForNothing) {
  const std::string half = dir_.file("half.aspic");
  ASSERT_EQ(test::aspic({"run", "cube-bowl", "--steps", "200", "--checkpoint", half}).exit_code, 0);
  drive({{"pages",
          {page_of({"cube-plane", "--duration", "1.5", "--set", "cube[0].particles-per-edge=6"}),
           page_of({"--resume", half, "--duration", "0.5"}),
           page_of({"cube-plane", "--set", "cube[0].structural.stiffness=1e7"})}},
         {"touch", true}});
}

TEST_P(LivePagesInBrowsers, HaveSlidersOfInputs) {
  drive({{"pages",
          {page_of({"worm", "--duration", "0.2", "--set", "actuator[0].signal=input", "--set",
                    "actuator[0].name=legs"})}},
         {"inputs", {"legs"}}});
}

TEST_P(LivePagesInBrowsers, SimulateEveryBuiltInScene) {
  json pages = json::array();
  // A driver has two minutes.
  const auto drive_once = [&] {
    drive({{"pages", pages}});
    pages.clear();
  };
  for (const std::string& scene : test::builtin_scenes()) {
    std::vector<std::string> words = {scene, "--duration", "0.1"};
    if (scene == "large-cube") words.insert(words.end(), {"--set", "cube[0].particles-per-edge=16"});
    pages.push_back(page_of(words));
    if (pages.size() == 5) drive_once();
  }
  if (!pages.empty()) drive_once();
}

INSTANTIATE_TEST_SUITE_P(Both, LivePagesInBrowsers, testing::Values("chromium", "firefox"),
                         [](const auto& browser) { return browser.param; });

}  // namespace
}  // namespace aspic
