#pragma once
// What tests of batches share.
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "cpu_parallel/cpu_solver.h"
#include "support/model_building.h"

namespace aspic::test {

template <class T>
T take(Result<T> result) {
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message());
  return std::move(result).value();
}

inline SharedModel shared_model(const ModelSettings& settings) {
  return shared(build(settings));
}

/// A solver of one thread, to which an instance is compared.
inline std::unique_ptr<Solver> alone(const SharedModel& model) {
  return take(make_cpu_solver(model, {.threads = 1}));
}

}  // namespace aspic::test
