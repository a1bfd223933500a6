#include "verify/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "base/printable.h"
#include "cpu_reference/reference_solver.h"
#include "run/window_host.h"
#include "scene/diagnostics.h"

namespace aspic::verify {

Subject product(gl::Context* context, std::string program) {
  Subject subject;
  subject.reference = [](const Model& model, Precision precision) {
    return make_reference_solver(model, precision);
  };
  subject.other = [context](const Model& model,
                            const BackendChoice& choice) -> Result<std::unique_ptr<Solver>> {
    SolverHost host;
    host.context = context;
    ASPIC_TRY(auto backend, make_backend(choice, model, host));
    return std::move(backend.solver);
  };
  if (context != nullptr) {
    subject.gpu = [context](const Model& model, const GpuOptions& options) {
      return make_gpu_solver(*context, model, options);
    };
    subject.software_device = context->info().is_software;
  }
  subject.program = std::move(program);
  return subject;
}

std::vector<Check> battery() {
  std::vector<Check> checks;
  for (AddChecks* const add :
       {add_order_checks, add_closed_form_checks, add_stability_checks, add_conservation_checks,
        add_force_checks, add_contact_checks, add_coulomb_checks, add_rest_checks, add_scene_checks,
        add_implicit_checks, add_body_checks, add_voxel_checks, add_actuation_checks, add_ball_checks,
        add_body_contact_checks, add_contact_impact_checks, add_ball_face_checks, add_equality_checks,
        add_fast_checks})
    add(checks);
  return checks;
}

Result<std::vector<Check>> select(std::vector<Check> checks, std::span<const std::string> names, bool quick) {
  const auto meant = [](const Check& check, const std::string& name) {
    return check.name == name || check.name.starts_with(name + "/");
  };
  for (const std::string& name : names) {
    if (std::any_of(checks.begin(), checks.end(), [&](const Check& c) { return meant(c, name); })) continue;
    std::vector<std::string_view> known;
    for (const Check& one : checks) {
      const std::string_view check = one.name;
      for (std::size_t slash = check.find('/'); slash != std::string_view::npos;
           slash = check.find('/', slash + 1))
        known.push_back(check.substr(0, slash));
      known.push_back(check);
    }
    const std::string_view near = diagnostics::nearest(name, known);
    return fail(
        ErrorCode::usage,
        "no check is called \"{}\"{} A name selects itself and everything below it; aspic verify --list "
        "prints all names.",
        printable_line(name), near.empty() ? "." : diagnostics::did_you_mean(near));
  }
  std::erase_if(checks, [&](const Check& check) {
    const bool named = names.empty() || std::any_of(names.begin(), names.end(), [&](const std::string& name) {
                         return meant(check, name);
                       });
    return !named || (quick && !check.quick);
  });
  if (checks.empty()) {
    return Error{ErrorCode::usage, "none of the checks named is part of --quick: leave --quick out."};
  }
  return checks;
}

Row evaluate(const Check& check, const Subject& subject) {
  Row row{check.name, check.claim, check.bound, "", Verdict::failed, 0.0};
  if (check.needs_gpu && !subject.gpu) {
    row.verdict = Verdict::not_run;
    row.measured = "not run: no device";
    return row;
  }
  const auto started = std::chrono::steady_clock::now();
  const auto finding = check.run(subject);
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  row.measured = finding ? finding->measured : worded(finding.error(), FrontEnd::command_line);
  if (finding && finding->passed) row.verdict = Verdict::passed;
  return row;
}

std::vector<Row> evaluate_all(const std::vector<Check>& checks, const Subject& subject,
                              const std::function<void(std::size_t)>& finished,
                              const std::function<bool()>& stopped) {
  std::vector<std::optional<Row>> rows(checks.size());
  std::mutex mutex;
  std::size_t done = 0;
  const auto run = [&](bool on_device) {
    for (std::size_t i = 0; i < checks.size(); ++i) {
      if (checks[i].needs_gpu != on_device) continue;
      if (stopped()) return;
      Row row = evaluate(checks[i], subject);
      // What was stopped, processes that it started among it, says nothing.
      if (stopped()) return;
      rows[i] = std::move(row);
      const std::lock_guard lock(mutex);
      finished(++done);
    }
  };
  std::thread without_device([&] { run(false); });
  run(true);  // the context is current on this thread
  without_device.join();
  std::vector<Row> done_rows;
  for (std::optional<Row>& row : rows)
    if (row) done_rows.push_back(std::move(*row));
  return done_rows;
}

Finding at_most(double figure, double bound, std::string_view unit) {
  return {figure <= bound, fmt::format("{:.3g}{}{}", figure, unit.empty() ? "" : " ", unit)};
}

std::string at_most_text(double bound, std::string_view unit) {
  return fmt::format("≤ {:.3g}{}{}", bound, unit.empty() ? "" : " ", unit);
}

}  // namespace aspic::verify
