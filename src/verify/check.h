#pragma once
// The verification battery: rows that each state a claim, a bound that comes from theory, and what was
// measured.
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/solver.h"
#include "base/result.h"
#include "gpu_solver/gpu_solver.h"
#include "run/backends.h"

namespace aspic::verify {

/// What is put to the test. The battery reaches every solver through these, so that it can be shown to fail
/// by handing it a wrong one.
struct Subject {
  /// A solver for the model in the precision; never empty.
  std::function<Result<std::unique_ptr<Solver>>(const Model&, Precision)> reference;
  /// A device's solver; empty where there is no device.
  std::function<Result<std::unique_ptr<GpuSolver>>(const Model&, const GpuOptions&)> gpu;
  /// A solver of a backend that is neither of the two, in single precision; never empty.
  std::function<Result<std::unique_ptr<Solver>>(const Model&, const BackendChoice&)> other;
  bool software_device = false;  ///< llvmpipe and its like, where equality of bits is the bound
  std::string program;           ///< the aspic to start as child process
};

/// The product's own solvers, with the device of `context` or, if null, without one. The context must outlive
/// it and be current wherever a row that needs it runs.
Subject product(gl::Context* context, std::string program);

enum class Verdict {
  passed,
  failed,
  not_run  ///< for want of a device
};

/// What a check found.
struct Finding {
  bool passed = false;
  std::string measured;  ///< the figure with its unit
};

struct Check {
  std::string name;    ///< "order/midpoint": groups and names with a slash between
  std::string claim;   ///< what is said to hold
  std::string bound;   ///< what the figure may be, from theory; "none" where it is only printed
  bool quick = false;  ///< part of --quick
  bool needs_gpu = false;
  std::function<Result<Finding>(const Subject&)> run;
};

/// A row of the report.
struct Row {
  std::string name, claim, bound, measured;
  Verdict verdict = Verdict::failed;
  double seconds = 0.0;  ///< it took
};

/// All checks, in the order of the report.
std::vector<Check> battery();

/// The checks whose name is one of `names` or begins with one of them followed by a slash; all if `names` is
/// empty. With `quick` only those that are quick. Error (usage): a name that is no check's, with the nearest
/// one.
Result<std::vector<Check>> select(std::vector<Check> checks, std::span<const std::string> names, bool quick);

/// Runs one check. An error inside it is a failed row whose figure is the error's sentence.
Row evaluate(const Check& check, const Subject& subject);

/// Runs checks, those without a device on a second thread; rows come in the checks' order. `finished` is
/// called after each, from one thread at a time, with the number of rows done. Once `stopped`, which any
/// thread may call, returns true, no further check begins, and what has not ended has no row.
std::vector<Row> evaluate_all(
    const std::vector<Check>& checks, const Subject& subject,
    const std::function<void(std::size_t)>& finished,
    const std::function<bool()>& stopped = [] { return false; });

/// A figure that must not exceed its bound. NaN fails.
Finding at_most(double figure, double bound, std::string_view unit = "");
/// "≤ 1e-12 m"
std::string at_most_text(double bound, std::string_view unit = "");

/// Adds a group of rows. The groups are in the order of the report, one source file each.
using AddChecks = void(std::vector<Check>& checks);
AddChecks add_order_checks, add_closed_form_checks, add_stability_checks, add_conservation_checks,
    add_force_checks, add_contact_checks, add_coulomb_checks, add_rest_checks, add_scene_checks,
    add_implicit_checks, add_body_checks, add_voxel_checks, add_actuation_checks, add_ball_checks,
    add_body_contact_checks, add_contact_impact_checks, add_ball_face_checks, add_equality_checks,
    add_fast_checks;

}  // namespace aspic::verify
