#pragma once
// A mesh as a body of cells.
#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "mesh/occupancy.h"
#include "mesh/repair_mesh.h"

namespace aspic {

/// The axis of a mesh file that points upwards.
enum class UpAxis { y, z };

/// How a mesh becomes cells.
struct VoxelizationSettings {
  int cells = 32;         ///< along the longest edge of the mesh's box, 1 … most_mesh_cells
  double height = 0.0;    ///< of the mesh's box [m], to which the mesh is scaled; 0: its numbers are meters
  UpAxis up = UpAxis::y;  ///< of the file
  Pieces pieces = Pieces::largest;
  std::function<void(double)> watch = {};  ///< called with the share of the cells that is done
};
inline constexpr int most_mesh_cells = 256;

/// What came of it, for people.
struct VoxelReport {
  MeshRepairs repairs;
  Vec3 extent;                      ///< of the mesh, scaled [m]
  double mesh_volume = 0.0;         ///< [m³]: enclosed by the mesh, as enclosed_volume() has it
  double ambiguous = 0.0;           ///< share of cells with |w| from 0.3 to 0.7, which holes cause
  double thin = 0.0;                ///< share of the surface that bounds walls thinner than a cell
  std::vector<std::size_t> pieces;  ///< cells of each, largest first, before any was emptied
  bool kept_all = false;            ///< of several pieces
  std::size_t hinges = 0;           ///< see count_hinges()
  bool odd_size = false;            ///< longer than 50 m or shorter than a millimeter: probably other units
};

/// A mesh as cells, and itself, scaled, as the skin.
struct VoxelizedMesh {
  OccupancyGrid grid;
  TriangleMesh skin;  ///< repaired, y upwards [m]; its box and the grid's have the same middle, the origin
  VoxelReport report;
};

/// Repairs a mesh, scales it and fills the cells whose middle it winds around more than half: |w| > ½. The
/// grid has `cells` cubes along the longest edge of the mesh's box, and along the others the nearest whole
/// number. Errors (scene_rejected): no face is left, no cell is full, more than a tenth of the cells have |w|
/// between 0.3 and 0.7, or several pieces that are refused; each with its figures. `name` is what errors call
/// the mesh.
Result<VoxelizedMesh> voxelize(const TriangleMesh& mesh, const VoxelizationSettings& settings,
                               const std::string& name);

/// The report in sentences without a full stop, what was repaired first; cells and size are always told.
std::vector<std::string> sentences_of(const VoxelizedMesh& made);

}  // namespace aspic
