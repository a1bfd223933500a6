#include "playback/recorded_inputs.h"

#include <algorithm>
#include <string>
#include <utility>

#include "aspic/scene.h"
#include "base/result.h"
#include "model/model.h"

namespace aspic {
namespace {

/// Pins of hands, in addition to or against those of the scene.
Result<Inputs> pins_of(const Setup& setup) {
  Inputs inputs;
  if (setup.pinned.empty()) return inputs;
  ASPIC_TRY(const Model scene, build_model(setup.settings));
  for (const auto& [particle, pinned] : setup.pinned) {
    if (particle >= scene.particle_count() || pinned == (scene.inverse_mass[particle] == 0.0)) continue;
    (pinned ? inputs.pinned : inputs.released).push_back(particle);
  }
  return inputs;
}

std::string physics_of(const Setup& setup) {
  Scene scene;
  scene.model = setup.settings;
  return to_toml(scene);
}

/// Inputs of a step, with the pins of hands, for the scene alone.
Inputs with_pins(const Inputs& pins, Inputs inputs) {
  const auto has = [](const std::vector<std::uint32_t>& list, std::uint32_t i) {
    return std::ranges::find(list, i) != list.end();
  };
  for (const std::uint32_t i : pins.pinned) {
    // Released from the hand's pin it is as in the scene.
    if (std::erase(inputs.released, i) == 0 && !has(inputs.pinned, i)) inputs.pinned.push_back(i);
  }
  for (const std::uint32_t i : pins.released)
    if (std::erase(inputs.pinned, i) == 0) inputs.released.push_back(i);
  std::ranges::sort(inputs.pinned);
  std::ranges::sort(inputs.released);
  return inputs;
}

}  // namespace

Result<InputLog> recorded_inputs(const History& history, const Moment& until) {
  const Moment begin = history.begin_moment();
  if (begin.step > 0) {
    return fail(ErrorCode::usage, "The history begins at step {}, not at the start of the run.", begin.step);
  }
  const std::string physics = physics_of(history.stretch(until.stretch).setup);
  InputLog log;
  for (std::uint64_t number = begin.stretch; number <= until.stretch; ++number) {
    const Stretch& stretch = history.stretch(number);
    if (!stretch.setup.thrown.empty())
      return fail(ErrorCode::usage, "Balls were thrown: a replay has pulls and pins only.");
    if (physics_of(stretch.setup) != physics)
      return fail(ErrorCode::usage, "The scene was changed during the run: a replay needs one scene.");
    ASPIC_TRY(const Inputs pins, pins_of(stretch.setup));
    const std::uint64_t last = number == until.stretch ? until.step : stretch.last;
    for (std::optional<std::uint64_t> step = stretch.first; step && *step <= last;
         step = history.next_input_change({number, *step}))
      log.set(*step, with_pins(pins, history.inputs_at({number, *step})));
  }
  return log;
}

Result<InputLog> inputs_to_go_on(const History& history, const Moment& now, const InputLog& later) {
  const Setup& setup = history.stretch(now.stretch).setup;
  if (!setup.thrown.empty()) return fail(ErrorCode::usage, "Balls were thrown.");
  ASPIC_TRY(const Inputs pins, pins_of(setup));
  InputLog log;
  if (auto all = recorded_inputs(history, now))
    log = std::move(*all);
  else
    log.set(now.step, with_pins(pins, history.inputs_at(now)));
  // What begins with this very step is not history yet.
  const bool begins = now.step == 0 ? !later.at(0).empty() : later.next_change(now.step - 1) == now.step;
  std::optional<std::uint64_t> step = begins ? std::optional(now.step) : later.next_change(now.step);
  for (; step; step = later.next_change(*step)) {
    Inputs inputs = later.at(*step);
    for (auto* const particles : {&inputs.pinned, &inputs.released})
      std::erase_if(*particles, [&](std::uint32_t i) { return setup.pinned.contains(i); });
    log.set(*step, with_pins(pins, std::move(inputs)));
  }
  return log;
}

}  // namespace aspic
