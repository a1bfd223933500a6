// Runs side by side in the real window.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "app/stage.h"
#include "cpu_reference/reference_solver.h"
#include "io/atomic_file.h"
#include "io/state_sink.h"
#include "render/read_back.h"
#include "render/tiles.h"
#include "scene/follow.h"
#include "support/projection.h"
#include "support/state_csv_reader.h"

namespace aspic::test {
namespace {

using testing::HasSubstr;

class Comparison : public Stage {
 protected:
  aspic::Comparison& comparison() { return app().comparison; }
  app::ComparisonView& comparison_view() { return app().comparison_view; }
  const PlaybackSession& run(std::size_t i) { return comparison().run(i); }
  void settled() {
    frames(1);
    frames_until([&] { return comparison().settled(); });
  }
  /// A run compared with the scene's own, whatever suggests itself replaced by this.
  void compare(const Difference& difference) {
    press(GLFW_KEY_B, GLFW_MOD_CONTROL);
    frames(1);
    ASSERT_EQ(comparison().count(), 2u);
    comparison_view().set(1, difference);
    settled();
    ASSERT_EQ(comparison().count(), 2u);
  }
  void run_to(std::uint64_t step) {
    simulation().set_running(true);
    frames_to_step(step);
    simulation().set_running(false);
    settled();
  }
  std::string hash(std::size_t i) { return state_hash_text(run(i).snapshot()); }
  /// The state of a run as the reference alone comes to it.
  std::string hash_alone(std::size_t i) {
    Scene scene = app().scene.scene();
    scene.model = run(i).present().setup().settings;
    return reference_hash(scene, run(i).step());
  }
  static app::KeptState only_recording() {
    app::KeptState kept;
    for (const char* name : {"View", "Energy"}) kept.layout.sections[name] = false;
    kept.layout.sections["Recording"] = true;
    return kept;
  }
  std::string error() {
    const auto& notice = app().messages.notice();
    return notice && notice->is_error ? notice->text : std::string();
  }
  static constexpr const char* small = "cube[0].particles-per-edge=4";
  static constexpr const char* low = "cube[0].position=[0,1.2,0]";
};

TEST_F(Comparison, ARunIsAddedAndLeftAndComesBackByUndo) {
  open("cube-plane", {small});
  run_to(20);
  EXPECT_FALSE(has("comparison/0/label"));
  press(GLFW_KEY_B, GLFW_MOD_CONTROL);
  settled();
  frames(1);
  ASSERT_EQ(comparison().count(), 2u);
  EXPECT_EQ(simulation().step(), 0u) << "all runs start anew";
  EXPECT_EQ(run(1).present().setup().settings.simulation.integrator, Integrator::implicit_euler);
  EXPECT_TRUE(has("comparison/0/label"));
  EXPECT_TRUE(has("comparison/1/label"));
  const auto& boxes = comparison_view().boxes();
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_DOUBLE_EQ(boxes[0].right - boxes[0].left, boxes[1].right - boxes[1].left);
  EXPECT_TRUE(boxes[0].right < boxes[1].left || boxes[0].bottom < boxes[1].top);
  EXPECT_EQ(app().view.box, boxes[0]);
  press(GLFW_KEY_B, GLFW_MOD_CONTROL);
  press(GLFW_KEY_B, GLFW_MOD_CONTROL);
  settled();
  EXPECT_EQ(comparison().count(), 4u);
  press(GLFW_KEY_B, GLFW_MOD_CONTROL);
  EXPECT_THAT(error(), HasSubstr("4 runs"));
  frames(30, 0.3);
  EXPECT_EQ(error(), "") << "there is nothing to decide";
  press(GLFW_KEY_B, GLFW_MOD_CONTROL);
  EXPECT_THAT(error(), HasSubstr("4 runs"));
  press(GLFW_KEY_B, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
  frames(2);
  EXPECT_EQ(error(), "") << "there is room again";
  EXPECT_EQ(comparison().count(), 1u);
  EXPECT_FALSE(has("comparison/0/label"));
  app().scene.undo();
  settled();
  EXPECT_EQ(comparison().count(), 4u);
}

TEST_F(Comparison, EachRunHasTheBitsOfTheRunAloneAtTheSameTime) {
  open("cube-plane", {small, low});
  compare({"h", "0.0013"});
  simulation().set_running(true);
  int images = 0;
  double last = 0.0;
  frames_until([&] {
    EXPECT_NEAR(comparison().shown_time(1), comparison().shown_time(0), 0.5 * 0.0013 * (1.0 + 1e-9));
    EXPECT_GE(comparison().shown_time(0), last);
    if (comparison().shown_time(0) > last) ++images;
    last = comparison().shown_time(0);
    return last > 0.3;
  });
  EXPECT_GT(images, 2);
  simulation().set_running(false);
  settled();
  EXPECT_EQ(hash(0), hash_alone(0));
  EXPECT_EQ(hash(1), hash_alone(1));
  EXPECT_NEAR(run(1).time(), run(0).time(), 0.5 * 0.0013 * (1.0 + 1e-9));
}

TEST_F(Comparison, EachImageFollowsItsOwnRunsBody) {
  open("cube-plane", {small, "view.follow=cube"});
  compare({"simulation.gravity", "[0,-3,0]"});
  run_to(300);
  frames(1);
  const auto moved = [&](std::size_t i) {
    const auto place = [&](const State& state) { return place_of(run(i).model(), state, {false, 0}); };
    return place(run(i).snapshot()) - place(initial_state(run(i).model(), Precision::single));
  };
  EXPECT_LT(moved(0).y, 2.0 * moved(1).y) << "both fall, the first three times as far";
  EXPECT_EQ(app().view.offset(), moved(0));
  ASSERT_EQ(app().view.others.size(), 1u);
  EXPECT_EQ(app().view.others[0].offset, moved(1));
  // What the middles of both images show lies as far apart.
  const auto& boxes = comparison_view().boxes();
  const Vec3 first = app().view.sight(boxes[0].center_x(), boxes[0].center_y()).origin;
  const Vec3 second = app().view.sight(boxes[1].center_x(), boxes[1].center_y()).origin;
  EXPECT_NEAR(second.y - first.y, moved(1).y - moved(0).y, 1e-4) << "matrices are of single precision";
}

TEST_F(Comparison, ColorsHaveOneRangeInAllImages) {
  open("cube-plane", {small, low, "view.color=strain", "view.scale.range=automatic"}, "reference");
  compare({"k", "9000"});
  run_to(250);
  frames(3);
  const QuantityRange own = app().image.own_range(), shown = app().image.range();
  ASSERT_TRUE(app().image.common_range.has_value());
  EXPECT_EQ(shown, *app().image.common_range);
  EXPECT_EQ(comparison_view().image(1).range(), shown);
  const QuantityRange other = comparison_view().image(1).own_range();
  EXPECT_NE(own, other) << "else there is nothing to share";
  EXPECT_EQ(shown, widest(own, other));
  comparison_view().leave();
  frames(3);
  EXPECT_FALSE(app().image.common_range.has_value());
  EXPECT_EQ(app().image.range(), app().image.own_range());
}

TEST_F(Comparison, TimeTravelTakesAllRunsAlong) {
  open("cube-plane", {small, low});
  compare({"integrator", "midpoint"});
  run_to(200);
  app().run.go_to(0.1);
  settled();
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(run(i).step(), 100u) << i;
    EXPECT_EQ(hash(i), hash_alone(i)) << i;
  }
  run_to(150);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(hash(i), hash_alone(i)) << i;
  EXPECT_EQ(run(0).step(), run(1).step());
  type(U'.');
  settled();
  EXPECT_EQ(run(0).step(), run(1).step());
  type(U',');
  type(U',');
  settled();
  EXPECT_EQ(run(0).step(), run(1).step());
  EXPECT_EQ(hash(1), hash_alone(1));
  press(GLFW_KEY_R);
  settled();
  EXPECT_EQ(run(0).step(), 0u);
  EXPECT_EQ(run(1).step(), 0u);
}

TEST_F(Comparison, HandsAndValuesActOnAllRunsAlike) {
  open("cube-plane", {small, low}, "reference");
  compare({"backend", "cpu"});
  run_to(30);
  const std::uint32_t particle = 63;
  Pull pull = {particle, simulation().snapshot().position[particle] + Vec3{0.5, 0.5, 0.0}, 500.0, 5.0};
  simulation().set_hand(pull);
  run_to(simulation().step() + 40);
  pull.anchor = pull.anchor + Vec3{0.0, 0.5, 0.0};
  simulation().set_hand(pull);
  run_to(simulation().step() + 40);
  simulation().set_hand(std::nullopt);
  run_to(simulation().step() + 20);
  EXPECT_EQ(hash(0), hash(1)) << "a pull";
  EXPECT_NE(hash(0), hash_alone(0));
  app().hands.toggle_pin(0);
  run_to(simulation().step() + 30);
  EXPECT_EQ(hash(0), hash(1)) << "a pin";
  app().hands.throw_ball(app().view.sight(middle_x(), middle_y()));
  run_to(simulation().step() + 60);
  EXPECT_EQ(run(1).model().ball_count(), 1u);
  EXPECT_EQ(hash(0), hash(1)) << "a ball";
  app().scene.set_value(*find_parameter("simulation.gravity"), 0, Value(Vec3{0.0, -3.0, 0.0}));
  run_to(simulation().step() + 60);
  EXPECT_EQ(run(1).present().setup().settings.simulation.gravity, (Vec3{0.0, -3.0, 0.0}));
  EXPECT_EQ(run(0).step(), run(1).step());
  EXPECT_EQ(hash(0), hash(1)) << "a value";
}

TEST_F(Comparison, ADivergenceOfOneRunLeavesTheOthersGoing) {
  open("cube-plane", {small, "simulation.timestep=0.003", "cube[0].structural.stiffness=20000"});
  compare({"integrator", "implicit-euler"});
  simulation().set_running(true);
  frames_until([&] { return run(0).divergence().has_value(); });
  const double when = run(0).time();
  frames_until([&] { return comparison().shown_time(1) > when + 0.1; });
  EXPECT_TRUE(comparison().clock().others_go_on());
  EXPECT_TRUE(comparison().shown_divergence(0).has_value());
  EXPECT_FALSE(comparison().shown_divergence(1).has_value());
  press(GLFW_KEY_SPACE);
  settled();
  EXPECT_FALSE(comparison().clock().others_run());
  EXPECT_EQ(hash(1), hash_alone(1));
  const std::uint64_t paused = run(1).step();
  frames(5);
  EXPECT_EQ(run(1).step(), paused);
  press(GLFW_KEY_SPACE);
  frames_until([&] { return run(1).step() > paused; });
  press(GLFW_KEY_R);
  settled();
  EXPECT_EQ(run(1).step(), 0u);
  EXPECT_FALSE(run(0).divergence().has_value());
}

TEST_F(Comparison, ADivergenceOfAnotherRunDoesNotHoldUpTheFirst) {
  open("cube-plane", {small, "simulation.integrator=implicit-euler"});
  compare({"h", "0.5"});
  comparison_view().set(1, {"integrator", "explicit-euler"});
  settled();
  app().scene.set_value(*find_parameter("cube[].structural.stiffness"), 0, Value(1e6));
  run_to(300);
  EXPECT_TRUE(run(1).divergence().has_value());
  EXPECT_GE(run(0).step(), 300u);
  EXPECT_EQ(hash(0), hash_alone(0));
}

TEST_F(Comparison, WhatCannotBeIsRefusedAndChangesNothing) {
  open("cube-plane", {small});
  compare({"n", "5"});
  EXPECT_EQ(run(1).model().particle_count(), 125u);
  app().hands.toggle_pin(0);
  EXPECT_THAT(error(), HasSubstr("different particles"));
  app().hands.begin_pull(0, {});
  EXPECT_FALSE(simulation().hand().has_value());
  comparison_view().set(1, {"h", "-1"});
  EXPECT_THAT(error(), HasSubstr("simulation.timestep"));
  frames(1);
  EXPECT_EQ(run(1).model().particle_count(), 125u);
}

TEST_F(Comparison, TheSectionAndThePaletteAddEditAndRemove) {
  open("cube-plane", {small});
  click("section/Side by side");
  click("comparison/add");
  settled();
  frames(1);
  ASSERT_EQ(comparison().count(), 2u);
  EXPECT_TRUE(has("comparison/1/key"));
  EXPECT_TRUE(has("comparison/1/value"));
  comparison_view().set(1, {"k", "3000"});
  settled();
  EXPECT_EQ(run(1).present().setup().settings.cubes[0].structural.stiffness, 3000.0);
  app().scene.undo();
  settled();
  EXPECT_EQ(run(1).present().setup().settings.simulation.integrator, Integrator::implicit_euler);
  click("comparison/1/remove");
  frames(2);
  EXPECT_EQ(comparison().count(), 1u);
}

TEST_F(Comparison, FiguresOfAllRunsAreOfOneMoment) {
  open("cube-plane", {small});
  compare({"integrator", "implicit-euler"});
  simulation().set_running(true);
  frames_until([&] {
    // Each run has the energies of the time that is printed.
    const double time = comparison().clock().figures_time();
    EXPECT_LE(time, comparison().clock().time());
    for (std::size_t i = 0; i < 2; ++i) {
      const EnergySample* const sample = run(i).samples().nearest(time);
      EXPECT_TRUE(!sample || std::abs(sample->time - time) < 1e-9) << "run " << i;
    }
    return simulation().step() >= 107;
  });
  simulation().set_running(false);
  settled();
  // Off the grid of the plot.
  if (simulation().step() % 20 == 0) {
    type(U'.');
    settled();
  }
  const auto known = [&](std::size_t i) {
    const EnergySample* const sample = run(i).samples().nearest(run(0).time());
    return sample && sample->time == run(0).time();
  };
  for (int i = 0; i < 200 && !(known(0) && known(1)); ++i) frames(1);
  EXPECT_TRUE(known(0));
  EXPECT_TRUE(known(1)) << "a point of every run at a pause";
  EXPECT_EQ(comparison().clock().figures_time(), run(0).time());
}

TEST_F(Comparison, NamesAndFiguresOfFourRunsLieApart) {
  open("cube-plane", {small, low});
  for (int i = 0; i < 3; ++i) {
    press(GLFW_KEY_B, GLFW_MOD_CONTROL);
    frames(1);
  }
  settled();
  ASSERT_EQ(comparison().count(), 4u);
  run_to(60);
  frames(2);
  for (const char* const plot : {"energy/plot", "energy/momentum"}) {
    std::vector<app::Box> boxes;
    for (int i = 1; i <= 4; ++i) {
      boxes.push_back(widgets().at(fmt::format("{}/run {}/name", plot, i)));
      boxes.push_back(widgets().at(fmt::format("{}/run {}", plot, i)));
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t j = i + 1; j < boxes.size(); ++j) {
        const app::Box &a = boxes[i], &b = boxes[j];
        EXPECT_FALSE(a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom)
            << plot << " " << i << " " << j;
      }
    }
  }
  EXPECT_EQ(comparison_view().name(0), "explicit Euler, h 0.001 s, k 2000 N/m");
  EXPECT_EQ(comparison_view().name(1), "implicit Euler");
  EXPECT_EQ(comparison_view().name(2), "h 0.0005 s");
}

TEST_F(Comparison, RunsAreToldApartByFrameTintAndALineThatGrowsWithTheText) {
  open("cube-plane", {small, "cube[0].position=[0,3,0]"});
  EXPECT_FALSE(app().image.tint.has_value());
  resize(roomy[0], roomy[1]);
  compare({"integrator", "implicit-euler"});
  frames(2);
  EXPECT_EQ(app().image.tint, run_tint(0));
  EXPECT_EQ(comparison_view().image(1).tint, run_tint(1));
  // The frame is the run's color along the edge of its image.
  const Image window = image();
  for (std::size_t i = 0; i < 2; ++i) {
    const app::Box& box = comparison_view().boxes()[i];
    const auto x = static_cast<std::size_t>(box.left) + 1, y = static_cast<std::size_t>(box.center_y());
    const std::size_t at = 3 * (y * static_cast<std::size_t>(window.width) + x);
    const std::uint32_t color = app::ComparisonView::packed_color(i);
    for (std::size_t channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(std::to_integer<int>(window.rgb[at + channel]),
                  static_cast<int>((color >> (8 * channel)) & 255u), 3)
          << i << " " << channel;
  }
  const app::Box label = widgets().at("comparison/1/label");
  EXPECT_LT(label.bottom - label.top, 30.0) << "one line";
  app().layout.text_size = 1.5;
  frames(3);
  const app::Box larger = widgets().at("comparison/1/label");
  EXPECT_NEAR(larger.bottom - larger.top, 1.5 * (label.bottom - label.top), 3.0);
}

/// RGB of an image of a video, rows from the top.
std::string video_pixels(const std::filesystem::path& video, int number) {
  const std::string name = fmt::format("{}/frame-{:06}", video.string(), number);
  const std::string command =
      fmt::format("ffmpeg -v error -y -i {0}.png -f rawvideo -pix_fmt rgb24 {0}.rgb", name);
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  const auto bytes = read_file(name + ".rgb");
  EXPECT_TRUE(bytes.ok());
  return bytes.ok() ? *bytes : "";
}

TEST_F(Comparison, AVideoShowsAllRunsByNameAsEachIsDrawnAlone) {
  open("cube-plane", {small, low});
  compare({"integrator", "implicit-euler"});
  app().video.settings = {find_video_format("png"), 20.0, false, "video"};
  app().video.settings.states = &state_format_of("export", "video.pvd");
  press(GLFW_KEY_R, GLFW_MOD_CONTROL);
  ASSERT_TRUE(app().video.recording()) << app().messages.notice()->text;
  const ImageSize size = app().video.recording()->options().size;
  EXPECT_EQ(size.width, std::lround(app().view.whole.right - app().view.whole.left));
  EXPECT_EQ(app().video.recording()->frames(), 1u) << "the start, at once";
  simulation().set_running(true);
  frames_until([&] { return app().video.recording()->frames() >= 4; });
  EXPECT_EQ(simulation().step(), 150u) << "the motion waits for each image";
  EXPECT_DOUBLE_EQ(comparison().shown_time(1), comparison().shown_time(0));
  press(GLFW_KEY_R, GLFW_MOD_CONTROL);
  frames_until([&] { return app().video.completing() == 0; });
  EXPECT_FALSE(app().image.video || comparison_view().image(1).video);
  EXPECT_THAT(app().messages.notice()->text, HasSubstr("video holds 4 frames"));

  const std::string video = video_pixels(directory() / "video", 3);
  ASSERT_EQ(video.size(), 3u * static_cast<std::size_t>(size.width * size.height));
  const std::vector<Tile> tiles = tiles_of(size, 2);
  auto renderer = Renderer::create(context());
  ASSERT_TRUE(renderer.ok());
  for (std::size_t i = 0; i < 2; ++i) {
    const Model& model = run(i).model();
    auto solver = make_reference_solver(model, Precision::single);
    ASSERT_TRUE((*solver)->advance(150).ok());
    const auto path = [&](const std::string& name) { return (directory() / name).string(); };
    const std::string expected = path(fmt::format("expected-{}.vtp", i));
    ASSERT_TRUE(write_state(expected, model, *(*solver)->state(), Overwrite::refuse).ok());
    EXPECT_TRUE(*read_file(path(fmt::format("video-{}-00000150.vtp", i + 1))) == *read_file(expected)) << i;
    ASSERT_TRUE((*renderer)->set_model(model).ok());
    const auto state = (*renderer)->upload(*(*solver)->state());
    ASSERT_TRUE(state.ok());
    const Tile& tile = tiles[i];
    ImageOptions options;
    options.view = app().scene.scene().view;
    options.view.camera = fitted(options.view.camera, tile.width, tile.height);
    options.legend = false;
    options.tint = run_tint(i);
    options.text = comparison_text(comparison_view().name(i), i, 0.15, 0.001, std::nullopt);
    options.text_height = comparison_text_height(size.height, 2);
    options.samples = 1;  // as the window's video on a software rasterizer
    ASSERT_TRUE((*renderer)->draw(tile.width, tile.height, *state, options).ok());
    const std::vector<std::byte> alone = read(context(), **renderer);
    const int frame = std::max(size.height / 240, 1);
    int off = 0;
    for (int y = frame; y < tile.height - frame; ++y)
      off +=
          std::memcmp(&video[3 * static_cast<std::size_t>((tile.top + y) * size.width + tile.left + frame)],
                      &alone[3 * static_cast<std::size_t>(y * tile.width + frame)],
                      3 * static_cast<std::size_t>(tile.width - 2 * frame)) != 0;
    EXPECT_EQ(off, 0) << "rows of run " << i;
  }
}

TEST_F(Comparison, AVideoWithTextTellsRunsApartAndGoesOnAfterADivergence) {
  open("cube-plane", {small, "simulation.timestep=0.003", "cube[0].structural.stiffness=20000"});
  compare({"integrator", "implicit-euler"});
  app().video.settings = {find_video_format("png"), 20.0, true, "video"};
  app().video.start();
  ASSERT_TRUE(app().video.recording()) << app().messages.notice()->text;
  const ImageSize size = app().video.recording()->options().size;
  simulation().set_running(true);
  frames_until([&] { return run(0).divergence().has_value(); });
  const std::uint64_t then = app().video.recording()->frames();
  frames_until([&] { return app().video.recording()->frames() >= then + 3; });
  EXPECT_EQ(&comparison().clock().setter(), &run(1));
  EXPECT_FALSE(has("comparison/0/label")) << "names are in the video's images";
  app().video.stop();
  frames_until([&] { return app().video.completing() == 0; });
  const std::string last = video_pixels(directory() / "video", static_cast<int>(then) + 2),
                    before = video_pixels(directory() / "video", static_cast<int>(then) + 1);
  const std::vector<Tile> tiles = tiles_of(size, 2);
  const auto at = [&](const std::string& image, int x, int y) {
    return image.substr(3 * static_cast<std::size_t>(y * size.width + x), 3);
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& color = run_colors[i];
    EXPECT_EQ(at(last, tiles[i].left, tiles[i].top + tiles[i].height / 2),
              std::string(color.begin(), color.end()))
        << "the frame of run " << i;
  }
  const auto changes = [&](const Tile& tile) {
    int rows = 0;
    for (int y = tile.top; y < tile.top + tile.height; ++y) {
      const auto begin = 3 * static_cast<std::size_t>(y * size.width + tile.left);
      rows += last.compare(begin, 3 * static_cast<std::size_t>(tile.width), before, begin,
                           3 * static_cast<std::size_t>(tile.width)) != 0;
    }
    return rows;
  };
  EXPECT_EQ(changes(tiles[0]), 0) << "the run that diverged keeps its last good state";
  EXPECT_GT(changes(tiles[1]), 10);
}

TEST_F(Comparison, EveryRunIsSavedUnderItsNumber) {
  open("cube-plane", {small, low}, "", only_recording());
  compare({"h", "0.0005"});
  run_to(100);
  const auto save = [&](const std::string& widget) {
    click("save/" + widget);
    click("files/accept");
    ASSERT_TRUE(app().messages.notice() && !app().messages.notice()->is_error)
        << app().messages.notice()->text;
  };
  const auto lines = [&](const std::string& name) {
    const auto text = read_file((directory() / name).string());
    EXPECT_TRUE(text.ok()) << name;
    return text.ok() ? static_cast<std::size_t>(std::ranges::count(*text, '\n')) : 0u;
  };
  save("series.csv");
  EXPECT_EQ(lines("aspic-cube-plane-0001-1.csv"), run(0).samples().energies().size() + 1);
  EXPECT_EQ(lines("aspic-cube-plane-0001-2.csv"), run(1).samples().energies().size() + 1);
  EXPECT_FALSE(std::filesystem::exists(directory() / "aspic-cube-plane-0001.csv"));
  save("state.csv");
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string name = fmt::format("aspic-cube-plane-0002-{}.csv", i + 1);
    const auto state = read_state_csv((directory() / name).string(), Precision::single);
    ASSERT_TRUE(state.ok()) << name;
    EXPECT_EQ(state_hash_text(*state), hash(i));
  }
}

TEST_F(Comparison, ARunThatGoesOnAfterTheFirstDivergedCanBeScrubbed) {
  open("cube-plane", {small, "simulation.timestep=0.003", "cube[0].structural.stiffness=20000"});
  compare({"integrator", "implicit-euler"});
  simulation().set_running(true);
  frames_until([&] { return run(0).divergence().has_value(); });
  const double diverged = run(0).time();
  frames_until([&] { return comparison().shown_time(1) > diverged + 0.3; });
  EXPECT_EQ(&comparison().clock().setter(), &run(1));
  EXPECT_TRUE(comparison().clock().runs());
  frames_until([&] { return comparison().clock().real_time_factor() > 0.0; });
  press(GLFW_KEY_SPACE);
  settled();
  const double end = run(1).time();
  EXPECT_DOUBLE_EQ(comparison().clock().end_time(), end) << "the bar reaches as far";
  EXPECT_DOUBLE_EQ(comparison().clock().time(), end);
  frames(2);
  // A click in the middle of the bar.
  click("timeline");
  settled();
  const double middle = comparison().clock().time();
  EXPECT_GT(middle, diverged);
  EXPECT_LT(middle, end - 0.05);
  EXPECT_TRUE(run(0).divergence().has_value());
  EXPECT_EQ(hash(1), hash_alone(1));
  EXPECT_DOUBLE_EQ(comparison().clock().end_time(), end) << "nothing is lost";
  // Before the divergence both go there, and back again.
  EXPECT_FALSE(comparison_view().go_to(0.5 * diverged));
  app().run.go_to(0.5 * diverged);
  settled();
  EXPECT_NEAR(run(0).time(), 0.5 * diverged, 0.003);
  EXPECT_NEAR(run(1).time(), 0.5 * diverged, 0.003);
  EXPECT_FALSE(run(0).divergence().has_value());
  EXPECT_TRUE(comparison_view().go_to(end));
  frames(1);
  settled();
  EXPECT_TRUE(run(0).divergence().has_value());
  EXPECT_DOUBLE_EQ(run(1).time(), end);
}

TEST_F(Comparison, PlotsShowAQuantityOfAllRuns) {
  open("cube-plane", {small, low});
  compare({"h", "0.002"});
  run_to(200);
  bring_into_sight("energy/plot/run 2");
  EXPECT_TRUE(has("energy/plot/run 1"));
  EXPECT_FALSE(has("energy/plot/kinetic"));
  EXPECT_TRUE(has("energy/momentum/run 2"));
}

TEST_F(Comparison, AGhostShowsAnEarlierRunAtTheSameTime) {
  open("cube-plane", {small, low});
  const Scene earlier = app().scene.scene();
  run_to(60);
  const std::uint32_t particle = 63;
  simulation().set_hand(
      Pull{particle, simulation().snapshot().position[particle] + Vec3{0.5, 0.5, 0.0}, 500.0, 5.0});
  run_to(100);
  simulation().set_hand(std::nullopt);
  const std::uint64_t pulled_to = simulation().step();
  const std::string pulled = hash(0);
  run_to(pulled_to + 50);
  const std::uint64_t end = simulation().step();
  EXPECT_EQ(comparison().ghost(), nullptr);
  press(GLFW_KEY_G, GLFW_MOD_CONTROL);
  settled();
  ASSERT_NE(comparison().ghost(), nullptr);
  EXPECT_EQ(comparison().count(), 1u);
  app().scene.set_value(*find_parameter("simulation.gravity"), 0, Value(Vec3{0.0, -3.0, 0.0}));
  press(GLFW_KEY_R);
  settled();
  EXPECT_EQ(comparison().ghost()->simulation().step(), 0u);
  const auto to = [&](std::uint64_t step) {
    while (simulation().step() < step && !HasFailure()) {
      type(U'.');
      settled();
    }
  };
  to(30);
  EXPECT_EQ(state_hash_text(comparison().ghost()->simulation().snapshot()), reference_hash(earlier, 30));
  EXPECT_NE(hash(0), reference_hash(earlier, 30));
  frames(1);
  EXPECT_TRUE(has("ghost/label"));
  app().messages.info("A message is below the label.");
  frames(2);
  ASSERT_TRUE(has("notice/close"));
  EXPECT_GT(widgets().at("notice/close").top, widgets().at("ghost/label").bottom + 100.0);
  run_to(end + 40);
  EXPECT_EQ(comparison().ghost()->simulation().step(), end) << "its run goes no further";
  app().run.go_to(static_cast<double>(pulled_to) * earlier.model.simulation.timestep);
  settled();
  EXPECT_EQ(state_hash_text(comparison().ghost()->simulation().snapshot()), pulled) << "hands are part of it";
  // A video that is narrower than the view has margins; the ghost stands where the run does.
  app().video.settings = {find_video_format("png"), 20.0, false, "video"};
  press(GLFW_KEY_R, GLFW_MOD_CONTROL);
  frames(1);
  resize(roomy[0], roomy[1]);
  frames(2);
  EXPECT_LT(app().image.shown().right - app().image.shown().left,
            app().view.box.right - app().view.box.left - 8.0);
  EXPECT_EQ(comparison_view().ghost()->shown(), app().image.shown());
  press(GLFW_KEY_R, GLFW_MOD_CONTROL);
  press(GLFW_KEY_G, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
  frames(2);
  EXPECT_EQ(comparison().ghost(), nullptr);
  EXPECT_FALSE(has("ghost/label"));
}

TEST_F(Comparison, AGhostIsSeenOverTheImage) {
  open("cube-plane", {small});
  run_to(400);
  press(GLFW_KEY_G, GLFW_MOD_CONTROL);
  settled();
  app().messages.dismiss();
  // The run turns back by itself: what is seen elsewhere is the ghost.
  app().scene.set_value(*find_parameter("simulation.gravity"), 0, Value(Vec3{0.0, 9.8, 0.0}));
  press(GLFW_KEY_R);
  run_to(400);
  frames(3);
  const Image with = image();
  press(GLFW_KEY_G, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
  frames(3);
  const Image without = image();
  const auto seen = test::project(app().view.lens(), {0.0, 9.0 - 0.5 * 9.8 * 0.16, 0.0});
  ASSERT_TRUE(seen.has_value());
  const auto x = static_cast<int>(app().view.box.left + seen->x),
             y = static_cast<int>(app().view.box.top + seen->y);
  int differs = 0;
  for (int c = 0; c < 3; ++c) differs += std::abs(with.channel(x, y, c) - without.channel(x, y, c));
  EXPECT_GT(differs, 30);
}

TEST_F(Comparison, TheSavedImageHasAllRuns) {
  open("cube-plane", {small});
  compare({"h", "0.002"});
  press(GLFW_KEY_F12);
  frames(2);
  bool found = false;
  for (const auto& entry : std::filesystem::directory_iterator(directory()))
    found = found || entry.path().extension() == ".png";
  EXPECT_TRUE(found);
  EXPECT_EQ(error(), "");
}

TEST_F(Comparison, TheCameraTurnsInEveryImage) {
  open("cube-plane", {small});
  compare({"h", "0.002"});
  frames_to_rest();
  const CameraSettings before = app().view.camera.goal();
  const app::Box& other = comparison_view().boxes()[1];
  drag(GLFW_MOUSE_BUTTON_LEFT, other.center_x(), other.center_y(), 40.0, 0.0);
  EXPECT_NE(app().view.camera.goal(), before);
}

}  // namespace
}  // namespace aspic::test
