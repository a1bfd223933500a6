#include "report/report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "aspic/scene.h"
#include "aspic/version.h"
#include "base/files.h"
#include "base/fnv.h"
#include "base/printable.h"
#include "cpu_parallel/workers.h"
#include "io/atomic_file.h"
#include "io/console.h"
#include "io/machine.h"
#include "model/cube.h"
#include "report/outline.h"
#include "report/pdf.h"
#include "scene/diagnostics.h"

namespace aspic::report {
namespace {

namespace fs = std::filesystem;

constexpr SectionRow section_table[] = {
    {"integrators", "Integrators", integrators_section}, {"parameters", "Parameters", parameters_section},
    {"stability", "Stability map", stability_section},   {"contact", "Contact", contact_section},
    {"backends", "Backends", backends_section},
};

Status check_directory(const ReportPlan& plan) {
  std::error_code failed;
  if (fs::exists(plan.out, failed) && !fs::is_directory(plan.out, failed))
    return fail(ErrorCode::io, "{} is a file, and a report needs a directory; give another --out.",
                printable_line(plan.out));
  for (const char* const part : {"", "data", "figures"}) {
    const fs::path directory = fs::path(plan.out) / part;
    fs::create_directory(directory, failed);  // its parent exists, or the name is mistyped
    if (failed) return file_error("make the directory", directory.string(), failed.value());
  }
  if (plan.force) return {};
  for (const char* const page : {"report.html", "report.md", "report.pdf"}) {
    const fs::path file = fs::path(plan.out) / page;
    if (fs::exists(file, failed))
      return fail(ErrorCode::io, "{} exists; give another --out, or --force to overwrite the report.",
                  file.string());
  }
  return {};
}

Status write_file(const fs::path& path, const std::string& content) {
  ASPIC_TRY(auto file, AtomicFile::create(path.string(), Overwrite::allow));
  ASPIC_CHECK(file.write(content));
  return file.commit();
}

std::string hash_of(std::string_view text) {
  Fnv1a hash;
  hash.add_bytes(std::as_bytes(std::span(text)));
  return fmt::format("{:016x}", hash.value());
}

/// Cubes with so many particles per edge at most are studied as they are.
constexpr int most_per_edge = 12;

/// Makes larger cubes coarser, in place. True if there was one.
bool coarsen(Scene& scene) {
  bool coarser = false;
  for (CubeSettings& cube : scene.model.cubes) {
    const int longest = std::ranges::max(cube.lattice());
    coarser = coarser || longest > most_per_edge;
    resize(cube, std::min(longest, most_per_edge));
  }
  return coarser;
}

Result<Page> make_page(const ReportPlan& plan, const Study& study, const std::vector<const SectionRow*>& rows,
                       const OutlineRow* outline) {
  Page page;
  page.title = outline ? fmt::format("Soft body simulation: {}", study.scene.name)
                       : fmt::format("{}: integrators and parameters", study.scene.name);
  page.author = printable_line(study.scene.author.value_or(""));
  page.scene_toml = to_toml(study.scene);
  page.lead =
      outline ? fmt::format(
                    "Measured on this machine by aspic {}. Every figure names the command that measures it "
                    "again and the file with its numbers.",
                    ASPIC_VERSION)
              : fmt::format(
                    "Effects of the integrator, time step and parameters on the scene `{}`, measured on this "
                    "machine by aspic {}. Every figure names the command that measures it again and the file "
                    "with its numbers.",
                    study.scene.name, ASPIC_VERSION);
  if (plan.coarser)
    page.lead += fmt::format(
        " The report uses {} particles per edge, so that hundreds of runs take a minute; --thorough keeps "
        "the scene's own.",
        most_per_edge);
  if (!study.studio) page.lead += fmt::format(" There are no images: {}", study.no_studio);
  const std::time_t now = std::time(nullptr);
  {
    ProgressBar bar(rows.size(), "section");
    ProgressLines lines(rows.size(), "sections");
    for (const SectionRow* row : rows) {
      lines.begin(row->name);
      ASPIC_TRY(auto section, row->make(study));
      page.sections.push_back(std::move(section));
      bar.update(page.sections.size());
      lines.update(page.sections.size());
    }
  }
  if (outline) {
    page.scene_in_file = true;  // a course counts pages
    ASPIC_TRY(page.sections, outline->arrange(study, std::move(page.sections)));
  }
  ASPIC_TRY(const auto model, build_model(study.scene.model));
  ASPIC_TRY(const auto own, study.run(model, study.scene.model.simulation.duration));
  if (study.shortened() > 0)
    page.lead += fmt::format(
        " {} of its runs ended early, each after some seconds of computing; --thorough runs them to their "
        "end.",
        study.shortened());
  ASPIC_TRY(const unsigned processors, parallel::available_threads());
  page.colophon = {
      {"machine",
       fmt::format("{}, {} CPU cores, {}", processor_name().empty() ? "unknown CPU" : processor_name(),
                   processors, human_bytes(memory_bytes()))},
      {"driver", study.studio ? fmt::format("{}, OpenGL {}", study.studio->device().renderer,
                                            study.studio->device().version)
                              : "no OpenGL device"},
      {"version", fmt::format("aspic {}", ASPIC_VERSION)},
      {"date", fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(now))},
      {"command", fmt::format("aspic report {}{}{}{}{}{} --out DIR", plan.scene_words,
                              outline ? " --outline " : "", plan.outline, plan.thorough ? " --thorough" : "",
                              plan.only.empty() ? "" : " --only ", fmt::join(plan.only, " --only "))},
      {"scene", fmt::format("{}, FNV-1a of {} {}", study.scene.name,
                            outline ? "data/scene.toml" : "the text below", hash_of(page.scene_toml))},
      {"state hash", fmt::format("{} after {} steps of the scene as it is, the same on every backend",
                                 own.hash, own.steps)},
  };
  return page;
}

/// Null: the report has its own order.
Result<const OutlineRow*> chosen_outline(const ReportPlan& plan) {
  if (plan.outline.empty()) return nullptr;
  if (!plan.only.empty())
    return Error{ErrorCode::usage,
                 "--only names sections of a report without --outline; leave one of them out."};
  const auto found = std::ranges::find(outlines(), plan.outline, &OutlineRow::name);
  if (found != outlines().end()) return &*found;
  std::vector<std::string_view> names;
  for (const OutlineRow& row : outlines()) names.push_back(row.name);
  return Error{ErrorCode::usage,
               fmt::format("unknown --outline \"{}\"; allowed: {}.", printable_line(plan.outline),
                           diagnostics::list_text(names, false))};
}

Result<std::vector<const SectionRow*>> chosen_sections(const ReportPlan& plan, const OutlineRow* outline) {
  std::vector<const SectionRow*> rows;
  std::vector<std::string_view> names;
  for (const SectionRow& row : sections()) {
    names.push_back(row.name);
    const bool wanted = outline
                            ? std::ranges::find(outline->sections, row.name) != outline->sections.end()
                            : plan.only.empty() || std::ranges::find(plan.only, row.name) != plan.only.end();
    if (wanted) rows.push_back(&row);
  }
  for (const std::string& name : plan.only) {
    if (std::ranges::find(names, name) == names.end())
      return Error{ErrorCode::usage, fmt::format("unknown --only \"{}\"; allowed: {}.", printable_line(name),
                                                 diagnostics::list_text(names, false))};
  }
  return rows;
}

}  // namespace

