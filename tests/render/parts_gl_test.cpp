// Images that are drawn in parts, with other work between.
#include <gtest/gtest.h>

#include "aspic/scene.h"
#include "render/studio.h"

namespace aspic {
namespace {

struct ClosestPoint {
  std::string scene;
  std::uint64_t step;
  std::vector<std::string> overrides = {};
};

void PrintTo(const ClosestPoint& sight, std::ostream* out) {
  *out << sight.scene << " at step " << sight.step;
  for (const std::string& set : sight.overrides) *out << ", " << set;
}

class Parts : public test::Studio, public ::testing::WithParamInterface<ClosestPoint> {
 protected:
  static constexpr int width = 322, height = 181;

  void SetUp() override {
    Studio::SetUp();
    const ClosestPoint& sight = GetParam();
    auto scene = load_scene(sight.scene, sight.overrides);
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    options.view = scene->view;
    model = test::build(scene->model);
    state = test::after(model, sight.step);
    ASSERT_TRUE(renderer().set_model(model).ok());
  }

  DeviceState uploaded() {
    const auto there = renderer().upload(state);
    EXPECT_TRUE(there.ok());
    return *there;
  }

  Model model;
  State state;
  ImageOptions options;
};

TEST_P(Parts, MakeTheSameImageWhateverIsDrawnBetweenThem) {
  auto made = Renderer::create(context());
  ASSERT_TRUE(made.ok());
  Renderer& other = **made;
  const auto other_scene = load_scene("cube-and-balls");
  ASSERT_TRUE(other_scene.ok());
  const Model other_model = test::build(other_scene->model);
  ASSERT_TRUE(other.set_model(other_model).ok());
  ImageOptions other_options;
  other_options.view = other_scene->view;
  const auto other_state = other.upload(initial_state(other_model, Precision::single));
  ASSERT_TRUE(other_state.ok());

  ASSERT_TRUE(renderer().draw(width, height, uploaded(), options).ok());
  const std::vector<std::byte> whole = read();
  ImageOptions coarse = options;
  coarse.samples = 1;
  // The first fine image is drawn whole, the second from what is kept of the surroundings.
  for (int time = 0; time < 2; ++time) {
    if (time == 0) {
      ASSERT_TRUE(renderer().set_model(model).ok());
    }
    ASSERT_TRUE(renderer().draw(100, 60, uploaded(), coarse).ok());
    if (time == 1) {
      ASSERT_TRUE(renderer().draw(width, height, uploaded(), options).ok());
    }
    const std::vector<std::byte> before = read();
    ASSERT_TRUE(renderer().begin(width, height, uploaded(), options).ok());
    for (int parts = 1;; ++parts) {
      EXPECT_EQ(read(), before) << "shown until the other is finished";
      const auto finished = renderer().proceed();
      ASSERT_TRUE(finished.ok()) << finished.error().message();
      if (*finished) break;
      ASSERT_LT(parts, 1000);
      ASSERT_TRUE(other.draw(80, 50, *other_state, other_options).ok());
      renderer().present(other.image().id(), 40, 20);
    }
    EXPECT_EQ(read(), whole) << "time " << time;
  }
}

TEST_P(Parts, AreGivenUpForAnotherImage) {
  ASSERT_TRUE(renderer().draw(width, height, uploaded(), options).ok());
  const std::vector<std::byte> whole = read();
  ASSERT_TRUE(renderer().begin(2 * width, height, uploaded(), options).ok());
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(renderer().proceed().ok());
  ASSERT_TRUE(renderer().draw(width, height, uploaded(), options).ok());
  EXPECT_EQ(read(), whole);
  ASSERT_TRUE(renderer().begin(2 * width, height, uploaded(), options).ok());
  ASSERT_TRUE(renderer().proceed().ok());
  ASSERT_TRUE(renderer().set_model(model).ok());
  EXPECT_EQ(read(), whole);
}

INSTANTIATE_TEST_SUITE_P(
    Images, Parts,
    ::testing::Values(
        ClosestPoint{"cube-plane", 1300}, ClosestPoint{"cube-bowl", 1200}, ClosestPoint{"goal-net", 250},
        ClosestPoint{"flag", 200}, ClosestPoint{"ball-pit", 500},
        ClosestPoint{"cube-plane", 1300, {"view.color=strain", "view.scale.range=automatic"}},
        ClosestPoint{
            "cube-sphere", 900, {"view.cut.inside=springs", "view.ground=0.0", "view.arrows=[\"contacts\"]"}},
        ClosestPoint{
            "large-cube", 0, {"cube[0].particles-per-edge=20", "view.draw=[\"particles\", \"structural\"]"}}),
    [](const auto& about) { return "ClosestPoint" + std::to_string(about.index); });

}  // namespace
}  // namespace aspic
