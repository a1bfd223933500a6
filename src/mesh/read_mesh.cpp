#include "mesh/read_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "base/embedded_file.h"
#include "base/files.h"
#include "base/lines.h"
#include "base/out_of_memory.h"
#include "base/printable.h"

namespace aspic {

std::span<const EmbeddedFile> builtin_mesh_files();

namespace {

/// A file's name without its ending.
std::string_view stem_of(std::string_view name) {
  return name.substr(0, name.rfind('.'));
}

using Reader = Result<MeshFile> (*)(std::string_view, const std::string&);

Reader reader_of(std::string_view bytes, const std::string& file_name) {
  constexpr Reader readers[] = {parse_obj, parse_stl, parse_ply};
  const std::string ending = ending_of(file_name);
  const auto* const known = std::ranges::find(mesh_endings, ending);
  if (known != std::end(mesh_endings)) return readers[known - std::begin(mesh_endings)];
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return parse_ply;
  if (bytes.starts_with("solid")) return parse_stl;
  return nullptr;
}

}  // namespace

Result<MeshFile> parse_mesh(std::string_view bytes, const std::string& file_name) {
  const Reader reader = reader_of(bytes, file_name);
  if (reader == nullptr)
    return fail(
        ErrorCode::scene_rejected,
        "{}: unsupported mesh format (supported: {}). Convert it, for example with trimesh or Blender",
        printable_line(file_name), fmt::join(mesh_endings, ", "));
  // A binary STL may begin with any byte.
  if (is_utf16(bytes) && reader != parse_stl)
    return fail(ErrorCode::scene_rejected, "{}: this is {}", printable_line(file_name), utf16_words);
  return unless_out_of_memory([&] { return reader(bytes, file_name); },
                              [&]() -> Result<MeshFile> {
                                return fail(ErrorCode::io, "{}: not enough memory for this mesh.",
                                            printable_line(file_name));
                              });
}

std::vector<std::string> builtin_meshes() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : builtin_mesh_files()) names.emplace_back(stem_of(file.name));
  return names;
}

Result<MeshFile> load_mesh(const std::string& path) {
  for (const EmbeddedFile& file : builtin_mesh_files())
    if (stem_of(file.name) == path) return parse_mesh(file.text, std::string(file.name));
  ASPIC_TRY(const std::string bytes, read_file(path, largest_mesh_file));
  return parse_mesh(bytes, path);
}

}  // namespace aspic
