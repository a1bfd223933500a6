// What stands still is drawn once: images are the same bytes as if everything were drawn anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "aspic/scene.h"
#include "device/particles.h"
#include "render/moving_part.h"
#include "render/studio.h"

namespace aspic {
namespace {

/// Two renderers of the same images: one may keep what stands still, and the other has just looked
/// elsewhere.
class BackdropGl : public test::Studio {
 protected:
  void SetUp() override {
    Studio::SetUp();
    auto cold = Renderer::create(context());
    ASSERT_TRUE(cold.ok()) << cold.error().message();
    cold_ = std::move(*cold);
  }
  void TearDown() override {
    cold_.reset();
    Studio::TearDown();
  }

  void show(const Model& model) {
    model_ = &model;
    ASSERT_TRUE(renderer().set_model(model).ok());
    ASSERT_TRUE(cold_->set_model(model).ok());
  }

  std::vector<std::byte> image(Renderer& by, const State& state, const ImageOptions& options) {
    const auto uploaded = by.upload(state);
    EXPECT_TRUE(uploaded.ok());
    const Status drawn = by.draw(width_, height_, *uploaded, options);
    EXPECT_TRUE(drawn.ok()) << (drawn.ok() ? "" : drawn.error().message());
    return read(by);
  }

  /// Three images in a row, so that the second draws the backdrop and the third finds it.
  void expect_same(const ImageOptions& options, const char* what) {
    ImageOptions elsewhere = options;
    elsewhere.view.camera.position.x += 0.5;
    for (int n = 0; n < 3; ++n) {
      const State state = moved(n);
      const auto warm = image(renderer(), state, options);
      image(*cold_, state, elsewhere);
      const auto cold = image(*cold_, state, options);
      ASSERT_EQ(warm.size(), cold.size());
      std::size_t different = 0;
      for (std::size_t i = 0; i < warm.size(); ++i) different += warm[i] != cold[i] ? 1 : 0;
      EXPECT_EQ(different, 0u) << what << ", image " << n;
    }
  }

  /// The start, a little further to the side each time and leaning; balls among it.
  State moved(int n) const {
    State state = initial_state(*model_, Precision::single);
    state.step = step_;
    const auto shift = [&](Vec3& x) {
      x = x + Vec3{0.21 * n + 0.05 * n * x.y, -0.17 * n, 0.13 * n};
      for (double* c : {&x.x, &x.y, &x.z}) *c = static_cast<double>(static_cast<float>(*c));
    };
    for (Vec3& x : state.position) shift(x);
    for (Vec3& x : state.ball_position) shift(x);
    return state;
  }

