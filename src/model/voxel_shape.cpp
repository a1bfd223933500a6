// Layers of characters to cells, and what may be wrong with them.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "base/printable.h"
#include "model/material.h"
#include "model/skin_text.h"
#include "model/voxels.h"

namespace aspic {
namespace {

/// Cells in the order of a lattice.
struct Grid {
  std::array<int, 3> count = {};
  std::vector<char> cells;

  std::size_t index(const std::array<int, 3>& at) const {
    return (static_cast<std::size_t>(at[0]) * static_cast<std::size_t>(count[1]) +
            static_cast<std::size_t>(at[1])) *
               static_cast<std::size_t>(count[2]) +
           static_cast<std::size_t>(at[2]);
  }
  std::array<int, 3> place(std::size_t index) const {
    const auto n1 = static_cast<std::size_t>(count[1]), n2 = static_cast<std::size_t>(count[2]);
    return {static_cast<int>(index / (n1 * n2)), static_cast<int>(index / n2 % n1),
            static_cast<int>(index % n2)};
  }
};

CellFault fault(std::string message, std::optional<std::size_t> layer = {}) {
  return {"layers", std::move(message), layer};
}

/// Layers of one size, whose characters are cells.
std::optional<CellFault> check_layers(const CellLayers& layers) {
  if (layers.empty() || layers.front().empty() || layers.front().front().empty())
    return fault("the body is empty: write layers of rows such as [[\"11\", \"11\"]]");
  const std::size_t rows = layers.front().size(), columns = layers.front().front().size();
  for (std::size_t y = 0; y < layers.size(); ++y) {
    if (layers[y].size() != rows)
      return fault(fmt::format("layer {} has {} rows and layer 0 has {}: write as many in each; '.' is an "
                               "empty cell",
                               y, layers[y].size(), rows),
                   y);
    for (std::size_t z = 0; z < rows; ++z) {
      const std::string& row = layers[y][z];
      for (const char c : row)
        if (!is_empty_cell(c) && !is_full_cell(c))
          return fault(
              fmt::format("row {} of layer {} is \"{}\": cells are letters, digits and other signs of "
                          "ASCII, one each",
                          z, y, excerpt(row, 40)),
              y);
      if (row.size() != columns)
        return fault(
            fmt::format("row {} of layer {} is {} long and row 0 of layer 0 is {}: write as many cells "
                        "in each; '.' is an empty one",
                        z, y, row.size(), columns),
            y);
    }
  }
  for (const std::size_t along : {columns, layers.size(), rows})
    if (along > static_cast<std::size_t>(most_cells_along))
      return fault(fmt::format("{} cells along an axis; allowed: {}", along, most_cells_along));
  const std::uint64_t points = (columns + 1) * (layers.size() + 1) * (rows + 1);
  if (points > most_lattice_points)
    return fault(fmt::format("{} × {} × {} cells have {} corners; allowed: {}", columns, layers.size(), rows,
                             points, most_lattice_points));
  return std::nullopt;
}

Grid grid_of(const CellLayers& layers) {
  Grid grid;
  grid.count = {static_cast<int>(layers.front().front().size()), static_cast<int>(layers.size()),
                static_cast<int>(layers.front().size())};
  grid.cells.reserve(layers.size() * layers.front().size() * layers.front().front().size());
  for (std::size_t x = 0; x < layers.front().front().size(); ++x)
    for (const auto& layer : layers)
      for (const std::string& row : layer) grid.cells.push_back(is_empty_cell(row[x]) ? '.' : row[x]);
  return grid;
}

/// By cell: its piece, counted from 0 in the order of first cells; and how many cells each has. Cells of a
/// piece are joined by faces.
struct PiecesOf {
  std::vector<std::uint32_t> piece;
  std::vector<std::size_t> sizes;

