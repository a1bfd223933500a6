#include "app/kept_state.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "support/environment.h"
#include "support/temporary_directory.h"

namespace aspic::app {
namespace {

KeptState unusual() {
  KeptState s;
  s.window = WindowPlace{1600, 901, std::array<int, 2>{-7, 42}};
  s.layout.panels = false;
  s.layout.left_width = 300.5;
  s.layout.right_width = 411.25;
  s.layout.text_size = 1.35;
  s.layout.sections = {{"Scene", false}, {"Recording", true}};
  s.layout.choose(*find_layout("lecture"));
  s.layout.sections = {{"View", true}};
  s.greeted = true;
  s.pace = Pace::real_time;
  s.speed = 0.125;
  s.video_format = find_video_format("gif");
  s.video_fps = 24.5;
  s.video_text = false;
  s.cameras = {{"cube-plane", {{1.1, 2.2, 3.3}, {0.0, 0.5, 0.0}, 30.0}},
               {"/a \"quoted\"\\path/scene.toml", {{-1e5, 2, 3}, {0, 0, 0}, 60.0}}};
  return s;
}

TEST(KeptState, ComesBackAsItWasWritten) {
  const auto read = read_kept_state(to_text(unusual()));
  ASSERT_TRUE(read.ok()) << read.error().message();
  EXPECT_EQ(*read, unusual());
  const auto first = read_kept_state(to_text(KeptState()));
  ASSERT_TRUE(first.ok()) << first.error().message();
  EXPECT_EQ(*first, KeptState());
}

std::string with(const std::string& member) {
  return fmt::format("{{\"version\": 2, {}}}", member);
}

TEST(KeptState, WhatIsNotSaidIsAsAtTheFirstTime) {
  const auto read = read_kept_state(with(R"("layout": {"text_size": 2}, "video": {"format": "gif"})"));
  ASSERT_TRUE(read.ok()) << read.error().message();
  KeptState expected;
  expected.layout.text_size = 2.0;
  expected.video_format = find_video_format("gif");
  expected.video_fps = expected.video_format->most_fps;
  EXPECT_EQ(*read, expected);
}

TEST(KeptState, AcceptsTheNamesBeforeVersion03) {
  const std::string present =
      with(R"("layout_name": "lab", "layouts": {"video": {}}, "video": {"format": "gif", "fps": 20})");
  const std::string former =
      with(R"("layout_name": "lab", "layouts": {"film": {}}, "film": {"format": "gif", "fps": 20})");
  const auto read = read_kept_state(former);
  ASSERT_TRUE(read.ok()) << read.error().message();
  EXPECT_EQ(*read, *read_kept_state(present));
  EXPECT_NE(*read, KeptState());
  EXPECT_EQ(read_kept_state(with(R"("layout_name": "film")"))->layout.row().name, "video");
}

TEST(KeptState, WhatTheWindowWouldNotWriteIsNamed) {
  const std::pair<std::string, std::string> cases[] = {
      {"", "line 1"},
      {"{}", "version"},
      {R"({"version": 1})", "version"},
      {"{\"version\": 2,\n\"layout\"", "line 2"},
      {with(R"("layout": {"text_size": 99.0})"), "text_size"},
      {with(R"("layout": {"left_width": "wide"})"), "left_width"},
      {with(R"("layout": {"sections": {"Scene": 1}})"), "Scene"},
      {with(R"("layout_name": "cinema")"), "layout_name"},
      {with(R"("layouts": {"cinema": {}})"), "cinema"},
      {with(R"("layouts": {"lab": {"text_size": 99.0}})"), "text_size"},
      {with(R"("pace": "sideways")"), "pace"},
      {with(R"("speed": null)"), "speed"},
      {with(R"("speed": 1e999)"), "1e999"},
      {with(R"("window": {"size": [1e300, 5]})"), "size"},
      {with(R"("window": {"size": [800]})"), "size"},
      {with(R"("window": {"size": [-800, 600]})"), "size"},
      {with(R"("window": {"size": [800.5, 600]})"), "size"},
      {with(R"("window": 3)"), "window"},
      {with(R"("video": {"format": "gif", "fps": 200})"), "fps"},
      {with(R"("cameras": [{"scene": "a"}])"), "camera"},
      {with(R"("cameras": [{"scene": "a", "camera": {"position": {"x": 1, "y": 1, "z": 1},
                "target": {"x": 1, "y": 1, "z": 1}, "fov": 45}}])"),
       "camera"},
      {with("\"else\": " + std::string(100000, '[') + std::string(100000, ']')), "else"},
  };
  for (const auto& [text, word] : cases) {
    const auto read = read_kept_state(text);
    ASSERT_FALSE(read.ok()) << text;
    EXPECT_THAT(read.error().message(), testing::HasSubstr(word)) << text;
  }
}

