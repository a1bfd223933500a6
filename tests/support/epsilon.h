#pragma once
// What the bounds of tests are made from.
#include <limits>

namespace aspic::test {

/// Distance from 1 to the next double.
constexpr double eps = std::numeric_limits<double>::epsilon();

}  // namespace aspic::test
