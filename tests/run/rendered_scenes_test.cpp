// The cameras of built-in scenes: what a video of them shows, from its first image to its last.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aspic/scene.h"
#include "render/font.h"
#include "render/overlay.h"
#include "render/overlay_text.h"
#include "run/backends.h"
#include "scene/follow.h"
#include "support/model_building.h"
#include "support/projection.h"

namespace aspic {
namespace {

constexpr int width = 1280, height = 720;

using Point = std::array<double, 2>;

double area(const std::vector<Point>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a[0] * b[1] - b[0] * a[1];
  }
  return 0.5 * twice;
}

/// Andrew's monotone chain, 1979.
std::vector<Point> convex_hull(std::vector<Point> points) {
  std::ranges::sort(points);
  std::vector<Point> hull;
  const auto add = [&hull](const Point& p, std::size_t fixed) {
    const auto turns = [&] {
      const Point &a = hull[hull.size() - 2], &b = hull.back();
      return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0.0;
    };
    while (hull.size() > fixed && !turns()) hull.pop_back();
    hull.push_back(p);
  };
  for (const Point& p : points) add(p, 1);
  const std::size_t lower = hull.size();
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.pop_back();
  return hull;
}

/// A scene under way, and what of it is in the image.
class Shot {
 public:
  explicit Shot(const std::string& name) : scene_(std::move(load_scene(name)).value()) {
    model_ = test::build(scene_.model);
    auto backend = make_backend(*parse_backend("cpu"), model_);
    EXPECT_TRUE(backend.ok());
    backend_ = std::move(*backend);
    state_ = *backend_.solver->state();
    following_ = Following(scene_, model_, Precision::single);
  }
  const Scene& scene() const { return scene_; }
  const State& state() const { return state_; }

  /// Particles, and the centers of balls under way.
  std::vector<Vec3> bodies() const {
    std::vector<Vec3> all = state_.position;
    for (std::size_t i = 0; i < model_.balls.size(); ++i)
      if (model_.balls[i].launched(state_.step)) all.push_back(state_.ball_position[i]);
    return all;
  }

  void go_to(std::uint64_t step) {
    EXPECT_TRUE(backend_.solver->advance(step - state_.step).ok());
    state_ = *backend_.solver->state();
    camera_.emplace(moved(scene_.view.camera, following_.offset(model_, state_)), width, height);
  }
  Point place(const Vec3& x) const {
    const auto seen = test::project(*camera_, x);
    return seen ? Point{seen->x, seen->y} : Point{-1e9, -1e9};
  }
  /// The panel with the text of this moment.
  FactsPanel panel() const {
    static const Font font(text_height_in(height));
    const double time = static_cast<double>(state_.step) * scene_.model.simulation.timestep;
    return facts_panel(font, overlay_lines(scene_, time));
  }
  std::uint64_t last_step() const {
    return static_cast<std::uint64_t>(scene_.model.simulation.duration / scene_.model.simulation.timestep +
                                      0.5);
  }

 private:
  Scene scene_;
  Model model_;
  Backend backend_;
  Following following_;
  State state_;
  std::optional<Camera> camera_;
};

/// Every image of a few each second of the run, to `last_step` at most.
template <class Look>
void watch(Shot& shot, std::uint64_t last_step, Look look) {
  for (std::uint64_t step = 0; step <= std::min(last_step, shot.last_step()); step += 100) {
    shot.go_to(step);
    look(step);
  }
}

TEST(RenderedScenes, BodiesOfTheCourseFillTheirShareOfTheImage) {
  for (const BuiltinScene& builtin : list_builtin_scenes()) {
    if (builtin.group != "University course") continue;
    Shot shot{std::string(builtin.name)};
    watch(shot, 100000, [&](std::uint64_t step) {
      std::vector<Point> body;
      for (const Vec3& x : shot.state().position) {
        body.push_back(shot.place(x));
        ASSERT_TRUE(body.back()[0] > 0 && body.back()[0] < width && body.back()[1] > 0 &&
                    body.back()[1] < height)
            << builtin.name << " leaves the image at step " << step;
      }
      EXPECT_GE(area(convex_hull(body)), 0.08 * width * height) << builtin.name << " at step " << step;
    });
  }
}

TEST(RenderedScenes, TextCoversNoBody) {
  for (const BuiltinScene& builtin : list_builtin_scenes()) {
    Shot shot{std::string(builtin.name)};
    // The start of a scene whose steps take long.
    const std::uint64_t last = shot.state().position.size() > 10000 ? 0 : 8000;
    watch(shot, last, [&](std::uint64_t step) {
      const FactsPanel panel = shot.panel();
      const auto covered = [&](const Vec3& x) {
        const Point p = shot.place(x);
        return p[0] > panel.left && p[0] < panel.left + panel.width && p[1] > panel.top &&
               p[1] < panel.top + panel.height;
      };
      EXPECT_EQ(std::ranges::count_if(shot.bodies(), covered), 0) << builtin.name << " at step " << step;
    });
  }
}

}  // namespace
}  // namespace aspic
