// The methods compared: order, stability, cost, energy, and the same drop.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/stability.h"
#include "model/cube.h"
#include "report/study.h"
#include "verify/studies.h"

namespace aspic::report {
namespace {

constexpr std::size_t methods = all_integrators.size();

std::string title_of(std::size_t method) {
  return std::string(row_of(all_integrators[method]).title);
}

Curve method_curve(std::size_t method, bool markers) {
  return {title_of(method), {}, Palette::category, method, true, markers};
}

Result<Figure> order_figure(const Study& study) {
  std::vector<verify::OrderStudy> orders(methods);
  ASPIC_CHECK(study.each(methods, [&](std::size_t m) -> Status {
    ASPIC_TRY(orders[m], verify::study_order(study.subject, all_integrators[m]));
    return {};
  }));
  Figure figure;
  figure.id = "order";
  figure.chart.emplace();
  figure.chart->panels.push_back(
      {"", {"time step h [s]", Scale::log}, {"error after 0.4 s", Scale::log}, {}});
  figure.table =
      Table{{{"method"}, {"order in theory"}, {"order measured"}, {"error at the finest step"}}, {}};
  for (std::size_t m = 0; m < methods; ++m) {
    Curve curve = method_curve(m, true);
    for (std::size_t i = 0; i < orders[m].step.size(); ++i)
      curve.points.push_back({orders[m].step[i], orders[m].error[i]});
    figure.chart->panels[0].curves.push_back(std::move(curve));
    figure.table->rows.push_back({title_of(m), static_cast<double>(row_of(all_integrators[m]).order),
                                  orders[m].observed, orders[m].finest});
  }
  figure.caption =
      "Order of convergence. A deformed, moving 2³ cube of soft springs without contact, in double "
      "precision: the norm of the error in all positions and "
      "velocities after 0.4 s, against the classical Runge–Kutta method in extended precision. A method of "
      "order p gains p decades of accuracy per decade of h.";
  figure.command = "aspic verify --only order";
  return figure;
}

/// Stable steps, measured and in theory.
Result<Figure> limits_figure(const Study& study, const Model& model) {
  const auto limits = stability_limits(model, explicit_integrators, StabilityEffort::thorough);
  const ProbeStart start = probe_start(model);
  std::vector<double> measured(explicit_integrators.size());
  constexpr double below = 1.0 / 64, above = 64.0;  // of the scene's step
  const double h = model.simulation.timestep;
  ASPIC_CHECK(study.each(measured.size(), [&](std::size_t i) -> Status {
    Model probed = model;
    probed.simulation.integrator = explicit_integrators[i];
    ASPIC_TRY(measured[i],
              measured_limit(probed, start, study.make_solver(), below * h, above * h, 2e-3, 960));
    return {};
  }));
  Figure figure;
  figure.id = "largest-step";
  figure.table = Table{{{"method"}, {"theory [s]"}, {"measured [s]"}, {"measured over theory"}}, {}};
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const StabilityLimit& limit = limits[i];
    const std::string title(row_of(explicit_integrators[i]).title);
    const bool bracketed = measured[i] > 1.01 * below * h && measured[i] < 0.99 * above * h;
    std::vector<Cell> row = {title};
    row.push_back(limit.step && std::isfinite(*limit.step) ? Cell(*limit.step)
                                                           : Cell(stability_figure(limit)));
    row.push_back(bracketed ? Cell(measured[i]) : Cell("none found"));
    row.push_back(bracketed && limit.step && std::isfinite(*limit.step) ? Cell(measured[i] / *limit.step)
                                                                        : Cell());
    figure.table->rows.push_back(std::move(row));
  }
  figure.caption = fmt::format(
      "The largest stable time step of {}. Theory: the largest h at which no mode of the linearized springs "
      "grows. Measured: bisection to 0.2 % between "
      "runs of 960 steps in single precision whose small initial motion grows or does not. Implicit Euler "
      "has no limit.",
      study.scene.name);
  figure.command = fmt::format("aspic scene check {}", study.scene_words);
  return figure;
}

/// The scene's bodies, coarse and alone in space, smoothly deformed and moving.
struct Smooth {
  Model model;
  State start;
  double duration = 0.0;  ///< [s]
};
Result<Smooth> smooth_body(const Study& study) {
  Scene scene = study.scene;
  for (CubeSettings& cube : scene.model.cubes) resize(cube, std::min(std::ranges::max(cube.lattice()), 5));
  Smooth smooth;
  ASPIC_TRY(auto built, build_model(scene.model));
  smooth.model = alone_in_space(std::move(built));
  smooth.model.simulation.implicit = {50, 500, 1e-11};  // the solve takes no part in errors
  smooth.start = initial_state(smooth.model, Precision::double_);
  Vec3 center;
  for (const Vec3& x : smooth.start.position) center = center + x;
  center = center / static_cast<double>(std::max<std::size_t>(1, smooth.start.position.size()));
  for (std::size_t i = 0; i < smooth.start.position.size(); ++i) {
    const Vec3 d = smooth.start.position[i] - center;
    smooth.start.velocity[i] = {};
    if (smooth.model.inverse_mass[i] == 0.0) continue;
    smooth.start.position[i] = center + Vec3{1.06 * d.x + 0.03 * d.y, 0.95 * d.y, 1.03 * d.z};
    smooth.start.velocity[i] = {0.3 * d.y, -0.2 * d.x, 0.1 * d.z};
  }
  return smooth;
}

struct Work {
  double h = 0.0, seconds = 0.0, error = 0.0;  ///< [s], seconds per simulated second, [m]
};

/// The end of a run in exactly `steps` steps, and the time it took [s].
Result<std::pair<State, double>> timed_run(const Study& study, const Smooth& smooth, Integrator integrator,
                                           std::uint64_t steps) {
  Model model = smooth.model;
  model.simulation.integrator = integrator;
  model.simulation.timestep = smooth.duration / static_cast<double>(steps);
  ASPIC_TRY(const auto solver, study.subject.reference(model, Precision::double_));
  double least = 0.0;
  for (int repeat = 0; repeat < 3; ++repeat) {
    ASPIC_CHECK(solver->load(smooth.start));
    const double before = thread_time();
    ASPIC_TRY(const auto advanced, solver->advance(steps));
    const double took = thread_time() - before;
    least = repeat == 0 ? took : std::min(least, took);
    if (advanced.divergence || least > 0.1) break;
  }
  ASPIC_TRY(auto state, solver->state());
  return std::pair(std::move(state), least);
}

/// Seconds per simulated second at an error, between the runs of a curve on logarithmic scales; that of the
/// largest step where already that is more accurate.
Work at_error(const std::vector<Work>& curve, double error) {
  if (curve.front().error <= error) return curve.front();
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (curve[i].error > error) continue;
    const double share = std::log(curve[i - 1].error / error) / std::log(curve[i - 1].error / curve[i].error);
    const auto mean = [&](double a, double b) { return a * std::pow(b / a, share); };
    return {mean(curve[i - 1].h, curve[i].h), mean(curve[i - 1].seconds, curve[i].seconds), error};
  }
  return curve.back();
}

