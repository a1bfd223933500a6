// The default view of every built-in scene as the window shows it, at its start and after some steps, without
// panels: byte for byte what the renderer draws by itself, which tests/render holds against golden images.
#include "app/stage.h"
#include "aspic/scene.h"
#include "render/read_back.h"
#include "scene/follow.h"

namespace aspic::test {
namespace {

struct View {
  std::string scene;
  int steps;
};

void PrintTo(const View& view, std::ostream* out) {
  *out << view.scene << " after " << view.steps << " steps";
}

const std::vector<View>& views() {
  // Far enough for all bodies to have moved and most to touch something.
  static const std::vector<View> all = {{"cube-plane", 1500},
                                        {"cube-tilted-plane", 1300},
                                        {"cube-sphere", 1000},
                                        {"cube-bowl", 1300},
                                        {"jelly-figure", 1500},
                                        {"large-cube", 2},
                                        {"goal-net", 300},
                                        {"penalty", 1080},
                                        {"cube-and-balls", 700},
                                        {"ball-pit", 1500},
                                        {"cube-torus", 1300},
                                        {"cube-hole", 1500},
                                        {"elevator", 1500},
                                        {"flag", 500},
                                        {"curtain", 500},
                                        {"bridge", 700},
                                        {"swing", 900},
                                        {"worm", 2000},
                                        {"walker", 2000},
                                        {"cubes-stack", 900},
                                        {"cubes-tower", 100},
                                        {"heap", 700},
                                        {"squeeze", 900},
                                        {"jelly-in-net", 900},
                                        {"knot", 1125},
                                        {"course-2021-plane", 1250},
                                        {"course-2021-tilted-plane", 1050},
                                        {"course-2021-sphere", 900},
                                        {"course-2021-bowl", 1200},
                                        {"course-2018", 700}};
  return all;
}

class Views : public Stage, public ::testing::WithParamInterface<View> {
 protected:
  std::array<int, 2> window_size() const override { return {480, 270}; }
  bool full_quality() const override { return true; }  // whatever the time images take

  /// The same moment by a renderer of our own.
  Image drawn() {
    if (!renderer_) {
      auto made = Renderer::create(context());
      EXPECT_TRUE(made.ok()) << made.error().message();
      renderer_ = std::move(*made);
      EXPECT_TRUE(renderer_->set_model(simulation().model()).ok());
    }
    const Scene& scene = app().scene.editor().scene();
    const Following following(scene, simulation().model(), Precision::single);
    ImageOptions options;
    options.view = scene.view;
    options.view.camera =
        moved(scene.view.camera, following.offset(simulation().model(), simulation().snapshot()));
    return draw(context(), *renderer_, simulation().snapshot(), options, window_size()[0], window_size()[1]);
  }
  void TearDown() override {
    renderer_.reset();
    Stage::TearDown();
  }

 private:
  std::unique_ptr<Renderer> renderer_;
};

TEST_P(Views, AreTheRenderersImages) {
  const View& view = GetParam();
  open(view.scene, {}, "reference");
  app().messages.dismiss();  // warnings of the scene
  press(GLFW_KEY_TAB);
  frames(30);
  const Image start = image();
  EXPECT_EQ(start.rgb, drawn().rgb);
  // Step by step and without images on the way: balls turn from one image to the next.
  for (int i = 0; i < view.steps; ++i) type(U'.');
  ASSERT_TRUE(simulation().settle().ok());  // a large cube steps beside the images
  ASSERT_EQ(simulation().step(), static_cast<std::uint64_t>(view.steps));
  EXPECT_FALSE(app().messages.notice().has_value()) << app().messages.notice()->text;
  frames(30);
  const Image end = image();
  EXPECT_NE(end.rgb, start.rgb);
  EXPECT_EQ(end.rgb, drawn().rgb);
}

INSTANTIATE_TEST_SUITE_P(Views, Views, ::testing::ValuesIn(views()),
                         [](const ::testing::TestParamInfo<View>& view) {
                           std::string name = view.param.scene;
                           std::erase(name, '-');
                           return name;
                         });

TEST(ViewList, HasEveryBuiltInScene) {
  std::vector<std::string_view> seen, golden, scenes;
  for (const BuiltinScene& scene : list_builtin_scenes()) {
    scenes.push_back(scene.name);
    for (const View& view : views())
      if (view.scene == scene.name) seen.push_back(scene.name);
    if (std::filesystem::exists(std::string(ASPIC_GOLDEN) + "/" + std::string(scene.name) + ".png"))
      golden.push_back(scene.name);
  }
  EXPECT_EQ(seen, scenes);
  EXPECT_EQ(golden, scenes);
}

}  // namespace
}  // namespace aspic::test
