// The cameras of the built-in scenes: how much of an image the bodies fill from beginning to end.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "aspic/scene.h"
#include "cpu_parallel/cpu_solver.h"
#include "render/camera.h"
#include "render/studio.h"
#include "scene/follow.h"
#include "support/projection.h"

namespace aspic {
namespace {

/// A video's shape, and that of the first window's view: 1280 × 720 with panels on both sides.
constexpr std::array<std::array<int, 2>, 2> shapes = {{{320, 180}, {240, 224}}};

/// Pixels of the image within the convex hull of these places.
void add_hull(const Camera& camera, std::span<const Vec3> places, int width, int height,
              std::set<int>& pixels) {
  std::vector<std::array<double, 2>> points;
  for (const Vec3& place : places)
    if (const auto seen = test::project(camera, place)) points.push_back({seen->x, seen->y});
  std::ranges::sort(points);
  std::vector<std::array<double, 2>> hull;
  const auto half = [&](auto begin, auto end) {
    const std::size_t first = hull.size();
    for (auto p = begin; p != end; ++p) {
      const auto turns = [&] {
        const auto &a = hull[hull.size() - 2], &b = hull.back();
        return (b[0] - a[0]) * ((*p)[1] - a[1]) - (b[1] - a[1]) * ((*p)[0] - a[0]) > 0.0;
      };
      while (hull.size() >= first + 2 && !turns()) hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  half(points.begin(), points.end());
  half(points.rbegin(), points.rend());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      bool inside = hull.size() > 2;
      for (std::size_t i = 0; inside && i < hull.size(); ++i) {
        const auto &a = hull[i], &b = hull[(i + 1) % hull.size()];
        inside = (b[0] - a[0]) * (y + 0.5 - a[1]) - (b[1] - a[1]) * (x + 0.5 - a[0]) >= 0.0;
      }
      if (inside) pixels.insert(y * width + x);
    }
  }
}

/// What each built-in scene is looked at with, and the least share that is held in each shape.
struct Framing {
  std::string scene;
  std::vector<std::string> overrides = {};
  double video = 0.08, window = 0.08;
};

void PrintTo(const Framing& framing, std::ostream* out) {
  *out << framing.scene;
}

/// Scenes that cannot fill 8 % of every image, and why.
const std::map<std::string, const char*> exceptions = {
    {"ball-pit", "the bowl is empty at the start: nothing is there to see"},
    {"cube-plane",
     "in a video: a cube of 4 m falls by 8 m, and a camera at rest that has both ends and the horizon in a "
     "image of 16 : 9 comes to 7.6 %"},
    {"cubes-tower", "eight times as high as wide: as high as the image it has 7.7 %"},
    {"knot", "a strip that is thin for its length: an image that has both ends of it has 1.1 %"}};

class Framed : public test::Studio, public ::testing::WithParamInterface<Framing> {
 protected:
  /// The share of the image in which a body is seen, whatever hides it left out; of a net all that it
  /// spans, since its cords are thinner than a pixel.
  double share(const Scene& scene, const Model& model, const State& state, const Following& following,
               const std::array<int, 2>& shape) {
    const auto [width, height] = shape;
    ImageOptions options;
    options.view = scene.view;
    options.view.camera = fitted(moved(scene.view.camera, following.offset(model, state)), width, height);
    options.shadows = false;
    const test::Image with = draw(model, state, options, width, height);
    options.view.draw = {false, false, false, false, false};
    const test::Image without = draw(model, state, options, width, height);
    std::set<int> pixels;
    for (int i = 0; i < width * height; ++i) {
      const auto at = 3 * static_cast<std::size_t>(i);
      if (!std::equal(&with.rgb[at], &with.rgb[at] + 3, &without.rgb[at])) pixels.insert(i);
    }
    const Camera camera(options.view.camera, width, height);
    for (const Body& body : model.bodies)
      if (body.style == SurfaceStyle::cords)
        add_hull(camera, std::span(state.position).subspan(body.first_particle, body.particle_count), width,
                 height, pixels);
    return static_cast<double>(pixels.size()) / (width * height);
  }
};

TEST_P(Framed, BodiesFillTheImageFromBeginningToEnd) {
  const Framing& framing = GetParam();
  const auto scene = load_scene(framing.scene, framing.overrides);
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  const Model model = test::build(scene->model);
  auto solver = make_cpu_solver(model);
  ASSERT_TRUE(solver.ok());
  const Following following(*scene, model, Precision::single);
  const auto steps = static_cast<std::uint64_t>(
      std::llround(scene->model.simulation.duration / scene->model.simulation.timestep));
  constexpr std::uint64_t images = 12;
  std::array<double, 2> least = {1.0, 1.0};
  for (std::uint64_t i = 0; i <= images; ++i) {
    ASSERT_TRUE((*solver)->advance(i * steps / images - (i > 0 ? (i - 1) * steps / images : 0)).ok());
    const auto state = (*solver)->state();
    ASSERT_TRUE(state.ok());
    for (std::size_t k = 0; k < shapes.size(); ++k)
      least[k] = std::min(least[k], share(*scene, model, *state, following, shapes[k]));
  }
  std::printf("%s: %.1f %% of a video's image, %.1f %% of the window's\n", framing.scene.c_str(),
              100.0 * least[0], 100.0 * least[1]);
  EXPECT_GE(least[0], framing.video);
  EXPECT_GE(least[1], framing.window);
}

/// The large cube with a thousandth of its particles: the same material, in a run that does not take minutes.
const Framing framings[] = {{"cube-plane", {}, 0.075, 0.08},
                            {"cube-tilted-plane"},
                            {"cube-sphere"},
                            {"cube-bowl"},
                            {"jelly-figure"},
                            {"cube-torus"},
                            {"cube-hole"},
                            {"elevator"},
                            {"cubes-stack"},
                            {"cubes-tower", {}, 0.06, 0.06},
                            {"heap"},
                            {"squeeze"},
                            {"jelly-in-net"},
                            {"knot", {}, 0.01, 0.01},
                            {"goal-net"},
                            {"penalty"},
                            {"cube-and-balls"},
                            {"flag"},
                            {"curtain"},
                            {"bridge"},
                            {"swing"},
                            {"worm"},
                            {"walker"},
                            {"course-2021-plane"},
                            {"course-2021-tilted-plane"},
                            {"course-2021-sphere"},
                            {"course-2021-bowl"},
                            {"course-2018"},
                            {"large-cube", {"cube[0].particles-per-edge=10", "simulation.timestep=0.001"}}};

INSTANTIATE_TEST_SUITE_P(Scenes, Framed, ::testing::ValuesIn(framings),
                         [](const ::testing::TestParamInfo<Framing>& framing) {
                           std::string name = framing.param.scene;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Framing, EveryBuiltInSceneIsLookedAtOrExcepted) {
  for (const BuiltinScene& scene : list_builtin_scenes()) {
    const auto* const found = std::ranges::find(framings, scene.name, &Framing::scene);
    const bool full = found != std::end(framings) && found->video >= 0.08 && found->window >= 0.08;
    EXPECT_EQ(full, !exceptions.contains(std::string(scene.name))) << scene.name;
  }
}

}  // namespace
}  // namespace aspic
