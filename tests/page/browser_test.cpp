// Pages in Chromium and Firefox, on software rasterizers: golden images, keys, mouse, no error, no request.
// To take new images as golden: ASPIC_UPDATE_GOLDEN=1 build/release/tests/page/page_browser_tests, then
// look at tests/golden/page-*.png before committing them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "cli/process.h"
#include "page/builtin_scenes.h"
#include "support/image_comparison.h"

namespace aspic {
namespace {

struct Shot {
  std::string scene, time;  // [s]
  std::vector<std::string> more = {};
  std::string name = {};
  std::string golden() const { return "page-" + (name.empty() ? scene : name); }
};

/// Writes pages that end at their times, and shows them in a browser.
void expect_shown(const std::string& browser, const std::vector<Shot>& shots, bool touch) {
  test::TemporaryDirectory directory;
  nlohmann::json jobs;
  for (const Shot& shot : shots) {
    const std::string page = directory.file(shot.golden() + ".html");
    std::vector<std::string> words = {"run", shot.scene, "--duration", shot.time, "--html", page};
    words.insert(words.end(), shot.more.begin(), shot.more.end());
    const auto run = test::aspic(words);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    jobs.push_back({{"page", page},
                    {"time", std::stod(shot.time)},
                    {"image", directory.file(shot.golden() + ".png")},
                    {"touch", touch}});
  }
  test::ProcessOptions python;
  python.program = ASPIC_PYTHON;
  python.environment = {{"PYTHONDONTWRITEBYTECODE", "1"}};
  const auto driven = test::aspic({ASPIC_DRIVE, browser, jobs.dump()}, python);
  EXPECT_EQ(driven.exit_code, 0) << driven.out << driven.err;
  for (const Shot& shot : shots) {
    SCOPED_TRACE(browser);
    const test::Image image = test::read_image(directory.file(shot.golden() + ".png"));
    ASSERT_GT(image.width, 0) << shot.golden();
    test::expect_golden(image, shot.golden());
  }
}

TEST(PageInBrowsers, ShowsARunAndObeysTheReader) {
  expect_shown("chromium", {{"cube-plane", "1.5"}}, true);
}

TEST(EveryPageInBrowsersObeys, InFirefoxToo) {
  expect_shown("firefox", {{"cube-plane", "1.5"}}, true);
}

/// Every built-in scene, and looks of some.
std::vector<Shot> all_shots() {
  const std::string differences = "camera={position=[10,5,14],target=[0,2.4,0],fov=45}";
  const std::vector<Shot> shots = {
      {"cube-tilted-plane", "1.3"},
      {"cube-sphere", "1"},
      {"cube-bowl", "1.3"},
      {"cube-torus", "1.2"},
      {"cube-hole", "1.5"},
      {"elevator", "2.6"},
      {"large-cube", "0.01"},
      {"goal-net", "0.3"},
      {"penalty", "1.08"},
      {"cube-and-balls", "0.7"},
      {"ball-pit", "0.8"},
      {"flag", "2.4"},
      {"curtain", "1"},
      {"bridge", "0.7"},
      {"swing", "0.45"},
      {"jelly-figure", "1.5"},
      {"worm", "2.2"},
      {"walker", "2.1"},
      {"cubes-stack", "1"},
      {"cubes-tower", "0.1"},
      {"heap", "1.3"},
      {"squeeze", "1.9"},
      {"jelly-in-net", "1"},
      {"knot", "5"},
      {"course-2021-plane", "1.25"},
      {"course-2021-tilted-plane", "1.05"},
      {"course-2021-sphere", "0.9"},
      {"course-2021-bowl", "1.2"},
      {"course-2018", "1.08"},
      {"cube-plane", "1.4", {"--view", "color=strain"}, "strain"},
      {"flag",
       "2.4",
       {"--view", "color=strain", "--view", "draw=[\"solid\", \"structural\"]"},
       "flag-strain"},
      {"cube-plane",
       "1.5",
       {"--view", "draw=[\"particles\", \"shear\"]", "--view", "camera.projection=orthographic", "--set",
        "cube[0].particles-per-edge=4"},
       "springs"},
      {"cube-plane",
       "1.5",
       {"--variant", "integrator=implicit-euler", "--variant", "k=8000", "--view", differences},
       "beside"}};
  return shots;
}

TEST(EveryPage, OfTheBuiltInScenesHasAnImage) {
  std::set<std::string> shown = {"cube-plane"};
  for (const Shot& shot : all_shots())
    if (shot.name.empty()) shown.insert(shot.scene);
  EXPECT_EQ(shown, test::builtin_scenes()) << "name a moment of each in all_shots()";
}

class EveryPageInBrowsers : public testing::TestWithParam<std::string> {};
TEST_P(EveryPageInBrowsers, ShowsEveryScene) {
  const std::vector<Shot> shots = all_shots();
  std::vector<Shot> some;
  for (const Shot& shot : shots) {
    some.push_back(shot);
    if (some.size() < 5 && &shot != &shots.back()) continue;
    expect_shown(GetParam(), some, false);  // a driver has two minutes
    some.clear();
  }
}
INSTANTIATE_TEST_SUITE_P(Both, EveryPageInBrowsers, testing::Values("chromium", "firefox"),
                         [](const auto& browser) { return browser.param; });

}  // namespace
}  // namespace aspic
