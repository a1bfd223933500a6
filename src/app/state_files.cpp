#include "app/state_files.h"

#include <fmt/format.h>

#include "io/series_csv.h"
#include "run/run_files.h"
#include "scene/write.h"

namespace aspic::app {
namespace {

/// The energies of the plot as a table.
Status write_series(const std::string& path, const std::deque<EnergySample>& samples) {
  ASPIC_TRY(auto series, SeriesWriter::create(path, Overwrite::refuse));
  for (const EnergySample& sample : samples) {
    ASPIC_CHECK(series.add(sample.step, sample.time, sample.measures));
  }
  return series.finish();
}

Status write_state(const StateFormat& format, const std::string& path, Scene scene,
                   const Simulation& simulation) {
  scene.model = simulation.setup().settings;
  const RunFacts facts = {to_toml(scene), scene.model.simulation.integrator};
  ASPIC_TRY(auto sink, format.open(path, 0, Overwrite::refuse, facts));
  return sink->finish({simulation.model(), simulation.snapshot()});
}

}  // namespace

void StateFiles::save(const StateFormat& format, std::string path) const {
  if (path.empty()) path = free_name(editor.source(), format.ending);
  if (!messages.check(simulation.settle())) return;
  const Setup& setup = simulation.setup();
  if (format.holds_scene && !(setup.thrown.empty() && setup.pinned.empty())) {
    return messages.error(
        fmt::format("A {} holds the scene and the state, and balls thrown or particles pinned by hand are "
                    "not part of the scene. Remove them first (Balls, or Reset), or save the state alone.",
                    format.option));
  }
  const auto& energies = simulation.samples().energies();
  if (!messages.check(format.over_time ? write_series(path, energies)
                                       : write_state(format, path, editor.scene(), simulation)))
    return;
  messages.info(format.over_time ? fmt::format("{} holds {} rows.", path, energies.size())
                                 : fmt::format("{} holds the {} at step {}.", path, format.option,
                                               simulation.snapshot().step));
}

}  // namespace aspic::app
