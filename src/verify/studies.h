#pragma once
// Experiments that checks judge and reports show.
#include <vector>

#include "verify/check.h"

namespace aspic::verify {

/// Errors of a method on a smooth free spring system, in double precision, at steps that halve.
struct OrderStudy {
  std::vector<double> step;   ///< h [s]
  std::vector<double> error;  ///< norm over all positions [m] and velocities [m/s] after 0.4 s
  double observed = 0.0;      ///< order: log₂ of the last ratio of errors above rounding (1e-12)
  double finest = 0.0;        ///< the smaller error of that ratio
};
/// Errors: of the reference solver.
Result<OrderStudy> study_order(const Subject& subject, Integrator integrator);
/// The same of springs whose rest lengths follow a sine of 2 Hz with an amplitude of a tenth.
Result<OrderStudy> study_actuated_order(const Subject& subject, Integrator integrator);

/// A 5³ cube on a plane slope.
struct Slide {
  double acceleration = 0.0;  ///< mean over the last two seconds, down the slope [m/s²]
  double creep = 0.0;         ///< mean speed over them [m/s]
};
/// From rest on the surface, for `seconds` ≥ 2 under gravity of 9.8 m/s². Errors: of the reference solver.
Result<Slide> study_slide(const Subject& subject, Integrator integrator, ContactModel contact, double degrees,
                          double friction, double seconds);

}  // namespace aspic::verify
