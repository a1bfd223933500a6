#pragma once
// Readers of meshes: OBJ, STL (ascii and binary), PLY (ascii, binary of either byte order). Files are
// foreign: what they promise is believed only as far as their bytes go.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "model/triangle_mesh.h"

namespace aspic {

/// What a mesh file may hold.
inline constexpr std::uint64_t largest_mesh_file = std::uint64_t{1} << 30;    ///< [bytes]
inline constexpr std::size_t most_mesh_triangles = std::size_t{1} << 26;      ///< polygons as triangles
inline constexpr std::string_view mesh_endings[] = {".obj", ".stl", ".ply"};  ///< of the formats

/// What came of a file. Polygons are fans of triangles. Vertices may repeat and may be no finite numbers:
/// repair_mesh() deals with both.
struct MeshFile {
  TriangleMesh mesh;
  std::vector<std::string> notes;  ///< what was passed over, each naming the file and a place in it
};

/// Reads bytes in the format that the file's ending names, or where it names none, as their beginning says.
/// Error (scene_rejected): file, line or byte, what is wrong there, and how to mend it.
Result<MeshFile> parse_mesh(std::string_view bytes, const std::string& file_name);

/// Names of the meshes that are built in: files' names without their ending.
std::vector<std::string> builtin_meshes();

/// The same of a file, or of a mesh that is built in where `path` is the name of one. Errors also: io, the
/// file cannot be read.
Result<MeshFile> load_mesh(const std::string& path);

/// Wavefront OBJ: the lines `v` and `f`; points, lines, normals, materials and names are passed over.
Result<MeshFile> parse_obj(std::string_view text, const std::string& file_name);
/// STL. A binary file is one of exactly the size that its header's count of triangles asks for, whatever it
/// begins with, or one that does not begin with `solid`.
Result<MeshFile> parse_stl(std::string_view bytes, const std::string& file_name);
/// PLY: the elements `vertex` and `face`; others are passed over.
Result<MeshFile> parse_ply(std::string_view bytes, const std::string& file_name);

}  // namespace aspic
