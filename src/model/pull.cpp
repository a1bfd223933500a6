#include "model/pull.h"

#include <cmath>
#include <limits>

#include "base/result.h"

namespace aspic {

double rounded_number(double x, Precision precision) {
  if (precision == Precision::single) {
    // A conversion to a float out of its range is undefined, so larger numbers are infinite by decree.
    const double limit = std::numeric_limits<float>::max();
    x = std::abs(x) > limit ? std::copysign(HUGE_VAL, x) : static_cast<double>(static_cast<float>(x));
  }
  return x == 0.0 ? 0.0 : x;
}

Result<Pull> rounded_pull(const Model& model, const Pull& pull, Precision precision) {
  const char* const kind = pull.ball ? "ball" : "particle";
  const std::uint32_t count = pull.ball ? model.ball_count() : model.particle_count();
  if (pull.particle >= count) {
    return fail(ErrorCode::usage, "{0} {1} cannot be pulled: the scene has {2} {0}s, counted from 0", kind,
                pull.particle, count);
  }
  Pull taken = pull;
  for (int axis = 0; axis < 3; ++axis) taken.anchor[axis] = rounded_number(pull.anchor[axis], precision);
  taken.stiffness = rounded_number(pull.stiffness, precision);
  taken.damping = rounded_number(pull.damping, precision);
  for (const double value :
       {taken.anchor.x, taken.anchor.y, taken.anchor.z, taken.stiffness, taken.damping}) {
    if (std::isfinite(value)) continue;
    return fail(ErrorCode::usage,
                "the pull on {} {} has a number that is not finite in {} precision: anchor ({}, {}, "
                "{}) m, stiffness {} N/m, damping {} N·s/m",
                kind, pull.particle, name_of(precision), pull.anchor.x, pull.anchor.y, pull.anchor.z,
                pull.stiffness, pull.damping);
  }
  if (taken.stiffness < 0.0 || taken.damping < 0.0) {
    return fail(ErrorCode::usage,
                "the pull on {} {} has stiffness {} N/m and damping {} N·s/m: neither may be negative", kind,
                pull.particle, pull.stiffness, pull.damping);
  }
  return taken;
}

}  // namespace aspic
