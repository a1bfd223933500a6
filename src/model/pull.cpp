#include "model/pull.h"

#include <cmath>
#include <limits>

#include "base/result.h"

namespace aspic {
namespace {

/// A conversion to a float out of its range is undefined, so larger numbers are infinite by decree.
double rounded(double value, Precision precision) {
  if (precision == Precision::single) {
    const double limit = std::numeric_limits<float>::max();
    value = std::abs(value) > limit ? std::copysign(HUGE_VAL, value)
                                    : static_cast<double>(static_cast<float>(value));
  }
  return value == 0.0 ? 0.0 : value;
}

}  // namespace

Result<std::optional<Pull>> rounded_pull(const Model& model, const std::optional<Pull>& pull,
                                         Precision precision) {
  if (!pull) return std::optional<Pull>();
  const char* const kind = pull->ball ? "ball" : "particle";
  const std::uint32_t count = pull->ball ? model.ball_count() : model.particle_count();
  if (pull->particle >= count) {
    return fail(ErrorCode::usage, "{0} {1} cannot be pulled: the scene has {2} {0}s, counted from 0", kind,
                pull->particle, count);
  }
  Pull taken = *pull;
  for (int axis = 0; axis < 3; ++axis) taken.anchor[axis] = rounded(pull->anchor[axis], precision);
  taken.stiffness = rounded(pull->stiffness, precision);
  taken.damping = rounded(pull->damping, precision);
  for (const double value :
       {taken.anchor.x, taken.anchor.y, taken.anchor.z, taken.stiffness, taken.damping}) {
    if (std::isfinite(value)) continue;
    return fail(ErrorCode::usage,
                "the pull on {} {} has a number that is not finite in {} precision: anchor ({}, {}, "
                "{}) m, stiffness {} N/m, damping {} N·s/m",
                kind, pull->particle, name_of(precision), pull->anchor.x, pull->anchor.y, pull->anchor.z,
                pull->stiffness, pull->damping);
  }
  if (taken.stiffness < 0.0 || taken.damping < 0.0) {
    return fail(ErrorCode::usage,
                "the pull on {} {} has stiffness {} N/m and damping {} N·s/m: neither may be negative", kind,
                pull->particle, pull->stiffness, pull->damping);
  }
  return std::optional<Pull>(taken);
}

}  // namespace aspic
