#include "render/surface.h"

#include <algorithm>

#include "render/software_rasteriser.h"

namespace aspic {
namespace {

/// Whether a coarse skin would differ.
bool is_fine(const Body& body) {
  return std::ranges::any_of(body.surface, [](const Patch& patch) {
    return std::ranges::max(patch.count) - 1 > software::coarse_quads;
  });
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
    const std::vector<Quad> quads = quads_of(body);
    surface.parts.push_back(add_triangles(quads, surface.indices));
    all.insert(all.end(), quads.begin(), quads.end());
    surface.coarse_parts.push_back(
        is_fine(body) ? add_triangles(quads_of(body, software::coarse_quads), surface.indices)
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
