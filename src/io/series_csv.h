#pragma once
// Energies, momentum and extremes over time as a table.
#include <optional>
#include <string>
#include <string_view>

#include "aspic/analysis.h"
#include "aspic/files.h"
#include "base/result.h"
#include "io/atomic_file.h"
#include "model/implicit.h"
#include "model/model.h"

namespace aspic {

/// The header line, without its line end.
inline constexpr std::string_view series_csv_header =
    "step,time,kinetic,elastic,gravitational,total,px,py,pz,max_speed,min_height";

/// What follows it where the integrator is implicit-euler: iterations and ends of the solves since the row
/// before, the residual [m/s] of the last of them.
inline constexpr std::string_view series_csv_solve_header =
    ",newton_iterations,cg_iterations,residual,converged,stagnated,not_converged";
/// Follows these in a model with contact between bodies: the part of the elastic energy in contacts.
inline constexpr std::string_view series_csv_contact_header = ",contact";
/// And in one with actuators: their work since the first row.
inline constexpr std::string_view series_csv_work_header = ",actuator_work";
/// And in one with drag: the energy that it has dissipated since the first row, by the trapezoidal rule.
inline constexpr std::string_view series_csv_drag_header = ",dissipated_by_drag";

/// Writes rows during a run; the file appears when finish() succeeds.
class SeriesWriter {
 public:
  /// Opens the file (AtomicFile::create). The header comes with the first row, with the columns of solves if
  /// `solves`, and those of contact and of actuators if the row has them.
  static Result<SeriesWriter> create(const std::string& path, Overwrite overwrite, bool solves = false);

  /// Appends the row of a state unless the last row was of the same step; time is step · h [s]. Its
  /// statistics of solves are read only where the file has their columns. Errors: io from the file;
  /// diverged if a figure is not finite.
  Status add(const Sample& sample);
  /// The same with the measurements of a step, at `time` [s]; `work`: of actuators, ActuatorWork::add().
  Status add(std::uint64_t step, double time, const Measures& measures, const SolveStatistics& solves = {},
             std::optional<double> work = {});

  std::optional<double> work() const { return last_work_; }  ///< that of the last row
  Status finish();                                           ///< completes the file with the rows so far

 private:
  SeriesWriter(AtomicFile file, bool solves) : file_(std::move(file)), has_solves_(solves) {}
  AtomicFile file_;
  Status write_header(const Measures& first, bool work);
  bool has_solves_ = false, has_contact_ = false, has_work_ = false;
  std::optional<double> drag_power_;  // of the last row [W]; nothing without drag
  double last_time_ = 0.0, dissipated_ = 0.0;
  SolveStatistics before_;  // as of the last row
  ActuatorWork work_;
  std::optional<Meter> meter_;  // from the first row on
  std::optional<double> last_work_;
  bool has_row_ = false;
  std::uint64_t last_step_ = 0;
};

}  // namespace aspic
