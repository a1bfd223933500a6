// aspic run --variant: each run has the bits, and its part of the video the pixels, of the run alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stb_image.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/process.h"

namespace aspic {
namespace {

using test::aspic;
using test::ProcessOptions;
using testing::HasSubstr;
using testing::Not;
using Words = std::vector<std::string>;

/// A short run of a small cube, drawn in software.
test::Finished run(const Words& more) {
  Words words = {"run", "cube-plane", "--json", "--set", "cube[0].particles-per-edge=4"};
  if (std::ranges::find(more, "--backend") == more.end())
    words.insert(words.end(), {"--backend", "reference"});
  words.insert(words.end(), more.begin(), more.end());
  ProcessOptions options;
  options.environment = {{"ASPIC_EGL_DEVICE", "software"}};
  return aspic(words, options);
}

nlohmann::json json_of(const test::Finished& finished) {
  return nlohmann::json::parse(finished.out, nullptr, false);
}

struct Pixels {
  int width = 0, height = 0;
  std::string rgb;
};
Pixels read_png(const std::string& bytes) {
  Pixels pixels;
  int channels = 0;
  stbi_uc* rgb =
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()),
                            &pixels.width, &pixels.height, &channels, 3);
  if (rgb)
    pixels.rgb.assign(reinterpret_cast<char*>(rgb),
                      std::size_t{3} * static_cast<std::size_t>(pixels.width * pixels.height));
  stbi_image_free(rgb);
  return pixels;
}

/// Width × height pixels from (left, top).
std::string part(const Pixels& whole, int left, int top, int width, int height) {
  std::string rgb;
  for (int y = top; y < top + height; ++y)
    rgb += whole.rgb.substr(std::size_t{3} * static_cast<std::size_t>(y * whole.width + left),
                            std::size_t{3} * static_cast<std::size_t>(width));
  return rgb;
}

TEST(Comparison, EachRunHasTheBitsOfTheRunAlone) {
  const auto beside = run({"--duration", "0.4", "--variant", "integrator=implicit-euler", "--variant",
                           "h=0.0016", "--variant", "backend=cpu"});
  ASSERT_EQ(beside.exit_code, 0) << beside.err;
  const auto runs = json_of(beside)["runs"];
  ASSERT_EQ(runs.size(), 4u);
  const std::vector<Words> alone = {{},
                                    {"--set", "simulation.integrator=implicit-euler"},
                                    {"--set", "simulation.timestep=0.0016"},
                                    {"--backend", "cpu"}};
  for (std::size_t i = 0; i < alone.size(); ++i) {
    Words words = {"--duration", "0.4"};
    words.insert(words.end(), alone[i].begin(), alone[i].end());
    const auto one = json_of(run(words));
    EXPECT_EQ(runs[i]["state_hash"], one["state_hash"]) << i;
    EXPECT_EQ(runs[i]["steps"], one["steps"]) << i;
    EXPECT_EQ(runs[i]["backend"], one["backend"]) << i;
  }
  EXPECT_EQ(runs[0]["state_hash"], runs[3]["state_hash"]);
  EXPECT_NE(runs[0]["state_hash"], runs[1]["state_hash"]);
}

TEST(Comparison, TheAuthorIsNamedInTheFirstPartAlone) {
  const test::TemporaryDirectory dir;
  const auto image = [&](const std::string& name, const Words& more) {
    Words words = {"--steps", "0", "--size", "642x240", "--variant", "h=0.002", "--frames", dir.file(name)};
    words.insert(words.end(), more.begin(), more.end());
    const auto finished = run(words);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return read_png(dir.read(name + "/frame-000000.png"));
  };
  const Pixels nobody = image("nobody", {}), named = image("named", {"--set", "author=0356611"});
  ASSERT_EQ(named.width, 642);
  EXPECT_FALSE(part(named, 0, 0, 320, 240) == part(nobody, 0, 0, 320, 240));
  EXPECT_TRUE(part(named, 322, 0, 320, 240) == part(nobody, 322, 0, 320, 240));
}

TEST(Comparison, PartsOfTheImageAreThoseOfTheRunsAlone) {
  const test::TemporaryDirectory dir;
  const Words video = {"--duration", "0.2", "--fps", "10", "--no-text", "--frames"};
  const auto frames = [&](const std::string& name, const std::string& size, const Words& more) {
    Words words = video;
    words.insert(words.end(), {dir.file(name), "--size", size});
    words.insert(words.end(), more.begin(), more.end());
    const auto finished = run(words);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
  };
  frames("both", "130x96", {"--variant", "cube[0].structural.stiffness=300"});
  // Both backends with a context of their own where they run alone, and one where they run together.
  frames("gpu", "130x96", {"--variant", "backend=gpu"});
  frames("first", "64x96", {});
  frames("second", "64x96", {"--set", "cube[0].structural.stiffness=300"});
  for (const char* name : {"/frame-000000.png", "/frame-000001.png", "/frame-000002.png"}) {
    const Pixels both = read_png(dir.read(std::string("both") + name)),
                 gpu = read_png(dir.read(std::string("gpu") + name));
    const Pixels first = read_png(dir.read(std::string("first") + name));
    ASSERT_EQ(both.width, 130);
    ASSERT_EQ(first.width, 64);
    EXPECT_TRUE(part(both, 0, 0, 64, 96) == first.rgb) << name;
    EXPECT_TRUE(part(both, 66, 0, 64, 96) == read_png(dir.read(std::string("second") + name)).rgb) << name;
    EXPECT_TRUE(part(gpu, 0, 0, 64, 96) == first.rgb) << name;
    EXPECT_TRUE(part(gpu, 66, 0, 64, 96) == first.rgb) << name;
    EXPECT_TRUE(part(both, 64, 0, 2, 96) == std::string(std::size_t{3} * 2 * 96, '\0')) << name;
  }
}