Result<Figure> work_figure(const Study& study, Smooth smooth) {
  const auto limits = stability_limits(smooth.model, explicit_integrators, StabilityEffort::quick);
  double longest = 0.0;
  for (const StabilityLimit& limit : limits)
    if (limit.step && std::isfinite(*limit.step)) longest = std::max(longest, *limit.step);
  smooth.duration = 100.0 * (longest > 0.0 ? longest : smooth.model.simulation.timestep);
  ASPIC_TRY(const auto truth, timed_run(study, smooth, Integrator::runge_kutta_4, 1600));
  std::vector<std::vector<Work>> curves(methods);
  for (std::size_t m = 0; m < methods; ++m) {  // one after another: they are timed
    const Integrator integrator = all_integrators[m];
    double coarsest = smooth.duration / 5.0;
    if (row_of(integrator).staged()) {
      const auto at = std::ranges::find(explicit_integrators, integrator) - explicit_integrators.begin();
      const auto& step = limits[static_cast<std::size_t>(at)].step;
      coarsest = step && std::isfinite(*step) ? 0.9 * *step : smooth.model.simulation.timestep;
    }
    // Methods of first order need smaller steps for the errors of the others.
    const int halvings = row_of(integrator).order == 1 ? 7 : 4;
    for (int halving = 0; halving <= halvings; ++halving) {
      if (study.stopped()) return Error{ErrorCode::interrupted, "interrupted."};
      const double wanted = std::ceil(smooth.duration / coarsest) * std::exp2(halving);
      ASPIC_TRY(const auto run, timed_run(study, smooth, integrator, static_cast<std::uint64_t>(wanted)));
      if (run.first.step < static_cast<std::uint64_t>(wanted)) continue;  // diverged
      double sum = 0.0;
      for (std::size_t i = 0; i < run.first.position.size(); ++i) {
        const Vec3 d = run.first.position[i] - truth.first.position[i];
        sum += dot(d, d);
      }
      curves[m].push_back({smooth.duration / wanted, run.second / smooth.duration,
                           std::sqrt(sum / static_cast<double>(run.first.position.size()))});
    }
  }
  double reached = 0.0;  // by all
  for (const auto& curve : curves)
    if (!curve.empty()) reached = std::max(reached, curve.back().error);
  const double equal = std::pow(10.0, std::ceil(std::log10(std::max(reached, 1e-12))));

  Figure figure;
  figure.id = "work-precision";
  figure.chart.emplace();
  figure.chart->panels.push_back({"",
                                  {"CPU seconds per simulated second", Scale::log},
                                  {"error [m], root mean square", Scale::log},
                                  {}});
  figure.table = Table{{{"method"},
                        {"force evaluations a step"},
                        {"equal error [m]"},
                        {"with a step of [s]"},
                        {"CPU seconds per simulated second"}},
                       {}};
  for (std::size_t m = 0; m < methods; ++m) {
    if (curves[m].empty()) continue;
    Curve curve = method_curve(m, true);
    for (const Work& work : curves[m]) curve.points.push_back({work.seconds, work.error});
    figure.chart->panels[0].curves.push_back(std::move(curve));
    const Work work = at_error(curves[m], equal);
    const int evaluations = force_evaluations_per_step(all_integrators[m]);
    figure.table->rows.push_back({title_of(m),
                                  evaluations > 0 ? Cell(static_cast<double>(evaluations)) : Cell("solved"),
                                  work.error, work.h, work.seconds});
  }
  figure.caption =
      "Work and precision. The scene's bodies, cubes with at most 5 particles per edge, alone in space, "
      "smoothly deformed and moving. The reference solver computes in double precision with one thread. The "
      "error is that of the positions against Runge–Kutta 4 at a much smaller step. From left to right each "
      "step is half the one before; the first is 0.9 of the largest stable one. Lower and further left is "
      "better. In the table: the cost at equal error, or that of the largest stable step where it is more "
      "accurate.";
  figure.command = study.command("integrators");
  return figure;
}

