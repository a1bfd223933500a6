#pragma once
// Names of tests that run over the integrator table: --gtest_filter='*heun_3*' picks those of one row.
#include <algorithm>
#include <string>

#include "model/integrator.h"

namespace aspic::test {

/// "runge-kutta-4" as gtest allows it, "runge_kutta_4".
inline std::string word_of(Integrator integrator) {
  std::string name(name_of(integrator));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

/// For INSTANTIATE_TEST_SUITE_P over integrators.
inline constexpr auto by_integrator = [](const auto& instance) { return word_of(instance.param); };

}  // namespace aspic::test