TEST(Comparison, ADivergenceEndsOneRunAndNotTheVideo) {
  const test::TemporaryDirectory dir;
  const Words words = {"--duration", "0.3",
                       "--set",      "simulation.timestep=0.003",
                       "--set",      "cube[0].structural.stiffness=20000"};
  Words beside = words, alone = words;
  beside.insert(beside.end(), {"--variant", "integrator=implicit-euler", "--frames", dir.file("f"), "--size",
                               "130x96", "--fps", "20", "--series", dir.file("e.csv")});
  alone.insert(alone.end(),
               {"--set", "simulation.integrator=implicit-euler", "--series", dir.file("alone.csv")});
  const auto both = run(beside);
  EXPECT_EQ(both.exit_code, 5);
  EXPECT_THAT(both.err, HasSubstr("run 1 (integrator explicit Euler) diverged"));
  EXPECT_THAT(both.err, Not(HasSubstr("run 2 (integrator implicit Euler) diverged")));
  const auto runs = json_of(both)["runs"];
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_FALSE(runs[0]["diverged"].is_null());
  EXPECT_LT(runs[0]["steps"].get<int>(), 100);
  EXPECT_TRUE(runs[1]["diverged"].is_null());
  EXPECT_EQ(runs[1]["steps"], 100);
  EXPECT_EQ(runs[1]["state_hash"], json_of(run(alone))["state_hash"]);
  EXPECT_EQ(json_of(both)["images"]["count"], 7);
  EXPECT_EQ(dir.read("e-2.csv"), dir.read("alone.csv"));
  EXPECT_THAT(dir.read("e-1.csv"), Not(HasSubstr("nan")));
  // The image of the run that stands still changes no more; the other one's does.
  const Pixels last = read_png(dir.read("f/frame-000006.png")),
               before = read_png(dir.read("f/frame-000005.png"));
  ASSERT_EQ(last.width, 130);
  EXPECT_TRUE(part(last, 0, 0, 64, 96) == part(before, 0, 0, 64, 96));
  EXPECT_FALSE(part(last, 66, 0, 64, 96) == part(before, 66, 0, 64, 96));
}

TEST(Comparison, EachRunWritesFilesOfItsOwn) {
  const test::TemporaryDirectory dir;
  const auto beside =
      run({"--steps", "20", "--variant", "h=0.0005", "--state", dir.file("s.csv"), "--checkpoint",
           dir.file("c.aspic"), "--series", dir.file("e.csv"), "--every", "10"});
  ASSERT_EQ(beside.exit_code, 0) << beside.err;
  EXPECT_EQ(dir.entries(), 6u);
  const auto alone = run({"--steps", "20", "--state", dir.file("alone.csv")});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_EQ(dir.read("s-1.csv"), dir.read("alone.csv"));
  const auto runs = json_of(beside)["runs"];
  EXPECT_EQ(runs[1]["steps"], 40);  // the same time
  EXPECT_EQ(runs[1]["files"].size(), 3u);
  // A file that is there keeps all runs from starting.
  const auto again = run({"--steps", "1000000000", "--variant", "h=0.0005", "--state", dir.file("s.csv")});
  EXPECT_EQ(again.exit_code, 6);
  EXPECT_THAT(again.err, HasSubstr("--force"));
}

TEST(Comparison, WhatCannotBeIsRefused) {
  const auto refused = [](const Words& words) {
    const auto finished = run(words);
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    return finished.err;
  };
  EXPECT_THAT(refused({"--variant", "k"}), HasSubstr("KEY=VALUE"));
  EXPECT_THAT(refused({"--variant", "h=0.001", "--series", "/dev/null"}), HasSubstr("out-1.csv"));
  EXPECT_THAT(refused({"--variant", "h=0.001", "--resume", "c.aspic"}), HasSubstr("omit --resume"));
  EXPECT_THAT(refused({"--variant", "h=1", "--variant", "h=1", "--variant", "h=1", "--variant", "h=1"}),
              HasSubstr("at most 3"));
  const auto rejected = run({"--variant", "simulation.integratr=x"});
  EXPECT_EQ(rejected.exit_code, 3);
  EXPECT_THAT(rejected.err, HasSubstr("did you mean 'integrator'"));
}

}  // namespace
}  // namespace aspic
