#include "io/series_csv.h"

#include <fmt/format.h>

#include <cmath>

namespace aspic {

Result<SeriesWriter> SeriesWriter::create(const std::string& path, Overwrite overwrite) {
  auto file = AtomicFile::create(path, overwrite);
  if (!file) return file.error();
  if (const Status header = file->write(fmt::format("{}\n", series_csv_header)); !header)
    return header.error();
  return SeriesWriter(std::move(*file));
}

Status SeriesWriter::add(const Model& model, const State& state) {
  if (has_row_ && last_step_ == state.step) return {};
  const Measures m = measure(model, state);
  // Every figure is a sum or an extreme of finite terms, so one test of the sum of all finds a NaN or
  // infinity in any.
  if (!std::isfinite(m.total() + m.momentum.x + m.momentum.y + m.momentum.z + m.max_speed + m.min_height)) {
    return Error{ErrorCode::diverged,
                 fmt::format("{}: step {} is not a finite number.", file_.path(), state.step)};
  }
  const double time = static_cast<double>(state.step) * model.simulation.timestep;
  has_row_ = true;
  last_step_ = state.step;
  return file_.write(fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", state.step, time, m.kinetic, m.elastic,
                                 m.gravitational, m.total(), m.momentum.x, m.momentum.y, m.momentum.z,
                                 m.max_speed, m.min_height));
}

}  // namespace aspic
