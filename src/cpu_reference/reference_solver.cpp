#include "cpu_reference/reference_solver.h"

#include <fmt/format.h>

#include <cmath>
#include <new>
#include <utility>

#include "cpu_reference/balls.h"
#include "cpu_reference/implicit_euler.h"

namespace aspic {
namespace reference {
namespace {

/// Lowest particle, else lowest ball, that is not finite or too fast, if any; else the solve's residual.
template <class T>
std::optional<Divergence> find_divergence(const Model& model, const Phase<T>& phase,
                                          const BallPhase<T>& balls, const SolveReport& report,
                                          std::uint64_t step) {
  const T limit = static_cast<T>(divergence_speed * divergence_speed);
  for (Eigen::Index i = 0; i < phase.x.cols(); ++i) {
    const Vector<T> v = phase.v.col(i);
    const bool finite = phase.x.col(i).allFinite() && v.allFinite();
    if (!finite || dot3<T>(v, v) > limit)
      return Divergence{step, static_cast<std::uint32_t>(i), finite, false};
  }
  for (Eigen::Index b = 0; b < balls.x.cols(); ++b) {
    const Vector<T> v = balls.v.col(b);
    // An energy is measured in double precision, where the square of any ω in single precision is finite.
    const double spinning = balls.omega.col(b).template cast<double>().squaredNorm() *
                            model.balls[static_cast<std::size_t>(b)].inertia();
    const bool finite = balls.x.col(b).allFinite() && v.allFinite() && balls.omega.col(b).allFinite() &&
                        std::isfinite(spinning);
    if (!finite || dot3<T>(v, v) > limit)
      return Divergence{step, static_cast<std::uint32_t>(b), finite, true};
  }
  if (!std::isfinite(report.residual)) return Divergence{step, 0, false, false, true};
  return std::nullopt;
}

/// Particles and balls alone: counting springs by type takes a walk over all of them.
ModelCounts bodies(const Model& model) {
  ModelCounts counts;
  counts.particles = model.particle_count();
  counts.balls = model.ball_count();
  return counts;
}

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
  std::uint64_t bytes() const override { return reference_bytes(bodies(model_), precision()); }

  Status load(const State& state) override {
    if (const Status fits = check_sizes(model_, state); !fits) return fits;
    set(state);
    return {};
  }

  Status set_pull(const std::optional<Pull>& pull) override {
    const auto taken = rounded_pull(model_, pull, precision());
    if (!taken) return taken.error();
    dynamics_.set_pull(*taken);
    return {};
  }

  Result<std::optional<Divergence>> advance(std::uint64_t steps) override {
    const double h = model_.simulation.timestep;
    const bool solved = model_.simulation.integrator == Integrator::implicit_euler;
    for (std::uint64_t n = 0; n < steps && !divergence_; ++n) {
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
      BallPhase<T> next_balls;
      if (model_.ball_count() > 0) next_balls = balls_.step(step_, ball_phase_, phase_, next);
      divergence_ = find_divergence(model_, next, next_balls, report, step_ + 1);
      if (divergence_) break;
      if (solved) statistics_.add(report);
      std::swap(phase_, next);
      std::swap(ball_phase_, next_balls);
      ++step_;
    }
    return divergence_;
  }

  std::optional<SolveStatistics> solve_statistics() override {
    if (model_.simulation.integrator != Integrator::implicit_euler) return std::nullopt;
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
  static Field<T> field(const std::vector<Vec3>& vectors) {
    Field<T> f(3, static_cast<Eigen::Index>(vectors.size()));
    for (Eigen::Index i = 0; i < f.cols(); ++i) f.col(i) = rounded<T>(vectors[static_cast<std::size_t>(i)]);
    return f;
  }
  static std::vector<Vec3> columns(const Field<T>& f) {
    std::vector<Vec3> vectors;
    vectors.reserve(static_cast<std::size_t>(f.cols()));
    for (Eigen::Index i = 0; i < f.cols(); ++i) vectors.push_back({f(0, i), f(1, i), f(2, i)});
    return vectors;
  }

  void set(const State& state) {
    phase_ = {field(state.position), field(state.velocity)};
    ball_phase_ = {field(state.ball_position), field(state.ball_velocity),
                   field(state.ball_angular_velocity)};
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
    return Error{ErrorCode::scene_rejected,
                 fmt::format("no memory left for the reference solver of {} particles ({} bytes): use fewer "
                             "particles-per-edge",
                             model.particle_count(), reference_bytes(reference::bodies(model), precision))};
  }
}

std::uint64_t reference_bytes(const ModelCounts& counts, Precision precision) {
  // Start and end of a step, the four slopes of a Runge–Kutta method, one argument field and one force field:
  // x and v.
  const std::uint64_t real = precision == Precision::single ? sizeof(float) : sizeof(double);
  // Balls: the same, ω, constants and their order along x.
  return counts.particles * real * (3 * 14 + 2) + counts.balls * real * (3 * 17 + 7);
}

}  // namespace aspic
