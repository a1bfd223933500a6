#include "gpu_solver/device_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <utility>
#include <variant>

#include "device/particles.h"
#include "gpu/current.h"
#include "gpu_solver/kernels.h"

namespace aspic {

using gl::Buffer;

Status DeviceSolver::build(const GpuOptions& options) {
  const std::uint64_t held_before = context_.bytes_held();
  ASPIC_CHECK(build_shared(options));
  gl::ProgramBatch batch(context_.programs());
  ASPIC_TRY(KernelOptions kernels, kernel_options(context_, *model_, options, group_size(options), batch));
  if (takes_lattices()) {
    kernels.defines.push_back({"ASPIC_LATTICES", "1"});
    if (lattice_particles(*model_) < model_->particle_count())
      kernels.defines.push_back({"ASPIC_LISTED", "1"});
  }
  arithmetic_ = kernels.arithmetic;
  ASPIC_CHECK(build_passes(kernels, options));
  ASPIC_CHECK(batch.finish());
  bytes_ = context_.bytes_held() - held_before;
  if (springs_.use_count() > 1) bytes_ += springs_->bytes();  // held before, by the solver it shares with
  const State start = initial_state(*model_, Precision::single);
  take(view_of(start), start.step);
  return context_.check(ErrorCode::scene_rejected);
}

Status DeviceSolver::build_shared(const GpuOptions& options) {
  ASPIC_TRY(const layout::Simulation block, simulation_block(*model_));
  const std::uint64_t state_bytes = std::uint64_t{model_->particle_count()} * sizeof(layout::Particle);
  for (Buffer& state : states_) {
    ASPIC_TRY(state, Buffer::create(context_, "particle state", state_bytes));
  }
  ASPIC_TRY(simulation_,
            Buffer::of(context_, "simulation constants", std::span(&block, 1), gl::BufferKind::uniform));
  ASPIC_CHECK(pulls_.build(context_));
  ASPIC_CHECK(poses_.build(context_, *model_));
  ASPIC_CHECK(contact_.build(context_, *model_));
  const IncidentWords words = incident_words(*model_, path_);
  if (const GpuSolver* other = options.share_springs_of) {
    const auto& theirs = other->spring_buffers();
    if (theirs->context == &context_ && theirs->kind == words && same_springs(other->model(), *model_))
      springs_ = theirs;
  }
  if (!springs_) {
    ASPIC_TRY(springs_, make_spring_buffers(context_, *model_, words));
  }
  ASPIC_CHECK(lengths_.build(context_, *model_, *springs_));
  return {};
}

std::string DeviceSolver::description() const {
  return fmt::format("gpu, {}, force path {}, single precision{}", context_.info().renderer, path_.name,
                     fast_ ? ", fast arithmetic" : "");
}

DeviceState DeviceSolver::device_state() const {
  return {&states_[current_],        &balls_.buffer(), ball_slot_ * model_->ball_count(),
          base_step_ + steps_since_, springs_.get(),   inputs().channels};
}

void DeviceSolver::take(const ConstStateView& state, std::uint64_t step) {
  const std::vector<layout::Particle> particles = packed_particles(*model_, state);
  // Where the steps before ended early, no pass has handed these buffers to an upload.
  gl::barrier(gl::ReadBy::copy);
  states_[0].upload_items(particles);
  balls_.load(state, step);
  contact_.forget();
  current_ = 0;
  ball_slot_ = 0;
  base_step_ = step;
  poses_.set_base_step(base_step_);
  lengths_.set_base_step(base_step_);
  steps_since_ = 0;
  divergence_.reset();
  held_ = {};
  pins_held_ = false;
  moving_pins_.clear();
  const auto moves = [](const layout::vec4& v) { return v.x != 0.0f || v.y != 0.0f || v.z != 0.0f; };
  for (std::uint32_t i = 0; i < particles.size(); ++i)
    if (particles[i].position.w == 0.0f && moves(particles[i].velocity)) moving_pins_.push_back(i);
  restart();
}

Result<Advance> DeviceSolver::advance(std::uint64_t steps) {
  const gl::Current here(context_);
  ASPIC_CHECK(here.status());
  const std::uint64_t from = base_step_ + steps_since_;
  if (steps > 0) ASPIC_CHECK(hold_pins());
  ASPIC_CHECK(take_steps(steps));
  // A divergence in steps queued earlier takes the solver back.
  const std::uint64_t to = base_step_ + steps_since_;
  return Advance{to - std::min(from, to), divergence_};
}

Status DeviceSolver::take_state(const ConstStateView& view, std::uint64_t step) {
  const gl::Current here(context_);
  ASPIC_CHECK(here.status());
  take(view, step);
  return context_.check();
}

Status DeviceSolver::take_inputs(const Inputs& taken) {
  const gl::Current here(context_);
  ASPIC_CHECK(here.status());
  const bool lengths = lengths_.any() && taken.channels != inputs().channels;
  // Steps that found no room, or take more rounds than were queued, are repeated with the inputs they had.
  if ((lengths || taken.pulls != inputs().pulls) && repeats_steps()) ASPIC_CHECK(settle());
  if (taken.pulls != inputs().pulls) pulls_.set(*model_, taken.pulls);
  if (lengths) lengths_.set_channels(taken.channels);
  pins_held_ = pins_held_ && taken.same_pins(inputs());
  return {};
}

Status DeviceSolver::take_constants(SharedModel next, std::uint64_t step) {
  const gl::Current here(context_);
  ASPIC_CHECK(here.status());
  ASPIC_TRY(const layout::Simulation block, simulation_block(*next));
  ASPIC_CHECK(settle());
  const auto alike = [](const Ball& a, const Ball& b) {
    return a.radius == b.radius && a.mass == b.mass && a.launch_step == b.launch_step;
  };
  // A state holds masses and the balls' constants too.
  const bool same_state = !divergence_ && step == base_step_ + steps_since_ && model_->mass == next->mass &&
                          model_->inverse_mass == next->inverse_mass &&
                          std::ranges::equal(model_->balls, next->balls, alike);
  std::optional<State> state;
  if (!same_state) {
    state.emplace();
    state->step = step;
    resize(*state, model_->particle_count(), model_->ball_count());
    read(view_of(*state));
  }
  model_ = std::move(next);
  simulation_.upload_items(std::span(&block, 1));
  poses_.set_model(*model_);
  lengths_.set_model(*model_);
  balls_.set_model(*model_);
  contact_.set_model(*model_);
  if (state) take(view_of(std::as_const(*state)), state->step);
  return context_.check();
}

/// Gives particles the weights of the inputs' pins; pinned particles stand. The next step begins with it.
Status DeviceSolver::hold_pins() {
  if (std::exchange(pins_held_, true)) return {};
  if (moving_pins_.empty() && held_.pinned == inputs().pinned && held_.released == inputs().released)
    return {};
  // So that the state is that of the last step asked for.
  ASPIC_CHECK(settle());
  if (divergence_) return {};
  // Inverse mass and velocity lie side by side.
  constexpr std::uint64_t floats = sizeof(layout::Particle) / sizeof(float), weight_at = 3;
  static_assert(offsetof(layout::Particle, velocity) == (weight_at + 1) * sizeof(float));
  const auto hold = [&](const std::vector<std::uint32_t>& particles) {
    for (const std::uint32_t i : particles) {
      const auto w = static_cast<float>(inverse_mass_of(*model_, inputs(), i));
      const std::array<float, 4> held = {w, 0.0f, 0.0f, 0.0f};
      states_[current_].upload_items(std::span(held).first(w == 0.0f ? 4 : 1), i * floats + weight_at);
    }
  };
  hold(moving_pins_);
  for (const Inputs* const of : {&std::as_const(held_), &inputs()}) {
    hold(of->pinned);
    hold(of->released);
  }
  moving_pins_.clear();
  held_.pinned = inputs().pinned;
  held_.released = inputs().released;
  return {};
}

Result<std::uint64_t> DeviceSolver::give_state(const StateView& view) {
  const gl::Current here(context_);
  ASPIC_CHECK(here.status());
  ASPIC_CHECK(settle());
  read(view);
  ASPIC_CHECK(context_.check());
  return base_step_ + steps_since_;
}

/// Fields of the last good step, which settle() has seen.
void DeviceSolver::read(const StateView& view) const {
  const auto wanted = [&](std::size_t field) { return !std::holds_alternative<std::monostate>(view[field]); };
  if (wanted(0) || wanted(1)) {
    constexpr std::size_t each = sizeof(layout::Particle);
    states_[current_].read_parts(
        model_->particle_count() * each, [&](std::span<const std::byte> part, std::uint64_t offset) {
          unpack({reinterpret_cast<const layout::Particle*>(part.data()), part.size() / each}, view,
                 offset / each);
        });
  }
  if (wanted(2) || wanted(3) || wanted(4)) balls_.read(view, ball_slot_);
}

Result<gl::Pass> DeviceSolver::pass(const KernelOptions& kernels, std::string_view path,
                                    std::vector<gl::Binding> bindings) {
  ASPIC_TRY(auto program, kernels.start(path));
  programs_.push_back(std::move(program));
  return gl::Pass(*programs_.back(), std::move(bindings), gl::ReadBy::compute_pass);
}

Result<ItemPass> DeviceSolver::item_pass(const KernelOptions& kernels, std::string_view path,
                                         std::vector<gl::Binding> bindings, std::uint32_t items) {
  ASPIC_TRY(auto made, pass(kernels, path, std::move(bindings)));
  return ItemPass{std::move(made), items};
}

void ItemPass::dispatch(std::span<const gl::Binding> buffers, gl::ReadBy readers) const {
  std::array<gl::Binding, 8> bound;
  assert(buffers.size() <= bound.size());
  std::size_t count = 0;
  for (const gl::Binding& each : buffers)
    if (each.buffer && each.buffer->bytes() > 0) bound[count++] = each;
  pass.dispatch_for(items, std::span<const gl::Binding>(bound).first(count), readers);
}

void DeviceSolver::keep_counting() {
  if (!counts_far()) return;
  base_step_ += steps_since_;
  steps_since_ = 0;
  balls_.set_base_step(base_step_);
  poses_.set_base_step(base_step_);
  lengths_.set_base_step(base_step_);
}

Divergence DeviceSolver::divergence_from(std::uint32_t word, std::uint64_t steps) const {
  const std::uint64_t step = base_step_ + steps + 1;
  if (word == BAD_RESIDUAL) return {step, 0, false, false, true};
  const std::uint32_t index = word >> 1, particles = model_->particle_count();
  const bool ball = index >= particles;
  return {step, ball ? index - particles : index, (word & 1u) != 0, ball};
}

void DeviceSolver::set_profiling(bool on) {
  const gl::Current here(context_);
  if (on == (profiler_ != nullptr) || !here.status()) return;
  balls_.set_profiler(nullptr, 0);
  profiler_.reset();
  if (!on) return;
  std::vector<std::string> names = pass_names_;
  for (std::string& name : BallPasses::pass_names()) names.push_back(std::move(name));
  profiler_ = std::make_unique<gl::PassProfiler>(context_, std::move(names));
  balls_.set_profiler(profiler_.get(), pass_names_.size());
}

std::vector<gl::PassTime> DeviceSolver::pass_times() {
  const gl::Current here(context_);
  return profiler_ && here.status() ? profiler_->times() : std::vector<gl::PassTime>();
}

}  // namespace aspic
