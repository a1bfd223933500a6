// A single image has the bytes of a video's, wherever the state is, and depends on nothing but it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "aspic/run.h"
#include "support/gl_fixture.h"
#include "support/value_of.h"

namespace aspic {
namespace {

using Image = std::vector<std::byte>;
using Words = std::vector<std::string>;

class LastImage : public FrameSink {
 public:
  explicit LastImage(Image& image) : image_(image) {}
  Status write(std::span<const std::byte> rgb) override {
    image_.assign(rgb.begin(), rgb.end());
    return {};
  }
  Status finish() override { return {}; }
  const std::string& path() const override { return path_; }

 private:
  Image& image_;
  std::string path_ = "memory";
};

constexpr ImageSize size = {160, 90};

struct Actor {
  explicit Actor(const std::string& name, const std::string& backend_word, const Words& view = {})
      : scene(with_view(load_scene(name).value(), view).value()),
        backend(test::value_of(
            make_backend(parse_backend(backend_word).value(), make_model(scene.model).value()))) {}
  void advance(std::uint64_t steps) { EXPECT_TRUE(backend.solver->advance(steps).ok()); }

  Scene scene;
  Backend backend;
};

/// The image that a video would have of the state.
Image recorded(Actor& run, std::uint64_t step) {
  Image image;
  std::vector<std::unique_ptr<FrameSink>> sinks;
  sinks.push_back(std::make_unique<LastImage>(image));
  ImageOutput output;
  output.frames = "frames";
  output.size = size;
  const auto recorder = Recorder::create(output, run.scene, run.backend, std::move(sinks), step, step);
  EXPECT_TRUE(recorder.ok()) << recorder.error().message();
  EXPECT_TRUE((*recorder)->finish(*run.backend.solver, step).ok());
  return image;
}

Image still(Actor& run, const ViewSettings& view) {
  const auto painter = StillPainter::create(run.scene, run.backend);
  EXPECT_TRUE(painter.ok()) << painter.error().message();
  auto image = (*painter)->draw(view, size);
  EXPECT_TRUE(image.ok()) << image.error().message();
  return image.value();
}

class StillPainterTest : public aspic::testing::GlTest {};

TEST_F(StillPainterTest, IsAVideosImageOnEveryBackend) {
  const Words view = {"arrows=[\"contacts\"]", "follow=\"cube[0]\"", "color=strain"};
  Image first;
  for (const char* const backend : {"cpu", "gpu"}) {
    Actor run("cube-tilted-plane", backend, view);
    run.advance(900);
    const Image image = still(run, run.scene.view);
    EXPECT_EQ(image.size(), std::size_t{3} * 160 * 90);
    EXPECT_TRUE(image == recorded(run, 900)) << backend;
    if (first.empty()) first = image;
    EXPECT_TRUE(image == first) << backend;
  }
}

TEST_F(StillPainterTest, DoesNotDependOnTheImagesBefore) {
  Actor run("cube-and-balls", "cpu");
  const auto painter = StillPainter::create(run.scene, run.backend);
  ASSERT_TRUE(painter.ok()) << painter.error().message();
  ViewSettings other = run.scene.view;
  other.color = ViewColor::speed;
  ASSERT_TRUE((*painter)->draw(other, {64, 36}, false).ok());
  run.advance(150);
  const auto image = (*painter)->draw(run.scene.view, size);
  ASSERT_TRUE(image.ok()) << image.error().message();
  EXPECT_TRUE(*image == still(run, run.scene.view));
}

TEST_F(StillPainterTest, RefusesWhatIsTooLarge) {
  Actor run("cube-plane", "cpu");
  const auto painter = StillPainter::create(run.scene, run.backend);
  ASSERT_TRUE(painter.ok()) << painter.error().message();
  const auto image = (*painter)->draw(run.scene.view, {1000000, 1000000});
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().code, ErrorCode::scene_rejected) << image.error().message();
  EXPECT_TRUE((*painter)->draw(run.scene.view, size).ok());
}

}  // namespace
}  // namespace aspic
