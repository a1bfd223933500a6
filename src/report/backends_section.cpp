// The backends compared: equal bits, and speed by size.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "model/cube.h"
#include "model/springs.h"
#include "report/study.h"

namespace aspic::report {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t compared_steps = 100;

struct Speed {
  std::string device, hash;
  double steps_per_second = 0.0;
};

/// State hash after some steps; steps per second of those after them, over about `seconds`.
Result<Speed> measured(const SharedModel& model, const BackendRow& row, double seconds, const Study& study) {
  BackendChoice choice;
  choice.row = &row;
  ASPIC_TRY(const auto backend, make_backend(choice, model));
  Solver& solver = *backend.solver;
  Speed speed;
  speed.device = backend.device;
  ASPIC_TRY(auto advanced, solver.advance(compared_steps));
  ASPIC_TRY(auto state, solver.state());
  speed.hash = state_hash_text(state);
  if (advanced.divergence) return speed;
  // The fastest of three: others on the machine only ever slow one down.
  std::uint64_t batch = 1;
  for (int repeat = 0; repeat < 3 && seconds > 0.0; ++repeat) {
    std::uint64_t steps = 0;
    double took = 0.0;
    for (const auto start = Clock::now(); took < seconds / 3;) {
      if (study.stopped()) return Error{ErrorCode::interrupted, "interrupted."};
      ASPIC_TRY(advanced, solver.advance(batch));
      ASPIC_TRY(state, solver.state());  // waits for a device
      if (advanced.divergence) return speed;
      steps += batch;
      took = std::chrono::duration<double>(Clock::now() - start).count();
      if (took < 0.03 * seconds) batch *= 2;
    }
    speed.steps_per_second = std::max(speed.steps_per_second, static_cast<double>(steps) / took);
  }
  return speed;
}

}  // namespace

Result<Section> backends_section(const Study& study) {
  Section section{"backends", "Backends", {}, {}};
  section.paragraphs = {
      "All backends perform the same operations in the same order. In single precision their states have "
      "identical bits, and only the speed differs."};
  std::vector<int> sizes = {0};
  if (!study.scene.model.cubes.empty()) {
    sizes = {4, 6, 10, 16};
    if (study.thorough) sizes.insert(sizes.end(), {24, 40});
  }
  Figure figure;
  figure.id = "backends";
  figure.chart.emplace();
  figure.chart->panels.push_back({"", {"springs", Scale::log}, {"spring forces per second", Scale::log}, {}});
  figure.table = Table{{{"backend"},
                        {"device"},
                        {"particles per edge"},
                        {"springs"},
                        {"steps per second", 3},
                        {"spring forces per second", 3},
                        {fmt::format("state after {} steps", compared_steps)},
                        {"equal to the reference"}},
                       {}};
  std::vector<Curve> curves;
  std::vector<std::string> missing;
  for (const int size : sizes) {
    Scene scene = study.scene;
    for (CubeSettings& cube : scene.model.cubes)
      if (size > 0) resize(cube, size);
    // Below the stable step of every method and size: the figures are of work, not of motion.
    ASPIC_TRY(auto model, build_model(scene.model));
    model.simulation.timestep = std::min(model.simulation.timestep,
                                         study.step_for(model, model.simulation.integrator).value_or(1e-4));
    const double springs = static_cast<double>(spring_count(model));
    const double evaluations = std::max(1, force_evaluations_per_step(model.simulation.integrator));
    const SharedModel shared_model = shared(std::move(model));
    ASPIC_TRY(const auto reference, measured(shared_model, reference_backend(), 0.0, study));
    for (std::size_t b = 0; b < backends().size(); ++b) {
      const BackendRow& row = backends()[b];
      const auto speed = measured(shared_model, row, study.thorough ? 1.0 : 0.25, study);
      if (!speed && speed.error().code == ErrorCode::interrupted) return speed.error();
      if (!speed) {
        const std::string why =
            fmt::format("`{}`: {}", row.name, worded(speed.error(), FrontEnd::command_line));
        if (std::ranges::find(missing, why) == missing.end()) missing.push_back(why);
        continue;
      }
      const double forces = springs * evaluations * speed->steps_per_second;
      figure.table->rows.push_back({std::string(row.name), speed->device,
                                    size > 0 ? Cell(static_cast<double>(size)) : Cell(), springs,
                                    speed->steps_per_second, forces, speed->hash,
                                    std::string(&row == &reference_backend()    ? "is the reference"
                                                : speed->hash == reference.hash ? "yes"
                                                                                : "no")});
      if (springs == 0.0) continue;
      const std::string name = fmt::format("{}: {}", row.name, speed->device);
      auto curve = std::ranges::find(curves, name, &Curve::name);
      if (curve == curves.end())
        curve = curves.insert(curves.end(), {name, {}, Palette::category, b, true, true});
      curve->points.push_back({springs, forces});
    }
  }
  if (curves.empty()) figure.chart.reset();
  if (figure.chart) figure.chart->panels[0].curves = std::move(curves);
  for (const std::string& why : missing) section.paragraphs.push_back(fmt::format("Not measured, {}", why));
  figure.caption = fmt::format(
      "Speed by size and equality of bits on this machine: {} with these particles per edge of its cubes and "
      "its own integrator; each backend with its default number of threads. Figures of a software rasterizer "
      "do not apply to GPUs.",
      study.scene.name);
  figure.command = study.scene.model.cubes.empty()
                       ? fmt::format("aspic bench {} --backend cpu,reference,gpu", study.scene_words)
                       : fmt::format("aspic bench {} --backend cpu,reference,gpu --size {}",
                                     study.scene_words, fmt::join(sizes, ","));
  section.figures.push_back(std::move(figure));
  return section;
}

}  // namespace aspic::report
