#pragma once
// The run's state, energies and checkpoints as files.
#include <string>

#include "app/messages.h"
#include "app/scene_editor.h"
#include "app/simulation.h"
#include "io/state_sink.h"

namespace aspic::app {

struct StateFiles {
  const SceneEditor& editor;
  Simulation& simulation;
  Messages& messages;

  /// Writes the state now, or with a format over time the energies of the plot, to a new file (empty: a free
  /// name). A message says what became of it.
  void save(const StateFormat& format, std::string path) const;
};

}  // namespace aspic::app
