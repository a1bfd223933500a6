#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "analysis/stability.h"
#include "cli/commands.h"
#include "cli/json.h"
#include "io/program.h"
#include "model/integrator.h"
#include "model/springs.h"
#include "scene/load.h"

namespace aspic::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// One line of the table: a backend with a scene of one size and integrator, measured several times.
struct Measurement {
  std::string backend, force_path, device;
  Integrator integrator = Integrator::explicit_euler;
  int size = 0;  ///< particles per edge of the first cube; 0 without cubes
  std::uint64_t particles = 0, springs = 0, bytes = 0;
  double timestep = 0.0;
  std::uint64_t steps = 0;          ///< of each repeat
  double evaluations_per_step = 0;  ///< of all spring forces, Jacobians counted as such
  std::vector<double> seconds;      ///< of each repeat, ascending
  std::optional<Divergence> divergence;

  double median() const {
    const std::size_t n = seconds.size();
    return n % 2 == 1 ? seconds[n / 2] : 0.5 * (seconds[n / 2 - 1] + seconds[n / 2]);
  }
  double spread() const { return (seconds.back() - seconds.front()) / median(); }
  double steps_per_second() const { return static_cast<double>(steps) / median(); }
  double spring_evaluations_per_second() const {
    return static_cast<double>(springs) * evaluations_per_step * steps_per_second();
  }
  double seconds_per_simulated_second() const { return 1.0 / (steps_per_second() * timestep); }
};

/// The time step asked for: the scene's, a number, or the largest sensible one.
Result<double> chosen_timestep(const BenchOptions& options, const Model& model) {
  const double own = model.simulation.timestep;
  if (options.timestep == BenchTimestep::scene) return own;
  // A frame: implicit Euler is stable at any step, so accuracy and not stability sets its largest.
  if (model.simulation.integrator == Integrator::implicit_euler) return 1.0 / 60.0;
  const StabilityLimit limit = stability_limit(model, model.simulation.integrator, StabilityEffort::quick);
  if (!limit.step) {
    return fail(ErrorCode::scene_rejected, "--timestep largest: {}.",
                stability_sentence(model.simulation.integrator, limit));
  }
  return std::isfinite(*limit.step) ? 0.99 * *limit.step : own;
}

/// From the scene's start over `steps` steps, the wait for the device included [s].
Result<double> time_run(Solver& solver, std::uint64_t steps, Measurement& m) {
  ASPIC_CHECK(solver.load(initial_state(solver.model(), solver.precision())));
  const auto start = Clock::now();
  ASPIC_TRY(const auto advanced, solver.advance(steps));
  ASPIC_TRY(const auto state, solver.state());
  m.divergence = advanced;
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Steps that take about `seconds`, found by doubling.
Result<std::uint64_t> steps_for(Solver& solver, double seconds, Measurement& m) {
  for (std::uint64_t steps = 1;; steps *= 2) {
    ASPIC_TRY(const auto took, time_run(solver, steps, m));
    if (m.divergence || steps > (std::uint64_t{1} << 40)) return steps;
    if (took > seconds / 4) {
      return std::max<std::uint64_t>(1,
                                     static_cast<std::uint64_t>(static_cast<double>(steps) * seconds / took));
    }
  }
}

double evaluations_per_step(Solver& solver, std::uint64_t steps) {
  const auto solves = solver.solve_statistics();
  if (!solves) return force_evaluations_per_step(solver.model().simulation.integrator);
  // A residual at the start of the step and after each Newton iteration, and an application of the Jacobian
  // in each conjugate gradient iteration.
  return 1.0 +
         static_cast<double>(solves->newton_iterations + solves->cg_iterations) / static_cast<double>(steps);
}

Result<Measurement> measure_case(const BenchOptions& options, const Scene& scene, const BackendChoice& choice,
                                 const InterruptGuard& interrupt) {
  ModelSettings settings = scene.model;
  ASPIC_TRY(auto model, build_model(settings));
  ASPIC_TRY(const auto timestep, chosen_timestep(options, model));
  model.simulation.timestep = timestep;
  ASPIC_TRY(auto backend, make_backend(choice, model));
  Solver& solver = *backend.solver;

  Measurement m;
  m.backend = backend.row->name;
  m.force_path = backend.force_path;
  m.device = backend.device;
  m.integrator = model.simulation.integrator;
  m.size = settings.cubes.empty() ? 0 : settings.cubes.front().particles_per_edge;
  m.particles = model.particle_count();
  m.springs = spring_count(model);
  m.bytes = solver.bytes();
  m.timestep = timestep;
  if (options.duration) {
    ASPIC_TRY(const auto steps, steps_of({std::nullopt, options.duration}, model.simulation));
    m.steps = std::max<std::uint64_t>(1, steps);
  } else {
    ASPIC_TRY(m.steps, steps_for(solver, options.seconds / options.repeats, m));
  }
  for (int repeat = 0; repeat < options.repeats && !m.divergence; ++repeat) {
    if (interrupt.interrupted()) return Error{ErrorCode::interrupted, "interrupted; nothing was printed."};
    ASPIC_TRY(const auto took, time_run(solver, m.steps, m));
    m.seconds.push_back(took);
  }
  m.evaluations_per_step = evaluations_per_step(solver, m.steps);
  std::sort(m.seconds.begin(), m.seconds.end());
  return m;
}

Json to_json(const Measurement& m) {
  Json object = {{"backend", m.backend},
                 {"force_path", or_null(m.force_path)},
                 {"renderer", m.device},
                 {"integrator", name_of(m.integrator)},
                 {"size", m.size},
                 {"particles", m.particles},
                 {"springs", m.springs},
                 {"bytes", m.bytes},
                 {"timestep", m.timestep},
                 {"steps", m.steps},
                 {"diverged", m.divergence.has_value()}};
  if (!m.divergence) {
    object.update({{"seconds", m.seconds},
                   {"median_seconds", m.median()},
                   {"spread", m.spread()},
                   {"steps_per_second", m.steps_per_second()},
                   {"evaluations_per_step", m.evaluations_per_step},
                   {"spring_evaluations_per_second", m.spring_evaluations_per_second()},
                   {"seconds_per_simulated_second", m.seconds_per_simulated_second()}});
  }
  return object;
}

std::string table_line(const Measurement& m) {
  const std::string name = m.force_path.empty() ? m.backend : m.backend + ":" + m.force_path;
  std::string line = fmt::format("{:<15} {:<23} {:>4} {:>10} {:>11.4g}", name, name_of(m.integrator), m.size,
                                 m.springs, m.timestep);
  if (m.divergence) return line + fmt::format("  diverged in step {}\n", m.divergence->step);
  return line + fmt::format(" {:>10.4g} {:>13.3g} {:>12.4g} {:>7.0f}% {:>9.1f}\n", m.steps_per_second(),
                            m.spring_evaluations_per_second(), m.seconds_per_simulated_second(),
                            100.0 * m.spread(), static_cast<double>(m.bytes) / (1024.0 * 1024.0));
}

}  // namespace

