#pragma once
// Energies, momentum and extremes over time as a table.
#include <string>
#include <string_view>

#include "analysis/energy.h"
#include "base/result.h"
#include "io/atomic_file.h"
#include "model/model.h"

namespace aspic {

/// The header line, without its line end.
inline constexpr std::string_view series_csv_header =
    "step,time,kinetic,elastic,gravitational,total,px,py,pz,max_speed,min_height";

/// Writes rows as a run goes on; the file appears when finish() succeeds.
class SeriesWriter {
 public:
  /// Opens the file (AtomicFile::create) and writes the header.
  static Result<SeriesWriter> create(const std::string& path, Overwrite overwrite);

  /// Appends the row of a state unless the last row was of the same step; time is step · h [s]. Errors: io
  /// from the file; diverged if a figure is not finite.
  Status add(const Model& model, const State& state);

  /// Completes the file with the rows so far.
  Status finish() { return file_.commit(); }

 private:
  explicit SeriesWriter(AtomicFile file) : file_(std::move(file)) {}
  AtomicFile file_;
  bool has_row_ = false;
  std::uint64_t last_step_ = 0;
};

}  // namespace aspic
