// Measures the window on this machine: real-time factor, images a second, longest gap between handled events,
// and the largest cube that keeps up with time. Needs a display, such as that of
// tests/support/on_display.sh.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "app/app.h"
#include "app/window.h"
#include "run/backends.h"

namespace {

using namespace aspic;
using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point a, Clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

struct Figures {
  double real_time_factor = 0.0, images_per_second = 0.0;
  double longest_gap = 0.0;  ///< between two looks at the events [s]
  double resolution = 0.0;   ///< share of the full one, at the end
  double stepping = 0.0;     ///< processor time of the solver's threads by second of simulated time [s]
  double drawing = 0.0;      ///< that of the window's thread and the software rasterizer's by image [s]
};

/// Processor time of this process so far [s].
struct ProcessorTime {
  double stepping = 0.0, drawing = 0.0;
};

/// From Linux's list of this process's threads; elsewhere 0. Mesa names its threads, and the first one is the
/// window's.
ProcessorTime processor_time() {
  ProcessorTime time;
  std::error_code none;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", none)) {
    std::string name, nanoseconds;
    std::ifstream(task.path() / "comm") >> name;
    std::ifstream(task.path() / "schedstat") >> nanoseconds;
    const bool draws = name.starts_with("llvmpipe") || task.path().filename() == std::to_string(getpid());
    (draws ? time.drawing : time.stepping) += 1e-9 * std::strtod(nanoseconds.c_str(), nullptr);
  }
  return time;
}

struct Case {
  std::string scene;
  std::vector<std::string> overrides;
  std::string_view backend = "reference";
  bool edits = false;  ///< a value is changed ten times a second, as a slider under the mouse does
};

[[noreturn]] void fail(const std::string& message) {
  fmt::print(stderr, "{}\n", message);
  std::exit(1);
}

/// Runs a scene in real time for so long, in its own window, as aspic-view would.
Figures measure(const Case& c, double seconds) {
  auto window = app::Window::create(1280, 720, "Aspic figures");
  if (!window) fail(window.error().message());
  app::AppOptions options;
  options.scene = c.scene;
  options.overrides = c.overrides;
  options.backend = find_backend(c.backend);
  auto app = app::App::create((*window)->context(), options, 1.0, (*window)->services());
  if (!app) fail(app.error().message());
  (*window)->set_receiver(app->get());
  PlaybackSession& simulation = (*app)->simulation;
  simulation.pacer().set_pace(Pace::real_time);
  simulation.set_running(true);
  Figures figures;
  // The first second compiles shaders and finds the resolution.
  const double warm_up = 1.0;
  const auto start = Clock::now();
  auto last = start, polled = start, measured_from = start, edited = start;
  double time_from = 0.0;
  ProcessorTime used_from;
  bool warm = false;
  int images = 0;
  double pull = 9.8;  // of gravity [m/s²]
  for (;;) {
    double wait = 0.0;
    do {
      (*window)->poll(wait);
      const auto looked = Clock::now();
      if (warm) figures.longest_gap = std::max(figures.longest_gap, seconds_between(polled, looked));
      polled = looked;
      wait = (*app)->wait(seconds_between(last, looked));
    } while (wait > 0.0);
    const auto now = Clock::now();
    const double dt = seconds_between(last, now);
    last = now;
    if (!warm && seconds_between(start, now) > warm_up) {
      warm = true;
      measured_from = now;
      time_from = simulation.time();
      used_from = processor_time();
    } else if (warm) {
      ++images;
      if (seconds_between(measured_from, now) > seconds) break;
    }
    if (c.edits && seconds_between(edited, now) > 0.1) {
      edited = now;
      pull = pull > 9.8 ? 9.8 : 9.9;
      (*app)->scene.set_value(*find_parameter("simulation.gravity"), 0, Value(Vec3{0.0, -pull, 0.0}),
                              "slider");
    }
    if (const Status drawn = (*app)->frame((*window)->size(), std::min(dt, 0.25)); !drawn)
      fail(drawn.error().message());
    (*window)->show_image();
    if (simulation.divergence()) fail("diverged");
  }
  const double wall = seconds_between(measured_from, last);
  figures.real_time_factor = (simulation.time() - time_from) / wall;
  figures.images_per_second = images / wall;
  const ProcessorTime used = processor_time();
  figures.stepping = (used.stepping - used_from.stepping) / (simulation.time() - time_from);
  figures.drawing = (used.drawing - used_from.drawing) / images;
  const FramePolicy* const policy = (*app)->image.policy();
  figures.resolution = policy ? policy->resolution.share() : 1.0;
  (*window)->set_receiver(nullptr);
  return figures;
}

void report(std::string_view what, const Case& c, const Figures& f) {
  std::string overrides;
  for (const std::string& o : c.overrides)
    overrides += fmt::format("{}\"{}\"", overrides.empty() ? "" : ", ", o);
  fmt::print(
      "{{\"case\": \"{}\", \"scene\": \"{}\", \"overrides\": [{}], \"backend\": \"{}\", "
      "\"real_time_factor\": {:.3f}, \"images_per_second\": {:.1f}, \"longest_gap_seconds\": {:.3f}, "
      "\"resolution\": {}, \"stepping_seconds_a_simulated_second\": {:.3f}, \"drawing_seconds_an_image\": "
      "{:.4f}}}\n",
      what, c.scene, overrides, c.backend, f.real_time_factor, f.images_per_second, f.longest_gap,
      f.resolution, f.stepping, f.drawing);
  std::fflush(stdout);
}

