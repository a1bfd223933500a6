#include "mesh/orient_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "mesh/winding.h"

namespace aspic {
namespace {

constexpr std::uint32_t no_face = 0xffffffffu;

/// One side of a face.
struct Side {
  std::uint32_t low, high;  ///< its vertices
  std::uint32_t face;
  std::uint8_t side;  ///< 0, 1, 2
  bool rising;        ///< the face goes from `low` to `high`
};

/// Across a side of a face.
struct Neighbor {
  std::uint32_t face = no_face;
  bool agrees = true;  ///< both run through the side in opposite directions, as faces of one surface do
};

/// What a patch is.
struct Patch {
  std::uint32_t first = 0, count = 0;  ///< faces, in the order in which they were reached
  bool closed = true;
  bool turned = false;         ///< against the direction in which it was reached
  bool file_outwards = false;  ///< the file turns more of its area outwards than inwards
  double volume = 0.0;         ///< enclosed, ≥ 0
  Bounds bounds;
};

/// At more closed patches cavities are not looked for: each is compared with each.
constexpr std::size_t most_nested_patches = 64;
/// Of the volume that a sphere of the same area has: below it an open patch is a sheet, and has no outside.
constexpr double least_bulge = 0.1;

class Orientation {
 public:
  Orientation(TriangleMesh& mesh, MeshRepairs& repairs) : mesh_(mesh), repairs_(repairs) {
    neighbors_.resize(mesh.triangles.size());
    flipped_.assign(mesh.triangles.size(), false);
    link();
    walk();
    for (Patch& patch : patches_) measure(patch);
    turn_cavities();
    apply();
  }

 private:
  void link() {
    std::vector<Side> sides;
    sides.reserve(3 * mesh_.triangles.size());
    for (std::uint32_t f = 0; f < mesh_.triangles.size(); ++f) {
      const Triangle& t = mesh_.triangles[f];
      for (std::uint8_t s = 0; s < 3; ++s) {
        const std::uint32_t a = t[s], b = t[(s + 1u) % 3u];
        sides.push_back({std::min(a, b), std::max(a, b), f, s, a < b});
      }
    }
    std::ranges::sort(sides, {}, [](const Side& s) { return std::make_tuple(s.low, s.high, s.face); });
    for (std::size_t i = 0; i < sides.size();) {
      std::size_t end = i;
      while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
      if (end - i == 1) ++repairs_.open_edges;
      if (end - i > 2) ++repairs_.crowded_edges;
      if (end - i == 2) {
        const Side &a = sides[i], &b = sides[i + 1];
        const bool agrees = a.rising != b.rising;
        neighbors_[a.face][a.side] = {b.face, agrees};
        neighbors_[b.face][b.side] = {a.face, agrees};
      }
      i = end;
    }
  }

  /// Patch by patch, face by face over common edges.
  void walk() {
    std::vector<bool> reached(mesh_.triangles.size(), false);
    std::size_t twisted = 0;
    for (std::uint32_t start = 0; start < mesh_.triangles.size(); ++start) {
      if (reached[start]) continue;
      Patch patch;
      patch.first = static_cast<std::uint32_t>(order_.size());
      reached[start] = true;
      order_.push_back(start);
      for (std::size_t at = patch.first; at < order_.size(); ++at) {
        const std::uint32_t face = order_[at];
        for (const Neighbor& n : neighbors_[face]) {
          if (n.face == no_face) {
            patch.closed = false;
          } else if (!reached[n.face]) {
            reached[n.face] = true;
            flipped_[n.face] = flipped_[face] != !n.agrees;
            order_.push_back(n.face);
          } else if ((flipped_[n.face] != flipped_[face]) == n.agrees) {
            ++twisted;  // found from both of its faces
          }
        }
      }
      patch.count = static_cast<std::uint32_t>(order_.size()) - patch.first;
      patches_.push_back(patch);
    }
    repairs_.twisted_edges = twisted / 2;
    repairs_.patches = patches_.size();
  }

