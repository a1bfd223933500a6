#include "render/surface.h"

#include <algorithm>
#include <array>
#include <limits>

#include "render/software_rasteriser.h"

namespace aspic {
namespace {

using Quad = std::array<std::uint32_t, 4>;

/// Places along an edge of n particles, the first and the last among them, with at most `quads` gaps.
std::vector<std::uint32_t> places(std::uint32_t n, std::uint32_t quads) {
  const std::uint32_t gaps = std::min(n - 1, quads);
  std::vector<std::uint32_t> result;
  for (std::uint64_t i = 0; i <= gaps; ++i) result.push_back(static_cast<std::uint32_t>(i * (n - 1) / gaps));
  return result;
}

/// Quads of a body's surface, anticlockwise from outside, at most so many along an edge of a patch.
std::vector<Quad> quads_of(const Body& body, std::uint32_t quads_along) {
  std::vector<Quad> quads;
  for (const Patch& patch : body.surface) {
    const std::vector<std::uint32_t> us = places(patch.count[0], quads_along),
                                     vs = places(patch.count[1], quads_along);
    const auto at = [&](std::size_t i, std::size_t j) {
      return patch.first + us[i] * patch.stride[0] + vs[j] * patch.stride[1];
    };
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
      for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
        const Quad quad = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
        quads.push_back(patch.clockwise ? Quad{quad[0], quad[3], quad[2], quad[1]} : quad);
      }
    }
  }
  return quads;
}

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
    const std::vector<Quad> quads = quads_of(body, std::numeric_limits<std::uint32_t>::max());
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
