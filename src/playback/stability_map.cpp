#include "playback/stability_map.h"

#include <algorithm>
#include <cmath>

#include "analysis/stability.h"
#include "analysis/stability_probe.h"
#include "aspic/scene.h"
#include "run/backends.h"
#include "scene/short_keys.h"

namespace aspic {
namespace {

constexpr std::size_t columns = 24, rows = 13;
constexpr double span_of_stiffness = 16.0;  ///< from a sixteenth to sixteen times the scene's
constexpr double span_of_step = 16.0;       ///< likewise around the stable step of the scene
constexpr std::uint32_t most_particles = 20000;
constexpr std::uint64_t probe_steps = 240, long_probe_steps = 30;

std::vector<double> around(double center, double span, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(center *
                     std::pow(span, 2.0 * static_cast<double>(i) / static_cast<double>(count - 1) - 1.0));
  return values;
}

/// The scene's text without what the map varies and what it does not depend on.
std::string key_of(Scene scene) {
  scene.view = {};
  scene.name.clear();
  scene.model.terrain.clear();
  scene.model.contact = {};
  scene.model.balls.clear();
  scene.model.launchers.clear();
  SimulationSettings simulation;
  simulation.integrator = scene.model.simulation.integrator;
  scene.model.simulation = simulation;
  if (const auto same = assignments(scene, "k", "1000")) {
    if (auto at_one = with_overrides(scene, *same)) scene = std::move(*at_one);
  }
  return to_toml(scene);
}

/// Index of the center nearest to a value on a logarithmic scale, within half a cell.
std::optional<std::size_t> nearest(const std::vector<double>& centers, double value) {
  const double cell = std::log(centers[1] / centers[0]);
  const double at = std::round(std::log(value / centers[0]) / cell);
  if (!(at >= 0.0 && at < static_cast<double>(centers.size()))) return std::nullopt;
  return static_cast<std::size_t>(at);
}

}  // namespace

std::optional<std::size_t> StabilityCells::cell_at(double step, double k) const {
  const auto column = nearest(steps, step), row = nearest(stiffness, k);
  if (!column || !row) return std::nullopt;
  return *row * steps.size() + *column;
}

void StabilityMap::update(const Scene& scene) {
  while (auto news = news_.take()) {
    if (news->generation == generation_) map_ = std::move(news->map);
  }
  std::string text = to_toml(scene);
  if (text == text_) return;
  text_ = std::move(text);
  const auto stiffness = present_value(scene, *find_short_key("k"));
  step_ = scene.model.simulation.timestep;
  stiffness_ = stiffness.value_or(0.0);
  std::string key = stiffness ? key_of(scene) : "";
  if (key == key_ && (!cells() || map_.cell_at(step_, stiffness_))) return;
  key_ = std::move(key);
  worker_.cancel();
  ++generation_;
  map_ = {};
  if (stiffness) begin(scene);
}

void StabilityMap::begin(const Scene& scene) {
  worker_.start([this, settings = scene.model, stiffness = stiffness_,
                 generation = generation_](const std::atomic<bool>& canceled) {
    const auto built = build_model(settings);
    if (!built) return;
    const Model model = alone_in_space(*built);
    const Integrator integrator = settings.simulation.integrator;
    const auto limit_at = [&](double factor) {
      return stability_limit(with_constants(model, factor, 1.0, 1.0), integrator, StabilityEffort::quick,
                             [&](double) { return !canceled; });
    };
    const std::optional<double> here = limit_at(1.0).step;
    const double step = settings.simulation.timestep;
    // The middle between the limit and the scene's own step, so that both are on the map.
    const bool bounded = here && std::isfinite(*here) && *here > 0.0;
    const double middle = bounded ? std::sqrt(*here * std::clamp(step, *here / 64, *here * 64)) : step;
    StabilityCells map = {around(middle, span_of_step, columns), around(stiffness, span_of_stiffness, rows),
                          std::vector<double>(rows), std::vector<Stability>(rows * columns)};
    const std::vector<double> factors = around(1.0, span_of_stiffness, rows);
    news_.put({generation, map});
    for (std::size_t row = 0; row < rows && !canceled; ++row)
      map.limit[row] = limit_at(factors[row]).step.value_or(0.0);
    news_.put({generation, map});
    if (model.particle_count() >= most_particles || canceled) return;

    const ProbeStart start = probe_start(model);
    BackendChoice choice;
    choice.row = find_backend("cpu");
    choice.threads = 1;
    const std::uint64_t count = row_of(integrator).traits.long_steps ? long_probe_steps : probe_steps;
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t column = 0; column < columns; ++column) {
        const auto backend =
            make_backend(choice, with_constants(model, factors[row], 1.0, map.steps[column]));
        if (!backend || canceled) return;
        backend->solver->set_stop_flag(&canceled);
        const auto grew = grows(*backend->solver, start, count);
        if (!grew || canceled) return;
        map.cells[row * columns + column] = *grew ? Stability::unstable : Stability::stable;
      }
      news_.put({generation, map});
    }
  });
}

}  // namespace aspic
