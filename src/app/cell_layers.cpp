#include "app/cell_layers.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

#include "model/rotation.h"

namespace aspic::app {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

/// Half a cell towards a side, as the body is turned [m].
Vec3 half_a_cell(const VoxelsSettings& voxels, CellSide side) {
  const double half = 0.5 * voxels.size;
  Vec3 along;
  switch (side) {
    case CellSide::left:
      along.x = -half;
      break;
    case CellSide::right:
      along.x = half;
      break;
    case CellSide::back:
      along.z = -half;
      break;
    case CellSide::front:
      along.z = half;
      break;
    case CellSide::bottom:
      along.y = -half;
      break;
    case CellSide::top:
      along.y = half;
      break;
  }
  return rotated(along, voxels.rotation.axis, voxels.rotation.angle);
}

}  // namespace

std::array<int, 3> size_of(const CellLayers& layers) {
  if (layers.empty() || layers.front().empty()) return {};
  return {static_cast<int>(layers.front().front().size()), static_cast<int>(layers.size()),
          static_cast<int>(layers.front().size())};
}

char cell_at(const CellLayers& layers, int layer, const CellPlace& place) {
  return layers[at(layer)][at(place.row)][at(place.column)];
}

bool is_inside(const CellLayers& layers, const CellPlace& place) {
  const auto [columns, high, rows] = size_of(layers);
  return place.row >= 0 && place.row < rows && place.column >= 0 && place.column < columns;
}

void paint(CellLayers& layers, int layer, const CellPlace& one, const CellPlace& other, char cell) {
  // In one order, so that a way back goes over the same cells.
  const bool ordered = std::pair(one.row, one.column) <= std::pair(other.row, other.column);
  const CellPlace &from = ordered ? one : other, &to = ordered ? other : one;
  const int steps = std::max(std::abs(to.row - from.row), std::abs(to.column - from.column));
  const auto between = [&](int a, int b, int i) {  // the nearest
    return steps == 0 ? a : a + (2 * (b - a) * i + (b > a ? steps : -steps)) / (2 * steps);
  };
  for (int i = 0; i <= steps; ++i) {
    const CellPlace place = {between(from.row, to.row, i), between(from.column, to.column, i)};
    if (is_inside(layers, place)) layers[at(layer)][at(place.row)][at(place.column)] = cell;
  }
}

void fill(CellLayers& layers, int layer, char cell) {
  for (std::string& row : layers[at(layer)]) row.assign(row.size(), cell);
}

void grow(VoxelsSettings& voxels, CellSide side) {
  const auto [columns, high, rows] = size_of(voxels.layers);
  const std::string row(at(columns), empty_cell);
  voxels.position = voxels.position + half_a_cell(voxels, side);
  if (side == CellSide::bottom || side == CellSide::top) {
    const auto where = side == CellSide::top ? voxels.layers.end() : voxels.layers.begin();
    voxels.layers.insert(where, std::vector<std::string>(at(rows), row));
    return;
  }
  for (auto& layer : voxels.layers) {
    if (side == CellSide::back || side == CellSide::front) {
      layer.insert(side == CellSide::front ? layer.end() : layer.begin(), row);
    } else {
      for (std::string& cells : layer)
        cells.insert(side == CellSide::right ? cells.end() : cells.begin(), empty_cell);
    }
  }
}

bool shrink(VoxelsSettings& voxels, CellSide side) {
  const auto [columns, high, rows] = size_of(voxels.layers);
  const bool upright = side == CellSide::bottom || side == CellSide::top,
             deep = side == CellSide::back || side == CellSide::front;
  if ((upright ? high : deep ? rows : columns) <= 1) return false;
  voxels.position = voxels.position - half_a_cell(voxels, side);
  const auto drop = [](auto& list, bool last) { list.erase(last ? list.end() - 1 : list.begin()); };
  if (upright) {
    drop(voxels.layers, side == CellSide::top);
    return true;
  }
  for (auto& layer : voxels.layers) {
    if (deep) {
      drop(layer, side == CellSide::front);
    } else {
      for (std::string& cells : layer) drop(cells, side == CellSide::right);
    }
  }
  return true;
}

void copy_up(VoxelsSettings& voxels, int layer) {
  if (at(layer) + 1 == voxels.layers.size()) grow(voxels, CellSide::top);
  voxels.layers[at(layer) + 1] = voxels.layers[at(layer)];
}

}  // namespace aspic::app
