// aspic run --export: which files there are, and what is left of a run that ends before its time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>

#include "cli/process.h"

namespace aspic {
namespace {

using test::aspic;
using testing::HasSubstr;
using Words = std::vector<std::string>;

Words flag_words(const Words& more) {
  Words words = {"run", "flag", "--backend", "reference"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// How many samples an archive of arrays has: the extents of `steps` in its table of types.
std::string samples_of(const std::string& archive) {
  const std::size_t at = archive.find("'descr': '<i8', 'fortran_order': False, 'shape': (");
  if (at == std::string::npos) return "none";
  const std::size_t first = archive.find('(', at) + 1;
  return archive.substr(first, archive.find(',', first) - first);
}

TEST(RunExports, TakeTheFormatOfTheirEnding) {
  const test::TemporaryDirectory dir;
  for (const char* name : {"run.pvd", "run.pc2", "run.NPZ"}) {
    const auto run = aspic(flag_words({"--steps", "25", "--export", dir.file(name), "--export-every", "10"}));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("wrote        " + dir.file(name)));
  }
  for (const char* name : {"run-00000000.vtp", "run-00000010.vtp", "run-00000020.vtp", "run-00000025.vtp"}) {
    EXPECT_THAT(dir.read("run.pvd"), HasSubstr(name));
    EXPECT_THAT(dir.read(name), HasSubstr("<VTKFile type=\"PolyData\""));
  }
  EXPECT_EQ(samples_of(dir.read("run.NPZ")), "4");
  EXPECT_THAT(dir.read("run.obj"), HasSubstr("# samples 3\n# start 0\n# interval 0.01\n"));
  EXPECT_EQ(dir.entries(), 8u);
  EXPECT_EQ(aspic(flag_words({"--steps", "3", "--export", dir.file("run.npz.npz")})).exit_code, 0);
  EXPECT_EQ(samples_of(dir.read("run.npz.npz")), "2") << "the start and the end";
}

TEST(RunExports, RefusePvdNamesThatXmlCannotHold) {
  const test::TemporaryDirectory dir;
  for (const char* name : {"\x1b.pvd", "\x01.pvd", "a\xff.pvd"}) {
    const auto run = aspic(flag_words({"--steps", "2", "--export", dir.file(name)}));
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_THAT(run.err, HasSubstr("choose another name"));
  }
  EXPECT_EQ(dir.entries(), 0u);
  EXPECT_EQ(aspic(flag_words({"--steps", "2", "--export", dir.file("ü & <\".pvd")})).exit_code, 0);
}

TEST(RunExports, OfRunsSideBySideEachHasItsOwn) {
  const test::TemporaryDirectory dir;
  const auto run =
      aspic(flag_words({"--steps", "20", "--variant", "h=0.002", "--export", dir.file("run.pc2")}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* name : {"run-1.pc2", "run-1.obj", "run-2.pc2", "run-2.obj"})
    EXPECT_GT(dir.read(name).size(), 100u) << name;
  EXPECT_EQ(dir.entries(), 4u);
}

TEST(RunExports, WhatIsThereIsKeptWithoutForce) {
  for (const char* name : {"run.pvd", "run.npz", "run.pc2", "run.obj", "run-00000005.vtp"}) {
    const test::TemporaryDirectory dir;
    dir.write(name, "precious");
    const std::string path = dir.file(std::string(name) == "run.obj"                 ? "run.pc2"
                                      : name == std::string_view("run-00000005.vtp") ? "run.pvd"
                                                                                     : name);
    const Words words = flag_words({"--steps", "5", "--export", path});
    const auto refused = aspic(words);
    EXPECT_EQ(refused.exit_code, 6) << name;
    EXPECT_THAT(refused.err, testing::AllOf(HasSubstr(name), HasSubstr("--force")));
    EXPECT_EQ(dir.read(name), "precious");
    Words forced = words;
    forced.push_back("--force");
    EXPECT_EQ(aspic(forced).exit_code, 0) << name;
    EXPECT_NE(dir.read(name), "precious");
  }
}

TEST(RunExports, NamesThatMeetAreRefused) {
  const test::TemporaryDirectory dir;
  const auto run = aspic(flag_words(
      {"--steps", "5", "--export", dir.file("a.pvd"), "--state", dir.file("a.vtp"), "--state-every", "5"}));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("give each its own name"));
  EXPECT_EQ(dir.entries(), 0u);
  EXPECT_EQ(aspic(flag_words({"--steps", "5", "--export", dir.file("a.pvd"), "--state", dir.file("a.vtp")}))
                .exit_code,
            0);
  const auto device = aspic(flag_words({"--steps", "5", "--export", "/dev/null"}));
  EXPECT_EQ(device.exit_code, 2);
  EXPECT_THAT(device.err, HasSubstr("name a file"));
}

TEST(RunExports, FullDiskLeavesNothingThatLooksComplete) {
  for (const char* name : {"run.pc2", "run.npz"}) {
    const test::TemporaryDirectory dir;
    test::ProcessOptions limited;
    limited.file_size_limit = 40000;
    const auto cut =
        aspic(flag_words({"--steps", "300", "--export", dir.file(name), "--export-every", "1"}), limited);
    EXPECT_EQ(cut.exit_code, 6) << cut.err;
    EXPECT_THAT(cut.err, HasSubstr(name));
    EXPECT_EQ(dir.entries(), 0u) << name;
  }
}

/// A run that no one could wait for, after some samples.
class EndlessExport {
 public:
  explicit EndlessExport(const std::string& name)
      : process_(flag_words({"--steps", "1000000000", "--export", dir.file(name), "--export-every", "50",
                             "--state", dir.file("every.csv"), "--state-every", "100"})) {
    while (!std::filesystem::exists(dir.file("every-00000300.csv")))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  test::Process& process() { return process_; }

  const test::TemporaryDirectory dir;

 private:
  test::Process process_;
};

TEST(RunExports, InterruptLeavesTheSamplesSoFar) {
  for (const char* name : {"run.pvd", "run.pc2", "run.npz"}) {
    EndlessExport run(name);
    run.process().send(SIGINT);
    const auto finished = run.process().wait();
    EXPECT_EQ(finished.exit_code, 130) << finished.err;
    if (std::string_view(name) == "run.npz") {
      EXPECT_GE(std::stoi(samples_of(run.dir.read(name))), 7);
    } else if (std::string_view(name) == "run.pc2") {
      const std::string cache = run.dir.read(name);
      std::int32_t vertices = 0, samples = 0;
      std::memcpy(&vertices, cache.data() + 16, 4);
      std::memcpy(&samples, cache.data() + 28, 4);
      EXPECT_GE(samples, 7);
      EXPECT_EQ(cache.size(),
                32 + 12 * static_cast<std::size_t>(vertices) * static_cast<std::size_t>(samples));
    } else {
      EXPECT_THAT(run.dir.read(name), testing::AllOf(HasSubstr("run-00000300.vtp"), HasSubstr("</VTKFile>")));
    }
  }
}

TEST(RunExports, AKilledRunLeavesASeriesThatCanBeRead) {
  EndlessExport run("run.pvd");
  run.process().send(SIGKILL);
  EXPECT_EQ(run.process().wait().signal, SIGKILL);
  const std::string collection = run.dir.read("run.pvd");
  EXPECT_THAT(collection, HasSubstr("</VTKFile>"));
  int files = 0;
  for (std::size_t at = 0; (at = collection.find("file=\"", at)) != std::string::npos; ++files) {
    at += 6;
    EXPECT_THAT(run.dir.read(collection.substr(at, collection.find('"', at) - at)), HasSubstr("</VTKFile>"));
  }
  EXPECT_GE(files, 1);
}

}  // namespace
}  // namespace aspic
