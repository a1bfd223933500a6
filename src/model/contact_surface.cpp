#include "model/contact_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace aspic {
namespace {

/// k of the springs between neighbors, and the least of their rest lengths.
void take_springs(const Model& model, const Body& body, ContactBody& contact) {
  contact.spacing = std::numeric_limits<double>::infinity();
  for (std::uint32_t c = body.first_class; c < body.first_class + body.class_count; ++c) {
    const SpringClass& springs = model.spring_classes[c];
    if (springs.type != SpringType::structural || springs.rest_length >= contact.spacing) continue;
    contact.spacing = springs.rest_length;
    contact.stiffness = lattice_stiffness_share * springs.stiffness;
    contact.damping = springs.damping;
  }
}

/// A side of a quad, a < b, and the group of that quad.
struct QuadSide {
  std::uint32_t a, b, group;
  friend auto operator<=>(const QuadSide&, const QuadSide&) = default;
};

/// Edges (a, b) at which quads of two groups meet, or, of an open surface, those of one quad alone;
/// ascending.
std::vector<std::array<std::uint32_t, 2>> sharp_edges(const QuadMesh& mesh, bool closed) {
  std::vector<QuadSide> sides;
  std::uint32_t number = 0;
  mesh.for_each_group([&](const NormalGroup&, std::span<const Quad> quads) {
    for (const Quad& q : quads)
      for (std::size_t n = 0; n < 4; ++n)
        sides.push_back({std::min(q[n], q[(n + 1) % 4]), std::max(q[n], q[(n + 1) % 4]), number});
    ++number;
  });
  std::ranges::sort(sides);
  std::vector<std::array<std::uint32_t, 2>> sharp;
  for (auto at = sides.begin(); at != sides.end();) {
    const auto end =
        std::find_if(at, sides.end(), [&](const QuadSide& s) { return s.a != at->a || s.b != at->b; });
    if (at->group != (end - 1)->group || (!closed && end - at == 1)) sharp.push_back({at->a, at->b});
    at = end;
  }
  return sharp;
}

/// Particles of a surface, ascending.
std::vector<std::uint32_t> particles_of(const QuadMesh& mesh) {
  std::vector<std::uint32_t> particles;
  for (const Quad& q : mesh.quads) particles.insert(particles.end(), q.begin(), q.end());
  std::ranges::sort(particles);
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  return particles;
}

void append_points(ContactSurfaces& all, ContactBody& contact, const QuadMesh& mesh) {
  const std::vector<std::uint32_t> particles = particles_of(mesh);
  const auto point_of = [&](std::uint32_t particle) {
    return contact.first_point +
           static_cast<std::uint32_t>(std::ranges::lower_bound(particles, particle) - particles.begin());
  };
  contact.first_point = static_cast<std::uint32_t>(all.points.size());
  contact.surface_particles = static_cast<std::uint32_t>(particles.size());
  for (const std::uint32_t p : particles)
    all.points.push_back({{p, p}, {point_of(p), point_of(p)}, {1.0, 0.0}});
  constexpr double parts = points_on_edge + 1;
  for (const auto& [a, b] : sharp_edges(mesh, contact.closed))
    for (int j = 1; j <= points_on_edge; ++j)
      all.points.push_back({{a, b}, {point_of(a), point_of(b)}, {1.0 - j / parts, j / parts}});
  contact.point_count = static_cast<std::uint32_t>(all.points.size()) - contact.first_point;
}

void append_triangles(ContactSurfaces& all, ContactBody& contact, const QuadMesh& mesh) {
  contact.first_triangle = static_cast<std::uint32_t>(all.triangles.size());
  std::uint32_t side = 0;
  mesh.for_each_group([&](const NormalGroup&, std::span<const Quad> quads) {
    for (const Quad& q : quads) {
      all.triangles.push_back({{q[0], q[1], q[2]}, side});
      all.triangles.push_back({{q[0], q[2], q[3]}, side});
    }
    ++side;
  });
  contact.triangle_count = static_cast<std::uint32_t>(all.triangles.size()) - contact.first_triangle;
}

/// Fills in from and at_particle: triangles by particle, then by number.
void list_triangles_at(ContactSurfaces& all) {
  std::vector<std::tuple<std::uint32_t, std::uint32_t>> at;  // particle, triangle
  for (std::uint32_t t = 0; t < all.triangles.size(); ++t)
    for (const std::uint32_t corner : all.triangles[t].corner) at.emplace_back(corner, t);
  std::ranges::sort(at);
  auto next = at.begin();
  for (const SurfacePoint& point : all.points) {
    all.from.push_back(static_cast<std::uint32_t>(all.at_particle.size()));
    if (!point.single()) continue;
    for (; next != at.end() && std::get<0>(*next) == point.carrier[0]; ++next)
      all.at_particle.push_back(std::get<1>(*next));
  }
  all.from.push_back(static_cast<std::uint32_t>(all.at_particle.size()));
}

/// Fills in faces.
void name_corners(ContactSurfaces& all, std::size_t particles) {
  std::vector<std::uint32_t> point_of(particles);
  for (std::uint32_t p = 0; p < all.points.size(); ++p)
    if (all.points[p].single()) point_of[all.points[p].carrier[0]] = p;
  for (const auto& [corner, side] : all.triangles)
    all.faces.push_back({point_of[corner[0]], point_of[corner[1]], point_of[corner[2]], side});
}

bool has_surface(const Body& body) {
  return body.style != SurfaceStyle::cords || !body.listed_surface.quads.empty();
}

/// The surface of a body, or the meshes of a net.
QuadMesh contact_mesh(const Body& body) {
  return body.style == SurfaceStyle::cords ? body.listed_surface : surface_of(body);
}

}  // namespace

