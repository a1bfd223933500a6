// Pictures that processes draw have the bytes of those that are drawn here, whatever a picture shows and
// whatever becomes of the processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "aspic/scene.h"
#include "cpu_reference/reference_solver.h"
#include "render/camera.h"
#include "render/overlay_text.h"
#include "run/arrows.h"
#include "run/comparison.h"
#include "run/film_painter.h"
#include "scene/follow.h"
#include "support/gl_fixture.h"

namespace aspic {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Words = std::vector<std::string>;
using Pictures = std::vector<std::vector<std::byte>>;

class MemorySink : public FrameSink {
 public:
  explicit MemorySink(Pictures& pictures) : pictures_(pictures) {}
  Status write(std::span<const std::byte> rgb) override {
    pictures_.emplace_back(rgb.begin(), rgb.end());
    return {};
  }
  Status finish() override { return {}; }
  const std::string& path() const override { return path_; }

 private:
  Pictures& pictures_;
  std::string path_ = "memory";
};

/// What is filmed: a picture every so many steps.
struct Take {
  std::string scene;
  Words set = {}, view = {};
  std::uint64_t first = 0, every = 20;
  int pictures = 7;
  Precision precision = Precision::single;
};

struct Actor {
  Scene scene;
  Model model;
  std::unique_ptr<Solver> solver;
  Following following;
};

std::unique_ptr<Actor> actor(const Take& take) {
  auto a = std::make_unique<Actor>();
  a->scene = with_view(load_scene(take.scene, take.set).value(), take.view).value();
  a->model = build_model(a->scene.model).value();
  a->solver = make_reference_solver(a->model, take.precision).value();
  a->following = Following(a->scene, a->model, take.precision);
  EXPECT_TRUE(a->solver->advance(take.first).ok());
  return a;
}

class FilmPainterTest : public aspic::testing::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (!context().info().is_software) GTEST_SKIP() << "hardware draws pictures in one process";
  }
  void TearDown() override {
    ::unsetenv("ASPIC_DRAWERS");
    GlTest::TearDown();
  }

  /// Films the takes side by side with so many processes; what was said of them goes to `said`.
  Pictures film(const std::vector<Take>& takes, const char* processes, const Words& drawer, std::string& said,
                PictureSize size = {160, 90}) {
    ::setenv("ASPIC_DRAWERS", processes, 1);
    std::vector<std::unique_ptr<Actor>> actors;
    std::vector<PaintedRun> runs;
    for (const Take& take : takes) {
      actors.push_back(actor(take));
      runs.push_back({&actors.back()->scene, &actors.back()->model});
    }
    const std::vector<Tile> tiles = tiles_of(size, runs.size());
    PictureOutput output;
    output.video = "film.mp4";
    output.size = size;
    output.drawer = drawer;
    Pictures pictures;
    std::vector<std::unique_ptr<FrameSink>> sinks;
    sinks.push_back(std::make_unique<MemorySink>(pictures));
    ::testing::internal::CaptureStderr();
    const auto painter = FilmPainter::create(context(), output, runs, 7, std::move(sinks));
    EXPECT_TRUE(painter.ok()) << painter.error().message();
    EXPECT_EQ((*painter)->times().processes, drawer.empty() ? 0 : std::stoul(processes));
    for (int f = 0; f < takes.front().pictures; ++f) {
      std::vector<State> copies;
      std::vector<ShownRun> shown;
      for (std::size_t i = 0; i < takes.size(); ++i) {
        Actor& a = *actors[i];
        const State& state = copies.emplace_back(a.solver->state().value());
        const ViewSettings& view = a.scene.view;
        ShownRun& s = shown.emplace_back();
        s.camera =
            fitted(moved(view.camera, a.following.offset(a.model, state)), tiles[i].width, tiles[i].height);
        s.text = overlay_lines(a.scene, 1e-3 * f);
        s.framed = takes.size() > 1;
        if (s.framed) s.tint = run_tint(i);
        if (view.arrows.any()) s.arrows = arrows_of(a.model, state, view.arrows);
        EXPECT_TRUE(a.solver->advance(takes[i].every).ok());
      }
      std::vector<PaintedState> states;
      for (const State& copy : copies) states.push_back({&copy, {}});
      const Status added = (*painter)->add(states, std::move(shown), f == 2 ? 2 : 1);
      EXPECT_TRUE(added.ok()) << added.error().message();
    }
    const Status finished = (*painter)->finish();
    EXPECT_TRUE(finished.ok()) << finished.error().message();
    said = ::testing::internal::GetCapturedStderr();
    return pictures;
  }

  /// The pictures of both ways are the same; those of processes come without a word.
  void expect_same(const std::vector<Take>& takes, const char* processes = "2") {
    std::string said;
    const Pictures here = film(takes, "0", {}, said);
    EXPECT_EQ(here.size(), static_cast<std::size_t>(takes.front().pictures) + 1);  // one twice
    EXPECT_NE(here.front(), here.back());
    EXPECT_TRUE(here == film(takes, processes, {ASPIC_DRAWER}, said)) << takes.front().scene;
    EXPECT_THAT(said, IsEmpty());
  }
};

