// What each parameter does to the same drop: small multiples of height over time and of three measures.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>

#include "analysis/stability.h"
#include "base/shell_word.h"
#include "report/csv.h"
#include "report/grid.h"
#include "report/study.h"
#include "scene/short_keys.h"

namespace aspic::report {
namespace {

constexpr double sideways = 5.0;  ///< [m/s], given to bodies that start at rest

/// A parameter, and its values relative to the scene's.
struct Varied {
  std::string_view key;  ///< a short name
  std::vector<double> (*values)(double present, double stable_step);
  std::string_view says;
};
constexpr Varied varied[] = {
    {"k", [](double k, double) { return spaced(k / 4, k * 4, steps_of_parameter, true); },
     "Softer springs give way further and sag under the body's own weight."},
    {"c", [](double c, double) { return spaced(c / 8, c * 2, steps_of_parameter, true); },
     "Damping decides how long the body wobbles after the impact."},
    {"e", [](double, double) { return spaced(0.0, 1.0, steps_of_parameter, false); },
     "Restitution acts on each particle that hits the ground; how high the body rises depends on its springs "
     "and dampers as well."},
    {"mu",
     [](double, double) {
       return std::vector<double>{0.0, 0.1, 0.2, 0.4, 0.8};
     },
     "Friction stops the slide; above a certain value the body sticks or topples instead."},
    {"h",
     [](double, double stable) {
       return std::vector<double>{stable / 16, stable / 4, 0.7 * stable, 0.95 * stable, 1.15 * stable};
     },
     "The step hardly matters if it is small enough; where springs limit it, the last value is above the "
     "largest stable one."},
    {"n",
     [](double, double) {
       return std::vector<double>{4, 6, 8, 10, 12};
     },
     "Without a material every particle has the same mass and every spring the same stiffness: a finer cube "
     "is heavier and softer, and thus another body."},
};

/// The number with so few digits.
double short_number(double value, int digits) {
  return std::stod(fmt::format("{:.{}g}", value, digits));
}

std::vector<std::string> words_of(const std::vector<double>& values) {
  std::vector<std::string> words;
  for (const double value : values) words.push_back(csv_number(short_number(value, 3)));
  return words;
}

/// The scene with bodies thrown sideways, and the words that do so.
struct Thrown {
  std::vector<std::string> assignments;
  double duration = 0.0;  ///< [s]
};
Result<Thrown> thrown(const Study& study) {
  Thrown result;
  ASPIC_TRY(result.duration, study.affordable(study.thorough ? 20.0 : 12.0));
  const auto& cubes = study.scene.model.cubes;
  for (std::size_t c = 0; c < cubes.size(); ++c) {
    if (length(cubes[c].velocity) == 0.0)
      result.assignments.push_back(fmt::format("cube[{}].velocity=[{},0,0]", c, sideways));
  }
  return result;
}

/// The largest step of the method that all variants of the scene take [s].
Result<double> common_step(const Study& study, const Thrown& base, std::string_view key,
                           const std::vector<std::string>& values) {
  double step = study.scene.model.simulation.timestep;
  for (const std::string& value : values) {
    ASPIC_TRY(auto assigned, assignments(study.scene, key, value));
    assigned.insert(assigned.end(), base.assignments.begin(), base.assignments.end());
    const auto scene = study.varied(assigned);
    if (!scene) continue;  // it is a rejected row
    ASPIC_TRY(const auto model, build_model(scene->model));
    if (const auto own = study.step_for(model, model.simulation.integrator)) step = std::min(step, *own);
  }
  return short_number(step, 2);
}

/// A panel of one measure over the values.
Panel measure_panel(const ShortKey& key, std::string title, std::string measure,
                    const std::vector<std::string>& words, const std::vector<TrialResult>& results,
                    double (*of)(const CourseSummary&)) {
  Panel panel{std::move(title),
              {key.unit.empty() ? std::string(key.title) : fmt::format("{} [{}]", key.title, key.unit)},
              {std::move(measure)},
              {}};
  const double first = std::stod(words.front()), last = std::stod(words.back());
  if (first > 0.0 && last / first > 6.0) panel.x.scale = Scale::log;
  panel.y.from = 0.0;
  // The same for all measures, whether a value has one or not.
  const bool log = panel.x.scale == Scale::log;
  panel.x.from = log ? first / 1.3 : first - 0.06 * (last - first);
  panel.x.to = log ? last * 1.3 : last + 0.06 * (last - first);
  Curve line{"", {}, Palette::category, 6, true, false};
  std::vector<Curve> marks;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const bool counts = results[i].summary && results[i].outcome == Outcome::ok;
    const Point point = {std::stod(words[i]), counts ? of(*results[i].summary) : std::nan("")};
    line.points.push_back(point);
    marks.push_back({fmt::format("{} = {}", key.name, words[i]), {point}, Palette::sequence, i, false, true});
  }
  panel.curves.push_back(std::move(line));
  for (Curve& mark : marks) panel.curves.push_back(std::move(mark));
  return panel;
}

/// When the center of mass is highest after the deepest squash [s].
double apex(const TrialResult& result) {
  double time = result.summary->squash_time, highest = -std::numeric_limits<double>::infinity();
  for (const CourseSample& sample : result.samples) {
    if (sample.time < result.summary->squash_time || sample.height <= highest) continue;
    highest = sample.height;
    time = sample.time;
  }
  return time;
}

/// A view that shows the states of all runs that ended well, each moved sideways to where it began.
ViewSettings following_view(const ViewSettings& view, const std::vector<TrialResult>& results) {
  std::vector<State> shown;
  for (const TrialResult& result : results) {
    if (result.outcome != Outcome::ok) continue;
    for (State state : result.images) {
      const Vec3 way = way_of(state);
      for (Vec3& x : state.position) x = x - way;
      for (Vec3& x : state.ball_position) x = x - way;
      shown.push_back(std::move(state));
    }
  }
  return framed(view, shown);
}

/// The measures and, with a studio, the images; nothing where the scene has no such parameter.
Result<std::vector<Figure>> parameter_figures(const Study& study, const Thrown& base, const Varied& row) {
  const ShortKey& key = *find_short_key(row.key);
  const bool step_varied = key.name == "h";
  const auto present = present_value(study.scene, key);
  if (!present && key.targets(study.scene).empty()) return std::vector<Figure>();
  ASPIC_TRY(const auto own, build_model(study.scene.model));
  const StabilityLimit limit = stability_limit(own, own.simulation.integrator, StabilityEffort::quick);
  const double stable = limit.step && std::isfinite(*limit.step) ? *limit.step : own.simulation.timestep;
  const std::vector<std::string> words = words_of(row.values(present.value_or(1.0), stable));
  std::vector<std::string> fixed = base.assignments;
  if (!step_varied) {
    ASPIC_TRY(const double step, common_step(study, base, key.name, words));
    fixed.push_back(fmt::format("simulation.timestep={}", step));
  }

  std::vector<Model> models(words.size());
  std::vector<Scene> scenes(words.size());
  std::vector<TrialResult> results(words.size());
  std::vector<double> times;
  const auto run = [&](std::size_t i, std::span<const double> image_times) -> Status {
    ASPIC_TRY(auto assigned, assignments(study.scene, key.name, words[i]));
    assigned.insert(assigned.end(), fixed.begin(), fixed.end());
    auto scene = study.varied(assigned);
    if (!scene) {
      results[i] = trial_error(scene.error());
      return {};
    }
    scenes[i] = std::move(*scene);
    ASPIC_TRY(models[i], build_model(scenes[i].model));
    ASPIC_TRY(results[i], study.run(models[i], base.duration, image_times));
    return {};
  };
  // The middle value says when there is something to see.
  const std::size_t middle = words.size() / 2;
  ASPIC_CHECK(run(middle, {}));
  const auto& summary = results[middle].summary;
  const bool lands = summary && summary->squash_time > 0.0;
  if (lands) {
    times = {summary->squash_time, apex(results[middle]), base.duration};
  } else if (summary) {
    times = {base.duration / 3, base.duration * 2 / 3, base.duration};
  }
  ASPIC_CHECK(study.each(words.size(), [&](std::size_t i) { return run(i, times); }));

  Figure figure;
  figure.id = fmt::format("parameter-{}", key.name);
  figure.chart.emplace();
  Chart& chart = *figure.chart;
  chart.columns = 4;
  chart.panel_width = 210;
  chart.panel_height = 170;
  Panel heights{"Height of the center of mass", {"time [s]"}, {"height [m]"}, {}};
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!results[i].summary) continue;
    heights.curves.push_back(course_curve(
        fmt::format("{} = {}", key.name, words[i]), results[i].samples,
        [](const CourseSample& s) { return s.height; }, Palette::sequence, i));
  }
  chart.panels.push_back(std::move(heights));
  chart.panels.push_back(measure_panel(key, "Largest compression", "share of height", words, results,
                                       [](const CourseSummary& s) { return s.squash; }));
  chart.panels.push_back(
      measure_panel(key, "Time to rest", "time [s]", words, results,
                    [](const CourseSummary& s) { return s.rest_time.value_or(std::nan("")); }));
  chart.panels.push_back(measure_panel(key, "Sliding distance", "distance [m]", words, results,
                                       [](const CourseSummary& s) { return s.end.slide; }));
  figure.table =
      Table{{{key.unit.empty() ? std::string(key.title) : fmt::format("{} [{}]", key.title, key.unit)},
             {"outcome"},
             {"largest compression"},
             {"at [s]"},
             {"at rest from [s]"},
             {"sliding distance [m]"},
             {"energy at the end [J]"}},
            {}};
  Strip strip;
  for (const std::string& word : words) strip.columns.push_back(fmt::format("{} = {}", key.name, word));
  strip.rows.resize(times.size());
  for (std::size_t t = 0; t < times.size(); ++t)
    strip.rows[t] = {fmt::format("t = {} s", rounded(times[t], 3)), "",
                     std::vector<std::string>(words.size())};
  const ViewSettings view = following_view(study.scene.view, results);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const TrialResult& result = results[i];
    std::vector<Cell> cells = {std::stod(words[i]), std::string(name_of(result.outcome))};
    if (const auto& s = result.summary; s && result.outcome == Outcome::ok) {
      cells.insert(cells.end(),
                   {s->squash, s->squash_time, Cell(s->rest_time), s->end.slide, s->end.measures.total()});
      ASPIC_TRY(auto jpegs, study.images(models[i], result.images, view, true));
      for (std::size_t t = 0; t < jpegs.size() && t < times.size(); ++t)
        strip.rows[t].jpegs[i] = std::move(jpegs[t]);
    } else {
      cells.insert(cells.end(), 5, Cell());
    }
    figure.table->rows.push_back(std::move(cells));
  }
  std::string title(key.title);
  title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  figure.caption = fmt::format("{} ({}). {}", title, key.meaning, row.says);
  std::string words_of_scene = study.scene_words;
  for (const std::string& assignment : fixed)
    words_of_scene += fmt::format(" --set {}", shell_word(assignment));
  words_of_scene += fmt::format(" --duration {}", base.duration);
  figure.command = fmt::format("aspic sweep {} --vary {}={} --out {}.csv", words_of_scene, key.name,
                               fmt::join(words, ","), key.name);
  std::vector<Figure> figures = {std::move(figure)};
  if (!study.studio) return figures;
  Figure images;
  images.id = fmt::format("parameter-{}-images", key.name);
  images.strip = std::move(strip);
  images.caption = fmt::format(
      "{}: the same runs{}. The camera follows the body sideways.", title,
      lands ? fmt::format(" at the moments of {} = {}: largest compression, highest point after it, end",
                          key.name, words[middle])
            : "");
  images.command = fmt::format("aspic run {} --variant {}=VALUE --frames DIR", words_of_scene, key.name);
  figures.push_back(std::move(images));
  return figures;
}

}  // namespace

Result<Section> parameters_section(const Study& study) {
  ASPIC_TRY(const Thrown base, thrown(study));
  Section section{"parameters", "Parameters", {}, {}};
  section.paragraphs = {
      fmt::format("Each figure varies one parameter of {} and keeps the others{}. A run takes {} s; all runs "
                  "of a figure have one time step, which is stable for all of them. Where the time to rest "
                  "has no mark, the body still moved at the end.",
                  study.scene.name,
                  base.assignments.empty()
                      ? ""
                      : fmt::format("; cubes are thrown sideways at {} m/s, so that they slide", sideways),
                  base.duration)};
  for (const Varied& row : varied) {
    ASPIC_TRY(auto figures, parameter_figures(study, base, row));
    std::ranges::move(figures, std::back_inserter(section.figures));
  }
  return section;
}

}  // namespace aspic::report
