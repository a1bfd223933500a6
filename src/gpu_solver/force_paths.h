#pragma once
// The table of force paths: how spring forces reach particles. Every path gives the same bits
// (docs/extending.md, "Add a force path").
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "aspic/solver.h"
#include "model/incident_springs.h"
#include "model/integrator.h"

namespace aspic {

/// A force path.
struct ForcePathRow {
  ForcePath path;
  std::string_view name;  ///< word of --force-path and of reports
  bool implicit = false;  ///< the kernels of implicit Euler take this path too
  IncidentWords words =
      IncidentWords::neighbors;          ///< of a model and a method that go with them: incident_words()
  std::string_view spring_kernel = {};   ///< one invocation per spring, first in a stage; empty: none
  std::string_view spring_title = {};    ///< of that pass, in profiles
  std::string_view lattice_kernel = {};  ///< complete cubes, to the end of the stage; empty: as all else
  std::string_view lattice_title = {};
  std::string_view cell_kernel = {};  ///< bodies of cells by blocks, likewise
  std::string_view cell_title = {};
  std::string_view particle_kernel = {};  ///< one invocation per particle, to the end of the stage
  std::string_view particle_title = {};
  std::uint64_t spring_bytes = 0;  ///< device memory that a spring takes in addition to SpringBuffers
};

/// All paths, the fastest first.
std::span<const ForcePathRow> force_paths();

/// The row that a model takes.
const ForcePathRow& row_of(ForcePath path, const Model& model);
/// "auto", or the row's name.
std::string_view name_of(ForcePath path);
/// "auto, lattice, gather, per-spring".
std::string force_path_words();
/// Names of the paths that compute with this integrator, joined by `between`.
std::string force_path_words(Integrator integrator, std::string_view between);

/// Whether the path computes with this integrator; automatic always does.
bool works_with(ForcePath path, Integrator integrator);

}  // namespace aspic