std::uint32_t ContactSurfaces::body_of_point(std::uint32_t point) const {
  const auto after = std::ranges::upper_bound(bodies, point, {}, &ContactBody::first_point);
  return static_cast<std::uint32_t>(after - bodies.begin()) - 1;
}

std::uint32_t ContactSurfaces::body_of_triangle(std::uint32_t triangle) const {
  const auto after = std::ranges::upper_bound(bodies, triangle, {}, &ContactBody::first_triangle);
  return static_cast<std::uint32_t>(after - bodies.begin()) - 1;
}

ContactSurfaces contact_surfaces(const Model& model) {
  ContactSurfaces all;
  for (const Body& body : model.bodies) {
    if (!has_surface(body)) continue;
    const QuadMesh mesh = contact_mesh(body);
    ContactBody contact;
    contact.body = static_cast<std::uint32_t>(&body - model.bodies.data());
    contact.closed = body.style == SurfaceStyle::flesh;
    contact.mass = model.mass[body.first_particle];
    contact.friction = body.friction.value_or(model.contact.body_friction);
    take_springs(model, body, contact);
    append_points(all, contact, mesh);
    append_triangles(all, contact, mesh);
    all.bodies.push_back(contact);
  }
  list_triangles_at(all);
  name_corners(all, model.particle_count());
  return all;
}

ContactPair contact_pair(const ContactSettings& contact, const ContactBody& point_of,
                         const ContactBody& face_of, bool same_body) {
  const double a = point_of.stiffness, b = face_of.stiffness;
  ContactPair pair;
  pair.stiffness = a + b > 0.0 ? 2.0 * a * b / (a + b) : 0.0;
  pair.damping =
      2.0 * contact.body_damping * std::sqrt(pair.stiffness / (1.0 / point_of.mass + 1.0 / face_of.mass));
  pair.friction = std::min(point_of.friction, face_of.friction);
  pair.spacing = std::min(point_of.spacing, face_of.spacing);
  // An open surface exerts no force on points that have passed its reach.
  pair.reach = (face_of.closed ? 1.0 : 2.5) * contact.body_gap * pair.spacing;
  pair.range = pair.reach;
  // Contact would move a point beyond the middle of a body out of the other side: a body of one cell is s
  // thick, less where it is compressed.
  pair.depth = 0.25 * pair.spacing;
  pair.eased_depth = (same_body ? 0.5 : 1.0) * pair.spacing;
  pair.margin = std::max(pair.eased_depth, pair.reach) + 0.5 * pair.spacing;
  return pair;
}

ContactPair with_implicit_range(ContactPair pair, double h) {
  pair.damping = pair.stiffness * h;
  pair.range = std::max(pair.reach, contact_range * pair.spacing);
  return pair;
}

std::uint64_t contact_bytes(const Model& model) {
  const ContactSurfaces all = contact_surfaces(model);
  // With places of points, boxes and corners of triangles (src/collision/candidate_lists.h).
  return all.points.size() * (sizeof(SurfacePoint) + 3 * sizeof(Vec3)) +
         all.triangles.size() * (sizeof(SurfaceTriangle) + sizeof(all.faces[0]) + 9 * sizeof(double)) +
         (all.from.size() + all.at_particle.size() + model.particle_count()) * sizeof(std::uint32_t);
}

bool has_body_contact(const Model& model) {
  const auto count = std::ranges::count_if(model.bodies, has_surface);
  return (model.contact.bodies && count > 1) || (model.contact.self && count > 0);
}

}  // namespace aspic