  const Model* model_ = nullptr;
  std::unique_ptr<Renderer> cold_;
  int width_ = 320, height_ = 180;
  std::uint64_t step_ = 0;
};

class BackdropOfScene : public BackdropGl, public ::testing::WithParamInterface<const char*> {};

TEST_P(BackdropOfScene, ChangesNoByte) {
  const auto scene = load_scene(GetParam(), {});
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  const Model model = test::build(scene->model);
  show(model);
  ImageOptions options;
  options.view = scene->view;
  step_ = 3000;  // balls have been launched, and a lift has moved
  expect_same(options, "as the scene is shown");
  options.view.draw.particles = options.view.draw.structural = true;
  expect_same(options, "with springs");
}

INSTANTIATE_TEST_SUITE_P(Scenes, BackdropOfScene,
                         ::testing::Values("cube-plane", "cube-tilted-plane", "cube-sphere", "cube-bowl",
                                           "jelly-figure", "cube-torus", "cube-hole", "elevator", "goal-net",
                                           "penalty", "cube-and-balls", "ball-pit", "flag", "curtain",
                                           "bridge", "swing"),
                         [](const ::testing::TestParamInfo<const char*>& scene) {
                           std::string name = scene.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST_F(BackdropGl, NoChangeIsMissed) {
  const auto scene = load_scene("cube-plane", {});
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  const Model model = test::build(scene->model);
  show(model);
  ImageOptions options;
  options.view = scene->view;
  expect_same(options, "at first");
  const std::pair<const char*, std::function<void()>> changes[] = {
      {"camera", [&] { options.view.camera.position.y += 2.0; }},
      {"angle of view", [&] { options.view.camera.fov *= 0.8; }},
      {"from below", [&] { options.view.camera.position.y = -4.0; }},
      {"from above again", [&] { options.view.camera.position.y = 4.0; }},
      {"size", [&] { width_ = 321, height_ = 203; }},
      {"samples", [&] { options.samples = 1; }},
      {"all samples", [&] { options.samples = 0; }},
      {"shadows", [&] { options.shadows = false; }},
      {"shadows again", [&] { options.shadows = true; }},
      {"springs", [&] { options.view.draw.shear = true; }},
      {"nothing", [&] { options.view.draw = {.solid = false}; }},
      {"bodies again", [&] { options.view.draw = scene->view.draw; }},
      {"strain", [&] { options.view.color = ViewColor::strain; }},
      {"text",
       [&] {
         options.text = {{"a", "b"}};
       }},
      {"background",
       [&] {
         options.background = Color{0.2f, 0.3f, 0.1f};
       }},
      {"none", [&] { options.background.reset(); }},
      {"pull",
       [&] {
         options.highlight = HighlightOptions{.pull = {{5, {-3.0, 4.0, 1.0}}}};
       }},
      {"ring", [&] { options.highlight = HighlightOptions{.hovered = 3, .unit = 3.0}; }},
      {"eye within the body", [&] {
         options.view.camera.position = moved(0).position[0] + Vec3{0.2, 0.2, 0.2};
       }}};
  for (const auto& [what, change] : changes) {
    change();
    expect_same(options, what);
  }
}

/// Light maps and what else depends on the state alone are kept while nothing moves: the camera and the look
/// may change, and the images are those of a renderer that has just drawn another state.
TEST_F(BackdropGl, StillLightChangesNoByte) {
  const auto scene = load_scene("cube-and-balls", {});
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  const Model model = test::build(scene->model);
  show(model);
  ImageOptions options;
  options.view = scene->view;
  step_ = 3000;
  State state = moved(0);
  const auto expect_same_light = [&](const char* what) {
    for (int n = 0; n < 2; ++n) {
      options.view.camera.position.x += 0.3;
      const auto warm = image(renderer(), state, options);
      image(*cold_, moved(2), options);
      EXPECT_TRUE(image(*cold_, state, options) == warm) << what << ", image " << n;
    }
  };
  expect_same_light("at first");
  const std::pair<const char*, std::function<void()>> changes[] = {
      {"springs", [&] { options.view.draw.shear = true; }},
      {"particles", [&] { options.view.draw = {.solid = false, .particles = true}; }},
      {"bodies again", [&] { options.view.draw = scene->view.draw; }},
      {"coarse skin", [&] { options.coarse_skin = true; }},
      {"fine skin", [&] { options.coarse_skin = false; }},
      {"cut", [&] { options.view.cut.inside = CutInside::springs; }},
      {"cut elsewhere", [&] { options.view.cut.offset = 0.4; }},
      {"whole", [&] { options.view.cut = {}; }},
      {"strain", [&] { options.view.color = ViewColor::strain; }},
      {"one particle", [&] { state.position.back().y += 0.25; }},
      {"one ball", [&] { state.ball_position.front().x += 0.5; }},
      {"another state without shadows",
       [&] {
         options.shadows = false;
         image(renderer(), moved(1), options);
         options.shadows = true;
       }},
      {"another state from elsewhere, then the same", [&] {
         image(renderer(), moved(1), options);
         image(renderer(), state, options);
       }}};
  for (const auto& [what, change] : changes) {
    change();
    expect_same_light(what);
  }
}

TEST_F(BackdropGl, StillLightIsNotDrawnAgain) {
  const auto scene = load_scene("cube-plane", {});
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  const Model model = test::build(scene->model);
  show(model);
  ImageOptions options;
  options.view = scene->view;
  const auto draws_maps = [&](const State& state) {
    options.view.camera.position.x += 0.3;
    renderer().set_profiling(true);
    image(renderer(), state, options);
    const auto passes = renderer().pass_times();
    renderer().set_profiling(false);
    return std::ranges::any_of(passes, [](const gl::PassTime& pass) { return pass.name == "light maps"; });
  };
  EXPECT_TRUE(draws_maps(moved(0)));
  EXPECT_FALSE(draws_maps(moved(0)));
  EXPECT_TRUE(draws_maps(moved(1)));
}

TEST_F(BackdropGl, AnotherModelHasItsOwn) {
  for (const char* name : {"cube-plane", "cube-tilted-plane", "cube-plane"}) {
    auto scene = load_scene(name, {});
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    const Model model = test::build(scene->model);
    show(model);
    ImageOptions options;
    options.view.camera = {};  // the same for all
    expect_same(options, name);
  }
}

/// What is drawn outside the boxes would be lost, so they must hold every pixel in which an image with
/// bodies differs from one without.
TEST_F(BackdropGl, BoxesHoldEverySeenParticle) {
  const auto scene = load_scene("cube-plane", {});
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  const Model model = test::build(scene->model);
  show(model);
  ImageOptions options;
  options.view = scene->view;
  ImageOptions empty = options;
  empty.view.draw = {.solid = false};
  options.shadows = empty.shadows = false;
  const State state = moved(1);
  const auto with = image(renderer(), state, options), without = image(*cold_, state, empty);
  const Camera camera(options.view.camera, width_, height_);
  render_layout::Frame frame = {};
  frame.view_projection = camera.projection() * camera.view();
  frame.projection = camera.projection();
  frame.viewport = glm::vec4(width_, height_, 0, 0);
  frame.eye = glm::vec4(camera.eye(), camera.target_distance());
  const auto particles = packed_particles(model, state);
  MovingThings things;
  things.particles = particles;
  things.margin = 4.0;
  const auto boxes = moving_part(frame, things);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_LT(boxes[0].area(), width_ * height_ / 4);
  int seen = 0;
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      const auto at = 3 * static_cast<std::size_t>(row * width_ + column);
      if (std::equal(&with[at], &with[at] + 3, &without[at])) continue;
      ++seen;
      const int up = height_ - 1 - row;
      EXPECT_TRUE(column >= boxes[0].left && column < boxes[0].right && up >= boxes[0].bottom &&
                  up < boxes[0].top)
          << column << ", " << row;
    }
  }
  EXPECT_GT(seen, 100);
}

}  // namespace
}  // namespace aspic
