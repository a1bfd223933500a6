#include <fmt/format.h>

#include "aspic/scene.h"
#include "base/shell_word.h"
#include "cli/commands.h"
#include "cli/json.h"
#include "io/program.h"
#include "report/report.h"

namespace aspic::cli {
Status execute(const ReportOptions& options) {
  const InterruptGuard interrupt;
  report::ReportPlan plan;
  ASPIC_TRY(plan.scene, load_scene(options.scene, options.overrides, by_set));
  plan.scene_words = shell_word(options.scene);
  for (const std::string& assignment : options.overrides)
    plan.scene_words += fmt::format(" --set {}", shell_word(assignment));
  plan.out = options.out;
  plan.only = options.only;
  plan.thorough = options.thorough;
  plan.force = options.force;
  plan.jobs = options.jobs;
  ASPIC_TRY(const auto summary, report::write_report(std::move(plan), interrupt));
  if (!summary.no_pictures.empty()) print_warning("no pictures: " + summary.no_pictures);
  if (!summary.no_pdf.empty()) print_message("no PDF: " + summary.no_pdf);
  if (options.json) {
    return print_data(to_text({{"files", summary.files},
                               {"data_files", summary.data_files},
                               {"no_pdf", or_null(summary.no_pdf)},
                               {"no_pictures", or_null(summary.no_pictures)}}));
  }
  std::string text;
  for (const std::string& file : summary.files) text += fmt::format("wrote        {}\n", file);
  return print_text(text + fmt::format("with         {} figures and CSV files\n", summary.data_files));
}

}  // namespace aspic::cli
