#include "scene/mesh_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "base/printable.h"
#include "model/skin.h"
#include "model/skin_text.h"
#include "scene/reader.h"

namespace aspic {
namespace {

CellLayers layers_of(const OccupancyGrid& grid, char full) {
  const auto [n, m, l] = grid.cells;
  CellLayers layers(
      static_cast<std::size_t>(m),
      std::vector<std::string>(static_cast<std::size_t>(l), std::string(static_cast<std::size_t>(n), '.')));
  for (std::size_t cell = 0; cell < grid.full.size(); ++cell) {
    if (grid.full[cell] == 0) continue;
    const auto [i, j, k] = grid.place(cell);
    layers[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)][static_cast<std::size_t>(i)] = full;
  }
  return layers;
}

}  // namespace

Result<std::vector<std::string>> take_mesh(VoxelsSettings& voxels, const MeshFile& file,
                                           const VoxelizationSettings& how, const std::string& name) {
  if (voxels.palette.size() > 1)
    return fail(ErrorCode::scene_rejected,
                "{}: a mesh has one material, and 'palette' has {}; remove one of them", printable_line(name),
                voxels.palette.size());
  ASPIC_TRY(VoxelizedMesh made, voxelize(file.mesh, how, name));
  std::vector<std::string> notes = file.notes;
  for (std::string& sentence : sentences_of(made)) notes.push_back(std::move(sentence));
  const bool named = !voxels.palette.empty() && !voxels.palette.begin()->first.empty();
  voxels.layers = layers_of(made.grid, named ? voxels.palette.begin()->first.front() : '1');
  voxels.size = made.grid.size;
  for (Vec3& v : made.skin.vertices) v = (v - made.grid.origin) / made.grid.size;
  voxels.skin = to_skin_text(made.skin);
  const SkinBinding binding = bind_skin(lattice_of(made.grid), made.skin.vertices);
  if (binding.clamped > 0)
    notes.push_back(
        fmt::format("{} of {} vertices of the skin were farther than half a cell from every full cell, and "
                    "were moved there",
                    binding.clamped, binding.vertices.size()));
  return notes;
}

namespace reader {
namespace {

/// What was written of a key that becomes cells.
template <class T>
T given(const Reader& reader, std::string_view path, std::size_t index, T otherwise) {
  const auto found = reader.cell_sources().find(path_text(path, index));
  if (found == reader.cell_sources().end()) return otherwise;
  return std::get<T>(found->second);
}

Result<std::vector<std::string>> mesh_into(Reader& reader, std::size_t index, const std::string& path,
                                           const std::function<void(double)>& watch) {
  VoxelsSettings& voxels = reader.scene().model.voxels[index];
  VoxelizationSettings how;
  how.cells = static_cast<int>(given<std::int64_t>(reader, "voxels[].cells", index, usual_mesh_cells));
  how.height = given<double>(reader, "voxels[].height", index, 0.0);
  const std::string up = given<std::string>(reader, "voxels[].up", index, "y");
  how.up = std::ranges::find(up_axes, up, &Named<UpAxis>::name)->value;
  how.pieces = voxels.pieces;
  how.watch = watch;
  ASPIC_TRY(const MeshFile file, load_mesh(path));
  return take_mesh(voxels, file, how, path);
}

/// What is wrong with a mesh; of a word that is no path, also which words there are.
std::string said_of(const Error& error, const std::string& name, const std::vector<std::string>& builtin) {
  if (error.code != ErrorCode::io || name.find_first_of("/\\.") != std::string::npos) return error.message();
  const std::vector<std::string_view> words(builtin.begin(), builtin.end());
  return fmt::format("{} Built in: {}{}", error.message(), diagnostics::list_text(words, false),
                     diagnostics::did_you_mean(diagnostics::nearest(name, words)));
}

}  // namespace

void read_meshes(Reader& reader, const std::vector<diagnostics::Source>& sources,
                 const LoadOptions& options) {
  for (std::size_t i = 0; i < reader.scene().model.voxels.size(); ++i) {
    const std::string path = path_text("voxels[].mesh", i);
    const auto written = reader.written().find(path);
    const bool any = written != reader.written().end();
    for (const std::string_view key : {"voxels[].cells", "voxels[].height", "voxels[].up"}) {
      const auto other = reader.written().find(path_text(key, i));
      if (any || other == reader.written().end() || other->second.problem) continue;
      reader.blame(other->first, fmt::format("'{0}' applies to a mesh; add the key 'mesh', or remove '{0}'",
                                             key.substr(9)));
    }
    const std::string name = given<std::string>(reader, "voxels[].mesh", i, "");
    if (!any || written->second.problem || name.empty()) continue;
    const bool in_file = written->second.key.source == 0;
    const std::filesystem::path folder =
        in_file ? std::filesystem::path(sources.front().label).parent_path() : std::filesystem::path();
    const auto builtin = builtin_meshes();
    const bool is_builtin = std::ranges::find(builtin, name) != builtin.end();
    const auto taken = mesh_into(reader, i, is_builtin ? name : (folder / name).string(), options.watch);
    if (!taken)
      reader.blame(path, fmt::format("'voxels.mesh': {}", said_of(taken.error(), name, builtin)));
    else if (options.notes)
      for (const std::string& note : *taken)
        options.notes->push_back(fmt::format("{}: {}", printable_line(name), note));
  }
}

}  // namespace reader
}  // namespace aspic
