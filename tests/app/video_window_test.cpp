// Videos made in the window: pace, formats, and what may come in between.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "app/stage.h"
#include "aspic/scene.h"
#include "cpu_reference/reference_solver.h"
#include "io/atomic_file.h"
#include "io/state_sink.h"
#include "page/live_facts.h"
#include "page/page_reader.h"
#include "support/environment.h"

namespace aspic::test {
namespace {

namespace fs = std::filesystem;

/// The standard output of a command; a failure if it ends badly.
std::string checked_output_of(const std::string& command) {
  int status = 0;
  const std::string text = output_of(command, &status);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << command;
  return text;
}

/// PATH as a test wants it, for as long as it lives.
class OtherPath {
 public:
  explicit OtherPath(const std::string& path) : before_(test::variable("PATH")) {
    ::setenv("PATH", path.c_str(), 1);
  }
  ~OtherPath() { ::setenv("PATH", before_.c_str(), 1); }
  OtherPath(const OtherPath&) = delete;
  OtherPath& operator=(const OtherPath&) = delete;

 private:
  std::string before_;
};

class Video : public Stage {
 protected:
  // The view, whose size videos have, is 320 × 180.
  std::array<int, 2> window_size() const override { return {640, 244}; }
  /// A cube that is quick to draw and to step, and falls.
  void open_small(std::string_view backend = "reference", const std::string& more = "name=\"video\"") {
    open("cube-plane", {"cube[0].particles-per-edge=4", "view.draw=[\"particles\"]", more}, backend);
  }
  void record(const VideoFormat* format, double fps, const std::string& path = "") {
    app().video.settings = {format, fps, true, path};
    app().video.start();
    ASSERT_TRUE(app().video.recording()) << app().messages.notice()->text;
  }
  void frames_to_images(std::uint64_t images) {
    for (int i = 0; app().video.recording() && app().video.recording()->frames() < images; ++i) {
      ASSERT_LT(i, 20000) << app().video.recording()->frames() << " images at step " << simulation().step();
      frames(1);
    }
    ASSERT_TRUE(app().video.recording());
  }
  /// Ends the video and waits until it is whole.
  void end_video() {
    app().video.stop();
    frames_to_complete();
  }
  void frames_to_complete() {
    for (int i = 0; app().video.completing() > 0; ++i) {
      ASSERT_LT(i, 20000);
      frames(1);
    }
  }
  std::string file(const std::string& name) {
    const auto content = read_file((directory() / name).string());
    EXPECT_TRUE(content.ok()) << content.error().message();
    return content.ok() ? *content : "";
  }
  /// Videos with a page of the video's states next to it.
  void video_with_page(const char* backend) {
    open_small(backend);
    const std::string name = fmt::format("with-{}", backend);
    app().video.settings = {find_video_format("png"), 50.0, true, name, true};
    press(GLFW_KEY_SPACE);
    app().video.start();
    frames_to_images(4);
    // Back in time: the page ends there, and the video goes on.
    press(GLFW_KEY_R);
    frames_to_images(6);
    EXPECT_THAT(file(name + ".html"), testing::HasSubstr("</html>"));
    end_video();
    const ReadPage page = read_page(file(name + ".html"));
    ASSERT_EQ(page.error, "");
    EXPECT_GE(page.images.size(), 4u);
    EXPECT_EQ(page.facts["command"], "");
    const auto& steps = page.ends[0]["steps"];
    for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(steps[i], 20 * i);
    const Scene scene =
        load_scene("cube-plane", std::vector<std::string>{"cube[0].particles-per-edge=4"}).value();
    auto solver = make_reference_solver(build_model(scene.model).value(), Precision::single).value();
    ASSERT_TRUE(solver->advance(steps.back()).ok());
    EXPECT_EQ(page.ends[0]["hash"], state_hash_text(solver->state().value()));
  }
  std::string image(const std::string& video, std::uint64_t number, const char* end = "png") {
    return file(fmt::format("{}/frame-{:06}.{}", video, number, end));
  }
  bool exists(const std::string& name) const { return fs::exists(directory() / name); }
  /// An `ffmpeg` of our own before the real one; the script runs with `$out`, the file to write.
  std::string path_with(const std::string& script) {
    const fs::path bin = directory() / "bin";
    fs::create_directory(bin);
    std::ofstream(bin / "ffmpeg") << "#!/bin/sh\nfor last; do :; done\nout=${last#file:}\n" << script;
    fs::permissions(bin / "ffmpeg", fs::perms::owner_all);
    return bin.string() + ":" + test::variable("PATH");
  }
};

TEST_F(Video, APageOfItsStatesIsWrittenNextToIt) {
  video_with_page("reference");
}

TEST_F(Video, APageThatSimulatesIsWrittenNextToItUntilAHandPulls) {
  if (const auto module = page::live_module(); !module) GTEST_SKIP() << module.error().message();
  open_small("reference");
  app().video.settings = {find_video_format("png"), 50.0, true, "live", false, true};
  press(GLFW_KEY_SPACE);
  app().video.start();
  frames_to_images(4);
  EXPECT_FALSE(exists("live-live.html"));
  app().hands.begin_pull(0, {});
  frames_to_images(8);
  EXPECT_TRUE(exists("live-live.html"));
  end_video();
  EXPECT_FALSE(exists("live.html"));
  const ReadPage page = read_page(file("live-live.html"));
  ASSERT_EQ(page.error, "");
  EXPECT_EQ(page.start, "");  // it is the scene's
  const Scene scene =
      load_scene("cube-plane", std::vector<std::string>{"cube[0].particles-per-edge=4"}).value();
  auto solver = make_reference_solver(build_model(scene.model).value(), Precision::single).value();
  const auto &steps = page.ends[0]["steps"], &hashes = page.ends[0]["hashes"];
  ASSERT_GE(steps.size(), 4u);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i], 20 * i);
    EXPECT_EQ(hashes[i], state_hash_text(solver->state().value()));
    ASSERT_TRUE(solver->advance(20).ok());
  }
}

