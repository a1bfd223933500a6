#include "model/ball_faces.h"

#include <algorithm>

namespace aspic {
namespace {

/// Balls pass between the cords of a net.
bool has_faces(const Body& body) {
  return body.style != SurfaceStyle::cords;
}

}  // namespace

bool balls_meet_faces(const Model& model) {
  return model.ball_count() > 0 && model.contact.bodies && model.contact.model == ContactModel::coulomb &&
         std::ranges::any_of(model.bodies, has_faces);
}

BallFaces ball_faces(const Model& model) {
  BallFaces faces;
  if (!balls_meet_faces(model)) return faces;
  for (const Body& body : model.bodies) {
    if (!has_faces(body)) continue;
    FacesOfBody& of = faces.bodies.emplace_back();
    of.closed = body.style == SurfaceStyle::flesh;
    of.first_triangle = static_cast<std::uint32_t>(faces.triangles.size());
    for (const Quad& q : surface_of(body).quads) {
      faces.triangles.push_back({q[0], q[1], q[2]});
      faces.triangles.push_back({q[0], q[2], q[3]});
    }
    of.triangle_count = static_cast<std::uint32_t>(faces.triangles.size()) - of.first_triangle;
  }
  return faces;
}

}  // namespace aspic
