// The files of a run: when each wants a state, and what is left of them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "aspic/scene.h"
#include "cpu_reference/reference_solver.h"
#include "io/checkpoint.h"
#include "run/recorder.h"
#include "run/run_files.h"
#include "support/state_csv_reader.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

class Outputs : public testing::Test {
 protected:
  void SetUp() override {
    const std::vector<std::string> small = {"cube[0].particles-per-edge=3"};
    scene_ = load_scene("cube-plane", small).value();
    model_ = build_model(scene_.model).value();
    solver_ = make_reference_solver(model_, Precision::single).value();
  }
  Result<RunFiles> open(const std::vector<StateOutput>& outputs, Overwrite overwrite = Overwrite::refuse) {
    return RunFiles::open(outputs, {}, {to_toml(scene_), scene_.model.simulation.integrator}, overwrite);
  }
  /// Runs as far as the files want, to `last`.
  Status run(RunFiles& files, std::uint64_t last) {
    auto state = solver_->state();
    ASPIC_CHECK(files.take({model_, *state}));
    for (std::uint64_t step = 0; step < last;) {
      const std::uint64_t next = std::min(files.next_step(step), last);
      visited_.push_back(next);
      EXPECT_TRUE(solver_->advance(next - step).ok());
      step = next;
      state = solver_->state();
      ASPIC_CHECK(files.take({model_, *state}));
    }
    return {};
  }
  State state() { return solver_->state().value(); }

  test::TemporaryDirectory dir_;
  Scene scene_;
  Model model_;
  std::unique_ptr<Solver> solver_;
  std::vector<std::uint64_t> visited_;
};

TEST_F(Outputs, EachHasItsOwnInterval) {
  auto files = open({{"state", dir_.file("s.csv"), 10}, {"series", dir_.file("e.csv"), 4}});
  ASSERT_TRUE(files.ok()) << files.error().message();
  ASSERT_TRUE(run(*files, 22).ok());
  EXPECT_THAT(visited_, testing::ElementsAre(4, 8, 10, 12, 16, 20, 22));
  ASSERT_TRUE(files->finish({model_, state()}).ok());
  for (const char* name : {"s-00000000.csv", "s-00000010.csv", "s-00000020.csv", "s-00000022.csv"})
    EXPECT_TRUE(test::read_state_csv(dir_.file(name), Precision::single).ok()) << name;
  EXPECT_EQ(dir_.entries(), 5u);
  EXPECT_THAT(files->written(), testing::ElementsAre(dir_.file("s-*.csv"), dir_.file("e.csv")));
  const std::string rows = dir_.read("e.csv");
  EXPECT_EQ(std::ranges::count(rows, '\n'), 8);  // header, 0, 4, …, 20, 22
}

TEST_F(Outputs, ACheckpointIsReplacedByTheNext) {
  auto files = open({{"checkpoint", dir_.file("c"), 10}});
  ASSERT_TRUE(files.ok());
  ASSERT_TRUE(run(*files, 25).ok());
  auto checkpoint = read_checkpoint(dir_.file("c"));
  ASSERT_TRUE(checkpoint.ok()) << checkpoint.error().message();
  EXPECT_EQ(checkpoint->state.step, 20u);
  ASSERT_TRUE(files->finish({model_, state()}).ok());
  checkpoint = read_checkpoint(dir_.file("c"));
  ASSERT_TRUE(checkpoint.ok());
  EXPECT_EQ(checkpoint->state.step, 25u);
  EXPECT_EQ(state_hash_text(checkpoint->state), state_hash_text(state()));
  EXPECT_EQ(dir_.entries(), 1u);
}

TEST_F(Outputs, WithoutAnIntervalTheLastStateAloneIsWritten) {
  auto files = open({{"state", dir_.file("s.csv"), {}}, {"checkpoint", dir_.file("c"), {}}});
  ASSERT_TRUE(files.ok());
  ASSERT_TRUE(run(*files, 7).ok());
  EXPECT_THAT(visited_, testing::ElementsAre(7));
  ASSERT_TRUE(files->finish({model_, state()}).ok());
  EXPECT_EQ(state_hash_text(*test::read_state_csv(dir_.file("s.csv"), Precision::single)),
            state_hash_text(state()));
  EXPECT_EQ(read_checkpoint(dir_.file("c"))->state.step, 7u);
  EXPECT_THAT(files->written(), testing::ElementsAre(dir_.file("s.csv"), dir_.file("c")));
}