TEST_F(Video, APageOfStatesOnTheDevice) {
  video_with_page("gpu");
}

TEST_F(Video, ItsStatesAreWrittenNextToIt) {
  open_small();
  const Scene scene =
      load_scene("cube-plane", std::vector<std::string>{"cube[0].particles-per-edge=4"}).value();
  const Model model = build_model(scene.model).value();
  auto solver = make_reference_solver(model, Precision::single).value();
  ASSERT_TRUE(solver->advance(40).ok());
  ASSERT_TRUE(
      write_state((directory() / "expected.vtp").string(), model, solver->state().value(), Overwrite::refuse)
          .ok());
  press(GLFW_KEY_SPACE);
  for (const StateFormat& format : state_formats()) {
    if (!format.motion) continue;
    press(GLFW_KEY_R);
    const std::string name = "with" + std::string(format.ending.substr(1));
    app().video.settings = {find_video_format("png"), 50.0, true, name, false, false, &format};
    app().video.start();
    frames_to_images(4);
    // Back in time: the states end there, and the video goes on.
    press(GLFW_KEY_R);
    frames_to_images(6);
    EXPECT_THAT(app().messages.notice()->text,
                testing::AllOf(testing::HasSubstr(name + std::string(format.ending) + " holds the states"),
                               testing::HasSubstr("It ends before the video: a run went back.")));
    EXPECT_GT(file(name + std::string(format.ending)).size(), 200u);
    end_video();
  }
  const std::string series = file("withpvd.pvd");
  for (const char* time : {"\"0\"", "\"0.02\"", "\"0.04\"", "\"0.06\""})
    EXPECT_THAT(series, testing::HasSubstr(fmt::format("timestep={}", time)));
  EXPECT_TRUE(file("withpvd-00000040.vtp") == file("expected.vtp"));
  std::int32_t samples = 0;
  std::memcpy(&samples, file("withpc2.pc2").data() + 28, sizeof(samples));
  EXPECT_GE(samples, 4);
  EXPECT_THAT(file("withpc2.obj"), testing::HasSubstr("# interval 0.02\n"));
}

