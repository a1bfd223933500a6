// Which steps are stable, as solvers show it and as theory says.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/stability.h"
#include "model/springs.h"
#include "report/grid.h"
#include "report/study.h"
#include "scene/short_keys.h"

namespace aspic::report {
namespace {

constexpr double span_of_constant = 16.0;  ///< the map reaches from a sixteenth to sixteen times the scene's

/// What a map varies besides the time step.
struct Constant {
  std::string_view key;  ///< a short name
  Model (*with)(const Model&, double factor, double timestep);
};
constexpr Constant constants[] = {
    {"k", [](const Model& m, double factor, double h) { return with_constants(m, factor, 1.0, h); }},
    {"c", [](const Model& m, double factor, double h) { return with_constants(m, 1.0, factor, h); }},
};

/// Edges halfway between centers of constant ratio.
std::vector<double> edges_of(const std::vector<double>& centers) {
  const double half = std::sqrt(centers[1] / centers[0]);
  std::vector<double> edges = {centers.front() / half};
  for (const double center : centers) edges.push_back(center * half);
  return edges;
}

/// Theory's limit over the constant, for every explicit method.
struct Limits {
  std::vector<double> factors;
  std::vector<std::vector<StabilityLimit>> by_factor;  ///< each in the order of explicit_integrators

  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
};
Result<Limits> theory(const Study& study, const Model& model, const Constant& constant, std::size_t count) {
  Limits limits;
  limits.factors = spaced(1.0 / span_of_constant, span_of_constant, count, true);
  limits.by_factor.resize(count);
  ASPIC_CHECK(study.each(count, [&](std::size_t i) -> Status {
    limits.by_factor[i] = stability_limits(constant.with(model, limits.factors[i], 1.0), explicit_integrators,
                                           StabilityEffort::quick);
    return {};
  }));
  for (const auto& row : limits.by_factor) {
    for (const StabilityLimit& limit : row) {
      if (!limit.step || !std::isfinite(*limit.step) || !(*limit.step > 0.0)) continue;
      limits.smallest = std::min(limits.smallest, *limit.step);
      limits.largest = std::max(limits.largest, *limit.step);
    }
  }
  return limits;
}

Result<Figure> map_figure(const Study& study, const Model& model, const ProbeStart& start,
                          const Constant& constant) {
  const ShortKey& key = *find_short_key(constant.key);
  const std::optional<double> present = present_value(study.scene, key);
  const double base = present.value_or(1.0);
  const std::string axis =
      present ? fmt::format("{} [{}]", key.title, key.unit) : fmt::format("{}, over the scene's", key.title);
  const std::size_t probe_steps = study.thorough ? 480 : 240;
  // Springs of large scenes are many: their maps are coarser.
  constexpr double most_forces = 2e10, usual_rows = 13, usual_columns = 24;
  const double forces = all_integrators.size() * usual_rows * usual_columns *
                        static_cast<double>(probe_steps * spring_count(model)),
               share = std::sqrt(std::min(1.0, most_forces / std::max(forces, 1.0)));
  const auto share_of = [&](double usual, std::size_t least) {
    return std::max(least, static_cast<std::size_t>(std::lround(usual * share)));
  };
  const std::size_t rows = study.thorough ? 25 : share_of(usual_rows, 5),
                    columns = study.thorough ? 41 : share_of(usual_columns, 9);
  ASPIC_TRY(const auto limits, theory(study, model, constant, 4 * (rows - 1) + 1));
  const bool bounded = limits.largest > 0.0;
  const double h = model.simulation.timestep;
  const std::vector<double> steps =
      spaced(bounded ? limits.smallest / 2 : h / 16, bounded ? limits.largest * 2 : h * 16, columns, true);
  const std::vector<double> factors = spaced(1.0 / span_of_constant, span_of_constant, rows, true);

  Figure figure;
  figure.id = fmt::format("stability-{}", constant.key);
  figure.chart.emplace();
  Chart& chart = *figure.chart;
  chart.columns = 4;
  chart.panel_width = 220;
  chart.panel_height = 190;
  const std::size_t cells = rows * columns, methods = all_integrators.size();
  std::vector<char> stable(methods * cells);
  ASPIC_CHECK(study.each(methods * rows, [&](std::size_t task) -> Status {
    const Integrator integrator = all_integrators[task / rows];
    const std::size_t row = task % rows;
    for (std::size_t column = 0; column < columns; ++column) {
      Model probed = constant.with(model, factors[row], steps[column]);
      probed.simulation.integrator = integrator;
      ASPIC_TRY(const auto solver, study.make_solver()(probed));
      // A long step costs as much as many explicit ones, and damps at once what it is given.
      const std::uint64_t count = row_of(integrator).traits.long_steps ? 30 : probe_steps;
      ASPIC_TRY(const bool grew, grows(*solver, start, count));
      stable[task / rows * cells + row * columns + column] = !grew;
    }
    return {};
  }));
  for (std::size_t m = 0; m < methods; ++m) {
    Panel panel;
    panel.title = row_of(all_integrators[m]).title;
    panel.x = {"time step h [s]", Scale::log};
    panel.y = {axis, Scale::log};
    CellMap map;
    map.x = steps;
    for (const double factor : factors) map.y.push_back(base * factor);
    map.x_edges = edges_of(map.x);
    map.y_edges = edges_of(map.y);
    panel.x.from = map.x_edges.front();
    panel.x.to = map.x_edges.back();
    panel.y.from = map.y_edges.front();
    panel.y.to = map.y_edges.back();
    const auto at = stable.begin() + static_cast<std::ptrdiff_t>(m * cells);
    map.stable.assign(at, at + static_cast<std::ptrdiff_t>(cells));
    panel.map = std::move(map);
    const auto* const method = std::ranges::find(explicit_integrators, all_integrators[m]);
    if (method != explicit_integrators.end()) {
      Curve curve{"largest stable step in theory", {}, Palette::theory, 0, true, false};
      for (std::size_t i = 0; i < limits.factors.size(); ++i) {
        const StabilityLimit& limit =
            limits.by_factor[i][static_cast<std::size_t>(method - explicit_integrators.begin())];
        curve.points.push_back({limit.step.value_or(std::nan("")), base * limits.factors[i]});
      }
      panel.curves.push_back(std::move(curve));
    }
    chart.panels.push_back(std::move(panel));
  }
  figure.caption = fmt::format(
      "Time step and {} of {} for each method. A cell is a run of the scene's bodies alone in space, "
      "displaced by a "
      "thousandth of a spring in their stiffest mode: it is unstable if that motion has grown after {} "
      "steps. The dashed line is the largest step "
      "that the linearized springs allow.",
      key.title, study.scene.name, study.thorough ? 480 : 240);
  figure.command = study.command("stability");
  return figure;
}

}  // namespace

Result<Section> stability_section(const Study& study) {
  Section section{"stability", "Stability map", {}, {}};
  ASPIC_TRY(auto built, build_model(study.scene.model));
  const Model model = alone_in_space(std::move(built));
  if (model.spring_classes.empty()) {
    section.paragraphs = {"The scene has no springs: nothing limits the time step of any method."};
    return section;
  }
  section.paragraphs = {
      "An explicit method multiplies each mode of vibration by a factor in every step. If the step is too "
      "large, that factor exceeds 1 for the stiffest mode, and the motion diverges. Damping first widens and "
      "then narrows the stable range: strongly damped springs are stiff in their velocities. Implicit Euler, "
      "solved in full, has no limit, but each step costs more."};
  const ProbeStart start = probe_start(model);
  for (const Constant& constant : constants) {
    ASPIC_TRY(auto figure, map_figure(study, model, start, constant));
    section.figures.push_back(std::move(figure));
  }
  return section;
}

}  // namespace aspic::report
