#include "batch.h"

#include <utility>

namespace aspic::python {
namespace {

void set_constants(Contents& contents, std::size_t instance, Scene scene) {
  check(contents.batch.set_constants(instance, take(make_model(scene.model))));
  contents.meters.erase(instance);
  contents.scenes[instance] = std::make_shared<const Scene>(std::move(scene));
}

void set_inputs(Contents& contents, std::size_t instance, const Inputs& inputs) {
  check(contents.batch.set_inputs(instance, inputs));
  contents.inputs[instance] = inputs;
}

/// Of a field's vectors.
std::size_t count_of(const Model& model, std::size_t field) {
  if (state_fields[field].carrier == StateCarrier::ball) return ball_facts(model).size();
  std::size_t count = 0;
  for (const ParticleRange& range : particle_ranges(model)) count += range.count;
  return count;
}

Error differ(std::size_t instance, std::size_t first, std::size_t count) {
  return {ErrorCode::usage,
          "arrays of all instances need equal numbers of particles or balls: instance 0 has " +
              std::to_string(first) + ", instance " + std::to_string(instance) + " has " +
              std::to_string(count) + ". Read the instances one by one: batch[i]"};
}

}  // namespace

Batch::Batch(std::vector<Scene> scenes, const std::vector<std::size_t>& which, unsigned threads) {
  const Unlocked others;
  std::vector<std::shared_ptr<const Scene>> shared;
  std::vector<SharedModel> models;
  for (Scene& scene : scenes) {
    models.push_back(take(make_model(scene.model)));
    shared.push_back(std::make_shared<const Scene>(std::move(scene)));
  }
  std::vector<std::shared_ptr<const Scene>> own_scenes;
  std::vector<SharedModel> own_models;
  for (const std::size_t n : which) {
    own_scenes.push_back(shared.at(n));
    own_models.push_back(models.at(n));
  }
  std::vector<Inputs> inputs(which.size());
  contents_ = Contents{take(aspic::Batch::create(std::move(own_models), {threads})), std::move(own_scenes),
                       std::move(inputs)};
  contents_->batch.set_stop_flag(&stop_);
}

void Batch::raise() {
  if (Unlocked::ending()) throw stopped_error();  // as far as the GIL, and no further
  const nb::gil_scoped_acquire own;
  throw nb::python_error();
}

std::size_t Batch::advance(std::uint64_t steps) {
  using Clock = std::chrono::steady_clock;
  const auto act = [&](Contents& contents) {
    const auto begin = Clock::now();
    const std::size_t diverged = take(contents.batch.advance(steps));
    if (stop_)
      throw LibraryError({ErrorCode::interrupted,
                          "stop() interrupted the batch; instances may be at different steps. batch.steps "
                          "has their numbers"});
    // Those that are diverged take no time, and may go on later.
    const bool brief = diverged == 0 && Clock::now() - begin < std::chrono::milliseconds(25);
    brief_ = brief ? steps : 0;
    return diverged;
  };
  return alone([&](Contents& contents) {
    stop_ = false;
    return steps <= brief_ ? act(contents) : watched(stop_, contents, act);
  });
}

BatchRecord Batch::run(double duration, double interval, const BatchQuantities& quantities) {
  return alone([&](Contents& contents) {
    stop_ = false;
    return watched(stop_, contents,
                   [&](Contents& c) { return take(c.batch.run(duration, interval, quantities)); });
  });
}

Gathered Batch::gather(std::size_t field) {
  return alone([&](Contents& contents) {
    Gathered all = {contents.batch.size(), 0, {}};
    for (std::size_t i = 0; i < all.instances; ++i) {
      const std::size_t count = count_of(*take(contents.batch.model(i)), field);
      if (i == 0) {
        all.vectors = count;
        all.numbers.resize(3 * count * all.instances);
      }
      if (count != all.vectors) throw LibraryError(differ(i, all.vectors, count));
      StateView view;
      view[field] = Strided<float>{all.numbers.data() + 3 * count * i, count};
      (void)take(contents.batch.read_into(i, view));
    }
    return all;
  });
}

Scene Instance::scene() {
  return batch_.alone([&](Contents& contents) { return *contents.scenes[number_]; });
}

SharedModel Instance::model() {
  return batch_.alone([&](Contents& contents) { return take(contents.batch.model(number_)); });
}

std::uint64_t Instance::step() {
  return read_into({});
}

State Instance::state() {
  return batch_.alone([&](Contents& contents) { return take(contents.batch.state(number_)); });
}

Measures Instance::measures() {
  return batch_.alone([&](Contents& contents) {
    Meter& meter = contents.meters.try_emplace(number_, *take(contents.batch.model(number_))).first->second;
    return meter.measure(take(contents.batch.state(number_)), contents.inputs[number_]);
  });
}

Measures Instance::motion() {
  return batch_.alone([&](Contents& contents) {
    return measure_motion(*take(contents.batch.model(number_)), take(contents.batch.state(number_)));
  });
}

std::optional<double> Instance::add_work(ActuatorWork& work) {
  return batch_.alone([&](Contents& contents) {
    return work.add(*take(contents.batch.model(number_)), take(contents.batch.state(number_)),
                    contents.inputs[number_]);
  });
}

StateQuantities Instance::quantities() {
  return batch_.alone([&](Contents& contents) {
    return quantities_of(*take(contents.batch.model(number_)), take(contents.batch.state(number_)),
                         contents.inputs[number_]);
  });
}

std::uint64_t Instance::read_into(const StateView& view) {
  return batch_.alone([&](Contents& contents) { return take(contents.batch.read_into(number_, view)); });
}

std::optional<Divergence> Instance::divergence() {
  return batch_.alone([&](Contents& contents) { return take(contents.batch.divergence(number_)); });
}

void Instance::load(const State& state, const InputLog* log) {
  batch_.alone([&](Contents& contents) {
    check(contents.batch.load(number_, state));
    if (log != nullptr) python::set_inputs(contents, number_, log->at(state.step));
  });
}

void Instance::update(const std::vector<std::string>& overrides) {
  batch_.alone([&](Contents& contents) {
    const Scene& before = *contents.scenes[number_];
    Scene changed = take(with_overrides(before, overrides));
    const auto step = static_cast<double>(take(contents.batch.read_into(number_, {})));
    changed.model = with_continuous_phases(std::move(changed.model), before.model,
                                           step * before.model.simulation.timestep);
    set_constants(contents, number_, std::move(changed));
  });
}

void Instance::set_scene(const Scene& scene) {
  batch_.alone([&](Contents& contents) { set_constants(contents, number_, scene); });
}

Inputs Instance::inputs() {
  return batch_.alone([&](Contents& contents) { return contents.inputs[number_]; });
}

void Instance::set_inputs(const Inputs& inputs) {
  batch_.alone([&](Contents& contents) { python::set_inputs(contents, number_, inputs); });
}

InputLog Instance::log() {
  return batch_.alone([&](Contents& contents) {
    InputLog log;
    if (!contents.inputs[number_].empty())
      log.set(take(contents.batch.read_into(number_, {})), contents.inputs[number_]);
    return log;
  });
}

}  // namespace aspic::python
