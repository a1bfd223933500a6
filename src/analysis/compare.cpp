#include <bit>
#include <cmath>
#include <cstring>
#include <tuple>
#include <vector>

#include "aspic/analysis.h"
#include "base/result.h"

namespace aspic {
namespace {

/// Numbers a float's neighbors consecutively: +0 is 0, −0 is −1. Unsigned, so that distances never overflow.
template <class Bits>
std::uint64_t distance(Bits a, Bits b) {
  constexpr Bits sign = Bits{1} << (8 * sizeof(Bits) - 1);
  const auto ordinal = [](Bits bits) {
    return (bits & sign) ? static_cast<Bits>(~bits) : static_cast<Bits>(bits | sign);
  };
  const Bits x = ordinal(a), y = ordinal(b);
  return x > y ? x - y : y - x;
}

QuantityDifference compare(const std::vector<Vec3>& a, const std::vector<Vec3>& b, bool in_double) {
  QuantityDifference worst;
  if (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0) return worst;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double x = a[i][axis], y = b[i][axis];
      const std::uint64_t ulp =
          in_double ? ulp_distance(x, y) : ulp_distance(static_cast<float>(x), static_cast<float>(y));
      const double absolute = std::abs(x - y);
      if (absolute > worst.absolute) {
        worst.absolute = absolute;
        worst.absolute_index = static_cast<std::uint32_t>(i);
      }
      if (ulp > worst.ulp) {
        worst.ulp = ulp;
        worst.ulp_index = static_cast<std::uint32_t>(i);
      }
    }
  }
  return worst;
}

}  // namespace

std::uint64_t ulp_distance(float a, float b) {
  return distance(std::bit_cast<std::uint32_t>(a), std::bit_cast<std::uint32_t>(b));
}

std::uint64_t ulp_distance(double a, double b) {
  return distance(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b));
}

Result<StateDifference> compare_states(const State& a, const State& b) {
  for (const auto& [bodies, of_a, of_b] : {std::tuple{"particles", &a.position, &b.position},
                                           std::tuple{"balls", &a.ball_position, &b.ball_position}}) {
    if (of_a->size() != of_b->size())
      return fail(ErrorCode::usage, "The states have {} and {} {}: only states of one scene can be compared.",
                  of_a->size(), of_b->size(), bodies);
  }
  const bool in_double = a.precision == Precision::double_ && b.precision == Precision::double_;
  return StateDifference{compare(a.position, b.position, in_double),
                         compare(a.velocity, b.velocity, in_double),
                         compare(a.ball_position, b.ball_position, in_double),
                         compare(a.ball_velocity, b.ball_velocity, in_double),
                         compare(a.ball_angular_velocity, b.ball_angular_velocity, in_double)};
}

}  // namespace aspic
