#include "report/outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "model/springs.h"

namespace aspic::report {
namespace {

constexpr std::string_view course_sections[] = {"integrators", "parameters"};

/// 12,876
std::string grouped(std::uint64_t number) {
  std::string text = fmt::format("{}", number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
  return text;
}

using SpringCounts = std::array<std::uint64_t, 3>;  // by SpringType
SpringCounts spring_counts(const Model& model) {
  SpringCounts counts = {};
  for (const Spring& spring : springs_of(model))
    ++counts[static_cast<std::size_t>(model.spring_classes[spring.spring_class].type)];
  return counts;
}

constexpr SpringType spring_types[] = {SpringType::structural, SpringType::shear, SpringType::bending};

std::string counts_text(const Model& model) {
  const SpringCounts counts = spring_counts(model);
  std::vector<std::string> parts;
  if (model.particle_count() > 0)
    parts.push_back(fmt::format("{} particles", grouped(model.particle_count())));
  for (const SpringType type : spring_types) {
    if (const std::uint64_t n = counts[static_cast<std::size_t>(type)]; n > 0)
      parts.push_back(fmt::format("{} {} springs", grouped(n), name_of(type)));
  }
  if (model.ball_count() > 0) parts.push_back(fmt::format("{} balls", model.ball_count()));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// The scene with its own method, at moments that tell its story.
Result<Figure> scene_figure(const Study& study, const Model& model) {
  const double duration = study.scene.model.simulation.duration;
  ASPIC_TRY(const auto first, study.run(model, duration));
  const std::vector<double> times =
      first.summary ? telling_times(*first.summary, duration) : std::vector<double>{0.0};
  ASPIC_TRY(const auto run, study.run(model, duration, times));
  Figure figure;
  figure.id = "scene";
  figure.strip.emplace();
  for (const double t : times) figure.strip->columns.push_back(fmt::format("t = {} s", rounded(t, 3)));
  ASPIC_TRY(auto jpegs, study.images(model, run.images, framed(study.scene.view, run.images)));
  const IntegratorRow& method = row_of(model.simulation.integrator);
  figure.strip->rows.push_back({std::string(method.title),
                                fmt::format("h = {} s", rounded(model.simulation.timestep)),
                                std::move(jpegs)});
  figure.caption = "The scene with its own method.";
  figure.command = fmt::format("aspic run {} --video scene.mp4", study.scene_words);
  return figure;
}

std::string_view meaning_of(SpringType type) {
  switch (type) {
    case SpringType::structural:
      return "structural ones go to the nearest particles";
    case SpringType::shear:
      return "shear ones along the diagonals";
    case SpringType::bending:
      return "bending ones to the particles after the nearest";
  }
  return "";
}

/// The springs of each type at the start.
Result<Figure> springs_figure(const Study& study, const Model& model) {
  const SpringCounts counts = spring_counts(model);
  const State start = initial_state(model, Precision::single);
  ViewSettings view = framed(study.scene.view, std::span(&start, 1));
  view.color = ViewColor::type;
  view.terrain = false;
  Figure figure;
  figure.id = "springs";
  figure.strip.emplace();
  figure.strip->rows.push_back({"springs", "at the start", {}});
  std::vector<std::string_view> meanings;
  std::string_view shown;
  for (const SpringType type : spring_types) {
    if (counts[static_cast<std::size_t>(type)] == 0) continue;
    view.draw = {.solid = false,
                 .structural = type == SpringType::structural,
                 .shear = type == SpringType::shear,
                 .bending = type == SpringType::bending};
    ASPIC_TRY(auto jpegs, study.images(model, std::span(&start, 1), view));
    if (jpegs.empty()) break;
    figure.strip->columns.push_back(
        fmt::format("{}: {}", name_of(type), grouped(counts[static_cast<std::size_t>(type)])));
    figure.strip->rows[0].jpegs.push_back(std::move(jpegs[0]));
    meanings.push_back(meaning_of(type));
    shown = name_of(type);
  }
  figure.caption = fmt::format("Springs by type: {}.", fmt::join(meanings, ", "));
  figure.command = fmt::format("aspic run {} --view 'draw=[\"{}\"]' --frames DIR", study.scene_words, shown);
  return figure;
}

Figure formulas_figure(const Model& model) {
  Figure figure;
  figure.id = "formulas";
  figure.table = Table{{{"what"}, {"formula"}}, {}};
  auto& rows = figure.table->rows;
  if (!model.spring_classes.empty())
    rows.push_back({"spring and damper", "f₁ = −[k(L − r) + c(v₁ − v₂)·n]·n, f₂ = −f₁, with n from 2 to 1"});
  if (!model.terrain.empty()) {
    rows.push_back({"bounce", "v' = vₜ − e·u·n, where d < ε and u = v·n < 0"});
    if (model.contact.model == ContactModel::course) {
      rows.push_back({"contact: resist", "f + N·n, where d < ε and N = −f·n > 0"});
      rows.push_back({"contact: friction", "f − μ·N·vₜ"});
    } else {
      rows.push_back({"contact: friction", "an impulse against vₜ of at most μ times that along n"});
    }
  }
  if (model.ball_count() > 0)
    rows.push_back({"two balls", "v₁' = (v₁ₙ(m₁ − m₂) + 2m₂v₂ₙ)/(m₁ + m₂) + v₁ₜ, v₂' likewise, at e = 1"});
  for (const Integrator integrator : all_integrators)
    rows.push_back({std::string(row_of(integrator).title), std::string(row_of(integrator).formula)});
  figure.caption =
      "Formulas. x, v, a: position, velocity and acceleration at the start of a step of h, with a dash at "
      "its end; L, r: length and rest length of a spring; k, c: stiffness and damping; d, n: distance from "
      "the ground and its normal; vₜ: the part of v along the ground; e, μ: restitution and friction; f: "
      "force on a particle.";
  return figure;
}

/// The functions of the course's framework, where the scene has what they make.
Figure functions_figure(const Scene& scene) {
  const bool cubes = !scene.model.cubes.empty(), nets = !scene.model.goal_nets.empty();
  Figure figure;
  figure.id = "functions";
  figure.table = Table{{{"what"}, {"function"}, {"file of aspic"}, {"check"}}, {}};
  auto& rows = figure.table->rows;
  if (cubes)
    rows.push_back({"springs", "`Cube::initializeSpring`", "`src/model/cube.cpp`", "`body/cube/made`"});
  if (nets)
    rows.push_back(
        {"springs", "`GoalNet::InitializeSpring`", "`src/model/goal_net.cpp`", "`body/goal-net/made`"});
  rows.push_back({"forces",
                  nets && !cubes ? "`GoalNet::ComputeInternalForce`" : "`Cube::computeInternalForce`",
                  "`src/physics/springs/law.h`", "`force`"});
  rows.push_back({"collisions", nets && !cubes ? "`ParticlePlaneCollision`" : "`handleCollision`",
                  "`src/physics/terrain/ground.h`", "`contact`"});
  if (nets)
    rows.push_back({"balls", "`BallPlaneCollision`, `BallToBallCollision`, `BallParticleCollision`",
                    "`src/physics/balls/law.h`", "`balls`"});
  rows.push_back({"integrators",
                  nets && !cubes ? "`CMassSpringSystem::ExplicitEuler`, `RungeKutta`" : "`integrate`",
                  "`src/cpu_reference/integrators.h`", "`order`"});
  figure.caption =
      "Functions of the course's framework and of aspic; `aspic verify --only CHECK` measures them. All rows "
      "of the slides are in docs/course.md.";
  return figure;
}

std::string question_of(std::string_view id) {
  constexpr std::pair<std::string_view, std::string_view> questions[] = {
      {"parameter-k", "Stiffness: what changes in height, compression and time to rest, and why?"},
      {"parameter-c", "Damping: which effect do small and large values have?"},
      {"parameter-e", "Restitution: why does the body not rise to e² of its fall?"},
      {"parameter-mu", "Friction: when does the body stop, stick or topple?"},
      {"parameter-h",
       "Time step: from which value on does the result change, and what happens beyond the stable one?"},
  };
  const auto* const found =
      std::ranges::find(questions, id, &std::pair<std::string_view, std::string_view>::first);
  return found == std::end(questions) ? "" : std::string(found->second);
}

/// A question after the last figure of each parameter.
void ask(Section& parameters) {
  for (Figure& figure : parameters.figures) {
    const bool images = figure.id.ends_with("-images");
    const std::string of = images ? figure.id.substr(0, figure.id.rfind("-images")) : figure.id;
    const bool last = images || std::ranges::none_of(parameters.figures, [&](const Figure& other) {
                        return other.id == of + "-images";
                      });
    if (last) figure.gap = question_of(of);
  }
}

Result<std::vector<Section>> course_outline(const Study& study, std::vector<Section> sections) {
  Section &integrators = sections.at(0), &parameters = sections.at(1);
  ASPIC_TRY(const Model model, build_model(study.scene.model));
  Section introduction{"introduction", "1 Introduction", {}, {}};
  introduction.paragraphs = {
      fmt::format("The scene `{}` has {}. It is simulated for {} s in steps of {} s with {}.",
                  study.scene.name, counts_text(model), rounded(model.simulation.duration),
                  rounded(model.simulation.timestep), row_of(model.simulation.integrator).title)};
  introduction.gaps = {
      "Name the subject and purpose of the simulation. Which insight should the reader gain?"};
  Section fundamentals{"fundamentals", "2 Fundamentals", {}, {}};
  fundamentals.paragraphs = {
      "Mass sits in particles. Springs and dampers act along the line between two of them, and terrain on "
      "those that touch it."};
  if (study.studio) {
    ASPIC_TRY(auto scene, scene_figure(study, model));
    introduction.figures.push_back(std::move(scene));
    if (!model.spring_classes.empty()) {
      ASPIC_TRY(auto springs, springs_figure(study, model));
      fundamentals.figures.push_back(std::move(springs));
    }
  }
  fundamentals.figures.push_back(formulas_figure(model));
  fundamentals.gaps = {
      "Springs and contact: what does each type of spring hold, what does damping take away, and what do "
      "bounce, resist and friction do?",
      "Integrators: at which moments does each method evaluate forces, and how does its error depend on h?"};
  Section implementation{"implementation", "3 Implementation", {}, {functions_figure(study.scene)}};
  implementation.gaps = {
      "Your program: its data, the order of a step, what was difficult, how you tested it. Name what is a "
      "bonus."};
  Section results{"results", "4 Results and discussion", {}, {}};
  results.paragraphs = {
      "Two questions: what does the choice of integrator do, and what do the parameters do?"};
  integrators.title = "4.1 The difference between integrators";
  parameters.title = "4.2 Effect of parameters";
  integrators.part = parameters.part = true;
  integrators.gaps = {
      "Which methods add energy and which take it away? Which step can each take, at what cost? Which one "
      "would you take for this scene?"};
  // A finer body without a material is another body, and pages are few.
  std::erase_if(parameters.figures,
                [](const Figure& figure) { return figure.id.starts_with("parameter-n"); });
  ask(parameters);
  Section conclusion{"conclusion", "5 Conclusion", {}, {}};
  conclusion.gaps = {"Summarize your results. Which of them surprised you, and which steps would be next?"};
  std::vector<Section> chapters;
  for (Section* chapter :
       {&introduction, &fundamentals, &implementation, &results, &integrators, &parameters, &conclusion})
    chapters.push_back(std::move(*chapter));
  return chapters;
}

constexpr OutlineRow outline_table[] = {{"course", 10, course_sections, course_outline}};

}  // namespace

std::span<const OutlineRow> outlines() {
  return outline_table;
}

}  // namespace aspic::report
