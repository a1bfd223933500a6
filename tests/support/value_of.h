#pragma once
// Values that a test cannot go on without.
#include <stdexcept>
#include <utility>

#include "aspic/error.h"

namespace aspic::test {

/// The value. Of an error, the test fails with its message and ends, and the tests behind it run: to read an
/// error's value would end the program. Legal in tests, fixtures and what they call.
template <class T>
T value_of(Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().message());
  return std::move(result).value();
}

}  // namespace aspic::test
