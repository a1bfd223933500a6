#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "aspic/version.h"
#include "base/printable.h"
#include "cli/commands.h"
#include "cli/json.h"
#include "gpu/context.h"
#include "io/program.h"
#include "verify/check.h"

namespace aspic::cli {
namespace {

using verify::Row;
using verify::Verdict;

std::string_view name_of(Verdict verdict) {
  return verdict == Verdict::passed ? "pass" : verdict == Verdict::failed ? "FAIL" : "not run";
}

std::size_t count(const std::vector<Row>& rows, Verdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [&](const Row& row) { return row.verdict == verdict; }));
}

/// A line per claim, with its rows below: a claim that holds for every integrator is said once.
std::string table(const std::vector<Row>& rows, const std::string& device, double seconds) {
  std::size_t names = 0, bounds = 0;
  for (const Row& row : rows) {
    names = std::max(names, character_count(row.name));
    bounds = std::max(bounds, character_count(row.bound));
  }
  std::string text = fmt::format("device: {}\n", device);
  const Row* before = nullptr;
  for (const Row& row : rows) {
    if (before == nullptr || before->claim != row.claim) text += fmt::format("\n{}\n", row.claim);
    text += fmt::format("  {:<7}  {:<{}}  {:<{}}  {}  ({:.1f} s)\n", name_of(row.verdict), row.name, names,
                        row.bound, bounds, row.measured, row.seconds);
    before = &row;
  }
  return text + fmt::format("\n{} passed, {} failed, {} not run, in {:.0f} s\n", count(rows, Verdict::passed),
                            count(rows, Verdict::failed), count(rows, Verdict::not_run), seconds);
}

Status print_rows(const VerifyOptions& options, const std::vector<Row>& rows, const std::string& device,
                  double seconds) {
  if (!options.json) return print_text(table(rows, device, seconds));
  Json array = Json::array();
  for (const Row& row : rows) {
    array.push_back({{"name", row.name},
                     {"claim", row.claim},
                     {"bound", row.bound},
                     {"measured", row.measured},
                     {"verdict", row.verdict == Verdict::failed ? "fail" : name_of(row.verdict)},
                     {"seconds", row.seconds}});
  }
  return print_data(to_text({{"version", ASPIC_VERSION},
                             {"device", device},
                             {"passed", count(rows, Verdict::passed)},
                             {"failed", count(rows, Verdict::failed)},
                             {"not_run", count(rows, Verdict::not_run)},
                             {"seconds", seconds},
                             {"rows", array}}));
}

Status print_names(const VerifyOptions& options, const std::vector<verify::Check>& checks) {
  std::size_t names = 0;
  for (const verify::Check& check : checks) names = std::max(names, check.name.size());
  std::string text;
  Json array = Json::array();
  for (const verify::Check& check : checks) {
    text += fmt::format("{:<{}}  {}\n", check.name, names, check.claim);
    array.push_back({{"name", check.name}, {"claim", check.claim}, {"quick", check.quick}});
  }
  return options.json ? print_data(to_text(array)) : print_text(text);
}

}  // namespace

Status execute(const VerifyOptions& options) {
  ASPIC_TRY(const auto checks, verify::select(verify::battery(), options.only, options.quick));
  if (options.list) return print_names(options, checks);

  std::shared_ptr<gl::Context> context;
  std::string device = "none";
  const bool wanted =
      std::any_of(checks.begin(), checks.end(), [](const verify::Check& check) { return check.needs_gpu; });
  if (wanted) {
    auto made = gl::Context::create_headless();
    if (made) {
      context = std::move(*made);
      device = context->info().renderer;
    } else {
      print_warning("no usable GL device; checks that need one are skipped. " +
                    worded(made.error(), FrontEnd::command_line));
    }
  } else {
    device = "none needed";
  }
  std::error_code unreadable;
  const std::string program = std::filesystem::read_symlink("/proc/self/exe", unreadable).string();
  const verify::Subject subject = verify::product(context.get(), program);

  const auto started = std::chrono::steady_clock::now();
  const InterruptGuard interrupt;
  std::vector<Row> rows;
  {
    ProgressBar bar(checks.size(), "check");
    rows = verify::evaluate_all(
        checks, subject, [&](std::size_t done) { bar.update(done); },
        [&] { return interrupt.interrupted(); });
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  ASPIC_CHECK(print_rows(options, rows, device, seconds));

  if (rows.size() < checks.size())
    return fail(ErrorCode::interrupted, "interrupted; {} of {} checks were done.", rows.size(),
                checks.size());
  const std::size_t failed = count(rows, Verdict::failed), not_run = count(rows, Verdict::not_run);
  if (failed > 0) return fail(ErrorCode::check_failed, "{} of {} checks failed.", failed, rows.size());
  if (not_run > 0 && options.require_gpu) {
    return fail(ErrorCode::check_failed,
                "{} of {} checks did not run: --require-gpu was given, and there is no GL device.", not_run,
                rows.size());
  }
  return {};
}

}  // namespace aspic::cli