  explicit PiecesOf(const Grid& grid) : piece(grid.cells.size(), none) {
    std::vector<std::size_t> open;
    for (std::size_t first = 0; first < grid.cells.size(); ++first) {
      if (grid.cells[first] == '.' || piece[first] != none) continue;
      const auto number = static_cast<std::uint32_t>(sizes.size());
      sizes.push_back(0);
      piece[first] = number;
      open.push_back(first);
      while (!open.empty()) {
        const std::array<int, 3> at = grid.place(open.back());
        open.pop_back();
        ++sizes.back();
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const int step : {-1, 1}) {
            std::array<int, 3> next = at;
            next[axis] += step;
            if (next[axis] < 0 || next[axis] >= grid.count[axis]) continue;
            const std::size_t index = grid.index(next);
            if (grid.cells[index] == '.' || piece[index] != none) continue;
            piece[index] = number;
            open.push_back(index);
          }
        }
      }
    }
  }

  static constexpr std::uint32_t none = 0xffffffffu;
};

/// "12, 3 and 1", the largest first; no more than five.
std::string sizes_text(std::vector<std::size_t> sizes) {
  std::ranges::sort(sizes, std::greater());
  std::string text;
  const std::size_t shown = std::min<std::size_t>(sizes.size(), 5);
  for (std::size_t i = 0; i < shown; ++i)
    text += fmt::format("{}{}", i == 0 ? "" : i + 1 == sizes.size() ? " and " : ", ", sizes[i]);
  return sizes.size() > shown ? text + ", …" : text;
}

/// The box around the full cells.
VoxelShape trimmed(const Grid& grid) {
  VoxelShape shape;
  shape.grid = grid.count;
  std::array<int, 3> low = grid.count, high = {-1, -1, -1};
  for (std::size_t c = 0; c < grid.cells.size(); ++c) {
    if (grid.cells[c] == '.') continue;
    ++shape.full;
    const std::array<int, 3> at = grid.place(c);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], at[axis]);
      high[axis] = std::max(high[axis], at[axis]);
    }
  }
  shape.offset = low;
  for (std::size_t axis = 0; axis < 3; ++axis) shape.lattice.particles[axis] = high[axis] - low[axis] + 2;
  for (int x = low[0]; x <= high[0]; ++x)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int z = low[2]; z <= high[2]; ++z) shape.cells.push_back(grid.cells[grid.index({x, y, z})]);
  if (shape.full < shape.cells.size())
    for (const char c : shape.cells) shape.lattice.full_cells.push_back(c != '.');
  return shape;
}

/// Characters that have no entry in a palette, or entries that are none.
std::optional<CellFault> check_palette(const ModelSettings& settings, const VoxelsSettings& voxels,
                                       const VoxelShape& shape) {
  for (const auto& [key, name] : voxels.palette) {
    if (key.size() != 1 || !is_full_cell(key.front()))
      return CellFault{"palette", fmt::format("\"{}\" is not a cell: a key is one letter, digit or other "
                                              "sign of ASCII; '.', '0' and ' ' are empty cells",
                                              excerpt(key, 20))};
    if (!find_material(settings, name))
      return CellFault{"palette", fmt::format("'{}' is {}", key, unknown_material(settings, name))};
  }
  std::vector<std::string_view> known;
  for (const auto& [key, name] : voxels.palette) known.push_back(key);
  const auto n2 = static_cast<std::size_t>(shape.lattice.cells()[2]),
             n1 = static_cast<std::size_t>(shape.lattice.cells()[1]);
  for (std::size_t c = 0; c < shape.cells.size(); ++c) {
    if (shape.cells[c] == '.' || voxels.palette.contains(std::string_view(&shape.cells[c], 1))) continue;
    const std::size_t y = c / n2 % n1 + static_cast<std::size_t>(shape.offset[1]),
                      z = c % n2 + static_cast<std::size_t>(shape.offset[2]);
    return fault(fmt::format("row {1} of layer {2} has a cell '{0}', which 'palette' does not name; it names "
                             "{3}: add \"{0}\" to it, or write '.' for an empty cell",
                             shape.cells[c], z, y, fmt::join(known, ", ")),
                 y);
  }
  return std::nullopt;
}

}  // namespace

