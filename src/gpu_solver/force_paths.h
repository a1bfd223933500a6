#pragma once
// The table of force paths: how spring forces reach particles. Every path gives the same bits
// (docs/architecture.md).
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "base/result.h"
#include "model/incident_springs.h"

namespace aspic {

enum class ForcePath {
  automatic,   ///< the first of the table
  gather,      ///< one invocation per particle evaluates its springs, everything fused
  per_spring,  ///< one invocation per spring writes its force, a second pass sums
  lattice      ///< gather on a cube without connectivity in memory; not built yet
};

/// A force path.
struct ForcePathRow {
  ForcePath path;
  std::string_view name;  ///< word of --force-path and of reports
  bool built = true;      ///< false: the word is known and refused
  bool implicit = false;  ///< the kernels of implicit Euler take this path too
  IncidentWords words = IncidentWords::neighbours;
  std::string_view spring_kernel = {};    ///< one invocation per spring, first in a stage; empty: none
  std::string_view spring_title = {};     ///< of that pass, in profiles
  std::string_view particle_kernel = {};  ///< one invocation per particle, to the end of the stage
  std::string_view particle_title = {};
  std::uint64_t spring_bytes = 0;  ///< device memory that a spring takes
};

/// All paths, those that are built first; the first is the fastest.
std::span<const ForcePathRow> force_paths();
std::span<const ForcePathRow> built_force_paths();

/// The row of a path; of automatic, the first.
const ForcePathRow& row_of(ForcePath path);
/// "auto", or the row's name.
std::string_view name_of(ForcePath path);
/// "auto, gather, per-spring, lattice".
std::string force_path_words();
/// Names of the built paths, joined by `between`, of those alone that implicit Euler takes, if so asked.
std::string built_path_words(std::string_view between, bool implicit_alone = false);

/// Error (scene_rejected): the path is not built yet.
Status check_built(ForcePath path);
/// Whether the path computes with this integrator; automatic always does.
bool works_with(ForcePath path, Integrator integrator);

}  // namespace aspic