Result<Figure> free_energy_figure(const Study& study, const Smooth& smooth) {
  const Model undamped = with_constants(smooth.model, 1.0, 0.0, 1.0);
  const StabilityLimit limit =
      stability_limit(undamped, Integrator::symplectic_euler, StabilityEffort::quick);
  const double h =
      limit.step && std::isfinite(*limit.step) ? 0.3 * *limit.step : undamped.simulation.timestep;
  constexpr std::uint64_t steps = 400;
  Figure figure;
  figure.id = "energy-free";
  figure.chart.emplace();
  figure.chart->panels.push_back(
      {"", {"time [s]"}, {"energy, relative to start", Scale::linear, 0.0, 2.0}, {}});
  std::vector<Curve> curves(methods);
  const auto vibrate = [&](std::size_t m) -> Status {
    Model model = with_constants(undamped, 1.0, 1.0, h);
    model.simulation.integrator = all_integrators[m];
    ASPIC_TRY(const auto solver, study.subject.reference(model, Precision::double_));
    ASPIC_CHECK(solver->load(smooth.start));
    const double first = measure(model, smooth.start).total();
    curves[m] = method_curve(m, false);
    for (std::uint64_t step = 0; step <= steps; ++step) {
      ASPIC_TRY(const auto state, solver->state());
      const double share = measure(model, state).total() / first;
      curves[m].points.push_back({static_cast<double>(step) * h, share});
      if (share > 10.0) break;
      ASPIC_TRY(const auto advanced, solver->advance(1));
      if (advanced.divergence) break;
    }
    return {};
  };
  ASPIC_CHECK(study.each(methods, vibrate));
  figure.chart->panels[0].curves = std::move(curves);
  figure.caption = fmt::format(
      "Energy of a free vibration without damping, h = {} s: 0.3 of symplectic Euler's largest stable step. "
      "The true energy is constant. Explicit Euler and the midpoint method "
      "add energy in every step, implicit Euler takes it away, and symplectic Euler and velocity Verlet keep "
      "it within narrow bounds.",
      rounded(h));
  figure.command = study.command("integrators");
  return figure;
}