bool is_empty_cell(char c) {
  return c == '.' || c == '0' || c == ' ';
}

bool is_full_cell(char c) {
  return c > ' ' && c <= '~' && !is_empty_cell(c) && c != '"' && c != '\\';
}

std::variant<VoxelShape, CellFault> shape_of(const VoxelsSettings& voxels) {
  if (auto wrong = check_layers(voxels.layers)) return *std::move(wrong);
  Grid grid = grid_of(voxels.layers);
  const PiecesOf pieces(grid);
  if (pieces.sizes.empty())
    return fault("the body is empty: all its cells are empty. Write a digit or letter for each full cell");
  if (pieces.sizes.size() > 1 && voxels.pieces == Pieces::refuse)
    return fault(
        fmt::format("the cells form {} pieces that share no face, of {} cells: join them, write pieces = "
                    "\"largest\" to keep one, or pieces = \"all\" to keep all",
                    pieces.sizes.size(), sizes_text(pieces.sizes)));
  if (voxels.pieces == Pieces::largest) {
    const auto kept =
        static_cast<std::uint32_t>(std::ranges::max_element(pieces.sizes) - pieces.sizes.begin());
    for (std::size_t c = 0; c < grid.cells.size(); ++c)
      if (pieces.piece[c] != kept) grid.cells[c] = '.';
  }
  VoxelShape shape = trimmed(grid);
  shape.pieces = pieces.sizes.size();
  return shape;
}

std::optional<CellFault> fault_of(const ModelSettings& settings, const VoxelsSettings& voxels) {
  auto found = shape_of(voxels);
  if (auto* const wrong = std::get_if<CellFault>(&found)) return std::move(*wrong);
  if (!voxels.skin.empty() && !mesh_of_skin_text(voxels.skin))
    return CellFault{"skin", "this skin is not one that Aspic made, or it was changed: make it again"};
  if (!voxels.palette.empty()) return check_palette(settings, voxels, std::get<VoxelShape>(found));
  const std::string& name = voxels.material.name;
  if (name.empty() || find_material(settings, name)) return std::nullopt;
  return CellFault{"material", fmt::format("it names {}", unknown_material(settings, name))};
}

CellMaterials materials_of(const ModelSettings& settings, const VoxelsSettings& voxels,
                           const VoxelShape& shape) {
  CellMaterials result;
  if (voxels.palette.empty()) {
    const MaterialSettings* const named = find_material(settings, voxels.material.name);
    result.materials.push_back(named ? *named : voxels.material);
    return result;
  }
  const std::set<char> present(shape.cells.begin(), shape.cells.end());
  for (const MaterialSettings& material : settings.materials) {
    bool used = false;
    for (const auto& [key, name] : voxels.palette) {
      if (find_material(settings, name) != &material || !present.contains(key.front())) continue;
      result.number[static_cast<std::size_t>(key.front())] =
          static_cast<std::uint8_t>(result.materials.size());
      used = true;
    }
    if (used) result.materials.push_back(material);
  }
  return result;
}

std::size_t hinges(const Lattice& lattice) {
  std::size_t count = 0;
  const std::array<int, 3> cells = lattice.cells();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    // The four cells around an edge along the axis, whose upper ones in u and v are `cell`.
    for (Lattice::Place cell = {}; cell[axis] < cells[axis]; ++cell[axis]) {
      for (cell[u] = 1; cell[u] < cells[u]; ++cell[u]) {
        for (cell[v] = 1; cell[v] < cells[v]; ++cell[v]) {
          Lattice::Place below = cell, before = cell, across = cell;
          --below[u];
          --before[v];
          --across[u];
          --across[v];
          const bool here = lattice.full(cell), opposite = lattice.full(across);
          const bool one = lattice.full(below), other = lattice.full(before);
          count += (here && opposite && !one && !other) || (!here && !opposite && one && other);
        }
      }
    }
  }
  return count;
}

std::string_view name_of(Pieces pieces) {
  return std::ranges::find(piece_choices, pieces, &Named<Pieces>::value)->name;
}

}  // namespace aspic