TEST(KeptState, ADozenCamerasAreKeptAndTheOneLongestUnusedGoes) {
  std::vector<KeptCamera> cameras;
  CameraSettings camera;
  for (int i = 0; i < 14; ++i) {
    camera.fov = 20.0 + i;
    keep_camera(cameras, fmt::format("scene-{}", i), camera);
  }
  ASSERT_EQ(cameras.size(), 12u);
  EXPECT_EQ(cameras.front().scene, "scene-2");
  keep_camera(cameras, "scene-2", camera);
  EXPECT_EQ(cameras.back().scene, "scene-2");
  EXPECT_EQ(cameras.front().scene, "scene-3");
  keep_camera(cameras, "scene-3", std::nullopt);
  EXPECT_EQ(cameras.size(), 11u);
  EXPECT_EQ(cameras.front().scene, "scene-4");
}

class KeptFile : public testing::Test {
 protected:
  void SetUp() override { ::setenv("XDG_STATE_HOME", directory_.path().c_str(), 1); }
  void TearDown() override { ::unsetenv("XDG_STATE_HOME"); }
  test::TemporaryDirectory directory_;
};

TEST_F(KeptFile, StandsWhereTheBaseDirectorySpecificationSays) {
  EXPECT_EQ(kept_state_path(), (directory_.path() / "aspic" / "window.json").string());
  ::setenv("XDG_STATE_HOME", "relative/paths/do/not/count", 1);
  const std::string home = test::variable("HOME");
  ::setenv("HOME", "/home/somebody", 1);
  EXPECT_EQ(kept_state_path(), "/home/somebody/.local/state/aspic/window.json");
  ::unsetenv("HOME");
  EXPECT_EQ(kept_state_path(), "");
  ::setenv("HOME", home.c_str(), 1);
}

TEST_F(KeptFile, IsMissingAtFirstThenWrittenAndRead) {
  const std::string path = kept_state_path();
  auto read = load_kept_state(path);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(*read, KeptState());
  ASSERT_TRUE(save_kept_state(unusual(), path).ok());
  read = load_kept_state(path);
  ASSERT_TRUE(read.ok()) << read.error().message();
  EXPECT_EQ(*read, unusual());
  ASSERT_TRUE(save_kept_state(KeptState(), path).ok()) << "written over";
  EXPECT_EQ(*load_kept_state(path), KeptState());
}

TEST_F(KeptFile, ABrokenOneIsToldOfByName) {
  const std::string path = kept_state_path();
  std::filesystem::create_directories(directory_.path() / "aspic");
  std::ofstream(path) << "\x7f\x45LF is no layout";
  const auto read = load_kept_state(path);
  ASSERT_FALSE(read.ok());
  EXPECT_THAT(read.error().message(), testing::HasSubstr(path));
  EXPECT_TRUE(save_kept_state(unusual(), path).ok());
  EXPECT_TRUE(load_kept_state(path).ok());
  EXPECT_TRUE(save_kept_state(unusual(), "").ok()) << "nowhere to keep it is no error";
}

TEST_F(KeptFile, TheFormerVersionIsToldOfByNameAndReplaced) {
  const std::string path = kept_state_path();
  const auto former = directory_.path() / "aspic" / "window.toml";
  std::filesystem::create_directories(former.parent_path());
  std::ofstream(former) << "version = 1\n";
  const auto read = load_kept_state(path);
  ASSERT_FALSE(read.ok());
  EXPECT_THAT(read.error().message(), testing::HasSubstr(former.string()));
  ASSERT_TRUE(save_kept_state(unusual(), path).ok());
  EXPECT_FALSE(std::filesystem::exists(former));
  EXPECT_EQ(*load_kept_state(path), unusual());
}

}  // namespace
}  // namespace aspic::app
