#include "cpu_reference/method.h"

#include <cassert>
#include <memory>

#include "cpu_reference/implicit_euler.h"
#include "cpu_reference/step_dynamics.h"

namespace aspic::reference {
namespace {

/// The explicit methods, by their textbook formulas.
template <class T>
class StagedMethod final : public Method<T> {
 public:
  StagedMethod(const Dynamics<T>& dynamics, const Model& model)
      : dynamics_(dynamics),
        terms_(dynamics),
        integrator_(model.simulation.integrator),
        h_(model.simulation.timestep) {
    if (has_body_contact(model)) bodies_ = std::make_unique<BodyContact<T>>(model);
  }

  Phase<T> step(const Phase<T>& s, SolveReport&) override {
    return explicit_step(integrator_, StepDynamics<T>(dynamics_, terms_, s.x, s.v, bodies_.get()), s, h_);
  }
  void respond(const Phase<T>& s, Phase<T>& end) const override { dynamics_.respond(s.x, s.v, end.x, end.v); }

  /// For each stage a velocity and an acceleration; contact of bodies without lists of what touches.
  static std::uint64_t bytes(const Model& model) {
    const std::size_t stages = row_of(model.simulation.integrator).staged()->stages.size();
    const std::uint64_t contact = has_body_contact(model) ? contact_bytes(model) : 0;
    return model.particle_count() * sizeof(T) * 3 * 2 * stages + contact;
  }

 private:
  const Dynamics<T>& dynamics_;
  Terms<T> terms_;
  std::unique_ptr<BodyContact<T>> bodies_;  // none where none can touch
  Integrator integrator_;
  double h_;
};

template <class T, class M>
KindRow<T> row() {
  return {[](const Dynamics<T>& dynamics, const Model& model) {
            return std::unique_ptr<Method<T>>(std::make_unique<M>(dynamics, model));
          },
          M::bytes};
}

}  // namespace

template <class T>
KindRow<T> kind_row(MethodKind kind) {
  switch (kind) {
    case MethodKind::staged:
      return row<T, StagedMethod<T>>();
    case MethodKind::newton:
      return row<T, ImplicitEuler<T>>();
  }
  assert(false);
  return {};
}

template KindRow<float> kind_row(MethodKind);
template KindRow<double> kind_row(MethodKind);

}  // namespace aspic::reference
