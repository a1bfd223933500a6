#pragma once
// Results that a benchmark needs: without them it prints why and ends.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "aspic/error.h"

namespace aspic {

inline void check(const Status& done) {
  if (done) return;
  fmt::print(stderr, "{}\n", done.error().message());
  std::exit(1);
}

template <class T>
T checked(Result<T> made) {
  if (!made) check(made.error());
  return std::move(*made);
}

}  // namespace aspic
