#include "io/series_csv.h"

#include <fmt/format.h>

#include "io/state_sink.h"

namespace aspic {

Result<SeriesWriter> SeriesWriter::create(const std::string& path, Overwrite overwrite, bool solves) {
  ASPIC_TRY(auto file, AtomicFile::create(path, overwrite));
  return SeriesWriter(std::move(file), solves);
}

Status SeriesWriter::write_header(const Measures& first, bool work) {
  has_contact_ = first.contact.has_value();
  has_work_ = work;
  return file_.write(
      fmt::format("{}{}{}{}{}\n", series_csv_header, has_solves_ ? series_csv_solve_header : "",
                  has_contact_ ? series_csv_contact_header : "", work ? series_csv_work_header : "",
                  first.drag_power ? series_csv_drag_header : ""));
}

Status SeriesWriter::finish() {
  if (!has_row_) ASPIC_CHECK(write_header({}, false));
  return file_.commit();
}

Status SeriesWriter::add(const Sample& sample) {
  const std::uint64_t step = sample.state.step;
  if (has_row_ && last_step_ == step) return {};
  const double time = static_cast<double>(step) * sample.model.simulation.timestep;
  const Inputs& inputs = inputs_of(sample);
  if (!meter_) meter_.emplace(sample.model);
  return add(step, time, meter_->measure(sample.state, inputs), sample.solves,
             work_.add(sample.model, sample.state, inputs));
}

Status SeriesWriter::add(std::uint64_t step, double time, const Measures& m, const SolveStatistics& solves,
                         std::optional<double> work) {
  if (const auto bad = first_not_finite(m)) {
    return fail(ErrorCode::diverged, "{}: {} of step {} is not a finite number.", file_.path(), *bad, step);
  }
  if (!has_row_) ASPIC_CHECK(write_header(m, work.has_value()));
  if (m.drag_power)
    dissipated_ +=
        0.5 * (drag_power_.value_or(*m.drag_power) + *m.drag_power) * (has_row_ ? time - last_time_ : 0.0);
  drag_power_ = m.drag_power;
  last_time_ = time;
  has_row_ = true;
  last_step_ = step;
  last_work_ = work;
  std::string row =
      fmt::format("{},{},{},{},{},{},{},{},{},{},{}", step, time, m.kinetic, m.elastic, m.gravitational,
                  m.total(), m.momentum.x, m.momentum.y, m.momentum.z, m.max_speed, m.min_height);
  if (has_solves_) {
    row += fmt::format(",{},{},{},{},{},{}", solves.newton_iterations - before_.newton_iterations,
                       solves.cg_iterations - before_.cg_iterations, solves.last.residual,
                       solves.converged - before_.converged, solves.stagnated - before_.stagnated,
                       solves.not_converged - before_.not_converged);
    before_ = solves;
  }
  if (has_contact_) row += fmt::format(",{}", m.contact.value_or(0.0));
  if (has_work_) row += fmt::format(",{}", work.value_or(0.0));
  if (drag_power_) row += fmt::format(",{}", dissipated_);
  return file_.write(row + "\n");
}

}  // namespace aspic