/// The scene itself with every method: energy over time and images.
Status add_drops(const Study& study, Section& section) {
  const double duration = study.scene.model.simulation.duration;
  ASPIC_TRY(const auto own, build_model(study.scene.model));
  Model shown = own;
  shown.simulation.timestep =
      study.step_for(own, own.simulation.integrator).value_or(own.simulation.timestep);
  ASPIC_TRY(const auto first, study.run(shown, duration));
  if (!first.summary) return fail(ErrorCode::check_failed, "{}", first.reason);
  const std::vector<double> times = telling_times(*first.summary, duration);

  std::vector<Model> models(methods, own);
  std::vector<TrialResult> results(methods);
  ASPIC_CHECK(study.each(methods, [&](std::size_t m) -> Status {
    models[m].simulation.integrator = all_integrators[m];
    const auto step = study.step_for(models[m], all_integrators[m]);
    if (!step) return {};
    models[m].simulation.timestep = *step;
    ASPIC_TRY(results[m], study.run(models[m], duration, times));
    return {};
  }));
  Figure energy, strip;
  energy.id = "energy-drop";
  energy.chart.emplace();
  energy.chart->panels.push_back({"", {"time [s]"}, {"total energy [J]"}, {}});
  energy.table = Table{
      {{"method"}, {"time step [s]"}, {"CPU microseconds per step"}, {"CPU seconds per simulated second"}},
      {}};
  strip.id = "drop";
  strip.strip.emplace();
  for (const double t : times) strip.strip->columns.push_back(fmt::format("t = {} s", rounded(t, 3)));
  ViewSettings view = study.scene.view;
  for (std::size_t m = 0; m < methods; ++m) {
    const TrialResult& result = results[m];
    if (!result.summary) continue;
    if (m == 0 || view == study.scene.view) view = framed(study.scene.view, result.images);
    Curve curve = course_curve(
        title_of(m), result.samples, [](const CourseSample& s) { return s.measures.total(); },
        Palette::category, m);
    energy.chart->panels[0].curves.push_back(std::move(curve));
    const double h = models[m].simulation.timestep,
                 a_step =
                     result.thread_seconds / static_cast<double>(std::max<std::uint64_t>(1, result.steps));
    energy.table->rows.push_back({title_of(m), h, 1e6 * a_step, a_step / h});
    ASPIC_TRY(auto jpegs, study.images(models[m], result.images, view));
    strip.strip->rows.push_back({title_of(m), fmt::format("h = {} s", rounded(h)), std::move(jpegs)});
  }
  energy.caption = fmt::format(
      "Total energy while {} runs, each method at the scene's time step, or at 0.9 of its largest stable one "
      "where that is smaller; implicit Euler at 1/60 s. Damping and impacts take energy; a method that "
      "adds some shows as a rise. The table has the cost on the cpu backend with one thread.",
      study.scene.name);
  energy.command =
      fmt::format("aspic run {} --set simulation.integrator=METHOD --series energy.csv", study.scene_words);
  strip.caption = "The same drop with every method: contact, largest compression, and after.";
  strip.command =
      fmt::format("aspic run {} --set simulation.integrator=METHOD --frames DIR", study.scene_words);
  section.figures.push_back(std::move(energy));
  if (study.studio) section.figures.push_back(std::move(strip));
  return {};
}

}  // namespace

Result<Section> integrators_section(const Study& study) {
  Section section{"integrators", "Integrators", {}, {}};
  section.paragraphs = {
      "A time integration method turns forces into motion step by step. Four things tell methods apart: how "
      "fast the error falls with the step (order), how large a step may be before motion "
      "explodes (stability), its cost per step, and how it changes the energy."};
  ASPIC_TRY(auto order, order_figure(study));
  section.figures.push_back(std::move(order));
  ASPIC_TRY(auto smooth, smooth_body(study));
  if (!smooth.model.spring_classes.empty()) {
    ASPIC_TRY(auto built, build_model(study.scene.model));
    ASPIC_TRY(auto limits, limits_figure(study, alone_in_space(std::move(built))));
    section.figures.push_back(std::move(limits));
    ASPIC_TRY(auto work, work_figure(study, smooth));
    section.figures.push_back(std::move(work));
    ASPIC_TRY(auto energy, free_energy_figure(study, smooth));
    section.figures.push_back(std::move(energy));
  } else {
    section.paragraphs.emplace_back(
        "The scene has no springs, so the figures of stability and vibration are left out.");
  }
  ASPIC_CHECK(add_drops(study, section));
  return section;
}

}  // namespace aspic::report
