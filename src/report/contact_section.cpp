// The two contact models compared with each other and with closed forms.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/grid.h"
#include "report/study.h"
#include "verify/experiments.h"
#include "verify/studies.h"

namespace aspic::report {
namespace {

constexpr double g = 9.8;  // [m/s²]

std::string title_of(ContactModel model) {
  return model == ContactModel::coulomb ? "Coulomb" : "course";
}

/// A particle of 1 kg above or on the plane y = 0.
Model particle(Integrator integrator, ContactModel contact, const Vec3& position, const Vec3& velocity) {
  Model model = verify::loose_particles({position}, {velocity});
  model.simulation.integrator = integrator;
  model.simulation.timestep = 1e-3;
  model.contact.model = contact;
  model.terrain.push_back(verify::plane_through_origin(model, {0, 1, 0}));
  return model;
}

/// Square root of the height regained over the height fallen, both from the lowest point.
Result<double> measured_restitution(const Study& study, ContactModel contact, double e) {
  constexpr double start = 1.0;  // [m]
  Model model = particle(study.scene.model.simulation.integrator, contact, {0, start, 0}, {});
  model.terrain[0].restitution = e;
  ASPIC_TRY(const auto solver, study.subject.reference(model, Precision::double_));
  double lowest = start, apex = 0.0;
  bool bounced = false;
  for (int step = 0; step < 1000; ++step) {
    ASPIC_TRY(const auto state, verify::run(*solver, 1));
    const double y = state.position[0].y, v = state.velocity[0].y;
    if (bounced && v < 0.0) break;
    bounced = bounced || (y < 0.5 * start && v >= 0.0);
    lowest = std::min(lowest, y);
    if (bounced) apex = std::max(apex, y);
  }
  if (!bounced) return Error{ErrorCode::check_failed, "the particle never bounced"};
  return std::sqrt((apex - lowest) / (start - lowest));
}

/// Of the scene's bodies: square root of the rise of the center of mass after the impact over its fall.
Result<std::optional<double>> rebound_of_body(const Study& study, double e) {
  Scene scene = study.scene;
  scene.model.contact.restitution = e;
  for (TerrainSettings& terrain : scene.model.terrain) terrain.restitution = e;
  ASPIC_TRY(auto model, build_model(scene.model));
  if (model.bodies.empty()) return std::optional<double>();
  if (const auto step = study.step_for(model, model.simulation.integrator)) model.simulation.timestep = *step;
  ASPIC_TRY(const auto result, study.run(model, scene.model.simulation.duration, {}, 1.0 / 240));
  if (!result.summary || !result.summary->contact_time || result.outcome != Outcome::ok)
    return std::optional<double>();
  const auto at_contact =
      std::ranges::find(result.samples, *result.summary->contact_time, &CourseSample::time);
  const double fall = result.samples.front().height - at_contact->height;
  const auto lowest = std::ranges::find(result.samples, result.summary->squash_time, &CourseSample::time);
  double apex = at_contact->height;
  for (auto s = lowest; s != result.samples.end(); ++s) apex = std::max(apex, s->height);
  if (!(fall > 0.1)) return std::optional<double>();
  return std::optional(std::sqrt((apex - at_contact->height) / fall));
}

Result<Figure> restitution_figure(const Study& study) {
  const std::vector<double> values = spaced(0.0, 1.0, 6, false);
  constexpr std::size_t models = std::size(contact_models);
  std::vector<double> measured(models * values.size());
  std::vector<std::optional<double>> body(values.size());
  ASPIC_CHECK(study.each(values.size(), [&](std::size_t i) -> Status {
    for (std::size_t m = 0; m < models; ++m) {
      ASPIC_TRY(measured[m * values.size() + i],
                measured_restitution(study, contact_models[m].value, values[i]));
    }
    ASPIC_TRY(body[i], rebound_of_body(study, values[i]));
    return {};
  }));
  Figure figure;
  figure.id = "restitution";
  figure.chart.emplace();
  figure.chart->panel_width = 420;
  figure.chart->panels.push_back({"",
                                  {"restitution e set", Scale::linear, 0.0, 1.0},
                                  {"restitution measured", Scale::linear, 0.0, 1.05},
                                  {}});
  auto& curves = figure.chart->panels[0].curves;
  figure.table =
      Table{{{"e set"}, {"a particle, Coulomb"}, {"a particle, course"}, {"the scene's body"}}, {}};
  curves.push_back({"e as set", {{0, 0}, {1, 1}}, Palette::theory, 0, true, false});
  for (std::size_t m = 0; m < models; ++m) {
    Curve curve{fmt::format("a particle, {}", title_of(contact_models[m].value)),
                {},
                Palette::category,
                m,
                m == 0,
                true};
    for (std::size_t i = 0; i < values.size(); ++i)
      curve.points.push_back({values[i], measured[m * values.size() + i]});
    curves.push_back(std::move(curve));
  }
  Curve soft{"the scene's body", {}, Palette::category, 2, true, true};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (body[i]) soft.points.push_back({values[i], *body[i]});
    figure.table->rows.push_back({values[i], measured[i], measured[values.size() + i], Cell(body[i])});
  }
  if (!soft.points.empty()) curves.push_back(std::move(soft));
  figure.caption =
      "Restitution as set and as measured: the square root of the height regained over the height fallen. A "
      "particle regains e² of the height under both models. The center of mass of the scene's body regains "
      "much less or more: its dampers take most of the energy, and its springs return some of it, "
      "independent of e.";
  figure.command = "aspic verify --only contact/restitution";
  return figure;
}

Result<Figure> friction_figure(const Study& study) {
  constexpr double degrees = 25.0;
  const std::vector<double> values = spaced(0.0, 0.8, 9, false);
  constexpr std::size_t models = std::size(contact_models);
  std::vector<double> measured(models * values.size());
  const Integrator integrator = study.scene.model.simulation.integrator;
  ASPIC_CHECK(study.each(measured.size(), [&](std::size_t i) -> Status {
    ASPIC_TRY(const auto slide,
              verify::study_slide(study.subject, integrator, contact_models[i / values.size()].value, degrees,
                                  values[i % values.size()], 3.0));
    measured[i] = slide.acceleration;
    return {};
  }));
  const double angle = degrees * std::numbers::pi / 180;
  const auto theory = [&](double mu) { return std::max(0.0, g * (std::sin(angle) - mu * std::cos(angle))); };
  Figure figure;
  figure.id = "friction";
  figure.chart.emplace();
  figure.chart->panel_width = 420;
  figure.chart->panels.push_back({"", {"friction μ"}, {"acceleration [m/s²]"}, {}});
  auto& curves = figure.chart->panels[0].curves;
  Curve law{"g (sin θ − μ cos θ), at least 0", {}, Palette::theory, 0, true, false};
  for (const double mu : spaced(0.0, 0.8, 81, false)) law.points.push_back({mu, theory(mu)});
  curves.push_back(std::move(law));
  figure.table = Table{{{"μ"}, {"theory [m/s²]"}, {"Coulomb [m/s²]"}, {"course [m/s²]"}}, {}};
  for (std::size_t m = 0; m < models; ++m) {
    Curve curve{title_of(contact_models[m].value), {}, Palette::category, m, m == 1, true};
    for (std::size_t i = 0; i < values.size(); ++i)
      curve.points.push_back({values[i], measured[m * values.size() + i]});
    curves.push_back(std::move(curve));
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    figure.table->rows.push_back({values[i], theory(values[i]), measured[i], measured[values.size() + i]});
  figure.caption =
      "Friction as set and as measured: the mean acceleration of a 5³ cube on a slope of 25°, between 1 s "
      "and 3 s after its release. Coulomb's friction is μN at any speed, and holds the cube where μ > tan θ "
      "= 0.466. The course's formula, −μN·v, acts on particles within ε of the surface that move across it "
      "more slowly than v_s. Particles of a cube hop more than that, and it slides as on ice.";
  figure.command = "aspic verify --only contact/cone";
  return figure;
}

Result<Figure> level_figure(const Study& study) {
  constexpr double v0 = 3.0, mu = 0.3, duration = 2.0;
  Figure figure;
  figure.id = "level";
  figure.chart.emplace();
  figure.chart->panel_width = 420;
  figure.chart->panels.push_back({"", {"time [s]"}, {"speed [m/s]", Scale::linear, 0.0}, {}});
  auto& curves = figure.chart->panels[0].curves;
  for (std::size_t m = 0; m < std::size(contact_models); ++m) {
    const ContactModel contact = contact_models[m].value;
    Model model = particle(study.scene.model.simulation.integrator, contact, {0, 0, 0}, {v0, 0, 0});
    model.terrain[0].friction = mu;
    ASPIC_TRY(const auto solver, study.subject.reference(model, Precision::double_));
    Curve curve{title_of(contact), {{0.0, v0}}, Palette::category, m, false, true};
    Curve law{"closed form", {}, Palette::theory, 0, true, false};
    for (int tenth = 1; tenth <= 20; ++tenth) {
      ASPIC_TRY(const auto state, verify::run(*solver, 100));
      curve.points.push_back({duration * tenth / 20, state.velocity[0].x});
    }
    for (const double t : spaced(0.0, duration, 81, false)) {
      const bool coulomb = contact == ContactModel::coulomb;
      law.points.push_back({t, coulomb ? std::max(0.0, v0 - mu * g * t) : v0 * std::exp(-mu * g * t)});
    }
    curves.push_back(std::move(law));
    curves.push_back(std::move(curve));
  }
  figure.caption =
      "A particle sliding on level ground, μ = 0.3, from 3 m/s. Under Coulomb's law it loses μg of speed per "
      "second and stops; under the course's formula the speed falls as exp(−μgt) and never reaches 0.";
  figure.command = "aspic verify --only contact/viscous --only contact/slide";
  return figure;
}

/// The scene under both models, with its own method and with the midpoint method.
Result<Figure> drop_figure(const Study& study) {
  struct Case {
    Integrator integrator;
    ContactModel contact;
  };
  std::vector<Case> cases;
  std::vector<Integrator> integrators = {study.scene.model.simulation.integrator};
  if (integrators.front() != Integrator::midpoint) integrators.push_back(Integrator::midpoint);
  for (const Integrator integrator : integrators)
    for (const auto& row : contact_models) cases.push_back({integrator, row.value});
  ASPIC_TRY(const double duration, study.affordable(8.0));
  std::vector<TrialResult> results(cases.size());
  ASPIC_CHECK(study.each(cases.size(), [&](std::size_t i) -> Status {
    Scene scene = study.scene;
    scene.model.simulation.integrator = cases[i].integrator;
    scene.model.contact.model = cases[i].contact;
    ASPIC_TRY(auto model, build_model(scene.model));
    if (const auto step = study.step_for(model, cases[i].integrator)) model.simulation.timestep = *step;
    ASPIC_TRY(results[i], study.run(model, duration));
    return {};
  }));
  Figure figure;
  figure.id = "contact-drop";
  figure.chart.emplace();
  figure.chart->columns = 2;
  figure.chart->panel_width = 420;
  figure.chart->panel_height = 230;
  Panel height{"Height of the center of mass", {"time [s]"}, {"height [m]"}, {}};
  Panel lowest{"Lowest particle", {"time [s]"}, {"height [m]"}, {}};
  double bottom = 0.0, first_bottom = 0.0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::string name =
        fmt::format("{}, {}", title_of(cases[i].contact), row_of(cases[i].integrator).title);
    height.curves.push_back(course_curve(
        name, results[i].samples, [](const CourseSample& s) { return s.height; }, Palette::category, i));
    lowest.curves.push_back(course_curve(
        name, results[i].samples, [](const CourseSample& s) { return s.lowest; }, Palette::category, i));
    for (const CourseSample& sample : results[i].samples)
      bottom =
          std::min(i == 0 && &sample == results[i].samples.data() ? sample.lowest : bottom, sample.lowest);
    if (i == 0 && results[i].summary) first_bottom = results[i].summary->end.lowest;
  }
  // The ground, and as much above it as below the deepest of all.
  lowest.y.from = bottom - 0.02;
  lowest.y.to = first_bottom + std::max(0.1, first_bottom - bottom);
  figure.chart->panels = {std::move(height), std::move(lowest)};
  figure.caption =
      "The scene under both contact models. Under Coulomb's rule a body at rest stays on the surface. The "
      "course's contact force cancels the load only at the moment of evaluation. With several evaluations "
      "per step the body sinks slowly.";
  figure.command = fmt::format(
      "aspic sweep {} --vary contact.model=coulomb,course --vary integrator={} --duration {} --out "
      "contact.csv",
      study.scene_words,
      integrators.size() > 1 ? fmt::format("{},{}", name_of(integrators[0]), name_of(integrators[1]))
                             : std::string(name_of(integrators[0])),
      duration);
  return figure;
}

}  // namespace

Result<Section> contact_section(const Study& study) {
  Section section{"contact", "Contact", {}, {}};
  section.paragraphs = {
      "Aspic has two contact models: `coulomb`, the default, under which bodies come to rest and stick, and "
      "`course`, the formulas of the assignment to the letter."};
  for (const auto make : {restitution_figure, friction_figure, level_figure, drop_figure}) {
    ASPIC_TRY(auto figure, make(study));
    section.figures.push_back(std::move(figure));
  }
  return section;
}

}  // namespace aspic::report
