#include "gpu_solver/force_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "gpu_solver/layout.h"

namespace aspic {
namespace {

constexpr std::uint64_t incident_bytes = 2 * sizeof(std::uint32_t);

constexpr ForcePathRow table[] = {
    {.path = ForcePath::gather,
     .name = "gather",
     .implicit = true,
     .particle_kernel = "compute/gather.comp",
     .particle_title = "springs, integration, contact",
     .spring_bytes = incident_bytes},
    {.path = ForcePath::per_spring,
     .name = "per-spring",
     .words = IncidentWords::springs,
     .spring_kernel = "compute/spring_forces.comp",
     .spring_title = "spring forces",
     .particle_kernel = "compute/sum_springs.comp",
     .particle_title = "sums, integration, contact",
     .spring_bytes = incident_bytes + sizeof(layout::uvec2) + sizeof(layout::vec4)},
    {.path = ForcePath::lattice, .name = "lattice", .built = false},
};

}  // namespace

std::span<const ForcePathRow> force_paths() {
  return table;
}

std::span<const ForcePathRow> built_force_paths() {
  const auto* const end = std::ranges::find(table, false, &ForcePathRow::built);
  return {std::begin(table), end};
}

const ForcePathRow& row_of(ForcePath path) {
  const auto* const found = std::ranges::find(table, path, &ForcePathRow::path);
  return found == std::end(table) ? table[0] : *found;
}

std::string_view name_of(ForcePath path) {
  return path == ForcePath::automatic ? "auto" : row_of(path).name;
}

std::string force_path_words() {
  std::string words = "auto";
  for (const ForcePathRow& row : table) words += fmt::format(", {}", row.name);
  return words;
}

std::string built_path_words(std::string_view between, bool implicit_alone) {
  std::vector<std::string_view> names;
  for (const ForcePathRow& row : built_force_paths())
    if (row.implicit || !implicit_alone) names.push_back(row.name);
  return fmt::format("{}", fmt::join(names, between));
}

Status check_built(ForcePath path) {
  if (row_of(path).built) return {};
  return fail(ErrorCode::scene_rejected, "the force path {} is not built yet; use {}.", name_of(path),
              built_path_words(" or "));
}

bool works_with(ForcePath path, Integrator integrator) {
  return !aspic::row_of(integrator).solved() || row_of(path).implicit;
}

}  // namespace aspic
