#pragma once
// The rows of a sweep, and the file that keeps them while it runs.
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/sweep.h"
#include "base/result.h"
#include "report/grid.h"
#include "report/trial.h"

namespace aspic::report {

RunRow row_of(const TrialResult& result);

/// The header line with its line end: run, the keys, the figures, and last the seconds, the one column that
/// is not the same each time.
std::string sweep_header(const Grid& grid);
/// The row of a run with its line end.
std::string sweep_row(const Grid& grid, std::size_t index, const RunRow& row);

/// Finished rows of a sweep that is not complete, in FILE.partial: a line that says whose they are, then rows
/// in the order of finishing. A row is appended by one write; an incomplete one, left by a kill, is dropped.
class SweepJournal {
 public:
  /// Opens the journal next to the output `path`, or creates it, and reads its rows. `owner` is one line that
  /// says which sweep it is, of the runs of `grid`. Errors: usage, it belongs to another sweep; io, another
  /// process is at it, it is damaged, or its place cannot be written.
  static Result<SweepJournal> open(const std::string& path, const std::string& owner, const Grid& grid);
  SweepJournal(SweepJournal&& other) noexcept;
  SweepJournal& operator=(SweepJournal&&) = delete;
  ~SweepJournal();

  /// Rows by run.
  const std::map<std::size_t, std::string>& rows() const { return rows_; }
  /// Keeps a row. Error (io): then the journal is as before.
  Status add(std::size_t index, const std::string& row);
  /// Removes the file: the sweep is complete.
  void remove();

 private:
  SweepJournal() = default;
  Status read(const std::string& owner, const Grid& grid);

  std::string path_;
  int descriptor_ = -1;
  std::map<std::size_t, std::string> rows_;
};

/// FILE.partial.
std::string journal_path(const std::string& path);

}  // namespace aspic::report
