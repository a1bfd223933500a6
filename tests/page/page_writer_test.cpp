#include "page/page_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "aspic/scene.h"
#include "base/files.h"
#include "cpu_reference/reference_solver.h"
#include "page/facts.h"
#include "page/page_reader.h"
#include "support/temporary_directory.h"

namespace aspic::page {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The largest difference of any component.
double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double far = a.size() == b.size() ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    far = std::max({far, std::abs(a[i].x - b[i].x), std::abs(a[i].y - b[i].y), std::abs(a[i].z - b[i].z)});
  return far;
}

/// A run of a scene whose states are kept.
struct Kept {
  Kept(const std::string& name, const std::vector<std::string>& overrides, std::uint64_t steps,
       std::vector<double> channels = {})
      : scene(load_scene(name, overrides).value()), model(build_model(scene.model).value()) {
    inputs.channels = std::move(channels);
    auto solver = make_reference_solver(model, Precision::single).value();
    EXPECT_TRUE(solver->set_inputs(inputs).ok());
    for (std::uint64_t step = 0;; ++step) {
      states.push_back(solver->state().value());
      if (step == steps) break;
      EXPECT_TRUE(solver->advance(1).ok());
    }
  }
  Scene scene;
  Model model;
  Inputs inputs;
  std::vector<State> states;  // of every step
};

struct PageTest : testing::Test {
  /// The page of a run that takes every state, as a video at that rate would.
  std::string page_of(const Kept& run, const PageSettings& settings = {}) {
    const std::string path = dir.file("page.html");
    const std::uint64_t last = run.states.size() - 1;
    auto sink = open_page(path, Overwrite::allow, run.scene, settings, 0, last);
    EXPECT_TRUE(sink.ok()) << sink.error().message();
    const auto sample = [&](std::uint64_t step) {
      return Sample{.model = run.model, .state = run.states[step], .inputs = &run.inputs};
    };
    EXPECT_TRUE((*sink)->take(sample(0)).ok());
    for (std::uint64_t step = (*sink)->next_step(0); step <= last; step = (*sink)->next_step(step))
      EXPECT_TRUE((*sink)->take(sample(step)).ok());
    EXPECT_TRUE((*sink)->finish(sample(last)).ok());
    return read_file(path).value();
  }
  void expect_near(const test::ReadPage& page, std::size_t run, const Kept& kept) {
    ASSERT_EQ(page.error, "");
    const auto& facts = page.facts["runs"][run];
    const auto& steps = page.ends[run]["steps"];
    ASSERT_EQ(steps.size(), page.images.size());
    for (std::size_t f = 0; f < page.images.size(); ++f) {
      const State& state = kept.states.at(steps[f]);
      const test::ReadImage& image = page.images[f][run];
      // Half a quantum, and the rounding of a product.
      EXPECT_LE(farthest(image.particles, state.position), 0.5000001 * facts["quantum"].get<double>());
      EXPECT_LE(farthest(image.balls, state.ball_position), 0.5000001 * facts["ballQuantum"].get<double>());
      EXPECT_LE(farthest(image.spins, state.ball_angular_velocity),
                0.5000001 * facts["spinQuantum"].get<double>());
      if (!facts["actuated"].empty()) {
        EXPECT_LE(farthest(image.changes, changes_of(kept.model, steps[f], kept.inputs.channels)),
                  0.5000001 * facts["changeQuantum"].get<double>());
      }
    }
  }
  test::TemporaryDirectory dir;
};

TEST_F(PageTest, HoldsRestLengthsOfActuatedSprings) {
  const Kept run("worm", {}, 100);
  const test::ReadPage page = test::read_page(page_of(run));
  expect_near(page, 0, run);
  EXPECT_GT(page.facts["runs"][0]["actuated"].size(), 10u);
  EXPECT_TRUE(page.facts["runs"][0]["ranges"].contains("actuation"));
  EXPECT_FALSE(page.images.back()[0].changes.empty());
  // What actuators did so far, to six digits, image by image.
  ActuatorWork work;
  const auto& steps = page.ends[0]["steps"];
  ASSERT_EQ(page.ends[0]["work"].size(), steps.size());
  for (std::size_t f = 0; f < steps.size(); ++f) {
    const double done = *work.add(run.model, run.states.at(steps[f]));
    EXPECT_NEAR(page.ends[0]["work"][f].get<double>(), done, 5e-6 * std::abs(done));
  }
  EXPECT_GT(page.ends[0]["work"].back().get<double>(), 0.0);
  // Those that follow inputs.
  const Kept steered("worm", {"actuator[0].signal=input", "actuator[0].ramp=0"}, 20, {0.5});
  const test::ReadPage page_of_it = test::read_page(page_of(steered));
  expect_near(page_of_it, 0, steered);
  EXPECT_GT(page_of_it.images.back()[0].changes[0].x, 0.01);
}

