#include "cpu_reference/reference_solver.h"

#include <fmt/format.h>

#include <cmath>
#include <new>
#include <utility>

#include "cpu_reference/implicit_euler.h"

namespace aspic {
namespace reference {
namespace {

/// Lowest particle that is not finite or too fast, if any.
template <class T>
std::optional<Divergence> find_divergence(const Phase<T>& phase, std::uint64_t step) {
  const T limit = static_cast<T>(divergence_speed * divergence_speed);
  for (Eigen::Index i = 0; i < phase.x.cols(); ++i) {
    const Vector<T> v = phase.v.col(i);
    const bool finite = phase.x.col(i).allFinite() && v.allFinite();
    if (!finite || dot3<T>(v, v) > limit) return Divergence{step, static_cast<std::uint32_t>(i), finite};
  }
  return std::nullopt;
}

template <class T>
class ReferenceSolver final : public Solver {
 public:
  explicit ReferenceSolver(const Model& model)
      : model_(model), dynamics_(model), implicit_(dynamics_, model) {
    set(initial_state(model, precision()));
  }

  std::string_view backend() const override { return "reference"; }
  std::string description() const override {
    return fmt::format("reference, Eigen {}.{}.{}, one thread, {} precision", EIGEN_WORLD_VERSION,
                       EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, name_of(precision()));
  }
  Precision precision() const override { return sizeof(T) == 4 ? Precision::single : Precision::double_; }
  const Model& model() const override { return model_; }
  std::uint64_t bytes() const override { return reference_bytes(count(model_), precision()); }

  Status load(const State& state) override {
    if (state.position.size() != model_.particle_count() ||
        state.velocity.size() != model_.particle_count()) {
      return Error{ErrorCode::usage, fmt::format("the state has {} particles, the scene has {}",
                                                 state.position.size(), model_.particle_count())};
    }
    set(state);
    return {};
  }

  Result<std::optional<Divergence>> advance(std::uint64_t steps) override {
    const double h = model_.simulation.timestep;
    const bool solved = model_.simulation.integrator == Integrator::implicit_euler;
    for (std::uint64_t n = 0; n < steps && !divergence_; ++n) {
      SolveReport report;
      Phase<T> next = solved ? implicit_.step(phase_, report)
                             : explicit_step(model_.simulation.integrator, dynamics_, phase_, h);
      dynamics_.respond(phase_.x, phase_.v, next.x, next.v);
      divergence_ = find_divergence(next, step_ + 1);
      if (divergence_) break;
      if (solved) statistics_.add(report);
      std::swap(phase_, next);
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
    for (Eigen::Index i = 0; i < phase_.x.cols(); ++i) {
      state.position.push_back({phase_.x(0, i), phase_.x(1, i), phase_.x(2, i)});
      state.velocity.push_back({phase_.v(0, i), phase_.v(1, i), phase_.v(2, i)});
    }
    return state;
  }

 private:
  void set(const State& state) {
    const auto count = static_cast<Eigen::Index>(state.position.size());
    phase_.x.resize(3, count);
    phase_.v.resize(3, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      phase_.x.col(i) = rounded<T>(state.position[static_cast<std::size_t>(i)]);
      phase_.v.col(i) = rounded<T>(state.velocity[static_cast<std::size_t>(i)]);
    }
    step_ = state.step;
    divergence_.reset();
    statistics_ = {};
  }

  const Model& model_;
  Dynamics<T> dynamics_;
  ImplicitEuler<T> implicit_;
  SolveStatistics statistics_;
  Phase<T> phase_;
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
                             model.particle_count(), reference_bytes(count(model), precision))};
  }
}

std::uint64_t reference_bytes(const ModelCounts& counts, Precision precision) {
  // Start and end of a step, the four slopes of a Runge–Kutta method, one argument field and one force field:
  // x and v.
  const std::uint64_t real = precision == Precision::single ? sizeof(float) : sizeof(double);
  return counts.particles * real * (3 * 14 + 2);
}

}  // namespace aspic