std::span<const SectionRow> sections() {
  return section_table;
}

Result<ReportSummary> write_report(ReportPlan plan, const InterruptGuard& interrupt) {
  ASPIC_TRY(const auto* const outline, chosen_outline(plan));
  ASPIC_TRY(const auto rows, chosen_sections(plan, outline));
  ASPIC_CHECK(check_directory(plan));
  unsigned jobs = plan.jobs;
  if (jobs == 0) {
    ASPIC_TRY(jobs, parallel::available_threads());
  }
  plan.coarser = !plan.thorough && coarsen(plan.scene);
  Study study(std::move(plan.scene), plan.scene_words, plan.thorough, jobs,
              [&] { return interrupt.interrupted(); });
  auto studio = Studio::open();
  if (studio) {
    study.studio = std::move(*studio);
  } else {
    study.no_studio = worded(studio.error(), FrontEnd::command_line);
  }
  const auto made = make_page(plan, study, rows, outline);
  if (!made && made.error().code == ErrorCode::interrupted)
    return Error{ErrorCode::interrupted,
                 "interrupted before the report was complete; no file of it was written."};
  if (!made) return made.error();
  const Page& page = *made;

  ReportSummary summary;
  summary.no_images = study.no_studio;
  const fs::path out = plan.out;
  for (const auto& [name, content] : files_of(page)) {
    ASPIC_CHECK(write_file(out / name, content));
    ++summary.data_files;
  }
  ASPIC_CHECK(write_file(out / "report.md", markdown_of(page)));
  ASPIC_CHECK(write_file(out / "report.html", html_of(page)));
  summary.files = {(out / "report.html").string(), (out / "report.md").string()};
  const std::string pdf = (out / "report.pdf").string();
  summary.no_pdf = print_pdf((out / "report.html").string(), pdf);
  if (interrupt.interrupted()) {
    std::error_code ignored;
    fs::remove(pdf, ignored);
    return fail(ErrorCode::interrupted, "interrupted while {} was printed; {} and {} are complete.",
                printable_line(pdf), printable_line(summary.files[0]), printable_line(summary.files[1]));
  }
  if (summary.no_pdf.empty()) {
    summary.files.push_back(pdf);
    if (const auto bytes = read_file(pdf, std::uint64_t{1} << 30)) summary.pages = pages_of_pdf(*bytes);
  }
  if (outline) summary.most_pages = outline->most_pages;
  return summary;
}

}  // namespace aspic::report
