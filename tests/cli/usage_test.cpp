#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <sstream>

#include "base/memory.h"
#include "cli/process.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using test::aspic;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Words = std::vector<std::string>;

TEST(Usage, VersionAndHelpAreData) {
  const auto version = aspic({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, testing::MatchesRegex("aspic [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  EXPECT_THAT(version.err, IsEmpty());
  for (const Words& words :
       {Words{"--help"}, {"run", "--help"}, {"compare", "--help"}, {"verify", "--help"}}) {
    const auto help = aspic(words);
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr("Examples:"));
    EXPECT_THAT(help.err, IsEmpty());
  }
  EXPECT_THAT(aspic({"run", "--help"}).out, HasSubstr("--checkpoint"));
  EXPECT_THAT(aspic({"scene", "--help"}).out, HasSubstr("check"));
}

TEST(Usage, NamesTheMissingProgramOfACommand) {
  const test::TemporaryDirectory dir;
  test::ProcessOptions alone;
  alone.program = dir.file("aspic");
  std::filesystem::copy_file(ASPIC_PROGRAM, alone.program);
  for (const Words& words : {Words{"verify", "--list"},
                             {"bench"},
                             {"report", "cube-plane", "--out", "r"},
                             {"sweep", "cube-plane", "--vary", "k=1,2", "--out", "s.csv"}}) {
    const auto missing = aspic(words, alone);
    EXPECT_EQ(missing.exit_code, 6) << words.front();
    EXPECT_THAT(missing.err, HasSubstr("Cannot start " + dir.file("aspic-studies")));
  }
  EXPECT_EQ(aspic({"scene", "list"}, alone).exit_code, 0);
}

TEST(Usage, HelpNamesTheCompleteCommand) {
  EXPECT_THAT(aspic({"--help"}).out, HasSubstr("Usage: aspic [OPTIONS]"));
  EXPECT_THAT(aspic({"run", "--help"}).out, HasSubstr("Usage: aspic run [OPTIONS]"));
  EXPECT_THAT(aspic({"scene", "check", "--help"}).out, HasSubstr("Usage: aspic scene check [OPTIONS]"));
}

TEST(Usage, EveryOptionIsDocumented) {
  std::ifstream file(ASPIC_SOURCE_DIR "/docs/commands.md");
  const std::string page{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  int options = 0;
  for (const Words& words : {Words{"run", "--help"},
                             {"view", "--help"},
                             {"compare", "--help"},
                             {"verify", "--help"},
                             {"bench", "--help"},
                             {"scene", "check", "--help"},
                             {"info", "--help"}}) {
    for (const std::string& line : test::lines(aspic(words).out)) {
      // An option's line is indented by two; names of one option are joined by commas.
      if (!line.starts_with("  --")) continue;
      std::istringstream names(line.substr(2, line.find_first_of(" =", 2) - 2));
      for (std::string name; std::getline(names, name, ',');) {
        ++options;
        EXPECT_THAT(page, HasSubstr("`" + name)) << words.front();
      }
    }
  }
  EXPECT_GE(options, 30);
}

struct Failure {
  Words words;
  int exit_code;
  const char* message;
};

void PrintTo(const Failure& failure, std::ostream* os) {
  *os << "aspic";
  for (const std::string& word : failure.words) *os << ' ' << word;
}

class Failures : public testing::TestWithParam<Failure> {};

TEST_P(Failures, HaveTheirExitCodeASentenceAndNoData) {
  const auto finished = aspic(GetParam().words);
  EXPECT_EQ(finished.exit_code, GetParam().exit_code) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr(GetParam().message));
  EXPECT_THAT(finished.out, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Usage, Failures,
    testing::Values(
        Failure{{}, 2, "Examples:"}, Failure{{"rnu", "cube-plane"}, 2, "Did you mean run?"},
        Failure{{"frobnicate"}, 2, "no command \"frobnicate\""},
        Failure{{"view", "--size", "huge"}, 2, "--size must be"},
        Failure{{"view", "--layout", "cinema"}, 2, "standard, lecture, lab, video"},
        Failure{{"view", "--backend", "tpu"}, 2, "auto, gpu"},
        Failure{{"verify", "--only", "odrer"}, 2, "did you mean 'order'?"},
        Failure{{"verify", "--only", "rest/midpint"}, 2, "did you mean 'rest/midpoint'?"},
        Failure{{"bench", "--repeats", "0"}, 2, "--repeats"}, Failure{{"report"}, 2, "--out is required"},
        Failure{{"report", "--out", "x", "--only", "integators"}, 2, "integrators, parameters"},
        Failure{{"report", "--out", "x", "--outline", "lecture"},
                2,
                "unknown --outline \"lecture\"; allowed: course"},
        Failure{{"report", "--out", "x", "--outline", "course", "--only", "contact"}, 2, "without --outline"},
        Failure{{"report", "--out", "/nonexistent/x"}, 6, "/nonexistent"},
        Failure{{"report", "--out", ASPIC_SOURCE_DIR "/README.md"}, 6, "README.md is a file"},
        Failure{{"sweep", "cube-plane", "--out", "x.csv"}, 2, "--vary is required"},
        Failure{
            {"sweep", "cube-plane", "--vary", "h=1", "--out", "x.csv", "--part", "3/2"}, 2, "1 <= i <= n"},
        Failure{{"sweep", "cube-plane", "--vary", "h", "--out", "x.csv"}, 2, "its = is missing"},
        Failure{{"sweep", "cube-plane", "--vary", "h=0.001"}, 2, "--runs DIR"},
        Failure{{"sweep", "cube-plane", "--vary", "h=0.001", "--runs", "/proc/x"}, 6, "/proc/x"},
        Failure{{"sweep", "cube-plane", "--vary", "h=1:2", "--out", "x.csv"}, 2, "the count is missing"},
        Failure{{"sweep", "cube-plane", "--vary", "h=1:2:0", "--out", "x.csv"}, 2, "the count is from 1"},
        Failure{{"sweep", "cube-plane", "--vary", "h=0.001", "--out", "k.txt"}, 2, "k.txt in .csv"},
        Failure{{"sweep", "cube-plane", "--vary", "h=0:1:3:log", "--out", "x.csv"}, 2, "above 0"},
        Failure{{"sweep", "cube-plane", "--vary", "h=1:2:3:cubic", "--out", "x.csv"}, 2, "log or nothing"},
        Failure{{"sweep", "cube-plane", "--vary", "h=1,,2", "--out", "x.csv"}, 2, "a value is missing"},
        Failure{{"sweep", "cube-plane", "--vary", "h=0.1:0.2:1001", "--vary", "k=1:2:1000", "--out", "x.csv"},
                2,
                "more than 1000000 runs"},
        Failure{{"sweep", "cube-plane", "--vary", "h=0.1", "--vary", "h=0.2", "--out", "x.csv"}, 2, "twice"},
        Failure{{"sweep", "ball-pit", "--vary", "k=1:2:3", "--out", "x.csv"}, 2, "has none"},
        Failure{{"sweep", "cube-plane", "--vary", "stifness=1:2:3", "--out", "x.csv"}, 3, "unknown key"},
        Failure{
            {"sweep", "cube-plane", "--vary", "h=0.001", "--out", "/nonexistent/x.csv"}, 6, "/nonexistent"},
        Failure{{"scene", "import"}, 2, "file is required"},
        Failure{{"scene", "import", "/nonexistent/x.txt"}, 6, "Cannot read"},
        Failure{{"scene", "lst"}, 2, "Did you mean list?"}, Failure{{"scene"}, 2, "--help"},
        Failure{{"scene", "show"}, 2, "scene is required"}, Failure{{"run"}, 2, "needs a SCENE"},
        Failure{{"run", "cube-plane", "--stpes", "3"}, 2, "Did you mean --steps?"},
        Failure{{"run", "cube-plane", "extra"}, 2, "extra"},
        Failure{{"run", "cube-plane", "--steps", "-3"}, 2, "-3 is negative"},
        Failure{{"run", "cube-plane", "--steps", "x"}, 2, "--steps"},
        Failure{{"run", "cube-plane", "--steps"}, 2, "--steps"},
        Failure{{"run", "cube-plane", "--steps", "3", "--duration", "1"}, 2, "--duration"},
        Failure{{"run", "cube-plane", "--duration", "-1"}, 2, "0 or more"},
        Failure{{"run", "cube-plane", "--duration", "nan"}, 2, "finite"},
        Failure{{"run", "cube-plane", "--duration", "1e300"}, 2, "too many steps"},
        Failure{{"run", "cube-plane", "--every", "5"}, 2, "--every applies to --series FILE"},
        Failure{{"run", "cube-plane", "--series-every", "5"}, 2, "--series-every applies to --series FILE"},
        Failure{{"run", "cube-plane", "--checkpoint-every=5"},
                2,
                "--checkpoint-every applies to --checkpoint FILE"},
        Failure{{"run", "cube-plane", "--export-every", "5"}, 2, "--export-every applies to --export FILE"},
        Failure{{"run", "cube-plane", "--export", "x.abc"}, 2, "must end in .pvd or .pc2 or .npz"},
        Failure{{"run", "cube-plane", "--series", "x.csv", "--every", "0"}, 2, "--every: 0 is too small"},
        Failure{{"run", "cube-plane", "--series", "x.csv", "--series-every", "0"},
                2,
                "--series-every: 0 is too small"},
        Failure{{"run", "cube-plane", "--checkpoint", "c.aspic", "--checkpoint-every", "-1"},
                2,
                "-1 is negative; give a whole number of 1 or more"},
        Failure{{"bench", "--size", "0"}, 2, "0 is too small"},
        Failure{{"run", "cube-plane", "--state", "a.csv", "--state", "b.csv"}, 2, "--state is given 2 times"},
        Failure{{"run", "cube-plane", "--backend", "tpu"}, 2, "auto, gpu, "},
        Failure{{"run", "cube-plane", "--precision", "half"}, 2, "single, double"},
        Failure{{"run", "cube-plane", "--force-path", "x"}, 2, "per-spring"},
        Failure{{"run", "cube-plane", "--backend", "gpu", "--precision", "double"}, 2, "--backend reference"},
        Failure{{"run", "cube-plane", "--backend", "reference", "--force-path", "gather"},
                2,
                "applies to the gpu"},
        Failure{{"run", "cube-plane", "--backend", "reference", "--arithmetic", "fast"},
                2,
                "does not compute in fast arithmetic. Use --backend gpu."},
        Failure{{"run", "cube-plane", "--backend", "cpu:fast"}, 2, "the cpu does not"},
        Failure{{"run", "cube-plane", "--arithmetic", "quick"}, 2, "allowed: exact, fast"},
        Failure{
            {"run", "cube-plane", "--arithmetic", "fast", "--precision", "double"}, 2, "no backend supports"},
        Failure{{"run", "cube-plane", "--backend", "reference", "--threads", "2"},
                2,
                "the reference does not take a number of threads. Use --backend cpu."},
        Failure{{"run", "cube-plane", "--threads", "0"}, 2, "from 1 to 1024"},
        Failure{{"run", "cube-plane", "--threads", "1025"}, 2, "--threads"},
        Failure{{"view", "--backend", "reference", "--arithmetic", "fast"}, 2, "the reference does not"},
        Failure{{"bench", "--backend", "reference", "--arithmetic", "fast"}, 2, "the reference does not"},
        Failure{{"compare", "cube-plane", "--backends", "reference,reference:double", "--arithmetic", "fast"},
                2,
                "the reference does not"},
        Failure{{"compare", "cube-plane", "--backends", "cpu,reference:fast"}, 2, "the reference does not"},
        // Names that say no format of the option, or nothing.
        Failure{{"run", "cube-plane", "--state", "x.txt"},
                2,
                "--state: the state's name x.txt must end in .csv or .vtp"},
        Failure{{"run", "cube-plane", "--state", "y.vtk"}, 2, "must end in .csv or .vtp"},
        Failure{{"run", "cube-plane", "--state", "-"}, 2, "/dev/stdout"},
        Failure{{"run", "cube-plane", "--checkpoint", "c.csv"}, 2, "must end in .aspic"},
        Failure{{"run", "cube-plane", "--series", "e.vtp"}, 2, "must end in .csv"},
        Failure{
            {"run", "cube-plane", "--variant", "h=0.002", "--state", "x.txt"}, 2, "must end in .csv or .vtp"},
        Failure{
            {"run", "cube-plane", "--html", "x.mp4"}, 2, "--html: the page's name x.mp4 must end in .html"},
        Failure{{"run", "cube-plane", "--html", "-"}, 2, "/dev/stdout"},
        // Former names.
        Failure{{"run", "cube-plane", "--page", "x.mp4"}, 2, "--html: the page's name x.mp4"},
        Failure{{"run", "cube-plane", "--page-live=x.mp4"}, 2, "--html-live: the page's name x.mp4"},
        Failure{{"run", "cube-plane", "--beside", "k"}, 2, "--variant: "},
        Failure{{"bench", "cube-plane", "--pictures", "k"}, 2, "--images"},
        Failure{{"run", "cube-plane", "--variant", "h=0.002", "--html", "x.csv"}, 2, "must end in .html"},
        Failure{{"run", "cube-plane", "--state", ""}, 2, "--state: the name is empty"},
        Failure{{"run", "cube-plane", "--video", ""}, 2, "--video: the name is empty"},
        Failure{{"report", "--out", ""}, 2, "--out: the name is empty"},
        // Options that would do nothing.
        Failure{{"run", "cube-plane", "--size", "64x64"}, 2, "--size applies to images"},
        Failure{{"run", "cube-plane", "--fps", "30"}, 2, "--fps applies to images"},
        Failure{{"run", "cube-plane", "--html", "x.html", "--size", "64x64"}, 2, "--size applies to images"},
        Failure{{"run", "large-cube", "--html", "x.html", "--fps", "600"}, 2, "--fps 63 or less"},
        Failure{{"run", "large-cube", "--variant", "h=0.0001", "--html", "x.html"}, 2, "million positions"},
        Failure{{"run", "cube-plane", "--no-text"}, 2, "--no-text applies to images"},
        Failure{{"run", "cube-plane", "--speed=0.5"}, 2, "--speed applies to images"},
        Failure{{"run", "cube-plane", "--view", "color=strain"}, 2, "--view applies to images"},
        Failure{{"run", "cube-plane", "--video", "x.mp4", "--frames-format", "jpg"},
                2,
                "applies to --frames DIR"},
        // Keys of a scene are no options.
        Failure{{"run", "cube-plane", "--dt", "0.001"}, 2, "--set simulation.timestep=VALUE"},
        Failure{{"run", "cube-plane", "--integrator", "midpoint"}, 2, "--set simulation.integrator=VALUE"},
        Failure{{"sweep", "cube-plane", "--friction", "0.1"}, 2, "--set contact.friction=VALUE"},
        // A backend's options after its name.
        Failure{{"run", "cube-plane", "--backend", "gpu:gahter"}, 2, "unknown backend option"},
        Failure{{"run", "cube-plane", "--backend", "cpu:gather"}, 2, "applies to the gpu"},
        Failure{{"run", "cube-plane", "--backend", "cpu:double"}, 2, "Use --backend reference"},
        Failure{{"compare", "cube-plane", "--backends", "gpu,cpu,reference"},
                2,
                "--backends takes two backends, such as gpu,reference, not 3 (gpu,cpu,reference)"},
        Failure{{"run", "cube-plane", "--state", "same.csv", "--series", "./same.csv"}, 2, "its own name"},
        Failure{{"run", "--resume", "x", "--set", "a=1"}, 2, "--set cannot change"},
        Failure{{"compare", "cube-plane", "--backends", "reference"}, 2, "--backends"},
        Failure{{"compare", "cube-plane", "--backends", "reference,refrence"}, 2, "unknown backend"},
        Failure{{"compare", "cube-plane", "--backends", "reference,reference:triple"}, 2, "backend option"},
        Failure{{"compare", "cube-plane", "--tolerance", "-1"}, 2, "--tolerance"}));

INSTANTIATE_TEST_SUITE_P(
    Rejected, Failures,
    testing::Values(Failure{{"run", "no-such-scene"}, 3, "no-such-scene"},
                    Failure{{"run", "cube-plan"}, 3, "cube-plane"},
                    Failure{{"run", "cube-plane", "--set", "simulation.timestpe=0.002"}, 3, "timestep"},
                    Failure{{"run", "cube-plane", "--set", "simulation.timestep=-1"}, 3, "timestep"},
                    Failure{{"scene", "check", "cube-plan"}, 3, "cube-plane"},
                    Failure{{"compare", "cube-plane", "--backends", "reference,tpu"}, 2, "auto, gpu, "}));

TEST(Usage, ABackendTakesItsOptionsAfterItsName) {
  const auto twice = aspic({"run", "cube-plane", "--backend", "reference:double", "--steps", "3", "--json"});
  EXPECT_EQ(twice.exit_code, 0) << twice.err;
  EXPECT_EQ(test::json_member(twice.out, "precision"), "double");
}

TEST(Usage, AnEndingMayBeInCapitals) {
  const test::TemporaryDirectory dir;
  const auto run =
      aspic({"run", "cube-plane", "--backend", "reference", "--steps", "1", "--state", dir.file("x.VTP"),
             "--series", dir.file("E.Csv"), "--checkpoint", dir.file("C.ASPIC")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(dir.read("x.VTP"), testing::StartsWith("<?xml"));
}

TEST(Usage, ImagesThatCannotBeCountedLeaveNothingBehind) {
  const test::TemporaryDirectory dir;
  for (const Words& more : {Words{}, {"--variant", "h=0.002"}}) {
    Words words = {"run",      "cube-plane",  "--backend", "reference",
                   "--frames", dir.file("z"), "--speed",   "1e-300"};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = aspic(words);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_THAT(run.err, HasSubstr("frames of this run. Use --speed "));
    EXPECT_EQ(dir.entries(), 0u);
  }
}

TEST(Usage, VerifyListsItsChecks) {
  const auto list = aspic({"verify", "--list"});
  EXPECT_EQ(list.exit_code, 0) << list.err;
  EXPECT_THAT(list.out, HasSubstr("order/midpoint "));
  const auto rest = aspic({"verify", "--list", "--only", "rest", "--json"});
  ASSERT_TRUE(test::is_json(rest.out)) << rest.out;
  EXPECT_THAT(rest.out, testing::AllOf(HasSubstr("rest/"), Not(HasSubstr("order/"))));
}

// Examples and exit codes of a command are its own, and every line fits a wide terminal.
TEST(Usage, HelpIsThatOfTheCommand) {
  for (const Words& words : {Words{},
                             {"run"},
                             {"view"},
                             {"compare"},
                             {"verify"},
                             {"report"},
                             {"sweep"},
                             {"bench"},
                             {"scene"},
                             {"scene", "list"},
                             {"scene", "show"},
                             {"scene", "check"},
                             {"scene", "import"},
                             {"info"}}) {
    Words asked = words;
    asked.emplace_back("--help");
    std::string name = "aspic", text = aspic(asked).out;
    for (const std::string& word : words) name += " " + word;
    const std::size_t examples = text.find("Example");
    ASSERT_NE(examples, std::string::npos) << name;
    EXPECT_THAT(text.substr(0, examples), Not(HasSubstr("\n\n\n"))) << name;
    std::istringstream shown(text.substr(examples));
    for (std::string line; std::getline(shown, line);) {
      if (line.starts_with("  aspic ")) {
        EXPECT_THAT(line, testing::StartsWith("  " + name)) << name;
      }
    }
    for (const std::string& line : test::lines(text)) EXPECT_LE(line.size(), 130u) << name << ": " << line;
    EXPECT_EQ(text.find("Exit codes:") != std::string::npos, words.empty()) << name;
  }
}

TEST(Usage, MisspeltKeyInAFileShowsLineAndCaretAndWritesNothing) {
  const test::TemporaryDirectory dir;
  dir.write("bad.toml", "schema = 1\n[simulation]\ntimestpe = 0.001\n[[cube]]\n");
  const auto finished = aspic({"run", dir.file("bad.toml"), "--state", dir.file("s.csv")});
  EXPECT_EQ(finished.exit_code, 3);
  EXPECT_THAT(finished.err, HasSubstr("bad.toml:3"));
  EXPECT_THAT(finished.err, HasSubstr("timestpe = 0.001"));
  EXPECT_THAT(finished.err, HasSubstr("^"));
  EXPECT_THAT(finished.err, HasSubstr("timestep"));
  EXPECT_EQ(dir.entries(), 1u);
}

TEST(Usage, WithoutADeviceGpuIsRefusedAndInfoSaysSo) {
  const test::ProcessOptions no_device = {{{"ASPIC_EGL_DEVICE", "97"}}, "", {}};
  EXPECT_EQ(aspic({"run", "cube-plane", "--steps", "1", "--backend", "gpu"}, no_device).exit_code, 4);
  EXPECT_EQ(aspic({"compare", "cube-plane", "--steps", "1"}, no_device).exit_code, 4);
  const auto picked = aspic({"run", "cube-plane", "--steps", "1", "--json"}, no_device);
  EXPECT_EQ(picked.exit_code, 0) << picked.err;
  EXPECT_EQ(test::json_member(picked.out, "backend"), "cpu");
  EXPECT_EQ(aspic({"run", "cube-plane", "--steps", "1", "--force-path", "gather"}, no_device).exit_code, 4);
  const auto info = aspic({"info"}, no_device);
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("No usable GL device"));
  EXPECT_THAT(info.out, HasSubstr("Backend auto: cpu, because no OpenGL 4.3 device was found"));
}

// On a software rasterizer: that there is one is no reason to install one, and all commands say the same.
TEST(Usage, AutoHasOneReasonEverywhere) {
  const test::ProcessOptions software = {{{"ASPIC_EGL_DEVICE", "software"}}, "", {}};
  const auto info = aspic({"info", "--json"}, software);
  ASSERT_EQ(info.exit_code, 0) << info.err;
  const std::string reason = test::json_member(info.out, "auto_reason");
  EXPECT_THAT(info.out, Not(HasSubstr("Install")));
  const Words run = {"run", "cube-plane", "--steps", "1", "--json"};
  EXPECT_EQ(test::json_member(aspic(run, software).out, "backend_reason"), reason);
  Words beside = run;
  beside.insert(beside.end(), {"--variant", "h=0.002"});
  EXPECT_EQ(test::json_member(aspic(beside, software).out, "backend_reason"), reason);
}

TEST(Usage, ShaderCacheIsFilledWhereItIsNotRefused) {
  const test::TemporaryDirectory cache;
  const test::ProcessOptions software = {
      {{"ASPIC_EGL_DEVICE", "software"}, {"ASPIC_SHADER_CACHE", cache.path().string()}}, "", {}};
  Words run = {"run", "cube-plane", "--backend", "gpu", "--steps", "1", "--json", "--no-shader-cache"};
  const std::string hash = test::json_member(aspic(run, software).out, "state_hash");
  EXPECT_EQ(cache.entries(), 0u);
  EXPECT_THAT(aspic({"info", "--no-shader-cache"}, software).out, HasSubstr("Shader cache: none"));
  run.pop_back();
  EXPECT_EQ(test::json_member(aspic(run, software).out, "state_hash"), hash);
  const std::size_t programs = cache.entries();
  EXPECT_GE(programs, 2u);
  EXPECT_EQ(test::json_member(aspic(run, software).out, "state_hash"), hash);
  EXPECT_EQ(cache.entries(), programs);
  EXPECT_THAT(aspic({"info"}, software).out, HasSubstr("Shader cache: " + cache.path().string() + ", "));
}

TEST(Usage, ThreadsOfTheEnvironmentMustBeANumber) {
  const Words run = {"run", "cube-plane", "--backend", "cpu", "--steps", "1"};
  const auto refused = aspic(run, {{{"ASPIC_THREADS", "abc"}}, "", {}});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err,
              HasSubstr("ASPIC_THREADS is \"abc\", which is not a number of threads: set a whole "
                        "number from 1 to 1024, or unset it."));
  EXPECT_EQ(aspic(run, {{{"ASPIC_THREADS", "3"}}, "", {}}).exit_code, 0);
}

TEST(Usage, ThreadsReachTheCpu) {
  const auto equal =
      aspic({"compare", "cube-plane", "--backends", "cpu,reference", "--threads", "5", "--steps", "20"});
  EXPECT_EQ(equal.exit_code, 0) << equal.err;
  EXPECT_THAT(equal.out, HasSubstr("cpu, 5 threads"));
  EXPECT_THAT(equal.out, HasSubstr("no step differs"));
}

TEST(Usage, InfoIsJsonOnRequest) {
  const auto info = aspic({"info", "--json"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_TRUE(test::is_json(info.out)) << info.out;
}

TEST(Usage, InfoGivesTheMachinesFreeMemoryForASoftwareRasterizer) {
  test::ProcessOptions software;
  software.environment = {{"ASPIC_EGL_DEVICE", "software"}};
  const auto info = aspic({"info", "--json"}, software);
  ASSERT_EQ(info.exit_code, 0) << info.err;
  const auto machine = available_memory();
  ASSERT_TRUE(machine.has_value());
  // Other programs take and give back memory meanwhile.
  const double told = std::strtod(test::json_member(info.out, "gpu_free_bytes").c_str(), nullptr);
  EXPECT_GT(told, 0.5 * static_cast<double>(*machine));
  EXPECT_LT(told, 2.0 * static_cast<double>(*machine));
}

TEST(Scene, ListNamesBuiltInScenesThatShowPrintsAndShownTextIsAScene) {
  const auto list = aspic({"scene", "list"});
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_THAT(list.out, testing::StartsWith("Cubes\n  cube-plane  "));
  EXPECT_THAT(list.out, HasSubstr("\n\nUniversity course\n  course-2021-plane  "));
  const auto shown = aspic({"scene", "show", "cube-plane", "--set", "simulation.timestep=0.0015"});
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("0.0015"));
  const test::TemporaryDirectory dir;
  dir.write("shown.toml", shown.out);
  const auto again = aspic({"scene", "show", dir.file("shown.toml")});
  EXPECT_EQ(again.out, shown.out) << again.err;
}

TEST(Scene, CheckPrintsCountsMemoryAndStableSteps) {
  const auto check = aspic({"scene", "check", "cube-plane"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  for (const char* part : {"1000, 0 of them pinned", "12876 (2700 structural, 7776 shear, 2400 bending)",
                           "gpu:gather", "0.002048 s", "0.001024 s", "0.002852 s", "0.001917 s"}) {
    EXPECT_THAT(check.out, HasSubstr(part));
  }
  EXPECT_THAT(check.err, IsEmpty());
  const auto json = aspic({"scene", "check", "cube-plane", "--json"});
  EXPECT_TRUE(test::is_json(json.out)) << json.out;
  EXPECT_EQ(test::json_member(json.out, "shear"), "7776");
}

TEST(Scene, CheckWarnsOfAnUnstableStep) {
  const auto check = aspic({"scene", "check", "cube-plane", "--set", "simulation.timestep=0.0021"});
  EXPECT_EQ(check.exit_code, 0);
  EXPECT_THAT(check.err, HasSubstr("0.0021 s is not stable"));
  EXPECT_THAT(check.err, HasSubstr("0.002048"));
}

}  // namespace
}  // namespace aspic
