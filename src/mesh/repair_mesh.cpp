#include "mesh/repair_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "mesh/orient_mesh.h"
#include "mesh/weld.h"

namespace aspic {
namespace {

/// Farther coordinates are taken as infinite: their squares and cubes must be numbers.
constexpr double farthest = 1e12;
/// Of the longest extent. Single precision, in which STL and most PLY are, has about a tenth of it.
constexpr double weld_share = 1e-6;

bool usable(const Vec3& v) {
  return std::abs(v.x) <= farthest && std::abs(v.y) <= farthest && std::abs(v.z) <= farthest;
}

void drop_not_finite(TriangleMesh& mesh, MeshRepairs& repairs) {
  repairs.not_finite = std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return !std::ranges::all_of(t, [&](std::uint32_t v) { return usable(mesh.vertices[v]); });
  });
}

/// Leaves the vertices that triangles use, in their order.
void compact(TriangleMesh& mesh) {
  std::vector<std::uint32_t> number(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) number[v] = 1;
  std::uint32_t count = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (number[v] == 0) continue;
    mesh.vertices[count] = mesh.vertices[v];
    number[v] = count++;
  }
  mesh.vertices.resize(count);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = number[v];
}

void weld(TriangleMesh& mesh, MeshRepairs& repairs) {
  const Vec3 extent = bounds_of(mesh).extent();
  const double longest = std::max({extent.x, extent.y, extent.z});
  const auto first = weld_points(mesh.vertices, weld_share * longest);
  for (std::size_t v = 0; v < first.size(); ++v)
    if (first[v] != v) ++repairs.welded;
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = first[v];
}

void drop_collapsed(TriangleMesh& mesh, MeshRepairs& repairs) {
  repairs.zero_area += std::erase_if(
      mesh.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

/// Whether a triangle turns from the lowest of its corners to the next higher one.
bool is_rising(const Triangle& t) {
  return (t[0] < t[1]) + (t[1] < t[2]) + (t[2] < t[0]) == 2;
}

/// Faces over the same corners, see repair_mesh().
void drop_doubled(TriangleMesh& mesh, MeshRepairs& repairs) {
  const auto corners = [&](std::uint32_t face) {
    Triangle t = mesh.triangles[face];
    std::ranges::sort(t);
    return t;
  };
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t face) { return std::make_pair(corners(face), face); });
  std::vector<std::pair<std::size_t, std::size_t>> runs;  // of doubled faces in `order`
  std::size_t distinct = 0;
  for (std::size_t i = 0; i < order.size(); ++distinct) {
    std::size_t end = i + 1;
    while (end < order.size() && corners(order[end]) == corners(order[i])) ++end;
    if (end - i > 1) runs.emplace_back(i, end);
    i = end;
  }
  const bool mostly = 2 * runs.size() > distinct;
  std::vector<bool> dropped(mesh.triangles.size(), false);
  for (const auto& [begin, end] : runs) {
    std::ptrdiff_t sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += is_rising(mesh.triangles[order[i]]) ? 1 : -1;
    // The first one stays, unless they cancel as a wall inside does.
    for (std::size_t i = !mostly && sum == 0 ? begin : begin + 1; i < end; ++i) dropped[order[i]] = true;
  }
  std::uint32_t face = 0;
  repairs.doubled = std::erase_if(mesh.triangles, [&](const Triangle&) { return dropped[face++]; });
}

void drop_flat(TriangleMesh& mesh, MeshRepairs& repairs) {
  const Vec3 extent = bounds_of(mesh).extent();
  const double least = 1e-14 * dot(extent, extent);
  repairs.zero_area += std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return length(area_vector(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]])) <= least;
  });
}

}  // namespace

RepairedMesh repair_mesh(const TriangleMesh& mesh) {
  RepairedMesh result = {mesh, {}};
  TriangleMesh& made = result.mesh;
  MeshRepairs& repairs = result.repairs;
  drop_not_finite(made, repairs);
  compact(made);
  if (!made.triangles.empty()) {
    weld(made, repairs);
    drop_collapsed(made, repairs);
    drop_doubled(made, repairs);
    orient_mesh(made, repairs);  // over faces without area too: they connect their neighbors
    drop_flat(made, repairs);
    compact(made);
  }
  repairs.faces = made.triangles.size();
  repairs.vertices = made.vertices.size();
  return result;
}

std::vector<std::string> sentences_of(const MeshRepairs& r) {
  std::vector<std::string> said;
  const auto say = [&](std::size_t count, fmt::format_string<std::size_t&> sentence) {
    if (count > 0) said.push_back(fmt::format(sentence, count));
  };
  say(r.not_finite, "left out {} faces with a corner that is not finite");
  say(r.zero_area, "left out {} faces without area");
  say(r.doubled, "left out {} duplicate faces");
  if (r.turned > 0)
    said.push_back(r.turned == r.faces
                       ? "turned all faces: the mesh was inside out"
                       : fmt::format("turned {} of {} faces to agree with their neighbors or outwards",
                                     r.turned, r.faces));
  say(r.cavities, "kept {} closed parts inside others as cavities");
  say(r.open_edges, "{} edges have one face: holes are closed where the winding number is ½");
  say(r.crowded_edges, "{} edges have more than two faces");
  say(r.twisted_edges, "{} edges lie between faces that cannot agree on an outside");
  return said;
}

}  // namespace aspic