Status execute(const BenchOptions& options) {
  const InterruptGuard interrupt;
  std::vector<Measurement> measurements;
  ASPIC_TRY(auto loaded, load_scene(options.scene, options.overrides));
  std::vector<int> sizes = options.sizes;
  if (!sizes.empty() && loaded.model.cubes.empty()) {
    return fail(ErrorCode::usage, "--size sets the particles-per-edge of cubes, but {} has no cube.",
                loaded.name);
  }
  if (sizes.empty()) sizes.push_back(0);
  std::vector<Integrator> integrators = options.integrators;
  if (integrators.empty()) integrators.push_back(loaded.model.simulation.integrator);
  for (const int size : sizes) {
    // Through the parser, so that a size out of range or past the memory is refused as in a file.
    std::vector<std::string> overrides;
    for (std::size_t c = 0; size > 0 && c < loaded.model.cubes.size(); ++c) {
      overrides.push_back(fmt::format("cube[{}].particles-per-edge={}", c, size));
    }
    ASPIC_TRY(auto scene, with_overrides(loaded, overrides));
    for (const Integrator integrator : integrators) {
      scene.model.simulation.integrator = integrator;
      for (const BackendChoice& choice : options.backends) {
        if (!works_with(choice.force_path, integrator)) {
          print_message(fmt::format("skipped {} on the force path {}, which it does not have.",
                                    name_of(integrator), name_of(choice.force_path)));
          continue;
        }
        ASPIC_TRY(auto measured, measure_case(options, scene, choice, interrupt));
        measurements.push_back(std::move(measured));
      }
    }
  }
  if (options.json) {
    Json rows = Json::array();
    for (const Measurement& m : measurements) rows.push_back(to_json(m));
    return print_data(to_text({{"version", ASPIC_VERSION},
                               {"scene", loaded.name},
                               {"repeats", options.repeats},
                               {"measurements", rows}}));
  }
  std::string text = fmt::format("{}, {} repeats each, medians\n", loaded.name, options.repeats);
  std::vector<std::string> devices;
  for (const Measurement& m : measurements) {
    const std::string device = fmt::format("{}: {}\n", m.backend, m.device);
    if (std::find(devices.begin(), devices.end(), device) == devices.end()) devices.push_back(device);
  }
  for (const std::string& device : devices) text += device;
  text += fmt::format("\n{:<15} {:<23} {:>4} {:>10} {:>11} {:>10} {:>13} {:>12} {:>8} {:>9}\n", "backend",
                      "integrator", "n", "springs", "h [s]", "steps/s", "spring ev./s", "s per sim. s",
                      "spread", "MiB");
  for (const Measurement& m : measurements) text += table_line(m);
  return print_text(text);
}

}  // namespace aspic::cli
