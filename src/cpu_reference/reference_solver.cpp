#include "cpu_reference/reference_solver.h"

#include <fmt/format.h>

#include <cmath>
#include <new>
#include <utility>

#include "cpu_reference/balls.h"
#include "cpu_reference/divergence.h"
#include "cpu_reference/implicit_euler.h"

namespace aspic {
namespace reference {
namespace {

template <class T>
class ReferenceSolver final : public Solver {
 public:
  explicit ReferenceSolver(const Model& model)
      : model_(model), dynamics_(model), implicit_(dynamics_, model), balls_(model) {
    set(initial_state(model, precision()));
  }

  std::string_view backend() const override { return "reference"; }
  std::string description() const override {
    return fmt::format("reference, Eigen {}.{}.{}, one thread, {} precision", EIGEN_WORLD_VERSION,
                       EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, name_of(precision()));
  }
  Precision precision() const override { return sizeof(T) == 4 ? Precision::single : Precision::double_; }
  const Model& model() const override { return model_; }
  std::uint64_t bytes() const override { return reference_bytes(model_, precision()); }

  Status load(const State& state) override {
    if (const Status fits = check_sizes(model_, state); !fits) return fits;
    set(state);
    return {};
  }

  Status set_pull(const std::optional<Pull>& pull) override {
    ASPIC_TRY(const auto taken, rounded_pull(model_, pull, precision()));
    dynamics_.set_pull(taken);
    balls_.set_pull(taken);
    return {};
  }

  void set_stop_flag(const std::atomic<bool>* flag) override {
    Solver::set_stop_flag(flag);
    dynamics_.set_stop_flag(flag);
  }

  Result<std::optional<Divergence>> advance(std::uint64_t steps) override {
    const double h = model_.simulation.timestep;
    const bool solved = row_of(model_.simulation.integrator).solved();
    for (std::uint64_t n = 0; n < steps && !divergence_ && !interrupted(); ++n) {
      SolveReport report;
      dynamics_.begin_step(step_);
      Phase<T> next = solved ? implicit_.step(phase_, report)
                             : explicit_step(model_.simulation.integrator,
                                             StepDynamics<T>(dynamics_, phase_.x, phase_.v), phase_, h);
      if (solved) {
        implicit_.respond(phase_, next);
      } else {
        dynamics_.respond(phase_.x, phase_.v, next.x, next.v);
      }
      if (interrupted()) break;
      BallPhase<T> next_balls;
      if (model_.ball_count() > 0) {
        next_balls = balls_.step(step_, ball_phase_, view_of(std::as_const(phase_)), view_of(next));
      }
      divergence_ = find_divergence<T>(
          model_, [&](Eigen::Index i) { return Vector<T>(next.x.col(i)); },
          [&](Eigen::Index i) { return Vector<T>(next.v.col(i)); }, next_balls, step_ + 1);
      if (!divergence_ && !std::isfinite(report.residual))
        divergence_ = Divergence{step_ + 1, 0, false, false, true};
      if (divergence_) break;
      if (solved) statistics_.add(report);
      std::swap(phase_, next);
      std::swap(ball_phase_, next_balls);
      ++step_;
    }
    return divergence_;
  }

  std::optional<SolveStatistics> solve_statistics() override {
    if (!row_of(model_.simulation.integrator).solved()) return std::nullopt;
    return statistics_;
  }

  Result<State> state() override {
    State state;
    state.precision = precision();
    state.step = step_;
    state.position = columns(phase_.x);
    state.velocity = columns(phase_.v);
    state.ball_position = columns(ball_phase_.x);
    state.ball_velocity = columns(ball_phase_.v);
    state.ball_angular_velocity = columns(ball_phase_.omega);
    return state;
  }

 private:
  void set(const State& state) {
    phase_ = {field<T>(state.position), field<T>(state.velocity)};
    ball_phase_ = {field<T>(state.ball_position), field<T>(state.ball_velocity),
                   field<T>(state.ball_angular_velocity)};
    step_ = state.step;
    divergence_.reset();
    statistics_ = {};
  }

  const Model& model_;
  Dynamics<T> dynamics_;
  ImplicitEuler<T> implicit_;
  SolveStatistics statistics_;
  Balls<T> balls_;
  Phase<T> phase_;
  BallPhase<T> ball_phase_;
  std::uint64_t step_ = 0;
  std::optional<Divergence> divergence_;
};

}  // namespace
}  // namespace reference

Result<std::unique_ptr<Solver>> make_reference_solver(const Model& model, Precision precision) {
  try {
    if (precision == Precision::single) {
      return std::unique_ptr<Solver>(std::make_unique<reference::ReferenceSolver<float>>(model));
    }
    return std::unique_ptr<Solver>(std::make_unique<reference::ReferenceSolver<double>>(model));
  } catch (const std::bad_alloc&) {
    return fail(
        ErrorCode::scene_rejected,
        "no memory left for the reference solver of {} particles ({} bytes): use fewer particles-per-edge",
        model.particle_count(), reference_bytes(model, precision));
  }
}

std::uint64_t reference_bytes(const Model& model, Precision precision) {
  const std::uint64_t real = precision == Precision::single ? sizeof(float) : sizeof(double);
  const IntegratorRow& method = row_of(model.simulation.integrator);
  // Balls: fields as below for x, v and ω, constants, and their order along x.
  const std::uint64_t balls = model.ball_count() * real * (3 * 17 + 7);
  const std::uint64_t masses = model.mass.bytes() + 2 * model.inverse_mass.bytes();
  if (!method.solved()) {
    // Fields of a step at once: x and v at its start and its end, and for each stage a velocity and an
    // acceleration.
    return model.particle_count() * real * 3 * (4 + 2 * method.stages.size()) + masses + balls;
  }
  const auto solve = precision == Precision::single ? reference::ImplicitEuler<float>::bytes(model)
                                                    : reference::ImplicitEuler<double>::bytes(model);
  return model.particle_count() * real * 3 * 4 + solve + masses + balls;
}

}  // namespace aspic