TEST_F(Video, TwoSecondsInEveryVideoFormat) {
  open_small();
  press(GLFW_KEY_SPACE);
  for (const VideoFormat* format :
       {find_video_format("mp4"), find_video_format("webm"), find_video_format("gif")}) {
    press(GLFW_KEY_R);
    record(format, 10.0, "two");
    const ImageSize size = app().video.recording()->options().size;
    frames_to_images(20);
    EXPECT_EQ(simulation().step(), 19u * 100u) << "the motion waits for each image";
    end_video();
    ASSERT_FALSE(app().messages.notice()->is_error) << app().messages.notice()->text;
    const std::string name = fmt::format("two.{}", format->name);
    EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr(name + " holds 20 frames, 2.00 s at 10"));
    const std::string found = checked_output_of(
        "ffprobe -v error -count_frames -show_entries "
        "stream=width,height,avg_frame_rate,nb_read_frames:format=duration -of "
        "default=noprint_wrappers=1 " +
        name);
    EXPECT_THAT(found, testing::HasSubstr(fmt::format("width={}\n", size.width))) << name;
    EXPECT_THAT(found, testing::HasSubstr(fmt::format("height={}\n", size.height))) << name;
    EXPECT_THAT(found, testing::HasSubstr("avg_frame_rate=10/1\n")) << name;
    EXPECT_THAT(found, testing::HasSubstr("nb_read_frames=20\n")) << name;
    EXPECT_THAT(found, testing::HasSubstr("duration=2.000000\n")) << name;
    EXPECT_TRUE(app().video.settings.path.empty()) << "a name that is used up is not offered again";
  }
}

TEST_F(Video, DirectoriesOfImages) {
  open_small();
  press(GLFW_KEY_SPACE);
  for (const VideoFormat* format : {find_video_format("png"), find_video_format("jpeg")}) {
    const bool png = format == find_video_format("png");
    const std::string name = png ? "as-png" : "as-jpeg";
    record(format, 10.0, name);
    frames_to_images(20);
    end_video();
    const std::string last = image(name, 19, png ? "png" : "jpg");
    EXPECT_EQ(last.substr(png ? 1 : 0, 3), png ? "PNG" : "\xff\xd8\xff");
    EXPECT_FALSE(exists(name + (png ? "/frame-000020.png" : "/frame-000020.jpg")));
    record(format, 50.0, name + "-more");
    end_video();
    app().video.settings.path = name;
    app().video.start();
    EXPECT_FALSE(app().video.recording()) << "a directory with images is left alone";
    EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr(name));
  }
}

TEST_F(Video, KeepsANameThatIsTypedWhileAVideoRuns) {
  open_small();
  record(find_video_format("png"), 10.0, "first");
  app().video.settings.path = "second";
  app().video.start();
  ASSERT_TRUE(app().video.recording());
  EXPECT_EQ(app().video.recording()->options().path, "second");
  end_video();
  EXPECT_TRUE(app().video.settings.path.empty());
}

TEST_F(Video, ImagesDependOnSimulatedTimeAlone) {
  open_small("reference", "simulation.steps-per-frame=1");
  const auto video = [&](const std::string& name, std::int64_t steps_per_frame) {
    app().scene.set_value(*find_parameter("simulation.steps-per-frame"), 0, Value(steps_per_frame), "");
    frames(2);
    press(GLFW_KEY_R);
    record(find_video_format("png"), 60.0, name);
    press(GLFW_KEY_SPACE);
    frames_to_images(8);
    press(GLFW_KEY_SPACE);
    end_video();
  };
  video("slow", 1);
  video("even", 17);
  video("wild", 1000);
  press(GLFW_KEY_G);
  video("gpu", 300);
  simulation().pacer().set_pace(Pace::real_time);
  video("clock", 300);
  for (std::uint64_t i = 0; i < 8; ++i) {
    const std::string slow = image("slow", i);
    EXPECT_GT(slow.size(), 5000u);
    if (i > 0) {
      EXPECT_NE(slow, image("slow", i - 1));
    }
    for (const char* other : {"even", "wild", "gpu", "clock"}) EXPECT_EQ(image(other, i), slow) << other << i;
  }
}

