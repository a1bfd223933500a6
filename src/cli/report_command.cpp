#include <fmt/format.h>

#include "aspic/scene.h"
#include "base/shell_word.h"
#include "cli/commands.h"
#include "cli/json.h"
#include "io/program.h"
#include "report/report.h"

namespace aspic::cli {
namespace {

/// "9 pages of at most 10"
std::string pages_text(const report::ReportSummary& summary) {
  std::string text = fmt::format("{} page{}", *summary.pages, *summary.pages == 1 ? "" : "s");
  if (summary.most_pages) text += fmt::format(" of at most {}", *summary.most_pages);
  return text;
}

}  // namespace

Status execute(const ReportOptions& options) {
  const InterruptGuard interrupt;
  report::ReportPlan plan;
  ASPIC_TRY(plan.scene, load_scene(options.scene, options.overrides, by_set));
  plan.scene_words = shell_word(options.scene);
  for (const std::string& assignment : options.overrides)
    plan.scene_words += fmt::format(" --set {}", shell_word(assignment));
  plan.out = options.out;
  plan.only = options.only;
  plan.outline = options.outline;
  plan.thorough = options.thorough;
  plan.force = options.force;
  plan.jobs = options.jobs;
  ASPIC_TRY(const auto summary, report::write_report(std::move(plan), interrupt));
  if (!summary.no_images.empty()) print_warning("no images: " + summary.no_images);
  if (!summary.no_pdf.empty()) print_message("no PDF: " + summary.no_pdf);
  if (summary.pages && summary.most_pages && *summary.pages > *summary.most_pages)
    print_warning(fmt::format("report.pdf has {} pages; the course accepts at most {}.", *summary.pages,
                              *summary.most_pages));
  if (options.json) {
    return print_data(to_text({{"files", summary.files},
                               {"data_files", summary.data_files},
                               {"pages", summary.pages ? Json(*summary.pages) : Json()},
                               {"no_pdf", or_null(summary.no_pdf)},
                               {"no_images", or_null(summary.no_images)}}));
  }
  std::string text;
  for (const std::string& file : summary.files) {
    text += fmt::format("wrote        {}", file);
    if (file.ends_with(".pdf") && summary.pages) text += fmt::format(", {}", pages_text(summary));
    text += '\n';
  }
  return print_text(text + fmt::format("with         {} figures and CSV files\n", summary.data_files));
}

}  // namespace aspic::cli
