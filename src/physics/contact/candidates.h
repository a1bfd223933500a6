#pragma once
// Candidates by their definition (docs/contact.md, "Which faces a point touches", 1): in a step a point can
// touch the triangles whose boxes, widened by the pair's margin, hold it where the step begins.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/contact_surface.h"
#include "model/model.h"
#include "physics/contact/geometry.h"
#include "physics/contact/pairs.h"
#include "physics/particle_view.h"

namespace aspic::physics {

/// Position or velocity of a point on a surface; value(particle) is that of a particle.
template <class T, class Value>
Vector<T> carried(const SurfacePoint& point, const Value& value) {
  if (point.single()) return value(point.carrier[0]);
  return static_cast<T>(point.weight[0]) * value(point.carrier[0]) +
         static_cast<T>(point.weight[1]) * value(point.carrier[1]);
}
template <class T>
Vector<T> position_of(const SurfacePoint& point, const ParticleView<const T>& at) {
  return carried<T>(point, [&](std::uint32_t p) { return at.position(p); });
}

template <class T>
Box<T> box_of(const SurfaceTriangle& triangle, const ParticleView<const T>& at) {
  return Box<T>::around(at.position(triangle.corner[0]), at.position(triangle.corner[1]),
                        at.position(triangle.corner[2]));
}

/// Whether a point and a triangle of the same body are far enough apart at rest to touch.
inline bool far_apart_at_rest(const Model& model, const SurfacePoint& point, const SurfaceTriangle& triangle,
                              double spacing) {
  const auto at = [&](std::uint32_t particle) { return model.initial_position[particle]; };
  const Vec3 place = point.single()
                         ? at(point.carrier[0])
                         : point.weight[0] * at(point.carrier[0]) + point.weight[1] * at(point.carrier[1]);
  return std::ranges::all_of(triangle.corner, [&](std::uint32_t corner) {
    return length(place - at(corner)) > least_rest_distance * spacing;
  });
}

/// Every point against every triangle, at the start of a step. Calls take(point, body, triangle) for all
/// candidates, ascending. Boxes around blocks of triangles rule most out; they change nothing in the result.
template <class T, class Take>
void for_each_candidate(const Model& model, const ContactSurfaces& surfaces, const PairTable<T>& table,
                        const ParticleView<const T>& start, const Take& take) {
  constexpr std::uint32_t block = 16;
  std::vector<Box<T>> boxes, blocks;  // blocks: by first triangle / block
  for (const SurfaceTriangle& triangle : surfaces.triangles) boxes.push_back(box_of<T>(triangle, start));
  for (std::uint32_t t = 0; t < boxes.size(); ++t) {
    if (t % block == 0) blocks.push_back(boxes[t]);
    blocks.back().extend(boxes[t]);
  }
  for (std::uint32_t own = 0; own < surfaces.bodies.size(); ++own) {
    const ContactBody& points = surfaces.bodies[own];
    for (std::uint32_t p = points.first_point; p < points.first_point + points.point_count; ++p) {
      const SurfacePoint& point = surfaces.points[p];
      const Vector<T> P = position_of<T>(point, start);
      for (std::uint32_t body = 0; body < surfaces.bodies.size(); ++body) {
        if (body == own && !model.contact.self) continue;
        const ContactBody& faces = surfaces.bodies[body];
        const T margin = table.at(own, body).margin;
        const std::uint32_t end = faces.first_triangle + faces.triangle_count;
        for (std::uint32_t t = faces.first_triangle; t < end; ++t) {
          if (!blocks[t / block].holds(margin, P)) {
            t = (t / block + 1) * block - 1;
            continue;
          }
          if (!boxes[t].holds(margin, P)) continue;
          if (body == own && !far_apart_at_rest(model, point, surfaces.triangles[t], points.spacing))
            continue;
          take(p, body, t);
        }
      }
    }
  }
}

}  // namespace aspic::physics