TEST_F(Video, TextStandsInTheImageIfWanted) {
  open_small();
  record(find_video_format("png"), 60.0, "with");
  end_video();
  app().video.settings = {find_video_format("png"), 60.0, false, "without"};
  app().video.start();
  end_video();
  EXPECT_NE(image("with", 0), image("without", 0));
}

TEST_F(Video, PausesJumpsAndOtherScenesAreRecordedAsShown) {
  open_small();
  record(find_video_format("png"), 50.0, "video");
  EXPECT_EQ(app().video.recording()->frames(), 1u) << "the start";
  frames(5);
  EXPECT_EQ(app().video.recording()->frames(), 1u) << "no time passes, no image";
  for (int i = 0; i < 40; ++i) type(U'.');
  EXPECT_EQ(app().video.recording()->frames(), 3u)
      << "single steps pass no image by, even between two frames";
  press(GLFW_KEY_R);
  frames(1);
  EXPECT_EQ(app().video.recording()->frames(), 4u) << "the start again, at once";
  for (int i = 0; i < 20; ++i) type(U'.');
  EXPECT_EQ(app().video.recording()->frames(), 5u);
  // Another constant changes nothing about the pace; twice the step comes twice as far.
  app().scene.set_value(*find_parameter("simulation.timestep"), 0, Value(0.002), "");
  frames(2);
  for (int i = 0; i < 10; ++i) type(U'.');
  EXPECT_EQ(app().video.recording()->frames(), 6u);
  type(U'+');
  for (int i = 0; i < 20; ++i) type(U'.');
  EXPECT_EQ(app().video.recording()->frames(), 7u) << "twice as fast: 40 ms for each image";
  const ImageSize size = app().video.recording()->options().size;
  app().scene.open("cube-sphere");
  press(GLFW_KEY_TAB);
  frames(3);
  EXPECT_EQ(app().video.recording()->frames(), 8u) << "the other scene's start";
  press(GLFW_KEY_G);
  press(GLFW_KEY_SPACE);
  frames_to_images(10);
  EXPECT_EQ(app().video.recording()->options().size.width, size.width) << "whatever becomes of the view";
  end_video();
  EXPECT_TRUE(exists("video/frame-000009.png"));
}

TEST_F(Video, RunsOnAtItsOwnPaceOnceTheVideoHasEnded) {
  open_small();
  press(GLFW_KEY_SPACE);
  record(find_video_format("png"), 10.0, "video");
  frames(1);
  end_video();
  EXPECT_FALSE(simulation().pacer().limit().has_value());
  frames_to_step(200);
}

TEST_F(Video, KeyAndNamesThatNobodyHasTaken) {
  open_small();
  app().video.settings.format = find_video_format("png");
  fs::create_directory(directory() / "aspic-cube-plane-0001");
  press(GLFW_KEY_R, GLFW_MOD_CONTROL);
  ASSERT_TRUE(app().video.recording());
  EXPECT_EQ(app().video.recording()->options().path, "aspic-cube-plane-0002");
  press(GLFW_KEY_R, GLFW_MOD_CONTROL);
  EXPECT_FALSE(app().video.recording());
  frames_to_complete();
  press(GLFW_KEY_R, GLFW_MOD_CONTROL);
  ASSERT_TRUE(app().video.recording());
  EXPECT_EQ(app().video.recording()->options().path, "aspic-cube-plane-0003");
  end_video();
  std::ofstream(directory() / "taken.mp4") << "precious";
  app().video.settings = {find_video_format("mp4"), 60.0, true, "taken"};
  app().video.start();
  EXPECT_FALSE(app().video.recording());
  EXPECT_TRUE(app().messages.notice()->is_error);
  EXPECT_EQ(file("taken.mp4"), "precious");
}

