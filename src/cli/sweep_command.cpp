#include <fmt/format.h>

#include "aspic/scene.h"
#include "aspic/version.h"
#include "base/printable.h"
#include "cli/commands.h"
#include "cli/json.h"
#include "io/program.h"
#include "report/sweep.h"

namespace aspic::cli {

Status execute(const SweepOptions& options) {
  ASPIC_TRY(auto scene, load_scene(options.scene, options.overrides, by_set));
  ASPIC_TRY(auto grid, report::make_grid(std::move(scene), options.backend, options.length, options.vary));
  if (options.worker) return report::serve_sweep(grid, options.runs);

  const InterruptGuard interrupt;
  report::SweepPlan plan;
  plan.part = {static_cast<std::size_t>(options.part), static_cast<std::size_t>(options.parts)};
  plan.jobs = options.jobs;
  plan.out = options.out;
  plan.runs = options.runs;
  plan.force = options.force;
  plan.description = fmt::format("{} --vary {} by aspic {}", options.scene,
                                 fmt::join(options.vary, " --vary "), ASPIC_VERSION);
  plan.command = {"/proc/self/exe", "sweep"};
  plan.command.insert(plan.command.end(), options.words.begin(), options.words.end());
  plan.command.emplace_back("--worker");
  plan.grid = std::move(grid);
  ASPIC_TRY(const auto counts, report::run_sweep(plan, interrupt));
  if (!counts.first_reason.empty()) print_warning(counts.first_reason);
  if (options.json) {
    return print_data(to_text({{"scene", plan.grid.scene.name},
                               {"grid", plan.grid.identity()},
                               {"runs", plan.grid.size()},
                               {"ok", counts.ok},
                               {"diverged", counts.diverged},
                               {"rejected", counts.rejected},
                               {"failed", counts.failed},
                               {"resumed", counts.resumed},
                               {"file", or_null(options.out)},
                               {"folder", or_null(options.runs)}}));
  }
  std::string text =
      fmt::format("runs         {} ok, {} diverged, {} rejected, {} failed{}\n", counts.ok, counts.diverged,
                  counts.rejected, counts.failed,
                  counts.resumed > 0 ? fmt::format("; {} of them before", counts.resumed) : "");
  for (const std::string& place : {options.runs, options.out})
    if (!place.empty()) text += fmt::format("wrote        {}\n", printable_line(place));
  return print_text(text);
}

}  // namespace aspic::cli
