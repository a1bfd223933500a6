#include "live/live_run.h"

#include <algorithm>
#include <utility>

#include "aspic/model.h"
#include "aspic/scene.h"
#include "base/lines.h"
#include "cpu_reference/reference_solver.h"
#include "model/actuation.h"
#include "model/model.h"

namespace aspic::live {
namespace {

Result<std::unique_ptr<Solver>> solver_of(const Scene& scene) {
  ASPIC_TRY(auto model, build_model(scene.model));
  return make_reference_solver(std::move(model), Precision::single);
}

std::size_t count_of(const Model& model, StateCarrier carrier) {
  return carrier == StateCarrier::particle ? model.particle_count() : model.ball_count();
}

std::size_t numbers_of(const Model& model) {
  return numbers_of(StateCarrier::particle) * model.particle_count() +
         numbers_of(StateCarrier::ball) * model.ball_count();
}

}  // namespace

LiveRun::LiveRun(Scene scene, std::unique_ptr<Solver> solver)
    : scene_(std::move(scene)),
      solver_(std::move(solver)),
      names_(input_names(solver_->model())),
      numbers_(numbers_of(solver_->model())),
      meter_(std::make_unique<Meter>(solver_->model())) {}

Result<LiveRun> LiveRun::create(std::string_view text) {
  ASPIC_TRY(auto scene, parse_scene(text, "scene.toml"));
  ASPIC_TRY(auto solver, solver_of(scene));
  return LiveRun(std::move(scene), std::move(solver));
}

Status LiveRun::change(std::string_view lines, std::vector<double> channels) {
  std::vector<std::string> overrides;
  while (!lines.empty()) overrides.emplace_back(take_line(lines));
  ASPIC_TRY(auto scene, with_overrides(scene_, overrides));
  ASPIC_TRY(auto solver, solver_of(scene));
  ASPIC_TRY(State state, solver_->state());
  state.step =
      step_at_same_time(state.step, model().simulation.timestep, solver->model().simulation.timestep);
  if (const Status loaded = solver->load(state); !loaded)
    return fail(ErrorCode::scene_rejected, "The number of particles and balls cannot change during a run.");
  ASPIC_TRY(Inputs inputs, inputs_for(solver->model(), channels));
  ASPIC_CHECK(solver->set_inputs(inputs));
  inputs_ = std::move(inputs);
  scene_ = std::move(scene);
  solver_ = std::move(solver);
  meter_ = std::make_unique<Meter>(model());
  (void)actuators_.add(model(), state, inputs_);
  return {};
}

/// An actuator may have come to follow another signal, so that the model reads other channels.
Result<Inputs> LiveRun::inputs_for(const Model& model, std::span<const double> channels) const {
  if (channels.size() > names_.size())
    return fail(ErrorCode::usage, "{} channels are given, and the scene reads {}.", channels.size(),
                names_.size());
  Inputs inputs;
  for (const std::string& name : input_names(model)) {
    const auto at = static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin());
    inputs.channels.push_back(at < channels.size() ? channels[at] : 0.0);
  }
  return inputs;
}

Status LiveRun::take() {
  ASPIC_TRY(const State state, solver_->state());
  ASPIC_TRY(step_, solver_->read_into(places()));
  hash_ = state_hash_text(state);
  measures_ = meter_->measure(state, inputs_);
  work_ = actuators_.add(model(), state, inputs_);
  changes_.clear();
  RestLengths lengths(model());
  for (const double r : lengths.at(step_, 0.0, inputs_.channels)) {
    const ActuatedClass& of = model().actuation.classes[changes_.size()];
    changes_.push_back(static_cast<float>(r / model().spring_classes[of.spring_class].rest_length - 1.0));
  }
  return {};
}

Status LiveRun::load(std::uint64_t step) {
  const StateView from = places();
  ConstStateView view;
  for (std::size_t n = 0; n < view.size(); ++n) {
    const auto& field = std::get<Strided<float>>(from[n]);
    view[n] = Strided<const float>{field.data, field.count};
  }
  ASPIC_CHECK(solver_->load(view, step));
  ASPIC_TRY(const State state, solver_->state());
  actuators_ = {};
  (void)actuators_.add(model(), state, inputs_);
  return {};
}

StateView LiveRun::places() {
  StateView view;
  float* at = numbers_.data();
  for (std::size_t n = 0; n < view.size(); ++n) {
    const std::size_t count = count_of(model(), state_fields[n].carrier);
    view[n] = Strided<float>{at, count};
    at += StateField::components * count;
  }
  return view;
}

}  // namespace aspic::live
