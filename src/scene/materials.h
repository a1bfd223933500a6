#pragma once
// Changes of a scene's materials that keep what bodies say of them.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/scene.h"
#include "base/result.h"

namespace aspic {

/// Bodies that are of the material of that name, or have it in their palettes: "cube[0]", "voxels[1]"; and
/// what selects cells by it.
std::vector<std::string> users_of_material(const Scene& scene, std::string_view name);

/// Adds a material with such numbers, under a name that no other has: `wish`, or that with a number. A list
/// in the order of names stays one. Returns the name.
std::string add_material(ModelSettings& settings, const MaterialSettings& numbers, const std::string& wish);

/// Gives a material another name, which all that names it follows. Error (scene_rejected): no name, or one
/// that another has; nothing changes.
Status rename_material(Scene& scene, std::size_t index, const std::string& name);

/// Removes a material. Bodies that were of it get its numbers, palettes lose it where no cell is of it.
/// Returns a sentence for what was changed beside, empty for nothing. Error (scene_rejected): cells of a
/// palette are of it, or cells are selected by it; nothing changes.
Result<std::string> remove_material(Scene& scene, std::size_t index);

/// The body's cells are of materials by their characters from then on: each character that it has gets the
/// one that all cells were of, which gets a name if it had none. Nothing where there is a palette already.
void make_palette(ModelSettings& settings, VoxelsSettings& voxels);

/// A character that is no cell of the body and in no entry of its palette, digits first; '\0': all are taken.
char free_cell(const VoxelsSettings& voxels);

/// Whether any cell has that character.
bool has_cell(const VoxelsSettings& voxels, char cell);

}  // namespace aspic
