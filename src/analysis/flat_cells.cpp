#include "analysis/flat_cells.h"

#include <cmath>

namespace aspic {
namespace {

constexpr double flat_share = 0.01;

template <class Take>
void for_each_full_cell(const Lattice& lattice, const Take& take) {
  const std::array<int, 3> count = lattice.cells();
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k)
        if (const Lattice::Place cell = {i, j, k}; lattice.full(cell)) take(cell);
}

}  // namespace

/// The determinant of the cell's mean edges, which is its volume where opposite edges are parallel [m³].
double FlatCellSearch::volume(const Cells& of, const std::vector<Vec3>& x, const Lattice::Place& cell) {
  Vec3 edge[3];
  for (int n = 0; n < 8; ++n) {
    const std::uint32_t point =
        of.lattice.index({cell[0] + (n & 1), cell[1] + (n >> 1 & 1), cell[2] + (n >> 2)});
    const Vec3& corner = x[of.first_particle + (of.particle.empty() ? point : of.particle[point])];
    for (int axis = 0; axis < 3; ++axis)
      edge[axis] = edge[axis] + ((n >> axis & 1) != 0 ? 0.25 : -0.25) * corner;
  }
  return dot(cross(edge[0], edge[1]), edge[2]);
}

FlatCellSearch::FlatCellSearch(const Model& model) {
  const std::vector<Vec3> start = model.initial_position.list(0, model.initial_position.size());
  for (const Body& body : model.bodies) {
    if (!body.lattice || body.style != SurfaceStyle::flesh) continue;
    Cells cells = {
        static_cast<std::uint32_t>(&body - model.bodies.data()), body.first_particle, *body.lattice, {}, 0.0};
    if (!body.lattice->all_full()) {
      std::uint32_t number = 0;
      for (std::size_t p = 0; p < body.lattice->points(); ++p)
        cells.particle.push_back(body.lattice->has_particle(body.lattice->place(p)) ? number++ : 0);
    }
    for_each_full_cell(cells.lattice, [&](const Lattice::Place& cell) {
      if (cells.least == 0.0) cells.least = flat_share * volume(cells, start, cell);
    });
    if (cells.least != 0.0) bodies_.push_back(std::move(cells));
  }
}

std::vector<FlatCells> FlatCellSearch::find(const State& state) const {
  std::vector<FlatCells> found;
  for (const Cells& cells : bodies_) {
    std::uint64_t count = 0;
    for_each_full_cell(cells.lattice, [&](const Lattice::Place& cell) {
      const double now = volume(cells, state.position, cell);
      if (cells.least > 0.0 ? now < cells.least : now > cells.least) ++count;
    });
    if (count > 0) found.push_back({cells.body, count});
  }
  return found;
}

}  // namespace aspic