Figures median_of(const Case& c, double seconds, int repeats) {
  std::vector<Figures> runs;
  for (int i = 0; i < repeats; ++i) runs.push_back(measure(c, seconds));
  std::ranges::sort(runs, {}, &Figures::real_time_factor);
  Figures figures = runs[runs.size() / 2];
  for (const Figures& f : runs) figures.longest_gap = std::max(figures.longest_gap, f.longest_gap);
  return figures;
}

/// Pauses a scene after a second: how long its fine image takes, and the longest time that the window does
/// not answer meanwhile.
void rest(const std::string& scene) {
  auto window = app::Window::create(1600, 1000, "Aspic figures");
  if (!window) fail(window.error().message());
  app::AppOptions options;
  options.scene = scene;
  options.backend = find_backend("cpu");
  auto app = app::App::create((*window)->context(), options, 1.0, (*window)->services());
  if (!app) fail(app.error().message());
  (*window)->set_receiver(app->get());
  (*app)->simulation.set_running(true);
  const auto start = Clock::now();
  double longest = 0.0;
  for (auto last = start; seconds_between(start, last) < 4.0;) {
    (*window)->poll(0.0);
    const auto now = Clock::now();
    const double dt = seconds_between(last, now);
    last = now;
    // A new image for each look at the events, as when the mouse moves.
    if (seconds_between(start, now) > 1.0) (*app)->simulation.set_running(false);
    if ((*app)->image.at_rest) longest = std::max(longest, dt);
    if (const Status drawn = (*app)->frame((*window)->size(), std::min(dt, 0.25)); !drawn)
      fail(drawn.error().message());
    (*window)->show_image();
  }
  fmt::print(
      "{{\"case\": \"rest\", \"scene\": \"{}\", \"fine_image_seconds\": {:.3f}, \"longest_gap_seconds\": "
      "{:.3f}}}\n",
      scene, (*app)->image.rate.draw_seconds, longest);
  std::fflush(stdout);
  (*window)->set_receiver(nullptr);
}

/// A cube of so many particles an edge, in steps that its method bears.
Case cube_of(int n, std::string_view backend, Integrator integrator) {
  // One-pass is stable up to 0.98 ms in large cubes; implicit Euler is for steps of an image's length.
  const double h = integrator == Integrator::implicit_euler            ? 1.0 / 60
                   : integrator == Integrator::implicit_euler_one_pass ? 0.0009
                                                                       : 0.001;
  return {"cube-plane",
          {fmt::format("cube[0].particles-per-edge={}", n),
           fmt::format("simulation.integrator={}", name_of(integrator)),
           fmt::format("simulation.timestep={}", h)},
          backend};
}

/// The largest cube, of 4 to 47 particles an edge, whose median factor is 0.98 or more; 3: none. By
/// bisection.
void largest(std::string_view backend, Integrator integrator) {
  int fits = 3, too_large = 48;
  while (too_large - fits > 1) {
    const int n = (fits + too_large) / 2;
    const Case c = cube_of(n, backend, integrator);
    const Figures f = median_of(c, 1.5, 3);
    report("size", c, f);
    (f.real_time_factor < 0.98 ? too_large : fits) = n;
  }
  fmt::print(
      "{{\"case\": \"largest\", \"backend\": \"{}\", \"integrator\": \"{}\", \"particles_per_edge\": {}}}\n",
      backend, name_of(integrator), fits);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "", only = argc > 2 ? argv[2] : "";
  const bool all = what == "all";
  int n = 0;
  if (argc > 3) {
    const std::string_view word = argv[3];
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), n);
    if (error != std::errc() || end != word.data() + word.size() || n < 2)
      fail("PARTICLES-PER-EDGE is a whole number from 2 on.");
  }
  if (!all && what != "default" && what != "large" && what != "rest" && what != "sizes")
    fail(
        "usage: window_figures default | large | rest | sizes [BACKEND/INTEGRATOR [PARTICLES-PER-EDGE]] | "
        "all\nPrints a JSON object a "
        "line; needs a display "
        "(tests/support/on_display.sh).");
  if (all || what == "default") {
    for (const BackendRow& backend : backends()) {
      const Case c = {"cube-plane", {}, backend.name};
      report("default", c, median_of(c, 4.0, 5));
    }
  }
  if (all || what == "large") {
    for (const bool edits : {false, true}) {
      const Case c = {"large-cube", {}, "reference", edits};
      report(edits ? "large, edited" : "large", c, median_of(c, 6.0, 3));
    }
  }
  if (all || what == "rest")
    for (const char* scene : {"cube-plane", "goal-net", "large-cube", "ball-pit"})
      for (int i = 0; i < 3; ++i) rest(scene);
  if (all || what == "sizes") {
    for (const BackendRow& row : backends()) {
      const std::string_view backend = row.name;
      for (const Integrator integrator : all_integrators) {
        const std::string name = fmt::format("{}/{}", backend, name_of(integrator));
        if (!only.empty() && only != name && only != backend) continue;
        if (n >= 2) {
          const Case c = cube_of(n, backend, integrator);
          report("size", c, median_of(c, 4.0, 5));
        } else {
          largest(backend, integrator);
        }
      }
    }
  }
  return 0;
}
