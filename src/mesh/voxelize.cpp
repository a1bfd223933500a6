#include "mesh/voxelize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/printable.h"
#include "mesh/winding.h"

namespace aspic {
namespace {

/// Refused above: what is inside is a guess.
constexpr double most_ambiguous = 0.1;
/// Told of above: every sharp edge is thin somewhere.
constexpr double told_thin = 0.05;
/// Faces that are asked how thick the wall behind them is.
constexpr std::size_t thickness_samples = 4096;

/// Turns the mesh upright, scales it and moves the middle of its box to the origin.
void place(TriangleMesh& mesh, const VoxelizationSettings& settings) {
  if (settings.up == UpAxis::z)
    for (Vec3& v : mesh.vertices) v = {v.x, v.z, -v.y};
  const Bounds bounds = bounds_of(mesh);
  const double high = bounds.extent().y,
               scale = settings.height > 0.0 && high > 0.0 ? settings.height / high : 1.0;
  const Vec3 middle = 0.5 * (bounds.low + bounds.high);
  for (Vec3& v : mesh.vertices) v = scale * (v - middle);
}

OccupancyGrid grid_around(const Vec3& extent, int cells) {
  OccupancyGrid grid;
  grid.size = std::max({extent.x, extent.y, extent.z}) / cells;
  for (int axis = 0; axis < 3; ++axis) {
    const int along = std::max(1, static_cast<int>(std::floor(extent[axis] / grid.size + 0.5)));
    grid.cells[static_cast<std::size_t>(axis)] = std::min(along, cells);
    grid.origin[axis] = -0.5 * grid.size * grid.cells[static_cast<std::size_t>(axis)];
  }
  const auto [n, m, l] = grid.cells;
  grid.full.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(m) * static_cast<std::size_t>(l),
                   0);
  return grid;
}

/// Fills the cells; returns how many are ambiguous.
std::size_t fill(OccupancyGrid& grid, const WindingTree& tree, const std::function<void(double)>& watch) {
  std::size_t ambiguous = 0;
  for (int i = 0; i < grid.cells[0]; ++i) {
    if (watch) watch(static_cast<double>(i) / grid.cells[0]);
    for (int j = 0; j < grid.cells[1]; ++j) {
      for (int k = 0; k < grid.cells[2]; ++k) {
        const double w = std::abs(tree.at(grid.center(i, j, k)));
        grid.full[grid.index(i, j, k)] = w > 0.5 ? 1 : 0;
        if (w > 0.3 && w < 0.7) ++ambiguous;
      }
    }
  }
  return ambiguous;
}

/// The share of the surface from which a cell's width inwards it is outside again.
double thin_share(const TriangleMesh& mesh, const WindingTree& tree, double cell) {
  const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / thickness_samples);
  double thin = 0.0, all = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
    const Triangle& t = mesh.triangles[i];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 normal = area_vector(a, b, c);
    const double area = length(normal);
    all += area;
    if (std::abs(tree.at((a + b + c) / 3.0 - (cell / area) * normal)) < 0.5) thin += area;
  }
  return all > 0.0 ? thin / all : 0.0;
}

std::string size_of(const Vec3& extent) {
  return fmt::format("{:.3g} × {:.3g} × {:.3g} m", extent.x, extent.y, extent.z);
}

}  // namespace

