#include "model/integrator.h"

#include <array>

namespace aspic {
namespace {

constexpr std::array<Stage, 1> euler_stages = {{{0.0, 1.0}}};
constexpr std::array<Stage, 2> midpoint_stages = {{{0.5, 0.0}, {0.0, 1.0}}};
constexpr std::array<Stage, 2> one_pass_stages = {{{1.0, 0.0}, {0.0, 1.0}}};
constexpr std::array<Stage, 4> runge_kutta_4_stages = {{{0.5, 1.0}, {0.5, 2.0}, {1.0, 2.0}, {0.0, 1.0}}};

constexpr StagedMethod explicit_euler = {euler_stages, 1.0, false};
constexpr StagedMethod symplectic_euler = {euler_stages, 1.0, true};
constexpr StagedMethod midpoint = {midpoint_stages, 1.0, false};
constexpr StagedMethod one_pass = {one_pass_stages, 1.0, false};
constexpr StagedMethod runge_kutta_4 = {runge_kutta_4_stages, 6.0, false};

}  // namespace

const StagedMethod* staged_method(Integrator integrator) {
  switch (integrator) {
    case Integrator::explicit_euler:
      return &explicit_euler;
    case Integrator::symplectic_euler:
      return &symplectic_euler;
    case Integrator::midpoint:
      return &midpoint;
    case Integrator::runge_kutta_4:
      return &runge_kutta_4;
    case Integrator::implicit_euler_one_pass:
      return &one_pass;
    case Integrator::implicit_euler:
      break;
  }
  return nullptr;
}

int force_evaluations_per_step(Integrator integrator) {
  const StagedMethod* method = staged_method(integrator);
  return method ? static_cast<int>(method->stages.size()) : 0;
}

}  // namespace aspic
