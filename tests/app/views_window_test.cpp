// The default view of every built-in scene as the window shows it, at its start and after some steps, without
// panels. To take new pictures as golden: run this suite with ASPIC_UPDATE_GOLDEN=1, then look at
// tests/golden/window/*.png before committing them.
#include "app/stage.h"
#include "scene/load.h"

namespace aspic::test {
namespace {

struct View {
  std::string scene;
  int steps;
};

void PrintTo(const View& view, std::ostream* out) {
  *out << view.scene << " after " << view.steps << " steps";
}

class Views : public Stage, public ::testing::WithParamInterface<View> {
 protected:
  std::array<int, 2> window_size() const override { return {640, 360}; }
  bool full_quality() const override { return true; }  // whatever the time pictures take
};

TEST_P(Views, AreAsTheyWere) {
  const View& view = GetParam();
  open(view.scene, {}, "reference");
  press(GLFW_KEY_TAB);
  // Long enough for the full resolution.
  frames(30);
  expect_golden(image(), "window/" + view.scene + "-start");
  // Step by step and without pictures on the way: balls turn from one picture to the next.
  for (int i = 0; i < view.steps; ++i) type(U'.');
  ASSERT_TRUE(simulation().settle().ok());  // a large cube steps beside the pictures
  ASSERT_EQ(simulation().step(), static_cast<std::uint64_t>(view.steps));
  EXPECT_FALSE(app().messages.notice().has_value()) << app().messages.notice()->text;
  frames(30);
  expect_golden(image(), "window/" + view.scene);
}

INSTANTIATE_TEST_SUITE_P(Views, Views,
                         ::testing::Values(View{"cube-plane", 1500}, View{"cube-tilted-plane", 1300},
                                           View{"cube-sphere", 1000}, View{"cube-bowl", 1300},
                                           View{"large-cube", 2}, View{"goal-net", 300},
                                           View{"penalty", 1080}, View{"cube-and-balls", 700},
                                           View{"ball-pit", 1500}, View{"cube-torus", 1300},
                                           View{"cube-hole", 1500}, View{"elevator", 1500}, View{"flag", 500},
                                           View{"curtain", 500}),
                         [](const ::testing::TestParamInfo<View>& view) {
                           std::string name = view.param.scene;
                           std::erase(name, '-');
                           return name;
                         });

TEST(ViewList, HasEveryBuiltInScene) {
  std::vector<std::string> missing;
  for (const BuiltinScene& scene : list_builtin_scenes())
    if (!std::filesystem::exists(std::string(ASPIC_GOLDEN) + "/window/" + std::string(scene.name) + ".png"))
      missing.emplace_back(scene.name);
  EXPECT_EQ(missing, std::vector<std::string>());
}

}  // namespace
}  // namespace aspic::test
