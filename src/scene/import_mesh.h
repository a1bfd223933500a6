#pragma once
// A mesh as a scene to start from.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "aspic/scene.h"
#include "base/result.h"

namespace aspic {

/// How a mesh becomes cells; the keys of [[voxels]] of the same names say more.
struct MeshImport {
  std::string file;                   ///< .obj, .stl or .ply, or a mesh that is built in
  std::optional<int> cells = {};      ///< along its longest edge
  std::optional<double> height = {};  ///< [m]
  std::string up = "y";               ///< axis of the file
  std::string pieces = "largest";
  std::function<void(double)> watch = {};  ///< as LoadOptions::watch
};

/// What came of a mesh.
struct ImportedMesh {
  Scene scene;
  std::vector<std::string> notes;  ///< what was repaired and made, a sentence each without a full stop
};

/// Whether a name is that of a mesh: by its ending, or of a mesh that is built in.
bool names_mesh(const std::string& file);

/// The mesh as a body of cells that falls on a plane, of a material stiff enough to carry itself, with the
/// mesh as its skin and a camera that sees it. The time step is symplectic Euler's usual one, which the
/// caller may want to change. Errors: as load_scene().
Result<ImportedMesh> import_mesh(const MeshImport& import);

/// Adds the cells inside a mesh file, or a mesh that is built in, to a scene as one more body with the mesh
/// as its skin, where it is in nobody's way: usual_mesh_cells along its longest edge, the largest piece, of a
/// material stiff enough to carry itself. The file's numbers are meters unless the body would be more than
/// ten times as long or short as what there is: then it becomes as long. Returns what was repaired and made,
/// a sentence each without a full stop. Errors: as load_mesh() and take_mesh(); nothing changes.
Result<std::vector<std::string>> add_mesh(Scene& scene, const std::string& file);

/// The scene as TOML, headed by comments that name its origin and the notes.
std::string imported_toml(const ImportedMesh& imported, const std::string& file_name);

}  // namespace aspic