const Words small_cube = {"cube[0].particles-per-edge=4"};

TEST_F(FilmPainterTest, TextAndColoursByStrain) {
  expect_same({{"cube-plane", small_cube, {"colour=strain", "scale.range=automatic"}, 1150}});
}

TEST_F(FilmPainterTest, ArrowsAndACameraThatFollows) {
  expect_same({{"cube-tilted-plane", small_cube, {"follow=cube", "arrows=[\"contacts\",\"net\"]"}, 500}});
}

TEST_F(FilmPainterTest, ACut) {
  expect_same({{"cube-sphere", small_cube, {"cut.inside=section", "colour=speed"}, 300}});
}

TEST_F(FilmPainterTest, DoublePrecisionAndSpringsAndAxes) {
  expect_same(
      {{.scene = "flag", .view = {"draw=[\"structural\"]", "axes=true"}, .precision = Precision::double_}});
}

TEST_F(FilmPainterTest, BallsTurnAsIfOneHadSeenThemAll) {
  expect_same({{.scene = "cube-and-balls", .every = 13, .pictures = 9}}, "3");
}

TEST_F(FilmPainterTest, RunsSideBySide) {
  const Words view = {"colour=strain", "scale.range=automatic"};
  expect_same(
      {{"cube-plane", small_cube, view, 1150},
       {"cube-plane", {"cube[0].particles-per-edge=4", "simulation.timestep=0.0005"}, view, 2300, 40}});
}

TEST_F(FilmPainterTest, ProcessesThatFailCostNoPicture) {
  const std::vector<Take> takes = {{.scene = "penalty", .every = 13}};
  std::string said;
  const Pictures here = film(takes, "0", {}, said);
  const std::string drawer = ASPIC_DRAWER;
  const std::pair<Words, const char*> ways[] = {
      {{"false"}, "ended with exit code 1"},
      {{"sh", "-c", "echo no such scene >&2; exit 6"}, "no such scene"},
      {{"sh", "-c", "echo ready; exit 0"}, "exit code 0"},
      {{"sh", "-c", "echo ready; echo done 77 0 0; exec sleep 100"}, "signal 9"},
      {{"sh", "-c", "kill -9 $$"}, "signal 9"},
      {{"sh", "-c", drawer + " | head -n 3"}, "process that draws pictures was lost"}};
  for (const auto& [command, words] : ways) {
    EXPECT_TRUE(here == film(takes, "2", command, said)) << command.back();
    EXPECT_THAT(said, HasSubstr(words)) << command.back();
    EXPECT_THAT(said, HasSubstr("drawn by this one")) << command.back();
  }
}

TEST_F(FilmPainterTest, ProgramsThatCannotStartAreNoProcesses) {
  ::setenv("ASPIC_DRAWERS", "2", 1);
  const auto a = actor({"cube-plane", small_cube});
  const DrawingWork work = {{"/no/such/program"}, {160, 90}, {{&a->scene, &a->model}}, 7};
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(Drawers::start(work, context().info().renderer, 2), nullptr);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(),
              HasSubstr("0 of 2 processes draw pictures: /no/such"));
}

TEST_F(FilmPainterTest, ProcessesAreWorthTheirStart) {
  const auto a = actor({"cube-plane", small_cube});
  DrawingWork work = {{"drawer"}, {1280, 720}, {{&a->scene, &a->model}}, 1};
  ::unsetenv("ASPIC_DRAWERS");
  EXPECT_EQ(drawers_for(work).value(), 0u);
  work.pictures = 1000000;
  const unsigned most = drawers_for(work).value();
  EXPECT_LE(most, std::thread::hardware_concurrency());
  work.size = {8, 8};
  EXPECT_LE(drawers_for(work).value(), most);
  work.command.clear();
  EXPECT_EQ(drawers_for(work).value(), 0u);
  work.command = {"drawer"};
  ::setenv("ASPIC_DRAWERS", "5", 1);
  EXPECT_EQ(drawers_for(work).value(), 5u);
  for (const char* wrong : {"x", "-1", "65", "2 "}) {
    ::setenv("ASPIC_DRAWERS", wrong, 1);
    ASSERT_FALSE(drawers_for(work).ok()) << wrong;
    EXPECT_EQ(drawers_for(work).error().code, ErrorCode::usage);
  }
}

}  // namespace
}  // namespace aspic
