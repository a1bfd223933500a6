#pragma once
// The explicit integrators (docs/physics.md, section 3), each as its textbook writes it. `h` is the time step
// [s]. `dynamics.acceleration(x, v, c)` gives a(t + c·h, x, v) of all particles, or of all balls, in a step
// from t on.
#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

#include "cpu_reference/dynamics.h"
#include "model/integrator.h"
#include "physics/phase.h"

namespace aspic::reference {

template <class T>
class StepDynamics;  // step_dynamics.h

/// x' = x + h·v, v' = v + h·a(x, v)   (Euler, 1768)
template <class T, class Forces>
Phase<T> explicit_euler(const Forces& dynamics, const Phase<T>& s, double step) {
  const T h = static_cast<T>(step);
  return {s.x + h * s.v, s.v + h * dynamics.acceleration(s.x, s.v, 0.0)};
}

/// v' = v + h·a(x, v), x' = x + h·v'   (Hairer, Lubich, Wanner, Geometric Numerical Integration, 2006,
/// §I.1.2)
template <class T, class Forces>
Phase<T> symplectic_euler(const Forces& dynamics, const Phase<T>& s, double step) {
  const T h = static_cast<T>(step);
  const Field<T> v = s.v + h * dynamics.acceleration(s.x, s.v, 0.0);
  return {s.x + h * v, v};
}

/// x_m = x + h/2·v, v_m = v + h/2·a(x, v);  x' = x + h·v_m, v' = v + h·a(x_m, v_m)   (Runge, 1895)
template <class T, class Forces>
Phase<T> midpoint(const Forces& dynamics, const Phase<T>& s, double step) {
  const T h = static_cast<T>(step), half_h = static_cast<T>(step / 2);
  const Field<T> x_m = s.x + half_h * s.v;
  const Field<T> v_m = s.v + half_h * dynamics.acceleration(s.x, s.v, 0.0);
  return {s.x + h * v_m, s.v + h * dynamics.acceleration(x_m, v_m, 0.5)};
}

/// x_p = x + h·v, v_p = v + h·a(x, v);  x' = x + h·v_p, v' = v + h·a(x_p, v_p): the assignments' shortcut for
/// backward Euler, a predictor evaluated once. It is an explicit method (docs/physics.md).
template <class T, class Forces>
Phase<T> implicit_euler_one_pass(const Forces& dynamics, const Phase<T>& s, double step) {
  const T h = static_cast<T>(step);
  const Field<T> x_p = s.x + h * s.v;
  const Field<T> v_p = s.v + h * dynamics.acceleration(s.x, s.v, 0.0);
  return {s.x + h * v_p, s.v + h * dynamics.acceleration(x_p, v_p, 1.0)};
}

/// The classical four stages (Kutta, 1901): x' = x + h/6·(k₁ + 2k₂ + 2k₃ + k₄), the same for v.
template <class T, class Forces>
Phase<T> runge_kutta_4(const Forces& dynamics, const Phase<T>& s, double step) {
  const T h = static_cast<T>(step), half_h = static_cast<T>(step / 2), sixth_h = static_cast<T>(step / 6);
  const Field<T> k1_x = s.v;
  const Field<T> k1_v = dynamics.acceleration(s.x, s.v, 0.0);
  const Field<T> k2_x = s.v + half_h * k1_v;
  const Field<T> k2_v = dynamics.acceleration(s.x + half_h * k1_x, k2_x, 0.5);
  const Field<T> k3_x = s.v + half_h * k2_v;
  const Field<T> k3_v = dynamics.acceleration(s.x + half_h * k2_x, k3_x, 0.5);
  const Field<T> k4_x = s.v + h * k3_v;
  const Field<T> k4_v = dynamics.acceleration(s.x + h * k3_x, k4_x, 1.0);
  const T two = 2;
  return {s.x + sixth_h * (((k1_x + two * k2_x) + two * k3_x) + k4_x),
          s.v + sixth_h * (((k1_v + two * k2_v) + two * k3_v) + k4_v)};
}

/// Heun's third-order method: stages at 0, h/3 and 2h/3, x' = x + h/4·(k₁ + 3k₃), the same for v (Heun,
/// 1900).
template <class T, class Forces>
Phase<T> heun_3(const Forces& dynamics, const Phase<T>& s, double step) {
  const T third_h = static_cast<T>(step * (1.0 / 3)), two_thirds_h = static_cast<T>(step * (2.0 / 3)),
          quarter_h = static_cast<T>(step / 4);
  const Field<T> k1_x = s.v;
  const Field<T> k1_v = dynamics.acceleration(s.x, s.v, 0.0);
  const Field<T> k2_x = s.v + third_h * k1_v;
  const Field<T> k2_v = dynamics.acceleration(s.x + third_h * k1_x, k2_x, 1.0 / 3);
  const Field<T> k3_x = s.v + two_thirds_h * k2_v;
  const Field<T> k3_v = dynamics.acceleration(s.x + two_thirds_h * k2_x, k3_x, 2.0 / 3);
  const T three = 3;
  return {s.x + quarter_h * (k1_x + three * k3_x), s.v + quarter_h * (k1_v + three * k3_v)};
}

/// x' = x + h/2·(v + v₁), v₁ = v + h·a(x, v);  v' = v + h/2·(a(x, v) + a(x', v₁)): velocity Verlet with the
/// velocity predicted for dampers (Groot and Warren, J. Chem. Phys. 107, 4423, 1997, λ = 1).
template <class T, class Forces>
Phase<T> velocity_verlet(const Forces& dynamics, const Phase<T>& s, double step) {
  const T h = static_cast<T>(step), half_h = static_cast<T>(step / 2);
  const Field<T> a = dynamics.acceleration(s.x, s.v, 0.0);
  const Field<T> v_1 = s.v + h * a;
  const Field<T> x = s.x + half_h * (s.v + v_1);
  return {x, s.v + half_h * (a + dynamics.acceleration(x, v_1, 1.0))};
}

/// One step of an explicit method, before the terrain's response. Precondition: `integrator` is one of
/// explicit_integrators.
template <class T, class Forces>
Phase<T> explicit_step(Integrator integrator, const Forces& dynamics, const Phase<T>& s, double step) {
  using Method = Phase<T> (*)(const Forces&, const Phase<T>&, double);
  static constexpr std::pair<Integrator, Method> methods[] = {
      {Integrator::explicit_euler, explicit_euler<T, Forces>},
      {Integrator::symplectic_euler, symplectic_euler<T, Forces>},
      {Integrator::midpoint, midpoint<T, Forces>},
      {Integrator::runge_kutta_4, runge_kutta_4<T, Forces>},
      {Integrator::implicit_euler_one_pass, implicit_euler_one_pass<T, Forces>},
      {Integrator::heun_3, heun_3<T, Forces>},
      {Integrator::velocity_verlet, velocity_verlet<T, Forces>},
  };
  static_assert(std::all_of(explicit_integrators.begin(), explicit_integrators.end(),
                            [](Integrator wanted) {
                              return std::any_of(std::begin(methods), std::end(methods),
                                                 [=](const auto& row) { return row.first == wanted; });
                            }),
                "every staged method of the table has its formula here");
  const auto method = std::find_if(std::begin(methods), std::end(methods),
                                   [=](const auto& row) { return row.first == integrator; });
  assert(method != std::end(methods));
  return method->second(dynamics, s, step);
}

// Compiled once, in integrators.cpp.
extern template Phase<float> explicit_step(Integrator, const StepDynamics<float>&, const Phase<float>&,
                                           double);
extern template Phase<double> explicit_step(Integrator, const StepDynamics<double>&, const Phase<double>&,
                                            double);

}  // namespace aspic::reference
