#include "cpu_reference/reference_solver.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/flush_denormals.h"
#include "base/out_of_memory.h"
#include "base/result.h"
#include "cpu_reference/method.h"
#include "model/counts.h"
#include "model/pull.h"
#include "physics/balls/balls.h"
#include "physics/divergence.h"

namespace aspic {
namespace reference {
namespace {

/// Bytes a solver with methods of this kind holds at most during a step.
template <class T>
std::uint64_t bytes_of(const KindRow<T>& kind, const Model& model) {
  // x and v where the step starts and ends.
  const std::uint64_t ends = model.particle_count() * sizeof(T) * 3 * 4;
  // Fields of balls likewise for x, v and ω, constants, and their order along x.
  const std::uint64_t balls = model.ball_count() * sizeof(T) * (3 * 17 + 7);
  const std::uint64_t masses = model.mass.bytes() + 2 * model.inverse_mass.bytes();
  return ends + kind.bytes(model) + masses + balls;
}

template <class T>
KindRow<T> kind_of(const Model& model) {
  return kind_row<T>(row_of(model.simulation.integrator).kind());
}

template <class T>
class ReferenceSolver final : public Solver {
 public:
  ReferenceSolver(const KindRow<T>& kind, SharedModel model, Denormals denormals)
      : kind_(kind),
        denormals_(denormals),
        reports_solves_(row_of(model->simulation.integrator).traits.reports_solves),
        parts_(std::make_unique<Parts>(kind, std::move(model))) {
    const State start = initial_state(this->model(), precision());
    set(view_of(start), start.step);
  }

  std::string_view backend() const override { return "reference"; }
  std::string description() const override {
    return fmt::format("reference, Eigen {}.{}.{}, one thread, {} precision", EIGEN_WORLD_VERSION,
                       EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, name_of(precision()));
  }
  Precision precision() const override { return sizeof(T) == 4 ? Precision::single : Precision::double_; }
  const Model& model() const override { return *parts_->model; }
  std::uint64_t bytes() const override { return bytes_of(kind_, model()); }

  void set_stop_flag(const std::atomic<bool>* flag) override {
    Solver::set_stop_flag(flag);
    parts_->dynamics.set_stop_flag(flag);
  }

  Result<Advance> advance(std::uint64_t steps) override {
    std::optional<FlushDenormals> flush;
    if (denormals_ == Denormals::flushed) flush.emplace();
    const std::uint64_t from = step_;
    while (step_ - from < steps && !divergence_ && !interrupted()) {
      SolveReport report;
      const Field<T> before = hold_pins();
      parts_->dynamics.begin_step(step_);
      Phase<T> next = parts_->method->step(phase_, report);
      parts_->method->respond(phase_, next);
      // The step is dropped. Contact may have renewed its lists, on which no bit depends.
      if (interrupted()) {
        if (before.cols() > 0) phase_.v = before;
        pins_held_ = before.cols() == 0;
        break;
      }
      BallPhase<T> next_balls;
      const auto fly = [](Integrator integrator, const auto& forces, const Phase<T>& s, double h) {
        return explicit_step(integrator, forces, s, h);
      };
      if (model().ball_count() > 0) {
        next_balls =
            parts_->balls.step(step_, ball_phase_, view_of(std::as_const(phase_)), view_of(next), fly);
      }
      divergence_ = find_divergence<T>(
          model(), [&](Eigen::Index i) { return Vector<T>(next.x.col(i)); },
          [&](Eigen::Index i) { return Vector<T>(next.v.col(i)); }, next_balls, step_ + 1);
      if (!divergence_ && !std::isfinite(report.residual))
        divergence_ = Divergence{step_ + 1, 0, false, false, true};
      if (divergence_) break;
      if (reports_solves_) statistics_.add(report);
      std::swap(phase_, next);
      std::swap(ball_phase_, next_balls);
      ++step_;
    }
    return ended(step_ - from, steps, divergence_);
  }

  std::optional<SolveStatistics> solve_statistics() override {
    if (!reports_solves_) return std::nullopt;
    return statistics_;
  }

  std::optional<ConstStateView> view() const override {
    const auto of = [](const Field<T>& f) {
      return Strided<const T>{f.data(), static_cast<std::size_t>(f.cols())};
    };
    return ConstStateView{of(phase_.x), of(phase_.v), of(ball_phase_.x), of(ball_phase_.v),
                          of(ball_phase_.omega)};
  }