  Triangle face_of(std::uint32_t face, bool turned) const {
    Triangle t = mesh_.triangles[face];
    if (turned) std::swap(t[1], t[2]);
    return t;
  }
  /// A patch as a mesh with the vertices of all, which share nothing but it.
  TriangleMesh mesh_of(const Patch& patch) const {
    TriangleMesh one;
    one.vertices = mesh_.vertices;
    for (std::uint32_t i = patch.first; i < patch.first + patch.count; ++i)
      one.triangles.push_back(face_of(order_[i], flipped_[order_[i]] != patch.turned));
    return one;
  }

  void measure(Patch& patch) {
    double area = 0.0, as_in_file = 0.0, volume = 0.0;
    Vec3 center;
    const auto faces = std::span(order_).subspan(patch.first, patch.count);
    for (const std::uint32_t face : faces) {
      const auto& [a, b, c] = mesh_.triangles[face];
      for (const std::uint32_t v : {a, b, c}) patch.bounds.add(mesh_.vertices[v]);
      const double twice = length(area_vector(mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]));
      area += 0.5 * twice;
      if (!flipped_[face]) as_in_file += 0.5 * twice;
      center = center + (twice / 6.0) * (mesh_.vertices[a] + mesh_.vertices[b] + mesh_.vertices[c]);
    }
    if (area > 0.0) center = center / area;
    for (const std::uint32_t face : faces) {
      const auto [a, b, c] = face_of(face, flipped_[face]);
      volume +=
          dot(mesh_.vertices[a] - center, cross(mesh_.vertices[b] - center, mesh_.vertices[c] - center)) /
          6.0;
    }
    // A sphere of area A has the volume A^(3/2) / (6√π).
    const double bulge = std::abs(volume) / (area * std::sqrt(area) * 0.09403159725795937);
    if (bulge >= (patch.closed ? 1e-9 : least_bulge))
      patch.turned = volume < 0.0;
    else
      patch.turned = as_in_file < 0.5 * area;
    patch.file_outwards = (as_in_file >= 0.5 * area) != patch.turned;
    patch.volume = std::abs(volume);
  }

  /// Closed patches from the largest on: one that the file turns against the smallest that holds it gets the
  /// opposite direction of that one.
  void turn_cavities() {
    std::vector<std::size_t> closed;
    for (std::size_t p = 0; p < patches_.size(); ++p)
      if (patches_[p].closed) closed.push_back(p);
    if (closed.size() < 2 || closed.size() > most_nested_patches) return;
    std::ranges::stable_sort(closed, std::ranges::greater(),
                             [&](std::size_t p) { return patches_[p].volume; });
    std::vector<bool> inwards(closed.size(), false);
    for (std::size_t i = 1; i < closed.size(); ++i) {
      Patch& patch = patches_[closed[i]];
      const Vec3 inside = mesh_.vertices[mesh_.triangles[order_[patch.first]][0]];
      for (std::size_t j = i; j-- > 0;) {
        const Patch& holder = patches_[closed[j]];
        if (!holder.bounds.contains(patch.bounds)) continue;
        if (std::abs(winding_number(mesh_of(holder), inside)) < 0.5) continue;
        inwards[i] = inwards[j] != (patch.file_outwards != holder.file_outwards);
        break;
      }
    }
    for (std::size_t i = 0; i < closed.size(); ++i) {
      if (!inwards[i]) continue;
      patches_[closed[i]].turned = !patches_[closed[i]].turned;
      ++repairs_.cavities;
    }
  }

  void apply() {
    for (const Patch& patch : patches_) {
      for (std::uint32_t i = patch.first; i < patch.first + patch.count; ++i) {
        const std::uint32_t face = order_[i];
        const bool turned = flipped_[face] != patch.turned;
        if (turned) ++repairs_.turned;
        mesh_.triangles[face] = face_of(face, turned);
      }
    }
  }

  TriangleMesh& mesh_;
  MeshRepairs& repairs_;
  std::vector<std::array<Neighbor, 3>> neighbors_;  // by face and side
  std::vector<bool> flipped_;                       // to agree with the first face of its patch
  std::vector<std::uint32_t> order_;                // faces, patch by patch
  std::vector<Patch> patches_;
};

}  // namespace

void orient_mesh(TriangleMesh& mesh, MeshRepairs& repairs) {
  Orientation(mesh, repairs);
}

}  // namespace aspic
