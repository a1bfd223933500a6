// Cells of .npy files as layers of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "model/voxels.h"
#include "scene/cell_arrays.h"

namespace aspic::reader {
namespace {

/// What stands for the numbers of an array: digits for themselves, letters for larger ones.
constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
constexpr std::size_t most_materials = letters.size();

/// Cells and their palette with a character for each number.
struct FileCells {
  CellLayers layers;
  CellPalette palette;
};

Result<FileCells> cells_of(const NpyArray& array, const CellPalette& by_number) {
  if (!array.whole_numbers())
    return fail(ErrorCode::scene_rejected, "it must be an array of integers or truth values");
  const std::size_t nx = array.shape()[0], ny = array.shape()[1], nz = array.shape()[2];
  FileCells cells;
  std::map<std::int64_t, char> known = {{0, '.'}};
  const auto character_of = [&](std::int64_t number) -> std::optional<char> {
    if (const auto found = known.find(number); found != known.end()) return found->second;
    const auto entry = by_number.find(fmt::format("{}", number));
    if (by_number.empty()) return known[number] = '1';
    if (entry == by_number.end() || known.size() > most_materials) return std::nullopt;
    // A digit is its own character if it can be: other numbers take letters.
    const char c = number > 0 && number < 10 ? static_cast<char>('0' + number) : letters[known.size() - 1];
    cells.palette[std::string(1, c)] = entry->second;
    return known[number] = c;
  };
  cells.layers.assign(ny, std::vector<std::string>(nz, std::string(nx, '.')));
  for (std::size_t i = 0; i < array.size(); ++i) {
    const std::size_t x = i / (ny * nz), y = i / nz % ny, z = i % nz;
    const std::int64_t number = array.whole(i);
    const auto c = character_of(number);
    if (!c && known.size() > most_materials)
      return fail(ErrorCode::scene_rejected, "it has more than {} materials", most_materials);
    if (!c)
      return fail(ErrorCode::scene_rejected,
                  "it has the number {} at [{}, {}, {}], which 'palette' does not name; add {} = \"…\" to "
                  "'palette', or write 0 for an empty cell",
                  number, x, y, z, number);
    cells.layers[y][z][x] = *c;
  }
  return cells;
}

}  // namespace

void read_cell_files(Reader& reader, const std::vector<diagnostics::Source>& sources) {
  for (std::size_t i = 0; i < reader.scene().model.voxels.size(); ++i) {
    VoxelsSettings& voxels = reader.scene().model.voxels[i];
    take_named_file(reader, sources, path_text("voxels[].file", i), "voxels.file",
                    [&](const std::string& file) -> Status {
                      ASPIC_TRY(const auto array, read_cell_array(file));
                      ASPIC_TRY(FileCells cells, cells_of(array, voxels.palette));
                      voxels.layers = std::move(cells.layers);
                      if (!voxels.palette.empty()) voxels.palette = std::move(cells.palette);
                      return {};
                    });
  }
}

}  // namespace aspic::reader
