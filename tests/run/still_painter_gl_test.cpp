// A single picture has the bytes of a film's, wherever the state is, and depends on nothing but it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "aspic/run.h"
#include "support/gl_fixture.h"
#include "support/value_of.h"

namespace aspic {
namespace {

using Picture = std::vector<std::byte>;
using Words = std::vector<std::string>;

class LastPicture : public FrameSink {
 public:
  explicit LastPicture(Picture& picture) : picture_(picture) {}
  Status write(std::span<const std::byte> rgb) override {
    picture_.assign(rgb.begin(), rgb.end());
    return {};
  }
  Status finish() override { return {}; }
  const std::string& path() const override { return path_; }

 private:
  Picture& picture_;
  std::string path_ = "memory";
};

constexpr PictureSize size = {160, 90};

struct Actor {
  explicit Actor(const std::string& name, const std::string& backend_word, const Words& view = {})
      : scene(with_view(load_scene(name).value(), view).value()),
        backend(test::value_of(
            make_backend(parse_backend(backend_word).value(), make_model(scene.model).value()))) {}
  void advance(std::uint64_t steps) { EXPECT_TRUE(backend.solver->advance(steps).ok()); }

  Scene scene;
  Backend backend;
};

/// The picture that a film would have of the state.
Picture filmed(Actor& run, std::uint64_t step) {
  Picture picture;
  std::vector<std::unique_ptr<FrameSink>> sinks;
  sinks.push_back(std::make_unique<LastPicture>(picture));
  PictureOutput output;
  output.frames = "frames";
  output.size = size;
  const auto recorder = Recorder::create(output, run.scene, run.backend, std::move(sinks), step, step);
  EXPECT_TRUE(recorder.ok()) << recorder.error().message();
  EXPECT_TRUE((*recorder)->finish(*run.backend.solver, step).ok());
  return picture;
}

Picture still(Actor& run, const ViewSettings& view) {
  const auto painter = StillPainter::create(run.scene, run.backend);
  EXPECT_TRUE(painter.ok()) << painter.error().message();
  auto picture = (*painter)->draw(view, size);
  EXPECT_TRUE(picture.ok()) << picture.error().message();
  return picture.value();
}

class StillPainterTest : public aspic::testing::GlTest {};

TEST_F(StillPainterTest, IsAFilmsPictureOnEveryBackend) {
  const Words view = {"arrows=[\"contacts\"]", "follow=\"cube[0]\"", "colour=strain"};
  Picture first;
  for (const char* const backend : {"cpu", "gpu"}) {
    Actor run("cube-tilted-plane", backend, view);
    run.advance(900);
    const Picture picture = still(run, run.scene.view);
    EXPECT_EQ(picture.size(), std::size_t{3} * 160 * 90);
    EXPECT_TRUE(picture == filmed(run, 900)) << backend;
    if (first.empty()) first = picture;
    EXPECT_TRUE(picture == first) << backend;
  }
}

TEST_F(StillPainterTest, DoesNotDependOnThePicturesBefore) {
  Actor run("cube-and-balls", "cpu");
  const auto painter = StillPainter::create(run.scene, run.backend);
  ASSERT_TRUE(painter.ok()) << painter.error().message();
  ViewSettings other = run.scene.view;
  other.colour = ViewColour::speed;
  ASSERT_TRUE((*painter)->draw(other, {64, 36}, false).ok());
  run.advance(150);
  const auto picture = (*painter)->draw(run.scene.view, size);
  ASSERT_TRUE(picture.ok()) << picture.error().message();
  EXPECT_TRUE(*picture == still(run, run.scene.view));
}

TEST_F(StillPainterTest, RefusesWhatIsTooLarge) {
  Actor run("cube-plane", "cpu");
  const auto painter = StillPainter::create(run.scene, run.backend);
  ASSERT_TRUE(painter.ok()) << painter.error().message();
  const auto picture = (*painter)->draw(run.scene.view, {1000000, 1000000});
  ASSERT_FALSE(picture.ok());
  EXPECT_EQ(picture.error().code, ErrorCode::scene_rejected) << picture.error().message();
  EXPECT_TRUE((*painter)->draw(run.scene.view, size).ok());
}

}  // namespace
}  // namespace aspic
