// The part of App that writes states to files.
#include <fmt/format.h>

#include "app/app.h"
#include "io/series_csv.h"
#include "run/outputs.h"
#include "scene/write.h"

namespace aspic::app {
namespace {

/// The energies of the plot as a table.
Status write_series(const std::string& path, const std::deque<EnergySample>& samples) {
  auto series = SeriesWriter::create(path, Overwrite::refuse);
  if (!series) return series.error();
  for (const EnergySample& sample : samples) {
    ASPIC_CHECK(series->add(sample.step, sample.time, sample.measures));
  }
  return series->finish();
}

/// The state at hand in one file.
Status write_state(const StateFormat& format, const std::string& path, const Scene& scene,
                   const Simulation& simulation) {
  const RunFacts facts = {to_toml(scene), scene.model.simulation.integrator};
  auto sink = format.open(path, 0, Overwrite::refuse, facts);
  if (!sink) return sink.error();
  return (*sink)->finish({simulation.model(), simulation.snapshot()});
}

}  // namespace

void App::save_output(const StateFormat& format, std::string path) {
  if (path.empty()) path = free_name(editor_.source(), format.ending);
  if (const Status settled = simulation_->settle(); !settled) return tell(settled);
  const Setup& setup = simulation_->setup();
  if (format.holds_scene && !(setup.thrown.empty() && setup.pinned.empty())) {
    return tell(
        fmt::format(
            "A {} holds the scene and the state, and balls thrown or particles pinned by hand are not "
            "part of the scene. Remove them first (Balls, or Reset), or save the state alone.",
            format.option),
        true);
  }
  Scene scene = editor_.scene();
  scene.model = setup.settings;
  const Status written = format.over_time ? write_series(path, simulation_->energies())
                                          : write_state(format, path, scene, *simulation_);
  if (!written) return tell(written);
  tell(format.over_time
           ? fmt::format("{} holds {} rows.", path, simulation_->energies().size())
           : fmt::format("{} holds the {} at step {}.", path, format.option, simulation_->snapshot().step));
}

}  // namespace aspic::app