Result<VoxelizedMesh> voxelize(const TriangleMesh& mesh, const VoxelizationSettings& settings,
                               const std::string& name) {
  const std::string who = printable_line(name);
  RepairedMesh repaired = repair_mesh(mesh);
  VoxelizedMesh made;
  made.report.repairs = repaired.repairs;
  made.skin = std::move(repaired.mesh);
  place(made.skin, settings);
  const Vec3 extent = made.report.extent = bounds_of(made.skin).extent();
  if (made.skin.triangles.empty())
    return fail(ErrorCode::scene_rejected,
                "{}: no face has an area: of {} faces, {} have a corner that is not finite and {} have no "
                "area; export the surface again",
                who, mesh.triangles.size(), made.report.repairs.not_finite, made.report.repairs.zero_area);
  made.grid = grid_around(extent, settings.cells);
  made.report.mesh_volume = enclosed_volume(made.skin);
  const double longest = std::max({extent.x, extent.y, extent.z});
  made.report.odd_size = settings.height <= 0.0 && (longest > 50.0 || longest < 1e-3);

  const WindingTree tree(made.skin);
  const std::size_t ambiguous = fill(made.grid, tree, settings.watch);
  made.report.ambiguous = static_cast<double>(ambiguous) / static_cast<double>(made.grid.full.size());
  const MeshRepairs& r = made.report.repairs;
  if (made.report.ambiguous > most_ambiguous)
    return advised(
        fail(ErrorCode::scene_rejected,
             "{}: inside and outside are ambiguous: {} of {} cells ({:.0f} %, at most {:.0f} %) have a "
             "winding number between 0.3 and 0.7; {} edges of {} faces are rims of holes",
             who, ambiguous, made.grid.full.size(), 100.0 * made.report.ambiguous, 100.0 * most_ambiguous,
             r.open_edges, r.faces),
        {advice("close the mesh's holes, for instance with Blender's Fill or trimesh.repair.fill_holes")});
  if (made.grid.full_count() == 0)
    return advised(
        fail(ErrorCode::scene_rejected,
             "{}: the mesh fills none of {} × {} × {} cells of {:.3g} m: its walls are thinner than a cell, "
             "or it "
             "encloses nothing ({} of its edges are rims of holes)",
             who, made.grid.cells[0], made.grid.cells[1], made.grid.cells[2], made.grid.size, r.open_edges),
        {advice("use more cells"), advice("close the mesh's holes"),
         advice("use a [[cloth]] if the mesh is a sheet")});
  auto pieces = keep_pieces(made.grid, settings.pieces);
  if (!pieces) return fail(pieces.error(), "{}: {}", who, pieces.error().what);
  made.report.pieces = std::move(*pieces);
  made.report.kept_all = settings.pieces == Pieces::all;
  made.report.thin = thin_share(made.skin, tree, made.grid.size);
  made.report.hinges = count_hinges(made.grid);
  return made;
}

std::vector<std::string> sentences_of(const VoxelizedMesh& made) {
  const VoxelReport& r = made.report;
  const auto [n, m, l] = made.grid.cells;
  std::vector<std::string> said = sentences_of(r.repairs);
  said.push_back(
      fmt::format("{} of {} × {} × {} cells of {:.3g} m are full; the mesh is {}, x × y × z with y upwards",
                  made.grid.full_count(), n, m, l, made.grid.size, size_of(r.extent)));
  if (r.odd_size)
    said.emplace_back(
        "its numbers are read as meters, which is an unlikely size; give a height in meters to scale it");
  if (r.ambiguous > 0.01)
    said.push_back(fmt::format("{:.0f} % of the cells are near holes, where inside and outside are estimates",
                               100.0 * r.ambiguous));
  if (r.pieces.size() > 1 && r.kept_all)
    said.push_back(fmt::format("{} pieces, which share no face, move separately", r.pieces.size()));
  if (r.pieces.size() > 1 && !r.kept_all) {
    std::size_t lost = 0;
    for (std::size_t i = 1; i < r.pieces.size(); ++i) lost += r.pieces[i];
    said.push_back(fmt::format("kept the largest of {} pieces and left out {} cells of the others",
                               r.pieces.size(), lost));
  }
  if (r.thin > told_thin)
    said.push_back(
        fmt::format("{:.0f} % of the surface bounds walls thinner than a cell, which disappear or become a "
                    "cell thick; use more cells to keep them",
                    100.0 * r.thin));
  if (r.hinges > 0)
    said.push_back(
        fmt::format("hinges, edges or points at which cells meet without a common face: {}", r.hinges));
  return said;
}

}  // namespace aspic
