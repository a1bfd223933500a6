#include "render/surface.h"

#include <array>

namespace aspic {
namespace {

using Quad = std::array<std::uint32_t, 4>;

/// Quads of a lattice's six faces, anticlockwise from outside.
std::vector<Quad> faces_of(const Body& body) {
  const std::array<int, 3> n = body.lattice;
  const auto index = [&](const std::array<int, 3>& p) {
    return body.first_particle + static_cast<std::uint32_t>((p[0] * n[1] + p[1]) * n[2] + p[2]);
  };
  std::vector<Quad> quads;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    for (const bool high : {false, true}) {
      std::array<int, 3> p = {};
      p[axis] = high ? n[axis] - 1 : 0;
      for (p[u] = 0; p[u] + 1 < n[u]; ++p[u]) {
        for (p[v] = 0; p[v] + 1 < n[v]; ++p[v]) {
          std::array<int, 3> pu = p, pv = p, puv = p;
          ++pu[u];
          ++pv[v];
          ++puv[u];
          ++puv[v];
          const Quad outward = {index(p), index(pu), index(puv), index(pv)};
          quads.push_back(high ? outward : Quad{outward[0], outward[3], outward[2], outward[1]});
        }
      }
    }
  }
  return quads;
}

}  // namespace

Surface make_surface(const Model& model) {
  Surface surface;
  std::vector<Quad> all;
  for (const Body& body : model.bodies) {
    Surface::Part part;
    part.first_index = static_cast<std::uint32_t>(surface.indices.size());
    if (body.kind == BodyKind::cube) {
      for (const Quad& q : faces_of(body)) {
        surface.indices.insert(surface.indices.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
        all.push_back(q);
      }
    }
    part.index_count = static_cast<std::uint32_t>(surface.indices.size()) - part.first_index;
    surface.parts.push_back(part);
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
