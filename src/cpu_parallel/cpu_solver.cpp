#include "cpu_parallel/cpu_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

#include "cpu_parallel/contact_pieces.h"
#include "cpu_parallel/kernels.h"
#include "cpu_parallel/steps.h"
#include "cpu_reference/balls.h"
#include "cpu_reference/divergence.h"
#include "model/counts.h"
#include "model/pull.h"
#include "model/springs.h"

namespace aspic {
namespace parallel {
namespace {

/// Springs that pay for another thread: a stage of about 7 µs.
constexpr std::size_t springs_per_thread = 8192;

/// A number of every particle.
void fill(FloatArray& to, const Runs<double>& from) {
  std::size_t first = 0;
  for (const auto& [end, value] : from.runs()) {
    std::fill(to.data() + first, to.data() + end, static_cast<float>(value));
    first = end;
  }
}

class CpuSolver final : public Solver {
 public:
  CpuSolver(SharedModel model, unsigned threads, Arithmetic arithmetic)
      : model_(std::move(model)),
        reports_solves_(row_of(model_->simulation.integrator).traits.reports_solves),
        dynamics_(*model_),
        balls_(*model_),
        workers_(threads) {
    std::size_t margin = slice;
    for (const Body& body : model_->bodies) {
      if (body.lattice_edge > 0) {
        springs_.emplace_back(std::in_place_type<Lattice>, *model_, body);
        margin = std::max(margin, std::get<Lattice>(springs_.back()).reach() + slice);
      } else {
        springs_.emplace_back(std::in_place_type<SpringLists>, *model_, body);
      }
    }
    const std::size_t count = model_->particle_count();
    state_ = Particles(count, margin);
    next_ = Particles(count, margin);
    mass_ = FloatArray(count, slice);
    inverse_mass_ = FloatArray(count, slice);
    fill(mass_, model_->mass);
    fill(inverse_mass_, model_->inverse_mass);
    steps_ = make_steps({model_, dynamics_, springs_, mass_, inverse_mass_, margin, arithmetic, workers_});
    bytes_ = sizeof(*this) + heap_bytes();
    set(initial_state(*model_, Precision::single));
  }

  std::string_view backend() const override { return "cpu"; }
  std::string description() const override {
    return fmt::format("cpu, {} thread{}, {}, single precision{}", workers_.threads(),
                       workers_.threads() == 1 ? "" : "s", instruction_set(),
                       steps_->arithmetic() == Arithmetic::fast ? ", fast arithmetic" : "");
  }
  Precision precision() const override { return Precision::single; }
  const Model& model() const override { return *model_; }
  std::uint64_t bytes() const override { return bytes_; }

  Status load(const State& state) override {
    ASPIC_CHECK(check_sizes(*model_, state));
    set(state);
    return {};
  }

  void set_stop_flag(const std::atomic<bool>* flag) override {
    Solver::set_stop_flag(flag);
    dynamics_.set_stop_flag(flag);
  }

  Result<std::optional<Divergence>> advance(std::uint64_t steps) override {
    for (std::uint64_t n = 0; n < steps && !divergence_ && !interrupted(); ++n) step();
    return divergence_;
  }

  std::optional<SolveStatistics> solve_statistics() override {
    if (!reports_solves_) return std::nullopt;
    return statistics_;
  }

  Result<State> state() override;

 private:
  Status take_inputs(const Inputs& inputs) override;
  Status take_constants(SharedModel model) override;
  std::vector<reference::Vector<float>> hold_pins();
  std::uint64_t heap_bytes() const;
  void set(const State& state);
  void step();
  void move_balls();

