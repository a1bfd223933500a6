#pragma once
// `aspic report`: a scene's methods and parameters compared, as pages and data.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "io/program.h"
#include "report/study.h"

namespace aspic::report {

/// The sections, in the order of the page.
std::span<const SectionRow> sections();

struct ReportPlan {
  Scene scene;
  std::string scene_words;        ///< the scene as commands name it
  std::string out;                ///< directory; made if its parent exists
  std::vector<std::string> only;  ///< names of sections; empty: all
  std::string outline;            ///< name of one (report/outline.h); empty: the report's own order
  bool thorough = false;
  bool force = false;
  unsigned jobs = 0;     ///< threads; 0: one for each processor
  bool coarser = false;  ///< set by write_report(): its cubes were made coarser
};

struct ReportSummary {
  std::vector<std::string> files;  ///< the pages, in the order of report.html, report.md, report.pdf
  std::size_t data_files = 0;
  std::string no_pdf, no_images;          ///< why there is none; empty: there is
  std::optional<std::size_t> pages;       ///< of the PDF, where it can be counted
  std::optional<std::size_t> most_pages;  ///< that the outline allows; absent: no limit
};

/// Measures and writes. Errors: usage, no such section or outline, or both are given; io, the directory holds
/// a report and `force` is not given, or cannot be written; interrupted; those of solvers.
Result<ReportSummary> write_report(ReportPlan plan, const InterruptGuard& interrupt);

}  // namespace aspic::report
