// Videos and frames of the real program, and every way they can fail.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/process.h"

// After the others: it is plain C.
#include <stb_image.h>

namespace aspic {
namespace {

using test::aspic;
using test::json_member;
using test::ProcessOptions;
using testing::HasSubstr;
using testing::Not;
using Words = std::vector<std::string>;

/// Small images of a short run, drawn in software.
Words video_words(const Words& more) {
  Words words = {
      "run", "cube-plane", "--backend", "reference", "--json", "--set", "cube[0].particles-per-edge=4"};
  if (std::ranges::find(more, "--size") == more.end()) words.insert(words.end(), {"--size", "128x96"});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

ProcessOptions software(std::string path = {}) {
  ProcessOptions options;
  options.environment = {{"ASPIC_EGL_DEVICE", "software"}};
  if (!path.empty()) options.environment.emplace_back("PATH", std::move(path));
  return options;
}

/// What ffprobe says of the first stream: key=value lines.
std::string probe(const std::string& file) {
  const std::string command =
      "ffprobe -v error -count_frames -show_entries "
      "stream=codec_name,pix_fmt,width,height,nb_read_frames,r_frame_rate:format=duration -of default=nw=1 "
      "'" +
      file + "' 2>&1";
  std::string text;
  FILE* pipe = ::popen(command.c_str(), "r");
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  ::pclose(pipe);
  return text;
}

TEST(FrameCost, IsReportedByPass) {
  const auto run =
      aspic({"bench", "--images", "128x96", "--backend", "reference", "--set", "cube[0].particles-per-edge=4",
             "--duration", "0.1", "--repeats", "2", "--warm-up", "0", "--json"},
            software());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto report = nlohmann::json::parse(run.out);
  // Six intervals, seven images, of which every other one is told apart.
  EXPECT_EQ(report["images"], 8);
  EXPECT_EQ(report["width"], 128);
  EXPECT_EQ(report["seconds"].size(), 8u);
  std::vector<std::string> names;
  double sum = 0.0;
  for (const auto& pass : report["passes"]) {
    names.push_back(pass["name"]);
    sum += pass["milliseconds"].get<double>();
  }
  EXPECT_EQ(names.front(), "state to the device");
  EXPECT_EQ(names.back(), "pixels to memory");
  EXPECT_THAT(names, testing::IsSupersetOf({"light maps", "terrain", "jelly", "samples to pixels"}));
  EXPECT_GT(sum, 0.0);
}

TEST(FrameCost, RejectsOptionsOfOtherMeasurements) {
  for (const Words& words : {Words{"--images", "128"}, Words{"--images", "128x96", "--seconds", "1"},
                             Words{"--images", "128x96", "--size", "4"}}) {
    Words all = {"bench"};
    all.insert(all.end(), words.begin(), words.end());
    const auto run = aspic(all);
    EXPECT_EQ(run.exit_code, 2) << run.out;
    EXPECT_THAT(run.err, HasSubstr("--images"));
  }
}

TEST(Video, HasTheLengthRateAndSizeAskedFor) {
  const test::TemporaryDirectory dir;
  // 0.5 s at 60 a second are 30 intervals, 31 images.
  const auto run = aspic(video_words({"--duration", "0.5", "--video", dir.file("v.mp4")}), software());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string said = probe(dir.file("v.mp4"));
  EXPECT_THAT(said, HasSubstr("codec_name=h264"));
  EXPECT_THAT(said, HasSubstr("pix_fmt=yuv420p"));
  EXPECT_THAT(said, HasSubstr("width=128"));
  EXPECT_THAT(said, HasSubstr("height=96"));
  EXPECT_THAT(said, HasSubstr("r_frame_rate=60/1"));
  EXPECT_THAT(said, HasSubstr("nb_read_frames=31"));
  const std::size_t duration = said.find("duration=");
  ASSERT_NE(duration, std::string::npos);
  EXPECT_NEAR(std::stod(said.substr(duration + 9)), 31.0 / 60.0, 0.001);  // MP4 counts it in milliseconds
  EXPECT_EQ(dir.entries(), 1u);
  EXPECT_EQ(json_member(run.out, "count"), "31");
  for (const char* stage : {"simulate", "draw", "read", "encode"})
    EXPECT_GT(std::stod(json_member(run.out, stage)), 0.0);
  EXPECT_THAT(run.err, HasSubstr("31 frames on"));
  // The index stands in front (faststart).
  const std::string file = dir.read("v.mp4");
  EXPECT_LT(file.find("moov"), file.find("mdat"));
}

TEST(Video, SlowMotionAndOtherFormats) {
  const test::TemporaryDirectory dir;
  const auto webm = aspic(
      video_words({"--duration", "0.1", "--video", dir.file("v.webm"), "--fps", "30", "--speed", "0.25"}),
      software());
  ASSERT_EQ(webm.exit_code, 0) << webm.err;
  EXPECT_THAT(probe(dir.file("v.webm")), HasSubstr("nb_read_frames=13"));  // 0.4 s at 30 a second
  EXPECT_THAT(probe(dir.file("v.webm")), HasSubstr("codec_name=vp9"));
  const auto gif =
      aspic(video_words({"--duration", "0.1", "--video", dir.file("v.gif"), "--fps", "25"}), software());
  ASSERT_EQ(gif.exit_code, 0) << gif.err;
  EXPECT_THAT(probe(dir.file("v.gif")), HasSubstr("codec_name=gif"));
}

TEST(Video, ImpossibleWishesAreUsageErrors) {
  const test::TemporaryDirectory dir;
  const auto refused = [&](const Words& words) {
    const auto run = aspic(video_words(words), software());
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(dir.entries(), 0u);
    return run.err;
  };
  EXPECT_THAT(refused({"--video", dir.file("v.mp4"), "--size", "129x96"}), HasSubstr("130x96"));
  EXPECT_THAT(refused({"--video", dir.file("v.avi")}), HasSubstr(".mp4, .webm or .gif"));
  EXPECT_THAT(refused({"--video", dir.file("v.gif"), "--fps", "60"}), HasSubstr("50"));
  EXPECT_THAT(refused({"--video", dir.file("v.mp4"), "--size", "big"}), HasSubstr("1280x720"));
  EXPECT_THAT(refused({"--video", dir.file("v.mp4"), "--speed", "0"}), HasSubstr("--speed"));
  EXPECT_THAT(refused({"--video", dir.file("v.mp4"), "--fps", "-3"}), HasSubstr("--fps"));
  EXPECT_THAT(refused({"--frames", dir.file("f"), "--frames-format", "bmp"}), HasSubstr("png or jpg"));
  EXPECT_THAT(refused({"--frames", dir.file("f"), "--text", "maybe"}), HasSubstr("on or off"));
}

TEST(Video, ExistingFileIsKeptUnlessForced) {
  const test::TemporaryDirectory dir;
  dir.write("v.mp4", "mine");
  const auto refused =
      aspic(video_words({"--steps", "1000000000", "--video", dir.file("v.mp4")}), software());
  EXPECT_EQ(refused.exit_code, 6);  // at once: before a billion steps
  EXPECT_THAT(refused.err, HasSubstr("--force"));
  EXPECT_EQ(dir.read("v.mp4"), "mine");
  const auto forced =
      aspic(video_words({"--steps", "20", "--video", dir.file("v.mp4"), "--force"}), software());
  EXPECT_EQ(forced.exit_code, 0) << forced.err;
  EXPECT_THAT(probe(dir.file("v.mp4")), HasSubstr("codec_name=h264"));
}

TEST(Video, MissingFfmpegNamesThePackageAndFramesStillWork) {
  const test::TemporaryDirectory dir;
  const auto video =
      aspic(video_words({"--steps", "20", "--video", dir.file("v.mp4")}), software(dir.path().string()));
  EXPECT_EQ(video.exit_code, 6);
  EXPECT_THAT(video.err, HasSubstr("apt install ffmpeg"));
  EXPECT_EQ(dir.entries(), 0u);
  const auto frames =
      aspic(video_words({"--steps", "20", "--frames", dir.file("f")}), software(dir.path().string()));
  EXPECT_EQ(frames.exit_code, 0) << frames.err;
  EXPECT_TRUE(std::filesystem::exists(dir.file("f/frame-000002.png")));
}

TEST(Video, FailingFfmpegIsQuoted) {
  const test::TemporaryDirectory bin, dir;
  bin.write("ffmpeg", "#!/bin/sh\necho 'Unknown encoder libx264' >&2\nexit 7\n");
  ::chmod(bin.file("ffmpeg").c_str(), 0755);
  const auto run = aspic(video_words({"--duration", "0.5", "--video", dir.file("v.mp4")}),
                         software(bin.path().string() + ":/usr/bin:/bin"));
  EXPECT_EQ(run.exit_code, 6);
  EXPECT_THAT(run.err, HasSubstr("Unknown encoder libx264"));
  EXPECT_THAT(run.err, HasSubstr("exit code 7"));
  EXPECT_EQ(dir.entries(), 0u);
}

// ffmpeg 7 and later take these two from the images, and no option sets them.
TEST(Video, NamesItsColorsInTheFilterAndInTheOptions) {
  const test::TemporaryDirectory bin, dir;
  bin.write("ffmpeg", "#!/bin/sh\necho \"$@\" >&2\nexit 7\n");
  ::chmod(bin.file("ffmpeg").c_str(), 0755);
  const auto run = aspic(video_words({"--steps", "20", "--video", dir.file("v.mp4")}),
                         software(bin.path().string() + ":/usr/bin:/bin"));
  EXPECT_THAT(run.err, HasSubstr("setparams=color_primaries=bt709:color_trc=iec61966-2-1"));
  EXPECT_THAT(run.err, HasSubstr("-color_primaries bt709 -color_trc iec61966-2-1"));
}

TEST(Video, AFullDiskLeavesNothingThatLooksWhole) {
  const test::TemporaryDirectory dir;
  ProcessOptions options = software();
  options.file_size_limit = 2048;
  const auto video = aspic(video_words({"--duration", "0.5", "--video", dir.file("v.mp4")}), options);
  EXPECT_EQ(video.exit_code, 6);
  EXPECT_THAT(video.err, HasSubstr("File too large"));
  EXPECT_EQ(dir.entries(), 0u);
  const auto frames = aspic(video_words({"--duration", "0.5", "--frames", dir.file("f")}), options);
  EXPECT_EQ(frames.exit_code, 6);
  EXPECT_TRUE(std::filesystem::is_empty(dir.file("f")));
}

TEST(Video, AKilledRunLeavesNothingUnderTheFinalName) {
  const test::TemporaryDirectory dir;
  test::Process process(video_words({"--duration", "1000", "--video", dir.file("v.mp4")}), software());
  std::this_thread::sleep_for(std::chrono::seconds(3));
  process.send(SIGKILL);
  EXPECT_EQ(process.wait().signal, SIGKILL);
  EXPECT_FALSE(std::filesystem::exists(dir.file("v.mp4")));
}

TEST(Video, AnInterruptedRunLeavesAWholeVideo) {
  const test::TemporaryDirectory dir;
  test::Process process(video_words({"--duration", "100000", "--video", dir.file("v.mp4")}), software());
  std::this_thread::sleep_for(std::chrono::seconds(3));
  process.send(SIGINT);
  EXPECT_EQ(process.wait().exit_code, 130);
  EXPECT_THAT(probe(dir.file("v.mp4")), HasSubstr("codec_name=h264"));
  EXPECT_EQ(dir.entries(), 1u);
}

TEST(Frames, EndWithTheLastStateWhateverTheRate) {
  const test::TemporaryDirectory dir;
  // 7 ms at 60 a second: the first state, and the last.
  const auto run =
      aspic(video_words({"--steps", "7", "--frames", dir.file("f"), "--frames-format", "jpg", "--no-text"}),
            software());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(dir.file("f/frame-000001.jpg")));
  EXPECT_FALSE(std::filesystem::exists(dir.file("f/frame-000002.jpg")));
}

TEST(Frames, ViewChangesTheImageAndNotTheRun) {
  const test::TemporaryDirectory dir;
  const auto plain = aspic(video_words({"--steps", "5", "--frames", dir.file("a")}), software());
  const auto seen = aspic(video_words({"--steps", "5", "--frames", dir.file("b"), "--view", "color=speed",
                                       "--view", "camera.position=[3.0, 4.0, 20.0]"}),
                          software());
  ASSERT_EQ(seen.exit_code, 0) << seen.err;
  EXPECT_EQ(json_member(plain.out, "state_hash"), json_member(seen.out, "state_hash"));
  EXPECT_NE(dir.read("a/frame-000000.png"), dir.read("b/frame-000000.png"));
  const auto wrong = aspic(video_words({"--frames", dir.file("c"), "--view", "color=loud"}), software());
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("color"));
}

// A cube that falls freely stands still before a camera that falls along.
TEST(Frames, ACameraThatFollowsMovesAlong) {
  const test::TemporaryDirectory dir;
  dir.write("fall.toml",
            "schema = 1\n[[cube]]\nparticles-per-edge = 3\nposition = [0.0, 0.0, 0.0]\n"
            "[view]\ncamera = { position = [6.0, 3.0, 12.0], target = [0.0, 0.0, 0.0], fov = 40.0 }\n");
  const auto video = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> words = {
        "run",     dir.file("fall.toml"), "--duration", "0.5",         "--fps", "2", "--size",
        "160x120", "--no-text",           "--frames",   dir.file(name)};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = aspic(words, software());
    ASSERT_EQ(run.exit_code, 0) << run.err;
  };
  video("still", {});
  video("along", {"--view", "follow=cube"});
  const auto bytes_of = [&](const std::string& name) {
    int width = 0, height = 0, channels = 0;
    unsigned char* const pixels = stbi_load(dir.file(name).c_str(), &width, &height, &channels, 3);
    const std::vector<unsigned char> bytes(pixels, pixels + (pixels ? 3 * 160 * 120 : 0));
    stbi_image_free(pixels);
    return bytes;
  };
  const auto first = bytes_of("along/frame-000000.png"), last = bytes_of("along/frame-000001.png");
  EXPECT_EQ(dir.read("still/frame-000000.png"), dir.read("along/frame-000000.png"));
  EXPECT_NE(dir.read("still/frame-000001.png"), dir.read("along/frame-000001.png"));
  ASSERT_FALSE(first.empty());
  ASSERT_EQ(first.size(), last.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < first.size(); ++i)
    different += std::abs(static_cast<int>(first[i]) - static_cast<int>(last[i])) > 2;
  EXPECT_LT(different, first.size() / 200) << "edges alone may differ by rounding";
}

TEST(Program, IsLinkedToNothingOfOpenGlOrX11) {
  FILE* pipe = ::popen("ldd '" ASPIC_PROGRAM "'", "r");
  std::string libraries;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) libraries += static_cast<char>(c);
  ASSERT_EQ(::pclose(pipe), 0);
  EXPECT_THAT(libraries, HasSubstr("libfmt"));
  EXPECT_THAT(libraries, Not(HasSubstr("libEGL")));
  EXPECT_THAT(libraries, Not(HasSubstr("libGL")));
  EXPECT_THAT(libraries, Not(HasSubstr("libX11")));
}

}  // namespace
}  // namespace aspic
