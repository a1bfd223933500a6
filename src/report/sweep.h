#pragma once
// A sweep: the runs of a grid in separate processes, their rows in one file, or each in a separate one.
#include <cstddef>
#include <string>
#include <vector>

#include "base/result.h"
#include "io/program.h"
#include "report/grid.h"

namespace aspic::report {

/// Part i of n of a grid: consecutive runs, as many as in the other parts or one more.
struct Part {
  std::size_t i = 1, n = 1;  ///< 1 ≤ i ≤ n

  std::size_t first(std::size_t runs) const { return runs * (i - 1) / n; }
  std::size_t end(std::size_t runs) const { return runs * i / n; }
};

struct SweepPlan {
  Grid grid;
  Part part;
  unsigned jobs = 0;  ///< processes; 0: as many as there are processors, or one where runs take a device
  std::string out;    ///< the CSV file; empty: none
  std::string runs;   ///< the folder that keeps each finished run; empty: the journal of `out` does
  bool force = false;
  std::string description;           ///< what the journal says of it: the command and its version
  std::vector<std::string> command;  ///< that starts a worker: a program which calls serve_sweep()

  std::size_t first() const { return part.first(grid.size()); }  ///< of the part's runs
  std::size_t end() const { return part.end(grid.size()); }      ///< after them
};

/// Numbers of rows by outcome.
struct SweepCounts {
  std::size_t ok = 0, diverged = 0, rejected = 0, failed = 0, resumed = 0;  ///< resumed: of all these
  std::string first_reason;  ///< of the first run that was rejected or failed; empty: none was
};

/// Runs what the journal of `out`, or the folder, lacks, and then writes `out`, its rows in the grid's order.
/// Errors: those of journal, folder and output; io, a worker cannot be started; interrupted, with journal or
/// folder left to be continued.
Result<SweepCounts> run_sweep(const SweepPlan& plan, const InterruptGuard& interrupt);

/// A worker: reads runs from standard input, writes rows to standard output, until the input ends, and keeps
/// each run in the folder `runs` unless that is empty. It ends with its parent. Errors: usage, the grid is
/// another than the parent's; those of the folder.
Status serve_sweep(const Grid& grid, const std::string& runs);

}  // namespace aspic::report
