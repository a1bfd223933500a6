// The program itself with events of the X server: aspic-view in a process of its own, keys and mouse by
// xdotool, judged by the title and the files that it leaves. Every wait is for a condition.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "app/close_window.h"
#include "app/stage.h"
#include "io/atomic_file.h"
#include "support/environment.h"

namespace aspic::test {
namespace {

namespace fs = std::filesystem;

/// Far more than anything takes on a slow machine.
constexpr auto patience = std::chrono::seconds(60);
constexpr const char* window_title = "cube-plane";
/// Of the window: panels stand on both sides.
constexpr int width = 1040, height = 640;

/// Waits until a condition holds; false if it never does.
template <class Condition>
bool waited_for(Condition condition) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

/// A video's images come one for each step: 0.24 simulated seconds a second, shown at 240 images.
app::KeptState one_image_a_step(const VideoFormat* format) {
  app::KeptState kept;
  kept.window = app::WindowPlace{width, height, std::array<int, 2>{0, 0}};
  for (const char* name : {"Simulation", "Springs", "View", "Performance", "Energy"})
    kept.layout.sections[name] = false;
  kept.speed = 0.24;
  kept.video_fps = 240.0;
  kept.video_format = format;
  return kept;
}

class Events : public Stage {
 protected:
  std::array<int, 2> window_size() const override { return {width, height}; }
  void SetUp() override {
    Stage::SetUp();
    ::setenv("XDG_STATE_HOME", (directory() / "state").c_str(), 1);
  }
  void TearDown() override {
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
    ::unsetenv("XDG_STATE_HOME");
    Stage::TearDown();
  }

  /// Where widgets stand in a window left like that, found out in a window of our own.
  std::map<std::string, app::Box> widgets(const app::KeptState& kept) {
    open("cube-plane", {}, "reference", kept);
    auto found = Stage::widgets();
    view_ = app().view.box;
    close();
    close_window();
    return found;
  }
  void keep(const app::KeptState& kept) {
    const Status saved = app::save_kept_state(kept, app::kept_state_path());
    ASSERT_TRUE(saved.ok()) << saved.error().message();
  }
  /// Starts aspic-view on cube-plane and waits for its window, which gets the keyboard.
  void start(std::vector<std::string> words = {}) {
    close_window();
    words.insert(words.begin(), {ASPIC_VIEW, "cube-plane", "--backend", "reference"});
    process_ = ::fork();
    if (process_ == 0) {
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      if (!std::freopen("view.log", "w", stderr)) ::_exit(126);
      ::execv(ASPIC_VIEW, arguments.data());
      ::_exit(127);
    }
    ASSERT_GT(process_, 0);
    const std::string search =
        fmt::format("timeout 20 xdotool search --onlyvisible --name '^{}' 2>/dev/null", window_title);
    require([&] { return !(id_ = output_of(search)).empty(); }, "a window");
    id_ = id_.substr(0, id_.find('\n'));
    xdotool("windowfocus --sync " + id_);
  }
  /// With an ffmpeg of our own, a shell script.
  void start_with_ffmpeg(const std::string& script) {
    const std::string path = test::variable("PATH");
    fs::create_directory(directory() / "bin");
    std::ofstream(directory() / "bin" / "ffmpeg") << "#!/bin/sh\n" << script;
    fs::permissions(directory() / "bin" / "ffmpeg", fs::perms::owner_all);
    ::setenv("PATH", ((directory() / "bin").string() + ":" + path).c_str(), 1);
    start();
    ::setenv("PATH", path.c_str(), 1);
  }
  void xdotool(const std::string& what) {
    ASSERT_EQ(std::system(("timeout 30 xdotool " + what + " >/dev/null").c_str()), 0) << what << '\n'
                                                                                      << log();
  }
  void key(const std::string& name) { xdotool("key " + name); }
  void click_at(const app::Box& box) {
    xdotool(fmt::format("mousemove --window {} {:.0f} {:.0f} click 1", id_, box.center_x(), box.center_y()));
  }
  /// An image later, so that a field that was opened has the keyboard.
  void type(const std::string& text) { xdotool("type --delay 30 " + text); }
  /// Closes the window and returns what it leaves for the next time.
  app::KeptState left() {
    ask_to_close();
    EXPECT_EQ(exit_code(), 0) << log();
    const auto left = app::load_kept_state(app::kept_state_path());
    EXPECT_TRUE(left.ok());
    return left.ok() ? *left : app::KeptState();
  }
  /// All events so far are dealt with, and an image was drawn after them.
  void catch_up() {
    const std::string name = fmt::format("aspic-cube-plane-{:04}.png", ++screenshots_);
    key("shift+F12");
    require([&] { return exists(name); }, name);
    newest_ = name;
  }
  void ask_to_close() { ASSERT_TRUE(ask_window_to_close(std::stoul(id_))); }
  /// Waits for what the test cannot go on without.
  template <class Condition>
  void require(Condition condition, const std::string& what) {
    const bool came = waited_for([&] { return condition() || ended(); }) && condition();
    if (!came) throw std::runtime_error("In vain: " + what + ". " + log());
  }
  bool ended() {
    if (process_ > 0 && ::waitpid(process_, &status_, WNOHANG) == process_) process_ = 0;
    return process_ == 0;
  }
  int exit_code() {
    EXPECT_TRUE(waited_for([&] { return ended(); })) << log();
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
  }
  std::string title() { return output_of("timeout 20 xdotool getwindowname " + id_); }
  std::string log() { return file("view.log"); }
  std::string file(const std::string& name) {
    const auto content = read_file((directory() / name).string());
    return content.ok() ? *content : "";
  }
  bool exists(const std::string& name) const { return fs::exists(directory() / name); }
  static std::string image(int video, int number) {
    return fmt::format("aspic-cube-plane-{:04}/frame-{:06}.png", video, number);
  }
  void wait_for_image(int video, int number) {
    require([&] { return exists(image(video, number)); }, image(video, number));
  }
  /// A video of one image, of what is seen now.
  std::string still(int video) {
    key("ctrl+r");
    wait_for_image(video, 0);
    key("ctrl+r");
    return file(image(video, 0));
  }
  /// Width and height as a PNG's header says.
  static std::pair<int, int> size_of(const std::string& png) {
    const auto number = [&](std::size_t at) {
      int value = 0;
      for (std::size_t i = at; i < at + 4 && i < png.size(); ++i)
        value = 256 * value + static_cast<unsigned char>(png[i]);
      return value;
    };
    return {number(16), number(20)};
  }
  static int frames_of(const std::string& video) {
    const std::string count =
        output_of("ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 " + video);
    return count.empty() ? 0 : std::stoi(count);
  }

