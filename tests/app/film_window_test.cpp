// Films made in the window: pace, formats, and what may come in between.
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

/// What a command writes to its standard output; a failure if it ends badly.
std::string output_of(const std::string& command) {
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (!pipe) return "";
  std::string text;
  std::array<char, 4096> part;
  for (std::size_t got; (got = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    text.append(part.data(), got);
  const int status = ::pclose(pipe);
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

class Film : public Stage {
 protected:
  // The view, whose size films have, is 320 × 180.
  std::array<int, 2> window_size() const override { return {640, 244}; }
  /// A cube that is quick to draw and to step, and falls.
  void open_small(std::string_view backend = "reference", const std::string& more = "name=\"film\"") {
    open("cube-plane", {"cube[0].particles-per-edge=4", "view.draw=[\"particles\"]", more}, backend);
  }
  void record(const FilmFormat* format, double fps, const std::string& path = "") {
    app().film.settings = {format, fps, true, path};
    app().film.start();
    ASSERT_TRUE(app().film.recording()) << app().messages.notice()->text;
  }
  void frames_to_pictures(std::uint64_t pictures) {
    for (int i = 0; app().film.recording() && app().film.recording()->frames() < pictures; ++i) {
      ASSERT_LT(i, 20000) << app().film.recording()->frames() << " pictures at step " << simulation().step();
      frames(1);
    }
    ASSERT_TRUE(app().film.recording());
  }
  /// Ends the film and waits until it is whole.
  void end_film() {
    app().film.stop();
    frames_to_complete();
  }
  void frames_to_complete() {
    for (int i = 0; app().film.completing() > 0; ++i) {
      ASSERT_LT(i, 20000);
      frames(1);
    }
  }
  std::string file(const std::string& name) {
    const auto content = read_file((directory() / name).string());
    EXPECT_TRUE(content.ok()) << content.error().message();
    return content.ok() ? *content : "";
  }
  /// Films with a page of the film's states next to it.
  void film_with_page(const char* backend) {
    open_small(backend);
    const std::string name = fmt::format("with-{}", backend);
    app().film.settings = {find_film_format("png"), 50.0, true, name, true};
    press(GLFW_KEY_SPACE);
    app().film.start();
    frames_to_pictures(4);
    // Back in time: the page ends there, and the film goes on.
    press(GLFW_KEY_R);
    frames_to_pictures(6);
    EXPECT_THAT(file(name + ".html"), testing::HasSubstr("</html>"));
    end_film();
    const ReadPage page = read_page(file(name + ".html"));
    ASSERT_EQ(page.error, "");
    EXPECT_GE(page.pictures.size(), 4u);
    EXPECT_EQ(page.facts["command"], "");
    const auto& steps = page.ends[0]["steps"];
    for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(steps[i], 20 * i);
    const Scene scene =
        load_scene("cube-plane", std::vector<std::string>{"cube[0].particles-per-edge=4"}).value();
    auto solver = make_reference_solver(build_model(scene.model).value(), Precision::single).value();
    ASSERT_TRUE(solver->advance(steps.back()).ok());
    EXPECT_EQ(page.ends[0]["hash"], state_hash_text(solver->state().value()));
  }
  std::string picture(const std::string& film, std::uint64_t number, const char* end = "png") {
    return file(fmt::format("{}/frame-{:06}.{}", film, number, end));
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

TEST_F(Film, APageOfItsStatesIsWrittenNextToIt) {
  film_with_page("reference");
}

TEST_F(Film, APageThatSimulatesIsWrittenNextToItUntilAHandPulls) {
  if (const auto module = page::live_module(); !module) GTEST_SKIP() << module.error().message();
  open_small("reference");
  app().film.settings = {find_film_format("png"), 50.0, true, "live", false, true};
  press(GLFW_KEY_SPACE);
  app().film.start();
  frames_to_pictures(4);
  EXPECT_FALSE(exists("live-live.html"));
  app().hands.begin_pull(0, {});
  frames_to_pictures(8);
  EXPECT_TRUE(exists("live-live.html"));
  end_film();
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

TEST_F(Film, APageOfStatesOnTheDevice) {
  film_with_page("gpu");
}

TEST_F(Film, ItsStatesAreWrittenNextToIt) {
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
    app().film.settings = {find_film_format("png"), 50.0, true, name, false, false, &format};
    app().film.start();
    frames_to_pictures(4);
    // Back in time: the states end there, and the film goes on.
    press(GLFW_KEY_R);
    frames_to_pictures(6);
    EXPECT_THAT(app().messages.notice()->text,
                testing::AllOf(testing::HasSubstr(name + std::string(format.ending) + " holds the states"),
                               testing::HasSubstr("It ends before the video: a run went back.")));
    EXPECT_GT(file(name + std::string(format.ending)).size(), 200u);
    end_film();
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

TEST_F(Film, TwoSecondsInEveryFilmFormat) {
  open_small();
  press(GLFW_KEY_SPACE);
  for (const FilmFormat* format :
       {find_film_format("mp4"), find_film_format("webm"), find_film_format("gif")}) {
    press(GLFW_KEY_R);
    record(format, 10.0, "two");
    const PictureSize size = app().film.recording()->options().size;
    frames_to_pictures(20);
    EXPECT_EQ(simulation().step(), 19u * 100u) << "the motion waits for each picture";
    end_film();
    ASSERT_FALSE(app().messages.notice()->is_error) << app().messages.notice()->text;
    const std::string name = fmt::format("two.{}", format->name);
    EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr(name + " holds 20 frames, 2.00 s at 10"));
    const std::string found = output_of(
        "ffprobe -v error -count_frames -show_entries "
        "stream=width,height,avg_frame_rate,nb_read_frames:format=duration -of "
        "default=noprint_wrappers=1 " +
        name);
    EXPECT_THAT(found, testing::HasSubstr(fmt::format("width={}\n", size.width))) << name;
    EXPECT_THAT(found, testing::HasSubstr(fmt::format("height={}\n", size.height))) << name;
    EXPECT_THAT(found, testing::HasSubstr("avg_frame_rate=10/1\n")) << name;
    EXPECT_THAT(found, testing::HasSubstr("nb_read_frames=20\n")) << name;
    EXPECT_THAT(found, testing::HasSubstr("duration=2.000000\n")) << name;
    EXPECT_TRUE(app().film.settings.path.empty()) << "a name that is used up is not offered again";
  }
}

TEST_F(Film, DirectoriesOfPictures) {
  open_small();
  press(GLFW_KEY_SPACE);
  for (const FilmFormat* format : {find_film_format("png"), find_film_format("jpeg")}) {
    const bool png = format == find_film_format("png");
    const std::string name = png ? "as-png" : "as-jpeg";
    record(format, 10.0, name);
    frames_to_pictures(20);
    end_film();
    const std::string last = picture(name, 19, png ? "png" : "jpg");
    EXPECT_EQ(last.substr(png ? 1 : 0, 3), png ? "PNG" : "\xff\xd8\xff");
    EXPECT_FALSE(exists(name + (png ? "/frame-000020.png" : "/frame-000020.jpg")));
    record(format, 50.0, name + "-more");
    end_film();
    app().film.settings.path = name;
    app().film.start();
    EXPECT_FALSE(app().film.recording()) << "a directory with pictures is left alone";
    EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr(name));
  }
}

TEST_F(Film, KeepsANameThatIsTypedWhileAFilmRuns) {
  open_small();
  record(find_film_format("png"), 10.0, "first");
  app().film.settings.path = "second";
  app().film.start();
  ASSERT_TRUE(app().film.recording());
  EXPECT_EQ(app().film.recording()->options().path, "second");
  end_film();
  EXPECT_TRUE(app().film.settings.path.empty());
}

TEST_F(Film, PicturesDependOnSimulatedTimeAlone) {
  open_small("reference", "simulation.steps-per-frame=1");
  const auto film = [&](const std::string& name, std::int64_t steps_per_frame) {
    app().scene.set_value(*find_parameter("simulation.steps-per-frame"), 0, Value(steps_per_frame), "");
    frames(2);
    press(GLFW_KEY_R);
    record(find_film_format("png"), 60.0, name);
    press(GLFW_KEY_SPACE);
    frames_to_pictures(8);
    press(GLFW_KEY_SPACE);
    end_film();
  };
  film("slow", 1);
  film("even", 17);
  film("wild", 1000);
  press(GLFW_KEY_G);
  film("gpu", 300);
  simulation().pacer().set_pace(Pace::real_time);
  film("clock", 300);
  for (std::uint64_t i = 0; i < 8; ++i) {
    const std::string slow = picture("slow", i);
    EXPECT_GT(slow.size(), 5000u);
    if (i > 0) {
      EXPECT_NE(slow, picture("slow", i - 1));
    }
    for (const char* other : {"even", "wild", "gpu", "clock"})
      EXPECT_EQ(picture(other, i), slow) << other << i;
  }
}

TEST_F(Film, TextStandsInThePictureIfWanted) {
  open_small();
  record(find_film_format("png"), 60.0, "with");
  end_film();
  app().film.settings = {find_film_format("png"), 60.0, false, "without"};
  app().film.start();
  end_film();
  EXPECT_NE(picture("with", 0), picture("without", 0));
}

TEST_F(Film, PausesJumpsAndOtherScenesAreFilmedAsShown) {
  open_small();
  record(find_film_format("png"), 50.0, "film");
  EXPECT_EQ(app().film.recording()->frames(), 1u) << "the start";
  frames(5);
  EXPECT_EQ(app().film.recording()->frames(), 1u) << "no time passes, no picture";
  for (int i = 0; i < 40; ++i) type(U'.');
  EXPECT_EQ(app().film.recording()->frames(), 3u)
      << "single steps pass no picture by, even between two frames";
  press(GLFW_KEY_R);
  frames(1);
  EXPECT_EQ(app().film.recording()->frames(), 4u) << "the start again, at once";
  for (int i = 0; i < 20; ++i) type(U'.');
  EXPECT_EQ(app().film.recording()->frames(), 5u);
  // Another constant changes nothing about the pace; twice the step comes twice as far.
  app().scene.set_value(*find_parameter("simulation.timestep"), 0, Value(0.002), "");
  frames(2);
  for (int i = 0; i < 10; ++i) type(U'.');
  EXPECT_EQ(app().film.recording()->frames(), 6u);
  type(U'+');
  for (int i = 0; i < 20; ++i) type(U'.');
  EXPECT_EQ(app().film.recording()->frames(), 7u) << "twice as fast: 40 ms for each picture";
  const PictureSize size = app().film.recording()->options().size;
  app().scene.open("cube-sphere");
  press(GLFW_KEY_TAB);
  frames(3);
  EXPECT_EQ(app().film.recording()->frames(), 8u) << "the other scene's start";
  press(GLFW_KEY_G);
  press(GLFW_KEY_SPACE);
  frames_to_pictures(10);
  EXPECT_EQ(app().film.recording()->options().size.width, size.width) << "whatever becomes of the view";
  end_film();
  EXPECT_TRUE(exists("film/frame-000009.png"));
}

TEST_F(Film, RunsOnAtItsOwnPaceOnceTheFilmHasEnded) {
  open_small();
  press(GLFW_KEY_SPACE);
  record(find_film_format("png"), 10.0, "film");
  frames(1);
  end_film();
  EXPECT_FALSE(simulation().pacer().limit().has_value());
  frames_to_step(200);
}

TEST_F(Film, KeyAndNamesThatNobodyHasTaken) {
  open_small();
  app().film.settings.format = find_film_format("png");
  fs::create_directory(directory() / "aspic-cube-plane-0001");
  press(GLFW_KEY_R, GLFW_MOD_CONTROL);
  ASSERT_TRUE(app().film.recording());
  EXPECT_EQ(app().film.recording()->options().path, "aspic-cube-plane-0002");
  press(GLFW_KEY_R, GLFW_MOD_CONTROL);
  EXPECT_FALSE(app().film.recording());
  frames_to_complete();
  press(GLFW_KEY_R, GLFW_MOD_CONTROL);
  ASSERT_TRUE(app().film.recording());
  EXPECT_EQ(app().film.recording()->options().path, "aspic-cube-plane-0003");
  end_film();
  std::ofstream(directory() / "taken.mp4") << "precious";
  app().film.settings = {find_film_format("mp4"), 60.0, true, "taken"};
  app().film.start();
  EXPECT_FALSE(app().film.recording());
  EXPECT_TRUE(app().messages.notice()->is_error);
  EXPECT_EQ(file("taken.mp4"), "precious");
}

TEST_F(Film, TheSectionStartsAndEndsIt) {
  open_small();
  for (const char* section : {"View", "Performance", "Energy"}) click(std::string("section/") + section);
  click("section/Recording");
  click("record/format");
  click("record/format/gif");
  EXPECT_EQ(app().film.settings.format, find_film_format("gif"));
  EXPECT_EQ(app().film.settings.fps, 50.0) << "no viewer shows more";
  click("record/format");
  click("record/format/jpeg");
  click("record/text");
  EXPECT_TRUE(app().film.settings.text) << "not by itself: it covers the scene";
  click("record/states");
  click("record/states/.npz");
  click("record/path");
  for (const char32_t c : U"reel") {
    if (c != 0) type(c);
  }
  frames(2);
  click("record/start");
  ASSERT_TRUE(app().film.recording()) << app().messages.notice()->text;
  EXPECT_EQ(app().film.recording()->options().path, "reel");
  click("record/stop");
  frames_to_complete();
  EXPECT_EQ(picture("reel", 0, "jpg").substr(0, 3), "\xff\xd8\xff");
  EXPECT_EQ(file("reel.npz").substr(0, 4), "PK\3\4");
}

TEST_F(Film, ClosingTheWindowLeavesAWholeFilm) {
  open_small();
  record(find_film_format("mp4"), 30.0, "film");
  press(GLFW_KEY_SPACE);
  frames_to_pictures(7);
  close();
  EXPECT_THAT(
      output_of("ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 film.mp4"),
      testing::StartsWith("7"));
}

TEST_F(Film, WithoutFfmpegThereIsAMessageAndNoFilm) {
  open_small();
  press(GLFW_KEY_SPACE);
  const OtherPath path(directory().string());
  app().film.settings = {find_film_format("mp4"), 60.0, true, "film"};
  app().film.start();
  EXPECT_FALSE(app().film.recording());
  ASSERT_TRUE(app().messages.notice() && app().messages.notice()->is_error);
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("apt install ffmpeg"));
  frames_to_step(20);
  EXPECT_FALSE(exists("film.mp4"));
}

TEST_F(Film, AnEncoderThatDiesEndsTheFilmAndNotTheMotion) {
  open_small();
  const OtherPath path(path_with("head -c 100000 >/dev/null; echo out of film >&2; exit 3\n"));
  record(find_film_format("mp4"), 60.0, "film");
  press(GLFW_KEY_SPACE);
  for (int i = 0; app().film.recording() || app().film.completing() > 0; ++i) {
    ASSERT_LT(i, 20000);
    frames(1);
  }
  ASSERT_TRUE(app().messages.notice() && app().messages.notice()->is_error);
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("out of film"));
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("continues without a video"));
  EXPECT_TRUE(simulation().running());
  frames_to_step(simulation().step() + 100);
  EXPECT_FALSE(exists("film.mp4"));
}

TEST_F(Film, TheMotionWaitsForASlowEncoderAndNoPictureIsLost) {
  open_small();
  // What it writes must be a film: the real one does that with the pixels that came.
  const OtherPath path(
      path_with("while [ ! -e go ]; do sleep 0.02; done\ncat > pixels\nPATH=${PATH#*:}\nexec ffmpeg \"$@\" < "
                "pixels\n"));
  record(find_film_format("webm"), 60.0, "film");
  const PictureSize size = app().film.recording()->options().size;
  press(GLFW_KEY_SPACE);
  for (int i = 0; app().film.recording()->ready(); ++i) {
    ASSERT_LT(i, 20000);
    frames(1);
  }
  const std::uint64_t step = simulation().step();
  frames(5);
  EXPECT_EQ(simulation().step(), step);
  EXPECT_TRUE(simulation().running());
  press(GLFW_KEY_R);
  frames(1);
  EXPECT_EQ(simulation().step(), 0u) << "a reset is filmed, and waits again";
  const std::uint64_t so_far = app().film.recording()->frames();
  std::ofstream(directory() / "go") << "go";
  frames_to_pictures(so_far + 5);
  EXPECT_EQ(simulation().step(), 83u) << "five pictures after the start";
  app().film.stop();
  EXPECT_GT(app().film.completing(), 0u);
  frames_to_complete();
  const std::size_t bytes = 3u * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  EXPECT_EQ(file("pixels").size(), (so_far + 5) * bytes);
  EXPECT_TRUE(exists("film.webm"));
}

}  // namespace
}  // namespace aspic::test
