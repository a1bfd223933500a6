#include "aspic/batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

#include "base/result.h"
#include "batch/plan.h"
#include "batch/record.h"
#include "batch/unit.h"
#include "cpu_parallel/kernels.h"
#include "model/counts.h"

namespace aspic {
namespace {

constexpr unsigned most_threads = 1024;

}  // namespace

/// Units, and where each instance is among them.
struct Batch::Parts {
  std::vector<std::unique_ptr<batch::Unit>> units;
  std::vector<batch::Place> places;
  std::unique_ptr<parallel::Workers> pool;
  std::uint64_t shared_bytes = 0;
  const std::atomic<bool>* flag = nullptr;

  batch::Unit& unit(std::size_t instance) { return *units[places[instance].unit]; }
  std::size_t slot(std::size_t instance) const { return places[instance].slot; }
  Status check(std::size_t instance) const;
  bool stopped() const { return flag && flag->load(std::memory_order_relaxed); }
  Status move_out(std::size_t instance, SharedModel model);
  Status load(std::size_t instance, const State& state) {
    return unit(instance).load(slot(instance), view_of(state), state.step);
  }
};

Status Batch::Parts::check(std::size_t instance) const {
  if (instance < places.size()) return {};
  return fail(ErrorCode::usage, "instance {} does not exist: the batch has {}, numbered from 0", instance,
              places.size());
}

/// To a unit that has it alone, with another model.
Status Batch::Parts::move_out(std::size_t instance, SharedModel model) {
  batch::Unit& from = unit(instance);
  const std::size_t slot = places[instance].slot;
  const std::uint64_t step =
      step_at_same_time(from.step(slot), from.model(slot)->simulation.timestep, model->simulation.timestep);
  ASPIC_TRY(auto alone, batch::make_lone(std::move(model)));
  ASPIC_CHECK(alone->load(0, from.view(slot), step));
  ASPIC_CHECK(alone->set_inputs(0, from.inputs(slot)));
  alone->set_stop_flag(flag);
  from.retire(slot);
  places[instance] = {units.size(), 0};
  units.push_back(std::move(alone));
  return {};
}

Batch::Batch(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;
Batch::~Batch() = default;

Result<Batch> Batch::create(std::vector<SharedModel> models, const BatchOptions& options) {
  if (models.empty()) return fail(ErrorCode::usage, "a batch has at least one model");
  const auto null = std::ranges::find(models, nullptr);
  if (null != models.end())
    return fail(ErrorCode::usage, "the model of instance {} is null", null - models.begin());
  if (options.threads > most_threads)
    return fail(ErrorCode::usage, "a batch uses 1 to {} threads, not {}", most_threads, options.threads);
  ASPIC_TRY(const unsigned available, parallel::available_threads());
  const unsigned threads = options.threads > 0 ? options.threads : available;
  try {
    auto parts = std::make_unique<Parts>();
    parts->pool = std::make_unique<parallel::Workers>(threads);
    ASPIC_TRY(batch::Plan plan, batch::make_units(models, threads));
    parts->units = std::move(plan.units);
    parts->places = std::move(plan.places);
    parts->shared_bytes = plan.shared_bytes;
    return Batch(std::move(parts));
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::scene_rejected, "not enough memory for a batch of {} instances: use fewer",
                models.size());
  }
}

std::size_t Batch::size() const {
  return parts_->places.size();
}

std::string Batch::description() const {
  std::size_t stacks = 0, stacked = 0;
  std::vector<std::size_t> lodgers(parts_->units.size(), 0);
  for (const batch::Place& place : parts_->places) ++lodgers[place.unit];
  for (std::size_t n = 0; n < lodgers.size(); ++n) {
    if (parts_->units[n]->size() == 1 || lodgers[n] == 0) continue;
    ++stacks;
    stacked += lodgers[n];
  }
  const unsigned threads = parts_->pool->threads();
  return fmt::format("{} instance{}, {} of them in {} stack{}, cpu, {} thread{}, {}, single precision",
                     size(), size() == 1 ? "" : "s", stacked, stacks, stacks == 1 ? "" : "s", threads,
                     threads == 1 ? "" : "s", parallel::instruction_set());
}

std::uint64_t Batch::bytes() const {
  std::uint64_t sum =
      sizeof(*parts_) + parts_->shared_bytes + parts_->places.capacity() * sizeof(batch::Place);
  for (const auto& unit : parts_->units) sum += unit->bytes();
  return sum;
}

Result<std::size_t> Batch::advance(std::uint64_t steps) {
  ASPIC_CHECK(batch::for_each_unit(*parts_->pool, parts_->units,
                                   [&](std::size_t n) { return parts_->units[n]->advance(steps); }));
  std::size_t diverged = 0;
  for (std::size_t i = 0; i < size(); ++i)
    diverged += parts_->unit(i).divergence(parts_->slot(i)).has_value() ? 1 : 0;
  return diverged;
}

Result<BatchRecord> Batch::run(double duration, double interval, const BatchQuantities& quantities) {
  std::vector<SharedModel> models;
  for (std::size_t i = 0; i < size(); ++i) models.push_back(*model(i));
  ASPIC_TRY(batch::Recording recording, batch::Recording::plan(models, duration, interval, quantities));
  std::vector<std::vector<std::size_t>> instances(parts_->units.size());
  for (std::size_t i = 0; i < size(); ++i) {
    std::vector<std::size_t>& of_unit = instances[parts_->places[i].unit];
    if (of_unit.size() <= parts_->slot(i)) of_unit.resize(parts_->slot(i) + 1, batch::nobody);
    of_unit[parts_->slot(i)] = i;
  }
  ASPIC_CHECK(batch::for_each_unit(*parts_->pool, parts_->units, [&](std::size_t n) {
    return recording.take(*parts_->units[n], instances[n], parts_->flag);
  }));
  if (parts_->stopped())
    return fail(ErrorCode::interrupted,
                "the recorded run of the batch was stopped: every instance is at the end of a step");
  return std::move(recording).record();
}

Status Batch::reset(std::span<const std::uint8_t> mask) {
  if (!mask.empty() && mask.size() != size())
    return fail(ErrorCode::usage, "the mask has {} numbers, and the batch {} instances", mask.size(), size());
  for (std::size_t i = 0; i < size(); ++i) {
    if (!mask.empty() && mask[i] == 0) continue;
    ASPIC_CHECK(parts_->load(i, initial_state(**model(i), Precision::single)));
  }
  return {};
}

void Batch::set_stop_flag(const std::atomic<bool>* flag) {
  parts_->flag = flag;
  for (const auto& unit : parts_->units) unit->set_stop_flag(flag);
}

Result<SharedModel> Batch::model(std::size_t instance) const {
  ASPIC_CHECK(parts_->check(instance));
  return parts_->unit(instance).model(parts_->slot(instance));
}

Result<std::optional<Divergence>> Batch::divergence(std::size_t instance) const {
  ASPIC_CHECK(parts_->check(instance));
  return parts_->unit(instance).divergence(parts_->slot(instance));
}

Result<State> Batch::state(std::size_t instance) const {
  ASPIC_TRY(const SharedModel of, model(instance));
  State state;
  state.precision = Precision::single;
  resize(state, of->particle_count(), of->ball_count());
  ASPIC_TRY(state.step, read_into(instance, view_of(state)));
  return state;
}

Result<std::uint64_t> Batch::read_into(std::size_t instance, const StateView& view) const {
  ASPIC_TRY(const SharedModel of, model(instance));
  ASPIC_CHECK(check_sizes(*of, view));
  const batch::Unit& unit = parts_->unit(instance);
  const ConstStateView own = unit.view(parts_->slot(instance));
  for (std::size_t n = 0; n < own.size(); ++n) copy_vectors(own[n], view[n]);
  return unit.step(parts_->slot(instance));
}

Status Batch::load(std::size_t instance, const State& state) {
  ASPIC_TRY(const SharedModel of, model(instance));
  ASPIC_CHECK(check_sizes(*of, state));
  return parts_->load(instance, state);
}

Status Batch::load(std::size_t instance, const ConstStateView& view, std::uint64_t step) {
  ASPIC_CHECK(parts_->check(instance));
  return parts_->unit(instance).load(parts_->slot(instance), view, step);
}

Status Batch::set_inputs(std::size_t instance, const Inputs& inputs) {
  ASPIC_CHECK(parts_->check(instance));
  return parts_->unit(instance).set_inputs(parts_->slot(instance), inputs);
}

Status Batch::set_constants(std::size_t instance, SharedModel model) {
  ASPIC_CHECK(parts_->check(instance));
  if (!model) return fail(ErrorCode::usage, "the model for instance {} is null", instance);
  ASPIC_TRY(const bool taken, parts_->unit(instance).set_constants(parts_->slot(instance), model));
  if (taken) return {};
  try {
    return parts_->move_out(instance, std::move(model));
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::scene_rejected, "not enough memory for a solver of instance {}", instance);
  }
}

}  // namespace aspic
