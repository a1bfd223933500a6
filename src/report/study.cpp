#include "report/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <thread>

#include "analysis/stability.h"
#include "aspic/scene.h"
#include "model/springs.h"

namespace aspic::report {
namespace {

constexpr ImageSize image_size = {288, 216};

/// Spring forces after which a run ends, some seconds on one processor.
constexpr double most_evaluations = 1e9;

/// Spring forces of a step, with what balls, the solve of implicit methods and a step by itself cost as many.
double evaluations(const Model& model) {
  constexpr double ball = 200.0, solve = 60.0, step = 1000.0;
  const int stages = force_evaluations_per_step(model.simulation.integrator);
  return (static_cast<double>(spring_count(model)) + ball * model.ball_count() + step) *
         (stages > 0 ? stages : solve);
}

/// What an image is about: particles, or balls where there are none. Balls roll far away from what they hit.
const std::vector<Vec3>& shown_places(const State& state) {
  return state.position.empty() ? state.ball_position : state.position;
}

}  // namespace

Study::Study(Scene s, std::string words, bool thorough_study, unsigned jobs, std::function<bool()> stop)
    : scene(std::move(s)),
      scene_words(std::move(words)),
      thorough(thorough_study),
      subject(verify::product(nullptr, "")),
      jobs_(jobs),
      stop_(std::move(stop)) {}

BackendChoice Study::backend() const {
  BackendChoice choice;
  choice.row = find_backend("cpu");
  choice.threads = 1;
  return choice;
}

MakeSolver Study::make_solver() const {
  return [choice = backend()](const Model& model) -> Result<std::unique_ptr<Solver>> {
    ASPIC_TRY(auto made, make_backend(choice, model));
    return std::move(made.solver);
  };
}

Status Study::each(std::size_t count, const std::function<Status(std::size_t)>& task) const {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::optional<Error> first;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      Status done = stopped() ? Status(Error{ErrorCode::interrupted, "interrupted."}) : task(i);
      if (done) continue;
      const std::lock_guard lock(mutex);
      if (!first) first = done.error();
      next = count;
    }
  };
  std::vector<std::jthread> others;
  for (unsigned j = 1; j < jobs_ && j < count; ++j) others.emplace_back(work);
  work();
  others.clear();
  return first ? Status(*first) : Status();
}

Result<Scene> Study::varied(const std::vector<std::string>& assignments) const {
  return with_overrides(scene, assignments);
}

Result<TrialResult> Study::run(const Model& model, double duration, std::span<const double> image_times,
                               double interval) const {
  TrialOptions options;
  options.backend = backend();
  options.length.duration = duration;
  if (const double most = longest_run(model); duration > most) {
    options.length.duration = most;
    ++shortened_;
  }
  options.interval = interval;
  options.image_times = image_times;
  options.stop = stop_;
  return run_trial(shared(model), options);
}

double Study::longest_run(const Model& model) const {
  if (thorough) return std::numeric_limits<double>::infinity();
  return most_evaluations / evaluations(model) * model.simulation.timestep;
}

Result<double> Study::affordable(double wanted) const {
  ASPIC_TRY(auto model, build_model(scene.model));
  model.simulation.integrator = Integrator::symplectic_euler;  // the same whatever the scene's method
  constexpr double most = 4e8;                                 // spring forces
  const double seconds = std::floor(most / evaluations(model) * scene.model.simulation.timestep);
  return std::max(scene.model.simulation.duration, std::min(wanted, seconds));
}

std::optional<double> Study::step_for(const Model& model, Integrator integrator) const {
  const MethodTraits& traits = row_of(integrator).traits;
  if (traits.stable_at_any_step) return traits.nominal_step;
  const StabilityLimit limit = stability_limit(model, integrator, StabilityEffort::quick);
  if (!limit.step) return std::nullopt;
  return std::min(model.simulation.timestep, 0.9 * *limit.step);
}

std::string Study::command(std::string_view section) const {
  return fmt::format("aspic report {}{} --only {} --out DIR", scene_words, thorough ? " --thorough" : "",
                     section);
}

Result<std::vector<std::string>> Study::images(const Model& model, std::span<const State> states,
                                               const ViewSettings& view, bool follow) const {
  std::vector<std::string> jpegs;
  if (!studio) return jpegs;
  ASPIC_CHECK(studio->set_model(model));
  for (const State& state : states) {
    ViewSettings moved = view;
    const Vec3 way = follow ? way_of(state) : Vec3{};
    moved.camera.position = moved.camera.position + way;
    moved.camera.target = moved.camera.target + way;
    ASPIC_TRY(auto jpeg, studio->jpeg(state, moved, image_size));
    jpegs.push_back(std::move(jpeg));
  }
  return jpegs;
}

Vec3 way_of(const State& state) {
  Vec3 sum;
  const std::vector<Vec3>& places = shown_places(state);
  for (const Vec3& x : places) sum = sum + x;
  if (!places.empty()) sum = sum / static_cast<double>(places.size());
  return {sum.x, 0.0, sum.z};
}

ViewSettings framed(ViewSettings view, std::span<const State> states) {
  Vec3 low, high;
  bool first = true;
  const auto take = [&](const Vec3& x) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = first ? x[axis] : std::min(low[axis], x[axis]);
      high[axis] = first ? x[axis] : std::max(high[axis], x[axis]);
    }
    first = false;
  };
  for (const State& state : states)
    for (const Vec3& x : shown_places(state)) take(x);
  if (first) return view;
  const double radius = 0.5 * length(high - low) + 0.1;
  const Vec3 direction = view.camera.position - view.camera.target;
  view.camera.target = 0.5 * (low + high);
  const double distance = 1.05 * radius / std::sin(0.5 * view.camera.fov * std::numbers::pi / 180.0);
  view.camera.position = view.camera.target + (distance / length(direction)) * direction;
  return view;
}

std::vector<double> telling_times(const CourseSummary& summary, double duration) {
  std::vector<double> times;
  const double squash = summary.squash_time;
  if (const auto contact = summary.contact_time; contact && squash > *contact && squash < duration) {
    const double gap = squash - *contact;
    for (const double gaps : {0.0, 1.0, 2.0, 3.5, 6.0}) times.push_back(*contact + gaps * gap);
    times.push_back(duration);
  } else {
    for (int i = 0; i < 6; ++i) times.push_back(duration * i / 5.0);
  }
  std::erase_if(times, [&](double t) { return t > duration; });
  return times;
}

Curve course_curve(std::string name, const std::vector<CourseSample>& samples,
                   const std::function<double(const CourseSample&)>& measure, Palette palette,
                   std::size_t index) {
  Curve curve{std::move(name), {}, palette, index, true, false};
  for (const CourseSample& sample : samples) curve.points.push_back({sample.time, measure(sample)});
  return curve;
}

}  // namespace aspic::report
