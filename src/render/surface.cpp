#include "render/surface.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "render/software_rasterizer.h"

namespace aspic {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

/// Whether a coarse skin would differ.
bool is_fine(const QuadMesh& mesh) {
  return std::ranges::any_of(mesh.groups, [](const NormalGroup& group) {
    return std::ranges::max(group.count) > software::coarse_quads;
  });
}

/// Triangles over particles and over vertices.
struct Triangles {
  std::vector<std::uint32_t> particles, vertices;
};

/// Makes the vertices of one group of normals after another.
class Vertices {
 public:
  explicit Vertices(std::uint32_t particles) : of_group_(particles, none), latest_(particles, none) {}

  void add(std::span<const Quad> quads, Triangles& into) {
    for (const Quad& q : quads) {
      for (const std::size_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) {
        into.particles.push_back(q[corner]);
        into.vertices.push_back(vertex(q[corner]));
      }
    }
  }
  void add_fans(std::span<const Quad> quads) {
    for (const Quad& q : quads)
      for (std::size_t corner = 0; corner < 4; ++corner)
        own_[of_group_[q[corner]]].push_back({q[(corner + 1) % 4], q[(corner + 3) % 4]});
  }
  void end_group(std::span<const Quad> quads) {
    for (const Quad& q : quads)
      for (const std::uint32_t particle : q) of_group_[particle] = none;
  }

  std::uint32_t count() const { return static_cast<std::uint32_t>(particle_.size()); }

  /// Fans in the order of the vertices, a vertex's own quads before those of other groups.
  void write_fans(Surface& surface) const {
    surface.fan_vertex = particle_;
    for (std::size_t v = 0; v < own_.size(); ++v) {
      const auto append = [&](std::size_t of) {
        for (const auto& corner : own_[of])
          surface.fan.insert(surface.fan.end(), corner.begin(), corner.end());
        return static_cast<std::uint32_t>(surface.fan.size() / 2);
      };
      surface.fan_start.push_back(static_cast<std::uint32_t>(surface.fan.size() / 2));
      surface.fan_own.push_back(append(v));
      for (std::uint32_t other = latest_[particle_[v]]; other != none; other = before_[other])
        if (other != v) append(other);
    }
    surface.fan_start.push_back(static_cast<std::uint32_t>(surface.fan.size() / 2));
  }

 private:
  std::uint32_t vertex(std::uint32_t particle) {
    std::uint32_t& known = of_group_[particle];
    if (known != none) return known;
    known = static_cast<std::uint32_t>(particle_.size());
    before_.push_back(std::exchange(latest_[particle], known));
    particle_.push_back(particle);
    own_.emplace_back();
    return known;
  }

  std::vector<std::uint32_t> of_group_;         // by particle: its vertex in the group under way
  std::vector<std::uint32_t> latest_, before_;  // the newest vertex of a particle; the one before a vertex
  std::vector<std::uint32_t> particle_;         // by vertex
  std::vector<std::vector<std::array<std::uint32_t, 2>>> own_;  // by vertex: next and previous neighbors
};

Surface::Part append(const Triangles& made, Surface& surface) {
  const auto first = static_cast<std::uint32_t>(surface.indices.size());
  surface.indices.insert(surface.indices.end(), made.particles.begin(), made.particles.end());
  surface.corners.insert(surface.corners.end(), made.vertices.begin(), made.vertices.end());
  return {first, static_cast<std::uint32_t>(made.particles.size())};
}

/// Vertices and triangles of a mesh; vertices are counted from `fans` on, which is how many others there are.
Triangles add_mesh(const BodySkin& skin, std::uint32_t fans, Surface& surface,
                   std::vector<std::vector<std::uint32_t>>& fan) {
  const std::uint32_t first = fans + static_cast<std::uint32_t>(surface.mesh_corners.size());
  surface.mesh_corners.insert(surface.mesh_corners.end(), skin.corners.begin(), skin.corners.end());
  for (const SkinVertex& v : skin.binding.vertices)
    surface.mesh_places.push_back(
        {static_cast<float>(v.at.x), static_cast<float>(v.at.y), static_cast<float>(v.at.z), 0.0f});
  fan.resize(surface.mesh_corners.size());
  Triangles made;
  for (const Triangle& t : skin.triangles) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3& at = skin.binding.vertices[t[corner]].at;
      const std::size_t nearest = (at.x > 0.5 ? 4u : 0u) + (at.y > 0.5 ? 2u : 0u) + (at.z > 0.5 ? 1u : 0u);
      made.particles.push_back(skin.corners[t[corner]][nearest]);
      made.vertices.push_back(first + t[corner]);
      auto& around = fan[first - fans + t[corner]];
      around.push_back(first + t[(corner + 1) % 3]);
      around.push_back(first + t[(corner + 2) % 3]);
    }
  }
  return made;
}

/// The vertices of fans that a model has: those of its bodies without meshes.
std::uint32_t fan_vertices(const Model& model) {
  Vertices vertices(model.particle_count());
  Triangles passed;
  for (const Body& body : model.bodies) {
    if (!body.skin.empty()) continue;
    surface_of(body).for_each_group([&](const NormalGroup&, std::span<const Quad> quads) {
      vertices.add(quads, passed);
      vertices.end_group(quads);
    });
  }
  return vertices.count();
}

}  // namespace

Surface make_surface(const Model& model) {
  Surface surface;
  Vertices vertices(model.particle_count());
  const bool meshes = std::ranges::any_of(model.bodies, [](const Body& body) { return !body.skin.empty(); });
  const std::uint32_t fans = meshes ? fan_vertices(model) : 0;
  std::vector<std::vector<std::uint32_t>> mesh_fan;
  for (const Body& body : model.bodies) {
    Triangles fine, coarse;
    if (!body.skin.empty()) {
      surface.parts.push_back(append(add_mesh(body.skin, fans, surface, mesh_fan), surface));
      surface.parts.back().mesh = true;
      surface.coarse_parts.push_back(surface.parts.back());
      continue;
    }
    const QuadMesh mesh = surface_of(body);
    mesh.for_each_group([&](const NormalGroup& group, std::span<const Quad> quads) {
      vertices.add(quads, fine);
      vertices.add_fans(quads);
      if (is_fine(mesh)) vertices.add(coarser(group, quads, software::coarse_quads), coarse);
      vertices.end_group(quads);
    });
    surface.parts.push_back(append(fine, surface));
    surface.coarse_parts.push_back(is_fine(mesh) ? append(coarse, surface) : surface.parts.back());
  }
  vertices.write_fans(surface);
  surface.mesh_start.push_back(0);
  for (const auto& around : mesh_fan) {
    surface.mesh_fan.insert(surface.mesh_fan.end(), around.begin(), around.end());
    surface.mesh_start.push_back(static_cast<std::uint32_t>(surface.mesh_fan.size() / 2));
  }
  return surface;
}

}  // namespace aspic
