#include "gpu_solver/force_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "device/device_state.h"
#include "gpu_solver/device_solver.h"
#include "gpu_solver/layout.h"

namespace aspic {
namespace {

constexpr ForcePathRow table[] = {
    {.path = ForcePath::lattice,
     .name = "lattice",
     .implicit = true,
     .words = IncidentWords::beside_cells,
     .lattice_kernel = "compute/lattice.comp",
     .lattice_title = "cubes: springs, integration, contact",
     .cell_kernel = "compute/cells.comp",
     .cell_title = "cells: springs, integration, contact",
     .particle_kernel = "compute/gather.comp",
     .particle_title = "springs, integration, contact"},
    {.path = ForcePath::gather,
     .name = "gather",
     .implicit = true,
     .particle_kernel = "compute/gather.comp",
     .particle_title = "springs, integration, contact"},
    {.path = ForcePath::per_spring,
     .name = "per-spring",
     .words = IncidentWords::springs,
     .spring_kernel = "compute/spring_forces.comp",
     .spring_title = "spring forces",
     .particle_kernel = "compute/sum_springs.comp",
     .particle_title = "sums, integration, contact",
     .spring_bytes = sizeof(layout::vec4)},
};

const ForcePathRow& row_of(ForcePath path) {
  return *std::ranges::find(table, path, &ForcePathRow::path);
}

}  // namespace

std::span<const ForcePathRow> force_paths() {
  return table;
}

const ForcePathRow& row_of(ForcePath path, const Model& model) {
  if (path != ForcePath::automatic) return row_of(path);
  return row_of(has_lattices(model) || has_cells(model) ? ForcePath::lattice : ForcePath::gather);
}

std::string_view name_of(ForcePath path) {
  return path == ForcePath::automatic ? "auto" : row_of(path).name;
}

std::string force_path_words() {
  std::string words = "auto";
  for (const ForcePathRow& row : table) words += fmt::format(", {}", row.name);
  return words;
}

std::string force_path_words(Integrator integrator, std::string_view between) {
  std::vector<std::string_view> names;
  for (const ForcePathRow& row : table)
    if (works_with(row.path, integrator)) names.push_back(row.name);
  return fmt::format("{}", fmt::join(names, between));
}

bool works_with(ForcePath path, Integrator integrator) {
  return path == ForcePath::automatic || device_method(integrator, 1).takes(row_of(path));
}

}  // namespace aspic