  SharedModel model_;
  const bool reports_solves_;
  reference::Dynamics<float> dynamics_;
  reference::Balls<float> balls_;
  Workers workers_;
  std::vector<Springs> springs_;  // by body
  std::unique_ptr<Steps> steps_;
  SolveStatistics statistics_;
  FloatArray mass_, inverse_mass_;
  Particles state_, next_;
  reference::BallPhase<float> ball_phase_, next_balls_;
  bool pins_held_ = false;  // as inputs() say
  std::uint64_t step_ = 0;
  std::uint64_t bytes_;  ///< without contacts, which come and go
  std::optional<Divergence> divergence_;
};

std::uint64_t CpuSolver::heap_bytes() const {
  std::uint64_t sum = bytes_of(state_) + bytes_of(next_) + bytes_of(mass_) + bytes_of(inverse_mass_) +
                      bytes_of(springs_) + dynamics_.bytes() + balls_.bytes() +
                      std::uint64_t{model_->ball_count()} * 18 * sizeof(float);
  for (const Springs& springs : springs_)
    sum += std::visit([](const auto& each) { return each.bytes(); }, springs);
  return sum + steps_->bytes();
}

void CpuSolver::set(const State& state) {
  const auto take = [](const std::vector<Vec3>& from, VectorArray& to) {
    for (std::size_t i = 0; i < from.size(); ++i) parallel::set(to, i, reference::rounded<float>(from[i]));
  };
  take(state.position, state_.x);
  take(state.velocity, state_.v);
  ball_phase_ = {reference::field<float>(state.ball_position), reference::field<float>(state.ball_velocity),
                 reference::field<float>(state.ball_angular_velocity)};
  pins_held_ = false;
  step_ = state.step;
  divergence_.reset();
  statistics_ = {};
  steps_->forget();
}

Result<State> CpuSolver::state() {
  State state;
  state.precision = Precision::single;
  state.step = step_;
  const auto copy = [&](const VectorArray& from, std::vector<Vec3>& to) {
    to.reserve(model_->particle_count());
    for (std::size_t i = 0; i < model_->particle_count(); ++i)
      to.push_back({from[0][i], from[1][i], from[2][i]});
  };
  copy(state_.x, state.position);
  copy(state_.v, state.velocity);
  state.ball_position = reference::columns(ball_phase_.x);
  state.ball_velocity = reference::columns(ball_phase_.v);
  state.ball_angular_velocity = reference::columns(ball_phase_.omega);
  return state;
}

Status CpuSolver::take_inputs(const Inputs& taken) {
  if (taken.moves_pins() || inputs().moves_pins()) fill(inverse_mass_, inverse_mass_under(*model_, taken));
  dynamics_.set_inputs(taken);
  balls_.set_inputs(taken);
  pins_held_ = false;
  return {};
}

Status CpuSolver::take_constants(SharedModel model) {
  // Others refer to these, which stay in their places.
  model_ = std::move(model);
  dynamics_ = reference::Dynamics<float>(*model_);
  dynamics_.set_stop_flag(stop_flag());
  dynamics_.set_inputs(inputs());
  balls_ = reference::Balls<float>(*model_);
  balls_.set_inputs(inputs());
  for (Springs& springs : springs_) std::visit([&](auto& each) { each.set_constants(*model_); }, springs);
  fill(mass_, model_->mass);
  fill(inverse_mass_, inverse_mass_under(*model_, inputs()));
  steps_->constants_changed();
  pins_held_ = false;
  divergence_.reset();
  return {};
}

/// Particles that inputs pin stop where a step begins. Returns their velocities before; none if none changes.
std::vector<reference::Vector<float>> CpuSolver::hold_pins() {
  std::vector<reference::Vector<float>> before;
  if (std::exchange(pins_held_, true)) return before;
  for (const std::uint32_t i : inputs().pinned) {
    before.push_back(vector_of(state_.v, i));
    parallel::set(state_.v, i, reference::Vector<float>::Zero());
  }
  return before;
}

void CpuSolver::step() {
  const auto before = hold_pins();
  dynamics_.begin_step(step_);
  SolveReport report;
  bool sound = steps_->step(state_, next_, report);
  if (interrupted()) {  // the step is dropped
    steps_->forget();
    for (std::size_t n = 0; n < before.size(); ++n) parallel::set(state_.v, inputs().pinned[n], before[n]);
    pins_held_ = before.empty();
    return;
  }
  if (model_->ball_count() > 0) {
    move_balls();
    sound = steps_->look_at(next_);
    divergence_ = reference::find_divergence(*model_, next_balls_, step_ + 1);
  }
  if (!sound) {
    divergence_ = reference::find_divergence<float>(
        *model_, [&](Eigen::Index i) { return vector_of(next_.x, static_cast<std::size_t>(i)); },
        [&](Eigen::Index i) { return vector_of(next_.v, static_cast<std::size_t>(i)); }, next_balls_,
        step_ + 1);
  }
  if (!divergence_ && !std::isfinite(report.residual))
    divergence_ = Divergence{step_ + 1, 0, false, false, true};
  if (divergence_) return;
  if (reports_solves_) statistics_.add(report);
  std::swap(state_, next_);
  if (model_->ball_count() > 0) std::swap(ball_phase_, next_balls_);
  ++step_;
}

/// Balls fly and meet particles, as in the reference.
void CpuSolver::move_balls() {
  const auto view = [](auto& particles) {
    const auto of = [](auto& a) { return std::array{a[0].data(), a[1].data(), a[2].data()}; };
    return std::pair(of(particles.x), of(particles.v));
  };
  const auto [x_0, v_0] = view(std::as_const(state_));
  const auto [x, v] = view(next_);
  next_balls_ = balls_.step(step_, ball_phase_, {x_0, v_0, 1}, {x, v, 1});
}

}  // namespace
}  // namespace parallel

Result<std::unique_ptr<Solver>> make_cpu_solver(SharedModel model, const CpuOptions& options) {
  ASPIC_TRY(const unsigned available, parallel::available_threads());
  try {
    const std::size_t worth = spring_count(*model) / parallel::springs_per_thread;
    const unsigned threads = options.threads > 0
                                 ? options.threads
                                 : static_cast<unsigned>(std::clamp<std::size_t>(worth, 1, available));
    return std::unique_ptr<Solver>(std::make_unique<parallel::CpuSolver>(model, threads, options.arithmetic));
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::scene_rejected,
                "no memory left for the cpu solver of {} particles: use fewer particles-per-edge",
                model->particle_count());
  }
}

}  // namespace aspic
