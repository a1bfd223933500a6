#include "render/surface.h"

#include <algorithm>
#include <array>
#include <limits>

#include "render/software_rasteriser.h"

namespace aspic {
namespace {

using Quad = std::array<std::uint32_t, 4>;

/// Places along an edge of n particles, the first and the last among them, with at most `quads` gaps.
std::vector<int> places(int n, int quads) {
  const int gaps = std::min(n - 1, quads);
  std::vector<int> result;
  for (int i = 0; i <= gaps; ++i) result.push_back(i * (n - 1) / gaps);
  return result;
}

/// Quads of a lattice's six faces, anticlockwise from outside, at most so many along an edge.
std::vector<Quad> faces_of(const Body& body, int quads_along) {
  const std::array<int, 3> n = body.lattice;
  const auto index = [&](const std::array<int, 3>& p) {
    return body.first_particle + static_cast<std::uint32_t>((p[0] * n[1] + p[1]) * n[2] + p[2]);
  };
  std::vector<Quad> quads;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    const std::vector<int> us = places(n[u], quads_along), vs = places(n[v], quads_along);
    for (const bool high : {false, true}) {
      std::array<int, 3> p = {};
      p[axis] = high ? n[axis] - 1 : 0;
      const auto at = [&](std::size_t i, std::size_t j) {
        p[u] = us[i];
        p[v] = vs[j];
        return index(p);
      };
      for (std::size_t i = 0; i + 1 < us.size(); ++i) {
        for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
          const Quad outward = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
          quads.push_back(high ? outward : Quad{outward[0], outward[3], outward[2], outward[1]});
        }
      }
    }
  }
  return quads;
}

Surface::Part add_triangles(const std::vector<Quad>& quads, std::vector<std::uint32_t>& indices) {
  const auto first = static_cast<std::uint32_t>(indices.size());
  for (const Quad& q : quads) indices.insert(indices.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
  return {first, static_cast<std::uint32_t>(indices.size()) - first};
}

}  // namespace

Surface make_surface(const Model& model) {
  Surface surface;
  std::vector<Quad> all;
  for (const Body& body : model.bodies) {
    const bool inside = body.surface == BodySurface::faces;
    const std::vector<Quad> quads =
        inside ? faces_of(body, std::numeric_limits<int>::max()) : std::vector<Quad>();
    surface.parts.push_back(add_triangles(quads, surface.indices));
    all.insert(all.end(), quads.begin(), quads.end());
    const bool fine = std::ranges::max(body.lattice) - 1 > software::coarse_quads;
    surface.coarse_parts.push_back(
        inside && fine ? add_triangles(faces_of(body, software::coarse_quads), surface.indices)
                       : surface.parts.back());
  }
  std::vector<std::uint32_t> quads_at(model.particle_count(), 0);
  for (const Quad& q : all)
    for (const std::uint32_t vertex : q) ++quads_at[vertex];
  std::vector<std::uint32_t> next(model.particle_count(), 0);
  std::uint32_t total = 0;
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    if (quads_at[i] == 0) continue;
    surface.fan_vertex.push_back(i);
    surface.fan_start.push_back(total);
    next[i] = total;
    total += quads_at[i];
  }
  surface.fan_start.push_back(total);
  surface.fan.resize(2 * std::size_t{total});
  for (const Quad& q : all) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::size_t slot = 2 * std::size_t{next[q[corner]]++};
      surface.fan[slot] = q[(corner + 1) % 4];
      surface.fan[slot + 1] = q[(corner + 3) % 4];
    }
  }
  return surface;
}

}  // namespace aspic