TEST_F(PageTest, HoldsEveryImageOfAVideoWithinHalfAQuantum) {
  const Kept run(
      "cube-plane",
      {"cube[0].particles-per-edge=4", "cube[0].position=[0.1, 1.2, 0.2]", "cube[0].rotation.angle=20"}, 200);
  const test::ReadPage page = test::read_page(page_of(run));
  expect_near(page, 0, run);
  // At 60 images a second, and the last state.
  ASSERT_EQ(page.images.size(), 13u);
  EXPECT_EQ(page.ends[0]["steps"][1], 17);
  EXPECT_EQ(page.ends[0]["steps"][12], 200);
  EXPECT_EQ(page.ends[0]["hash"], state_hash_text(run.states.back()));
  const double spacing = 4.0 / 3.0;
  EXPECT_DOUBLE_EQ(page.facts["runs"][0]["quantum"], spacing / 4096.0);
}

TEST_F(PageTest, HoldsNetsClothBallsAndTerrain) {
  for (const char* scene : {"penalty", "flag", "cube-hole", "cube-torus", "elevator"}) {
    const Kept run(scene, {}, 40);
    expect_near(test::read_page(page_of(run, {.speed = 0.5})), 0, run);
  }
}

// A mesh is drawn where the solver's corners put it, and instead of the faces of its cells.
TEST_F(PageTest, HoldsTheMeshThatABodyIsDrawnAs) {
  const Kept run("jelly-figure", {"voxels[0].cells=10"}, 20);
  const test::ReadPage page = test::read_page(page_of(run));
  expect_near(page, 0, run);
  const BodySkin& skin = run.model.bodies[0].skin;
  ASSERT_GT(skin.triangles.size(), 2000u);
  EXPECT_TRUE(page.facts["runs"][0]["bodies"][0]["groups"].empty());
  ASSERT_EQ(page.meshes.at(0).size(), 1u);
  const test::ReadMesh& mesh = page.meshes[0][0];
  EXPECT_EQ(mesh.corners, skin.corners);
  EXPECT_EQ(mesh.triangles, skin.triangles);
  const std::vector<Vec3>& places = run.states.back().position;
  const std::vector<Vec3> wanted = skin_positions(skin.binding, skin.corners, places);
  ASSERT_EQ(mesh.at.size(), wanted.size());
  for (std::size_t v = 0; v < wanted.size(); ++v) {
    Vec3 sum;
    for (std::size_t n = 0; n < 8; ++n) {
      const double x = (n & 4u) != 0 ? mesh.at[v].x : 1.0 - mesh.at[v].x,
                   y = (n & 2u) != 0 ? mesh.at[v].y : 1.0 - mesh.at[v].y,
                   z = (n & 1u) != 0 ? mesh.at[v].z : 1.0 - mesh.at[v].z;
      sum = sum + (x * y * z) * places[mesh.corners[v][n]];
    }
    EXPECT_LT(length(sum - wanted[v]), 1e-12) << v;
  }
}

TEST_F(PageTest, TakesFewerImagesAtFewerASecondAndMoreInSlowMotion) {
  const Kept run("cube-plane", {"cube[0].particles-per-edge=2"}, 100);
  EXPECT_EQ(test::read_page(page_of(run, {.fps = 20.0})).images.size(), 3u);
  EXPECT_EQ(test::read_page(page_of(run, {.fps = 60.0, .speed = 0.25})).images.size(), 25u);
  // More images than steps: no step twice.
  EXPECT_EQ(test::read_page(page_of(run, {.fps = 60.0, .speed = 0.001})).images.size(), 101u);
}

TEST_F(PageTest, SeveralRunsShareAPage) {
  const std::vector<std::string> small = {"cube[0].particles-per-edge=3"};
  const Kept a("cube-plane", small, 60);
  const Kept b("cube-plane", {small[0], "simulation.timestep=0.002"}, 30);
  auto writer = PageWriter::create(dir.file("both.html"), Overwrite::refuse);
  ASSERT_TRUE(writer.ok());
  const std::vector<PageRun> runs = {{&a.scene, &a.model, "h 1 ms"}, {&b.scene, &b.model, "h 2 ms"}};
  ASSERT_TRUE(writer->begin({.command = "aspic run"}, runs).ok());
  for (std::size_t step : {0u, 10u, 10u, 30u}) {
    const State* const states[] = {&a.states[2 * step], &b.states[step]};
    ASSERT_TRUE(writer->add(states).ok());
  }
  const State* const last[] = {&a.states[60], &b.states[30]};
  const std::optional<Divergence> ends[] = {std::nullopt, Divergence{31, 7}};
  ASSERT_TRUE(writer->finish(last, ends).ok());
  const test::ReadPage page = test::read_page(read_file(dir.file("both.html")).value());
  expect_near(page, 0, a);
  expect_near(page, 1, b);
  EXPECT_EQ(page.images.size(), 3u);  // what did not go on is not there twice
  EXPECT_EQ(page.facts["runs"][1]["name"], "h 2 ms");
  EXPECT_FALSE(page.ends[0].contains("diverged"));
  EXPECT_THAT(page.ends[1]["diverged"].get<std::string>(), HasSubstr("step 31: particle 7"));
}

