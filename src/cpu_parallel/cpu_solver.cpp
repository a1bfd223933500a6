#include "cpu_parallel/cpu_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <new>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/flush_denormals.h"
#include "collision/ball_search.h"
#include "cpu_parallel/contact_pieces.h"
#include "cpu_parallel/kernels.h"
#include "cpu_parallel/steps.h"
#include "cpu_reference/integrators.h"
#include "model/counts.h"
#include "model/pull.h"
#include "model/reading.h"
#include "model/springs.h"
#include "physics/balls/balls.h"
#include "physics/divergence.h"

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
  CpuSolver(SharedModel model, std::shared_ptr<Workers> workers)
      : model_(std::move(model)),
        reports_solves_(row_of(model_->simulation.integrator).traits.reports_solves),
        dynamics_(*model_),
        balls_(*model_),
        workers_(std::move(workers)) {
    std::size_t margin = slice;
    const bool staged = row_of(model_->simulation.integrator).staged();
    for (const Body& body : model_->bodies) {
      if (body.box()) {
        springs_.emplace_back(std::in_place_type<LatticeStencil>, *model_, body);
        margin = std::max(margin, std::get<LatticeStencil>(springs_.back()).reach() + slice);
      } else if (auto bands = staged && body.lattice ? Bands::of(*model_, body) : std::nullopt) {
        springs_.emplace_back(*std::move(bands));
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
    lengths_.emplace(*model_, springs_);
    steps_ = make_steps({model_, dynamics_, springs_, *lengths_, mass_, inverse_mass_, margin, *workers_});
    bytes_ = sizeof(*this) + heap_bytes();
    const State start = initial_state(*model_, Precision::single);
    (void)CpuSolver::take_state(view_of(start), start.step);
  }

  std::string_view backend() const override { return "cpu"; }
  std::string description() const override {
    return fmt::format("cpu, {} thread{}, {}, single precision", workers_->threads(),
                       workers_->threads() == 1 ? "" : "s", instruction_set());
  }
  Precision precision() const override { return Precision::single; }
  const Model& model() const override { return *model_; }
  std::uint64_t bytes() const override { return bytes_; }

  void set_stop_flag(const std::atomic<bool>* flag) override {
    Solver::set_stop_flag(flag);
    dynamics_.set_stop_flag(flag);
  }

  Result<Advance> advance(std::uint64_t steps) override {
    const FlushDenormals flush;
    const std::uint64_t from = step_;
    while (step_ - from < steps && !divergence_ && !interrupted()) step();
    return ended(step_ - from, steps, divergence_);
  }

  std::optional<SolveStatistics> solve_statistics() override {
    if (!reports_solves_) return std::nullopt;
    return statistics_;
  }

  std::optional<ConstStateView> view() const override;

 private:
  Status take_state(const ConstStateView& view, std::uint64_t step) override;
  Result<std::uint64_t> give_state(const StateView& to) override;
  Status take_inputs(const Inputs& inputs) override;
  Status take_constants(SharedModel model, std::uint64_t step) override;
  std::vector<std::pair<std::size_t, physics::Vector<float>>> hold_pins();
  std::uint64_t heap_bytes() const;
  void step();
  void move_balls();
  template <class Task>
  void share(const Task& task);

  SharedModel model_;
  const bool reports_solves_;
  reference::Dynamics<float> dynamics_;
  physics::Balls<float, collision::BallSearch> balls_;
  std::shared_ptr<Workers> workers_;
  std::vector<Springs> springs_;  // by body
  std::optional<MovingLengths> lengths_;
  std::unique_ptr<Steps> steps_;
  SolveStatistics statistics_;
  FloatArray mass_, inverse_mass_;
  Particles state_, next_;
  physics::BallPhase<float> ball_phase_, next_balls_;
  bool pins_held_ = false;  // no pinned particle moves
  std::uint64_t step_ = 0;
  std::uint64_t bytes_;  ///< without contacts, which come and go
  std::optional<Divergence> divergence_;
};

std::uint64_t CpuSolver::heap_bytes() const {
  std::uint64_t sum = bytes_of(state_) + bytes_of(next_) + bytes_of(mass_) + bytes_of(inverse_mass_) +
                      bytes_of(springs_) + lengths_->bytes() + dynamics_.bytes() + balls_.bytes() +
                      std::uint64_t{model_->ball_count()} * 18 * sizeof(float);
  for (const Springs& springs : springs_)
    sum += std::visit([](const auto& each) { return each.bytes(); }, springs);
  return sum + steps_->bytes();
}

/// The arrays of a vector for each particle.
template <class T, class AnyArray>
Strided<T> strided(AnyArray& array, std::size_t count) {
  return {array[0].data(), count, 1, array[1].data() - array[0].data()};
}

template <class AnyVectors>
AnyVectors part_of(const AnyVectors& vectors, Range range) {
  return aspic::part_of(vectors, range.first, range.count);
}

/// Calls task(range) for all particles, on all threads: memory is as fast as several of them together.
template <class Task>
void CpuSolver::share(const Task& task) {
  constexpr std::size_t piece = 16384;
  const std::size_t count = model_->particle_count();
  workers_->run((count + piece - 1) / piece, [&](std::size_t n) {
    task(Range{n * piece, std::min(piece, count - n * piece)});
  });
}

Status CpuSolver::take_state(const ConstStateView& view, std::uint64_t step) {
  const std::size_t count = model_->particle_count();
  const Vectors own[] = {strided<float>(state_.x, count), strided<float>(state_.v, count)};
  for (std::size_t n = 0; n < std::size(own); ++n)
    share([&](Range range) { copy_vectors(part_of(view[n], range), part_of(own[n], range)); });
  physics::Field<float>* const balls[] = {&ball_phase_.x, &ball_phase_.v, &ball_phase_.omega};
  static_assert(2 + std::size(balls) == state_fields.size());
  for (std::size_t n = 0; n < std::size(balls); ++n) {
    balls[n]->resize(3, static_cast<Eigen::Index>(model_->ball_count()));
    copy_vectors(view[2 + n], Strided<float>{balls[n]->data(), model_->ball_count()});
  }
  pins_held_ = false;
  step_ = step;
  divergence_.reset();
  statistics_ = {};
  steps_->forget();
  return {};
}

std::optional<ConstStateView> CpuSolver::view() const {
  const std::size_t count = model_->particle_count();
  const auto balls = [&](const physics::Field<float>& f) {
    return Strided<const float>{f.data(), model_->ball_count()};
  };
  return ConstStateView{strided<const float>(state_.x, count), strided<const float>(state_.v, count),
                        balls(ball_phase_.x), balls(ball_phase_.v), balls(ball_phase_.omega)};
}

Result<std::uint64_t> CpuSolver::give_state(const StateView& to) {
  const ConstStateView own = *view();
  const VectorArray* const arrays[] = {&state_.x, &state_.v};
  for (std::size_t n = 0; n < own.size(); ++n) {
    if (n >= std::size(arrays)) {
      copy_vectors(own[n], to[n]);
      continue;
    }
    const auto* const floats = std::get_if<Strided<float>>(&to[n]);
    const bool rows = floats && floats->stride == 3 && floats->component == 1;
    if (std::holds_alternative<std::monostate>(to[n])) continue;
    share([&](Range range) {
      if (rows)
        write_rows(*arrays[n], range, floats->data + 3 * range.first);
      else
        copy_vectors(part_of(own[n], range), part_of(to[n], range));
    });
  }
  return step_;
}

Status CpuSolver::take_inputs(const Inputs& taken) {
  if (!taken.same_pins(inputs())) {
    fill(inverse_mass_, inverse_mass_under(*model_, taken));
    pins_held_ = false;
  }
  dynamics_.set_inputs(taken);
  balls_.set_inputs(taken);
  return {};
}

Status CpuSolver::take_constants(SharedModel model, std::uint64_t step) {
  // Others refer to these, which stay in their places.
  model_ = std::move(model);
  dynamics_ = reference::Dynamics<float>(*model_);
  dynamics_.set_stop_flag(stop_flag());
  dynamics_.set_inputs(inputs());
  balls_ = physics::Balls<float, collision::BallSearch>(*model_);
  balls_.set_inputs(inputs());
  for (Springs& springs : springs_) std::visit([&](auto& each) { each.set_constants(*model_); }, springs);
  lengths_->set_model(*model_);
  fill(mass_, model_->mass);
  fill(inverse_mass_, inverse_mass_under(*model_, inputs()));
  steps_->constants_changed();
  step_ = step;
  pins_held_ = false;
  divergence_.reset();
  return {};
}

/// Pinned particles stand from the beginning of a step on. Returns the velocities of those that did not.
std::vector<std::pair<std::size_t, physics::Vector<float>>> CpuSolver::hold_pins() {
  std::vector<std::pair<std::size_t, physics::Vector<float>>> before;
  if (std::exchange(pins_held_, true)) return before;
  for (std::size_t i = 0; i < model_->particle_count(); ++i) {
    if (inverse_mass_[i] != 0.0f) continue;
    const physics::Vector<float> v = vector_of(state_.v, i);
    if ((v.array() == 0.0f).all()) continue;
    before.emplace_back(i, v);
    parallel::set(state_.v, i, physics::Vector<float>::Zero());
  }
  return before;
}

void CpuSolver::step() {
  const auto before = hold_pins();
  dynamics_.begin_step(step_);
  SolveReport report;
  bool sound = steps_->step(state_, next_, report);
  // The step is dropped. Contact may have renewed its lists, on which no bit depends.
  if (interrupted()) {
    steps_->forget();
    for (const auto& [i, v] : before) parallel::set(state_.v, i, v);
    pins_held_ = before.empty();
    return;
  }
  if (model_->ball_count() > 0) {
    move_balls();
    sound = steps_->look_at(next_);
    divergence_ = physics::find_divergence(*model_, next_balls_, step_ + 1);
  }
  if (!sound) {
    divergence_ = physics::find_divergence<float>(
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
  const auto fly = [](Integrator integrator, const auto& forces, const physics::Phase<float>& s, double h) {
    return reference::explicit_step(integrator, forces, s, h);
  };
  next_balls_ = balls_.step(step_, ball_phase_, {x_0, v_0, 1}, {x, v, 1}, fly);
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
    auto workers = options.workers ? options.workers : std::make_shared<parallel::Workers>(threads);
    return std::unique_ptr<Solver>(std::make_unique<parallel::CpuSolver>(model, std::move(workers)));
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::scene_rejected,
                "not enough memory for the cpu solver of {} particles: use fewer particles-per-edge",
                model->particle_count());
  }
}

}  // namespace aspic
