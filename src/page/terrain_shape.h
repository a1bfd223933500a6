#pragma once
// The surfaces of terrain that has more to it than a plane, as a page draws them: whatever the shape, by its
// row of the table.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "model/terrain.h"

namespace aspic::page {

/// How many points the surface has, its quantum, and the square of its flat part in which something is left
/// out. The shape has a surface.
nlohmann::ordered_json surface_facts(const Terrain& terrain);

/// Appends the surface's points (differences, all x, all y, all z, in quanta from the terrain's place) and,
/// where there is a flat part, the distances of the square's points from the surface, in 64ths of the
/// square's mesh, at most ±127: those above 0 are left out.
void append_surface(const Terrain& terrain, std::string& bytes);

}  // namespace aspic::page