TEST_F(Video, TheSectionStartsAndEndsIt) {
  open_small();
  for (const char* section : {"View", "Performance", "Energy"}) click(std::string("section/") + section);
  click("section/Recording");
  click("record/format");
  click("record/format/gif");
  EXPECT_EQ(app().video.settings.format, find_video_format("gif"));
  EXPECT_EQ(app().video.settings.fps, 50.0) << "no viewer shows more";
  click("record/format");
  click("record/format/jpeg");
  click("record/text");
  EXPECT_TRUE(app().video.settings.text) << "not by itself: it covers the scene";
  click("record/states");
  click("record/states/.npz");
  click("record/path");
  for (const char32_t c : U"reel") {
    if (c != 0) type(c);
  }
  frames(2);
  click("record/start");
  ASSERT_TRUE(app().video.recording()) << app().messages.notice()->text;
  EXPECT_EQ(app().video.recording()->options().path, "reel");
  click("record/stop");
  frames_to_complete();
  EXPECT_EQ(image("reel", 0, "jpg").substr(0, 3), "\xff\xd8\xff");
  EXPECT_EQ(file("reel.npz").substr(0, 4), "PK\3\4");
}

TEST_F(Video, ClosingTheWindowLeavesAWholeVideo) {
  open_small();
  record(find_video_format("mp4"), 30.0, "video");
  press(GLFW_KEY_SPACE);
  frames_to_images(7);
  close();
  EXPECT_THAT(checked_output_of(
                  "ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 video.mp4"),
              testing::StartsWith("7"));
}

TEST_F(Video, WithoutFfmpegThereIsAMessageAndNoVideo) {
  open_small();
  press(GLFW_KEY_SPACE);
  const OtherPath path(directory().string());
  app().video.settings = {find_video_format("mp4"), 60.0, true, "video"};
  app().video.start();
  EXPECT_FALSE(app().video.recording());
  ASSERT_TRUE(app().messages.notice() && app().messages.notice()->is_error);
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("apt install ffmpeg"));
  frames_to_step(20);
  EXPECT_FALSE(exists("video.mp4"));
}

TEST_F(Video, AnEncoderThatDiesEndsTheVideoAndNotTheMotion) {
  open_small();
  const OtherPath path(path_with("head -c 100000 >/dev/null; echo out of video >&2; exit 3\n"));
  record(find_video_format("mp4"), 60.0, "video");
  press(GLFW_KEY_SPACE);
  for (int i = 0; app().video.recording() || app().video.completing() > 0; ++i) {
    ASSERT_LT(i, 20000);
    frames(1);
  }
  ASSERT_TRUE(app().messages.notice() && app().messages.notice()->is_error);
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("out of video"));
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("continues without a video"));
  EXPECT_TRUE(simulation().running());
  frames_to_step(simulation().step() + 100);
  EXPECT_FALSE(exists("video.mp4"));
}

TEST_F(Video, TheMotionWaitsForASlowEncoderAndNoImageIsLost) {
  open_small();
  // What it writes must be a video: the real one does that with the pixels that came.
  const OtherPath path(
      path_with("while [ ! -e go ]; do sleep 0.02; done\ncat > pixels\nPATH=${PATH#*:}\nexec ffmpeg \"$@\" < "
                "pixels\n"));
  record(find_video_format("webm"), 60.0, "video");
  const ImageSize size = app().video.recording()->options().size;
  press(GLFW_KEY_SPACE);
  for (int i = 0; app().video.recording()->ready(); ++i) {
    ASSERT_LT(i, 20000);
    frames(1);
  }
  const std::uint64_t step = simulation().step();
  frames(5);
  EXPECT_EQ(simulation().step(), step);
  EXPECT_TRUE(simulation().running());
  press(GLFW_KEY_R);
  frames(1);
  EXPECT_EQ(simulation().step(), 0u) << "a reset is recorded, and waits again";
  const std::uint64_t so_far = app().video.recording()->frames();
  std::ofstream(directory() / "go") << "go";
  frames_to_images(so_far + 5);
  EXPECT_EQ(simulation().step(), 83u) << "five images after the start";
  app().video.stop();
  EXPECT_GT(app().video.completing(), 0u);
  frames_to_complete();
  const std::size_t bytes = 3u * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  EXPECT_EQ(file("pixels").size(), (so_far + 5) * bytes);
  EXPECT_TRUE(exists("video.webm"));
}

}  // namespace
}  // namespace aspic::test