TEST_F(Outputs, OneThatFailsOnTheWayCostsNoOther) {
  std::filesystem::create_directory(dir_.file("far"));
  auto files = open({{"state", dir_.file("far/s.csv"), 10},
                     {"checkpoint", dir_.file("c"), 10},
                     {"series", dir_.file("e.csv"), 10}});
  ASSERT_TRUE(files.ok()) << files.error().message();
  ASSERT_TRUE(run(*files, 0).ok());
  std::filesystem::remove_all(dir_.file("far"));
  const auto advance_and_take = [&] {
    EXPECT_TRUE(solver_->advance(10).ok());
    return files->take({model_, state()});
  };
  ASSERT_TRUE(advance_and_take().ok());
  ASSERT_EQ(files->failures().size(), 1u);
  EXPECT_THAT(files->failures()[0].what, testing::HasSubstr("far/s-00000010.csv"));
  EXPECT_TRUE(files->any_left());
  // The disk is back: the next state is written again, and what is lost stays told of.
  std::filesystem::create_directory(dir_.file("far"));
  ASSERT_TRUE(advance_and_take().ok());
  EXPECT_FALSE(files->finish({model_, state()}).ok());
  EXPECT_EQ(files->failures().size(), 1u);
  EXPECT_TRUE(test::read_state_csv(dir_.file("far/s-00000020.csv"), Precision::single).ok());
  EXPECT_EQ(read_checkpoint(dir_.file("c"))->state.step, 20u);
  EXPECT_EQ(std::ranges::count(dir_.read("e.csv"), '\n'), 4);  // header, 0, 10, 20
}

TEST_F(Outputs, WhatRefusesTheFirstStateEndsTheRun) {
  auto files = open({{"state", dir_.file("none/s.csv"), 10}, {"series", dir_.file("e.csv"), 10}});
  ASSERT_TRUE(files.ok());
  EXPECT_FALSE(run(*files, 0).ok());
}

TEST_F(Outputs, FilesOfLaterStepsAreFoundAtTheStart) {
  dir_.write("s-00000010.csv", "earlier");
  const auto first = [&](std::uint64_t step, Overwrite overwrite) {
    auto files = open({{"state", dir_.file("s.csv"), 10}}, overwrite);
    State at = state();
    at.step = step;
    return files->take({model_, at});
  };
  const Status refused = first(0, Overwrite::refuse);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message(), testing::HasSubstr("s-00000010.csv already exists"));
  EXPECT_EQ(dir_.entries(), 1u);
  EXPECT_TRUE(first(20, Overwrite::refuse).ok()) << "a run that is resumed later never comes to that step";
  EXPECT_TRUE(first(0, Overwrite::allow).ok());
}

TEST(CheckImages, RefusesWhatCannotBeCountedAndSaysWhatFits) {
  ImageOutput output;
  output.frames = "z";
  output.fps = 60.0;
  output.speed = 1e-300;
  const Status refused = check_frame_count(output, 0.001, 100, 5100);
  ASSERT_FALSE(refused.ok());
  ASSERT_EQ(refused.error().remedies.size(), 2u);
  EXPECT_EQ(refused.error().remedies[0].kind, RemedyKind::raise_speed);
  output.speed = std::stod(refused.error().remedies[0].values[0]);
  EXPECT_TRUE(check_frame_count(output, 0.001, 100, 5100).ok());
  output.speed /= 2.0;
  const Status still = check_frame_count(output, 0.001, 100, 5100);
  ASSERT_FALSE(still.ok());
  EXPECT_EQ(still.error().remedies[1].kind, RemedyKind::lower_fps);
  output.fps = std::stod(still.error().remedies[1].values[0]);
  EXPECT_TRUE(check_frame_count(output, 0.001, 100, 5100).ok());
}

TEST_F(Outputs, OneNameForTwoFilesIsRefused) {
  const auto files = open({{"state", dir_.file("x"), {}}, {"series", dir_.file("x"), {}}});
  ASSERT_FALSE(files.ok());
  EXPECT_EQ(files.error().code, ErrorCode::usage);
  EXPECT_THAT(files.error().message(), testing::HasSubstr("state and series would both"));
  std::filesystem::create_symlink("x", dir_.file("link"));
  EXPECT_FALSE(open({{"state", dir_.file("x"), {}}, {"series", dir_.file("link"), {}}}).ok());
}

TEST(VideoFormats, AreFoundByNameAndEnding) {
  for (const VideoFormat& format : video_formats()) {
    EXPECT_EQ(find_video_format(format.name), &format);
    EXPECT_EQ(find_video_format(format.ending), &format);
    EXPECT_EQ(video_format_of(std::string("a").append(format.ending)).ok(), !format.is_directory());
    EXPECT_FALSE(check_video(format, {64, 64}, 2.0 * format.most_fps).ok());
    EXPECT_EQ(check_video(format, {63, 64}, 10.0).ok(), !format.even_sides);
  }
  EXPECT_EQ(find_video_format("MP4"), find_video_format(".mp4"));
  EXPECT_EQ(find_video_format(""), nullptr);
  EXPECT_EQ(find_video_format("avi"), nullptr);
  EXPECT_EQ(video_endings(false), ".mp4, .webm or .gif");
}

}  // namespace
}  // namespace aspic
