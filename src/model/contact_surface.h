#pragma once
// Surfaces for contact between bodies (docs/contact.md): points of one body, triangles of another, and the
// constants of a pair. Made once, from a model.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "model/model.h"

namespace aspic {

/// A point of a body for contact: a particle of its surface, or a point between two neighbors on a
/// sharp edge.
struct SurfacePoint {
  std::array<std::uint32_t, 2> carrier = {};  ///< particles; a particle's own point names it twice
  std::array<std::uint32_t, 2> own = {};      ///< the points of these particles
  std::array<double, 2> weight = {};          ///< {1, 0}, or (1 − j/3, j/3)
  bool single() const { return carrier[0] == carrier[1]; }
};

/// Half a quad of a surface, counterclockwise seen from outside.
struct SurfaceTriangle {
  std::array<std::uint32_t, 3> corner = {};  ///< particles
  std::uint32_t side = 0;                    ///< the group of the surface's quads that it belongs to
};

/// κ of a body in k of its structural springs: E·s of a cube.
inline constexpr double lattice_stiffness_share = 7.3125;

/// A body with a surface.
struct ContactBody {
  std::uint32_t body = 0;  ///< index in Model::bodies
  std::uint32_t first_point = 0, point_count = 0;
  std::uint32_t surface_particles = 0;  ///< the first of its points are those of particles, in their order
  std::uint32_t first_triangle = 0, triangle_count = 0;
  bool closed = true;      ///< has an inside
  double stiffness = 0.0;  ///< κ = 7.3125·k of its structural springs, E·s of a cube [N/m]
  double mass = 0.0;       ///< of a particle [kg], of pinned ones too
  double spacing = 0.0;    ///< s [m]
  double friction = 0.0;   ///< μ
  double damping = 0.0;    ///< c of these springs [N·s/m]

  /// Whether two have the same constants.
  bool alike(const ContactBody& other) const {
    return closed == other.closed && stiffness == other.stiffness && mass == other.mass &&
           spacing == other.spacing && friction == other.friction;
  }
};

/// All surfaces of a model, in the order of its bodies. Numbers of points and triangles count through all of
/// them.
struct ContactSurfaces {
  std::vector<ContactBody> bodies;
  std::vector<SurfacePoint> points;
  std::vector<SurfaceTriangle> triangles;
  std::vector<std::array<std::uint32_t, 4>> faces;  ///< of triangles: the points of the corners, and the side
  /// Triangles at the particle of point p, ascending: at_particle[from[p]] … at_particle[from[p + 1] − 1];
  /// none at the points of edges.
  std::vector<std::uint32_t> from, at_particle;

  std::span<const std::uint32_t> triangles_at(std::uint32_t point) const {
    return std::span(at_particle).subspan(from[point], from[point + 1] - from[point]);
  }
  /// Indices in `bodies`.
  std::uint32_t body_of_point(std::uint32_t point) const;
  std::uint32_t body_of_triangle(std::uint32_t triangle) const;
};

/// Points on a sharp edge between two neighboring particles.
inline constexpr int points_on_edge = 2;

ContactSurfaces contact_surfaces(const Model& model);

/// Constants of contact between a point of one body and the triangles of another, or of the same.
struct ContactPair {
  double stiffness = 0.0;    ///< k [N/m]
  double damping = 0.0;      ///< c [N·s/m]
  double friction = 0.0;     ///< μ
  double spacing = 0.0;      ///< s [m]
  double reach = 0.0;        ///< ρ [m]: where normal forces begin
  double range = 0.0;        ///< up to where contacts are found [m]
  double depth = 0.0;        ///< D [m]: where they end, far from the middle of the thinnest body
  double eased_depth = 0.0;  ///< the same of bodies that are eased apart [m]
  double margin = 0.0;       ///< by which the boxes of candidates are widened [m]
};
ContactPair contact_pair(const ContactSettings& contact, const ContactBody& point_of,
                         const ContactBody& face_of, bool same_body);

/// Distance, in spacings, from which on implicit Euler knows of a contact at the start of a step.
inline constexpr double contact_range = 0.4;

/// The same pair where normal forces are those at the end of a step h [s], k·(ρ − d − h·u): k·h is the
/// damping, and contacts are found from contact_range on.
ContactPair with_implicit_range(ContactPair pair, double h);

/// Least distance, in spacings and at rest, of a point and a triangle's corners for contact within one body.
inline constexpr double least_rest_distance = 2.1;

/// Bytes that a solver takes for all of it, without current contacts.
std::uint64_t contact_bytes(const Model& model);

/// Whether the settings ask for contact that some of the model's bodies can have.
bool has_body_contact(const Model& model);

}  // namespace aspic