 private:
  Status take_state(const ConstStateView& view, std::uint64_t step) override {
    set(view, step);
    return {};
  }
  Result<std::uint64_t> give_state(const StateView& to) override {
    const ConstStateView own = *view();
    for (std::size_t n = 0; n < own.size(); ++n) copy_vectors(own[n], to[n]);
    return step_;
  }

  Status take_inputs(const Inputs& inputs) override {
    parts_->dynamics.set_inputs(inputs);
    parts_->balls.set_inputs(inputs);
    pins_held_ = pins_held_ && inputs.same_pins(this->inputs());
    return {};
  }

  Status take_constants(SharedModel model, std::uint64_t step) override {
    parts_ = std::make_unique<Parts>(kind_, std::move(model));
    parts_->dynamics.set_stop_flag(stop_flag());
    step_ = step;
    divergence_.reset();
    pins_held_ = false;
    return take_inputs(inputs());
  }

  /// Pinned particles stand from the beginning of a step on. Returns the velocities before; nothing if none
  /// changes.
  Field<T> hold_pins() {
    Field<T> before;
    if (std::exchange(pins_held_, true)) return before;
    for (Eigen::Index i = 0; i < phase_.v.cols(); ++i) {
      if (parts_->dynamics.inverse_mass(i) != T(0) || (phase_.v.col(i).array() == T(0)).all()) continue;
      if (before.cols() == 0) before = phase_.v;
      phase_.v.col(i).setZero();
    }
    return before;
  }

  void set(const ConstStateView& view, std::uint64_t step) {
    Field<T>* const fields[] = {&phase_.x, &phase_.v, &ball_phase_.x, &ball_phase_.v, &ball_phase_.omega};
    static_assert(std::size(fields) == state_fields.size());
    for (std::size_t n = 0; n < view.size(); ++n) {
      fields[n]->resize(3, static_cast<Eigen::Index>(count_of(view[n])));
      copy_vectors(view[n], Strided<T>{fields[n]->data(), count_of(view[n])});
    }
    step_ = step;
    pins_held_ = false;
    divergence_.reset();
    statistics_ = {};
  }

  /// All that knows the model.
  struct Parts {
    SharedModel model;
    Dynamics<T> dynamics;
    std::unique_ptr<Method<T>> method;
    Balls<T> balls;

    Parts(const KindRow<T>& kind, SharedModel held)
        : model(std::move(held)), dynamics(*model), method(kind.make(dynamics, *model)), balls(*model) {}
  };

  const KindRow<T> kind_;
  const Denormals denormals_;
  const bool reports_solves_;
  std::unique_ptr<Parts> parts_;
  SolveStatistics statistics_;
  Phase<T> phase_;
  BallPhase<T> ball_phase_;
  bool pins_held_ = false;  // no pinned particle moves
  std::uint64_t step_ = 0;
  std::optional<Divergence> divergence_;
};

}  // namespace

template <class T>
std::unique_ptr<Solver> solver_with(const KindRow<T>& kind, SharedModel model, Denormals denormals) {
  return std::make_unique<ReferenceSolver<T>>(kind, std::move(model), denormals);
}
template std::unique_ptr<Solver> solver_with(const KindRow<float>&, SharedModel, Denormals);
template std::unique_ptr<Solver> solver_with(const KindRow<double>&, SharedModel, Denormals);

}  // namespace reference

Result<std::unique_ptr<Solver>> make_reference_solver(SharedModel model, Precision precision,
                                                      Denormals denormals) {
  const auto made = [&]() -> Result<std::unique_ptr<Solver>> {
    if (precision == Precision::single)
      return solver_with(reference::kind_of<float>(*model), model, denormals);
    return solver_with(reference::kind_of<double>(*model), model, denormals);
  };
  return unless_out_of_memory(made, [&]() -> Result<std::unique_ptr<Solver>> {
    return fail(
        ErrorCode::scene_rejected,
        "not enough memory for the reference solver of {} particles ({} bytes): use fewer particles-per-edge",
        model->particle_count(), reference_bytes(*model, precision));
  });
}

std::uint64_t reference_bytes(const Model& model, Precision precision) {
  return precision == Precision::single ? reference::bytes_of(reference::kind_of<float>(model), model)
                                        : reference::bytes_of(reference::kind_of<double>(model), model);
}

}  // namespace aspic