  pid_t process_ = 0;
  int status_ = -1, screenshots_ = 0;
  std::string id_, newest_;
  app::Box view_;
};

TEST_F(Events, NamesTheMissingDisplay) {
  EXPECT_THAT(output_of("env -u DISPLAY -u WAYLAND_DISPLAY " ASPIC_VIEW " 2>&1"),
              testing::HasSubstr("neither DISPLAY nor WAYLAND_DISPLAY is set"));
}

TEST_F(Events, KeysClicksAndDragsOfTheRealWindow) {
  app::KeptState kept = one_image_a_step(find_video_format("png"));
  kept.layout.text_size = 0.75;  // the terrain's shapes are in sight below the scenes
  const auto boxes = widgets(kept);
  keep(kept);
  start();
  catch_up();
  EXPECT_EQ(size_of(file(newest_)), std::pair(width, height));

  key("ctrl+r");
  wait_for_image(1, 0);
  key("period");
  wait_for_image(1, 1);
  EXPECT_FALSE(exists(image(1, 2))) << "one step, one image";
  key("period");
  wait_for_image(1, 2);
  EXPECT_NE(file(image(1, 2)), file(image(1, 1)));
  key("space");
  wait_for_image(1, 12);
  key("space");
  key("ctrl+r");

  key("ctrl+r");
  key("period");
  wait_for_image(2, 1);
  key("ctrl+r");
  key("Tab");
  catch_up();
  EXPECT_EQ(size_of(still(3)).first, width) << "without panels the image is as wide as the window";
  key("Tab");
  catch_up();
  const std::string before = still(4);
  EXPECT_EQ(size_of(before).first, static_cast<int>(view_.right - view_.left));

  xdotool(fmt::format("mousemove --window {} {:.0f} {:.0f}", id_, view_.center_x(), view_.center_y()));
  xdotool("mousedown 1 mousemove_relative 60 10 mousemove_relative 60 10 mouseup 1");
  catch_up();
  EXPECT_NE(still(5), before) << "a drag turns the camera";
  key("Home");
  int video = 6;
  EXPECT_TRUE(waited_for([&] { return still(video++) == before; })) << "Home comes back to the bit";
  EXPECT_THAT(title(), testing::StartsWith("cube-plane - "));
  ASSERT_LT(boxes.at("terrain/sphere").bottom, height - 20.0) << "above the status line";
  click_at(boxes.at("terrain/sphere"));
  EXPECT_TRUE(waited_for([&] { return title().starts_with("cube-plane (changed)"); })) << title();
  ask_to_close();
  catch_up();
  ASSERT_FALSE(ended()) << "it asks: the change would be lost";
  ask_to_close();
  catch_up();
  ASSERT_FALSE(ended()) << "a second click loses nothing";
  key("Escape ctrl+z");
  EXPECT_TRUE(waited_for([&] { return title().starts_with("cube-plane -"); })) << title();
  ask_to_close();
  EXPECT_EQ(exit_code(), 0) << log();
  EXPECT_TRUE(exists(image(2, 1)));
  EXPECT_FALSE(exists(image(2, 2))) << "Space had paused the motion";
}

TEST_F(Events, ShortcutsFollowThePrintedLetter) {
  keep(one_image_a_step(find_video_format("mp4")));
  for (const std::string layout : {"de", "fr"}) {
    ASSERT_EQ(std::system(("setxkbmap " + layout).c_str()), 0);
    start();
    for (const auto& [name, changed] : {std::pair{"a", true}, {"ctrl+z", false}, {"ctrl+y", true}}) {
      key(name);
      const std::string wanted = changed ? "cube-plane (changed)" : "cube-plane -";
      EXPECT_TRUE(waited_for([&] { return title().starts_with(wanted); }))
          << layout << ' ' << name << title();
    }
    key("ctrl+z");
    EXPECT_TRUE(waited_for([&] { return title().starts_with("cube-plane -"); })) << title();
    ask_to_close();
    EXPECT_EQ(exit_code(), 0) << log();
  }
  EXPECT_EQ(std::system("setxkbmap us"), 0);
}

TEST_F(Events, HeadingsOpenAtOnceAfterAShortcut) {
  const app::KeptState kept = one_image_a_step(find_video_format("png"));
  const auto boxes = widgets(kept);
  keep(kept);
  start();
  catch_up();
  xdotool("keydown ctrl key z keyup ctrl");
  click_at(boxes.at("section/Simulation"));
  catch_up();
  EXPECT_TRUE(left().layout.sections.at("Simulation"));
}

TEST_F(Events, ControlClickTypesIntoANumberAndEveryTapArrives) {
  app::KeptState kept = one_image_a_step(find_video_format("png"));
  kept.layout.sections["View"] = kept.layout.sections["View: more"] = true;
  // All rows down to the camera's in sight, in one column.
  kept.layout.sections["Scene"] = false;
  kept.layout.text_size = 0.75;  // the terrain's shapes are in sight below the scenes
  kept.window->height = 680;
  const auto boxes = widgets(kept);
  keep(kept);
  start();
  catch_up();
  const app::Box& box = boxes.at("view.camera.position");
  xdotool(fmt::format("mousemove --window {} {:.0f} {:.0f}", id_, box.center_x(), box.center_y()));
  xdotool("keydown ctrl click 1 keyup ctrl");
  catch_up();
  // Taps far shorter than an image, and some that many hands make.
  type("91234567890");
  xdotool("key --delay 4 BackSpace BackSpace BackSpace BackSpace BackSpace");
  xdotool("key --delay 60 BackSpace BackSpace BackSpace BackSpace BackSpace Return");
  catch_up();
  key("space");
  catch_up();
  const app::KeptState left_behind = left();
  ASSERT_EQ(left_behind.cameras.size(), 1u);
  EXPECT_NEAR(left_behind.cameras[0].camera.position.y, 9.0, 1e-9);
}

TEST_F(Events, ClosingWhileAVideoRunsLeavesItWhole) {
  keep(one_image_a_step(find_video_format("mp4")));
  start();
  key("ctrl+r");
  key("period period period period period");
  ask_to_close();
  EXPECT_EQ(exit_code(), 0) << log();
  EXPECT_EQ(frames_of("aspic-cube-plane-0001.mp4"), 6) << "the start and five steps";
  EXPECT_THAT(log(), testing::HasSubstr("aspic-cube-plane-0001.mp4 holds 6 frames"));
}

TEST_F(Events, ASignalWhileAVideoRunsLeavesItWhole) {
  int sent = 0;
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    keep(one_image_a_step(find_video_format("webm")));
    start();
    key("ctrl+r");
    key("period period period");
    catch_up();
    ASSERT_EQ(::kill(process_, signal), 0);
    EXPECT_EQ(exit_code(), 130) << log();
    EXPECT_EQ(frames_of(fmt::format("aspic-cube-plane-{:04}.webm", ++sent)), 4);
  }
}

TEST_F(Events, VideoAndSettingsOutliveTheDisplay) {
  app::KeptState kept = one_image_a_step(find_video_format("mp4"));
  keep(kept);
  const std::string display = test::variable("DISPLAY"), other = directory() / "display";
  close_window();
  const std::string server =
      output_of(fmt::format("Xvfb -displayfd 3 -screen 0 1280x720x24 >/dev/null 2>&1 3>{} & echo $!", other));
  std::string number;
  ASSERT_TRUE(waited_for([&] { return std::getline(std::ifstream(other), number) && !number.empty(); }));
  ::setenv("DISPLAY", (":" + number).c_str(), 1);
  start();
  key("plus ctrl+r");
  key("period period period");
  catch_up();
  ASSERT_EQ(::kill(std::stoi(server), SIGKILL), 0);
  EXPECT_EQ(exit_code(), 4) << log();
  ::setenv("DISPLAY", display.c_str(), 1);
  EXPECT_THAT(log(), testing::HasSubstr("The display was lost."));
  EXPECT_EQ(frames_of("aspic-cube-plane-0001.mp4"), 2) << "at twice the speed one for two steps";
  EXPECT_NEAR(app::load_kept_state(app::kept_state_path())->speed, 2.0 * kept.speed, 1e-9);
}

TEST_F(Events, AnEncoderThatHangsDoesNotHoldUpTheEnd) {
  keep(one_image_a_step(find_video_format("mp4")));
  start_with_ffmpeg("exec sleep 600\n");
  key("ctrl+r");
  key("period period period");
  catch_up();
  ask_to_close();
  EXPECT_EQ(exit_code(), 0) << log();
  EXPECT_THAT(log(), testing::ContainsRegex("cannot make the video .*aspic-cube-plane-0001.mp4"));
  EXPECT_FALSE(exists("aspic-cube-plane-0001.mp4"));
}

TEST_F(Events, AnEncoderThatFailsLeavesTheWindowAtWork) {
  keep(one_image_a_step(find_video_format("mp4")));
  start_with_ffmpeg("head -c 1000 >/dev/null\necho no space >&2\nexit 1\n");
  key("ctrl+r");
  key("space");
  catch_up();
  catch_up();
  ask_to_close();
  EXPECT_EQ(exit_code(), 0) << log();
  EXPECT_FALSE(exists("aspic-cube-plane-0001.mp4"));
}

TEST_F(Events, SizeAndLayoutAreKeptAndABrokenFileIsToldOfOnce) {
  fs::create_directories(directory() / "state" / "aspic");
  std::ofstream(app::kept_state_path()) << "this is = no [ layout\n";
  start({"--size", "900x650"});
  catch_up();
  EXPECT_EQ(size_of(file(newest_)), std::pair(900, 650));
  key("Tab");
  catch_up();
  ask_to_close();
  EXPECT_EQ(exit_code(), 0) << log();
  const std::string said = log();
  const std::size_t first = said.find("window.json");
  EXPECT_NE(first, std::string::npos) << said;
  EXPECT_EQ(said.find("window.json", first + 1), std::string::npos) << said;
  const auto left = app::load_kept_state(app::kept_state_path());
  ASSERT_TRUE(left.ok()) << left.error().message();
  EXPECT_FALSE(left->layout.panels);
  start();
  catch_up();
  EXPECT_EQ(size_of(file(newest_)), std::pair(900, 650)) << "from the last session";
  ask_to_close();
  EXPECT_EQ(exit_code(), 0);
  EXPECT_EQ(log(), "") << "nothing to complain about";
  start({"--size", "700x500"});
  catch_up();
  EXPECT_EQ(size_of(file(newest_)), std::pair(700, 500)) << "the command line goes first";
  ask_to_close();
  EXPECT_EQ(exit_code(), 0);
}

}  // namespace
}  // namespace aspic::test