TEST_F(PageTest, IsOneDocumentThatAsksForNothing) {
  Kept run("cube-plane", {"cube[0].particles-per-edge=2"}, 1);
  run.scene.name = "</script><b>&";
  run.scene.author = "A </script> \u202e B";
  const std::string html = page_of(run, {.command = "aspic run '</script>' --html x.html"});
  EXPECT_THAT(html, HasSubstr("<title>&lt;/script&gt;&lt;b&gt;&amp;</title>"));
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  for (const char* word : {"http:", "https:", "src=", "@import", "url(", "fetch(", "</script><b>"})
    EXPECT_THAT(html, Not(HasSubstr(word))) << word;
  const test::ReadPage page = test::read_page(html);
  ASSERT_EQ(page.error, "");
  EXPECT_EQ(page.facts["title"], "</script><b>&");
  EXPECT_THAT(page.facts["author"].get<std::string>(), HasSubstr("\\u{202e}"));
  EXPECT_EQ(page.facts["command"], "aspic run '</script>' --html x.html");
  // As many elements end as begin.
  const auto count = [&](const std::string& word) {
    std::size_t n = 0;
    for (std::size_t at = html.find(word); at != std::string::npos; at = html.find(word, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("<script"), count("</script>"));
}

TEST_F(PageTest, TheSameRunIsTheSameFile) {
  const Kept run("cube-and-balls", {"cube[0].particles-per-edge=3"}, 30);
  const std::string once = page_of(run);
  EXPECT_EQ(once, page_of(run));
}

TEST_F(PageTest, RefusesMoreThanABrowserHoldsAndSaysWhatFits) {
  EXPECT_TRUE(check_page(241, 200000, 60.0).ok());
  const Status refused = check_page(1000, 100000, 60.0);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::usage);
  EXPECT_THAT(refused.error().message(), HasSubstr("1000 frames of 100000 particles"));
  EXPECT_THAT(refused.error().message(), HasSubstr("100 million positions, and a browser holds 50 million"));
  EXPECT_THAT(
      worded(refused.error(), FrontEnd::command_line),
      testing::EndsWith(" Use --fps 30 or less, choose a shorter --duration, or use fewer particles."));
  const Scene large = load_scene("large-cube", {}).value();
  EXPECT_FALSE(open_page(dir.file("p.html"), Overwrite::refuse, large, {.fps = 240.0}, 0, 12500).ok());
  EXPECT_EQ(dir.entries(), 0u);
}

TEST_F(PageTest, NamesEndInHtml) {
  for (const char* name : {"a.html", "a.HTM", "a", "/dev/null"})
    EXPECT_TRUE(check_page_name(name).ok()) << name;
  for (const char* name : {"a.mp4", "-", "a.html.gz"}) EXPECT_FALSE(check_page_name(name).ok()) << name;
}

TEST(Packing, TrackIsExactModuloItsQuantumWhateverComes) {
  Track track(2, 0.5);
  std::string bytes;
  track.append(std::vector<Vec3>{{1e300, -1e300, 0.2}, {0.3, -0.3, 0.0}}, bytes);
  track.append(std::vector<Vec3>{{-1e300, 1e300, -0.2}, {1.0, 2.0, 3.0}}, bytes);
  // A byte for the number of planes, then four planes of six numbers each.
  EXPECT_EQ(bytes.size(), 2u * 25u);
  EXPECT_EQ(bytes[0], 4);
}

TEST(Packing, NumbersNearZeroTakeOneByte) {
  std::string bytes;
  append_planes(std::vector<std::int32_t>{0, -1, 1, -128, 127}, bytes);
  EXPECT_EQ(bytes, std::string("\x01\x00\x01\x02\xff\xfe", 6));
  bytes.clear();
  append_planes(std::vector<std::int32_t>{0, 0}, bytes);
  EXPECT_EQ(bytes, std::string(1, '\0'));
}

}  // namespace
}  // namespace aspic::page
