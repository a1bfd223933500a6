#include "analysis/body_overlap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "collision/contact_search.h"

namespace aspic {
namespace {

using Vector = physics::Vector<double>;

constexpr double no_bound = std::numeric_limits<double>::infinity();

/// How many triangles have one box.
constexpr std::uint32_t block_size = 32;
/// Of how many points of a pair the depth is found; of more, every second, third …
constexpr std::size_t most_measured = 200;
/// Of how many particles it is found whether they are within another body.
constexpr std::size_t most_tried = 2000;

/// Every second, third … so that there are no more than `most`.
std::size_t stride_of(std::size_t count, std::size_t most) {
  return std::max<std::size_t>(1, (count + most - 1) / most);
}

/// A closed surface in space.
class Skin {
 public:
  Skin(std::span<const SurfaceTriangle> triangles, const State& state) {
    for (const SurfaceTriangle& t : triangles) {
      const auto x = [&](std::size_t n) { return physics::rounded<double>(state.position[t.corner[n]]); };
      faces_.push_back({x(0), x(1), x(2)});
    }
    for (std::size_t first = 0; first < faces_.size(); first += block_size) {
      Block block = {first, std::min(first + block_size, faces_.size()), Vector::Constant(no_bound),
                     Vector::Constant(-no_bound)};
      for (std::size_t n = block.first; n < block.end; ++n) {
        for (const Vector& corner : faces_[n]) {
          block.low = block.low.cwiseMin(corner);
          block.high = block.high.cwiseMax(corner);
        }
      }
      blocks_.push_back(block);
    }
  }

  /// Distance of P from the surface where it is less than `most` [m], else that.
  double distance(const Vector& P, double most) const {
    for (const Block& block : blocks_) {
      const Vector away = (block.low - P).cwiseMax(P - block.high).cwiseMax(0.0);
      if (away.squaredNorm() >= most * most) continue;
      for (std::size_t n = block.first; n < block.end; ++n) {
        const auto& [A, B, C] = faces_[n];
        const auto at = physics::nearest_place<double>(P, A, B, C);
        most = std::min(most, (((P - A) - at.b * (B - A)) - at.c * (C - A)).norm());
      }
    }
    return most;
  }

  /// Whether a ray along x crosses the surface an odd number of times.
  bool holds(const Vector& P) const {
    bool within = false;
    for (const Block& block : blocks_) {
      if (block.high.x() < P.x() || block.low.y() > P.y() || block.high.y() < P.y() ||
          block.low.z() > P.z() || block.high.z() < P.z())
        continue;
      for (std::size_t n = block.first; n < block.end; ++n) within = within != crosses(faces_[n], P);
    }
    return within;
  }

 private:
  using Corners = std::array<Vector, 3>;
  struct Block {
    std::size_t first, end;
    Vector low, high;
  };

  /// Whether the ray from P along x meets the triangle. Of what lies on a side, seen along x, the side's two
  /// triangles have one each: sides are cut from their lower end, so that both find the same bits.
  static bool crosses(const Corners& face, const Vector& P) {
    std::array<Vector, 2> cuts;  // of the sides with the plane y = P.y
    std::size_t count = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      const Vector &a = face[n], &b = face[(n + 1) % 3];
      if ((a.y() > P.y()) == (b.y() > P.y())) continue;
      const Vector &low = a.y() < b.y() ? a : b, &high = a.y() < b.y() ? b : a;
      cuts[count++] = low + (P.y() - low.y()) / (high.y() - low.y()) * (high - low);
    }
    if (count == 0) return false;
    if (cuts[0].z() > cuts[1].z()) std::swap(cuts[0], cuts[1]);
    if (P.z() < cuts[0].z() || P.z() >= cuts[1].z()) return false;
    const double share = (P.z() - cuts[0].z()) / (cuts[1].z() - cuts[0].z());
    return cuts[0].x() + share * (cuts[1].x() - cuts[0].x()) > P.x();
  }

  std::vector<Corners> faces_;
  std::vector<Block> blocks_;
};

/// How far the deepest of these places within it is from a surface [m]; 0 if there are none.
double deepest_of(const Skin& skin, const std::vector<Vector>& within) {
  double deepest = 0.0;
  for (std::size_t n = 0; n < within.size(); n += stride_of(within.size(), most_measured))
    deepest = std::max(deepest, skin.distance(within[n], no_bound));
  return deepest;
}

BodyOverlap& pair_of(DeepPoints::Found& overlaps, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t low = std::min(a, b), high = std::max(a, b);
  return overlaps.try_emplace({low, high}, BodyOverlap{low, high, 0.0, 0.0, 0.0}).first->second;
}

}  // namespace

DeepPoints::DeepPoints(const Model& model) : contact_(model.contact) {
  if (model.contact.bodies && has_body_contact(model)) surfaces_ = contact_surfaces(model);
}

DeepPoints::Boxes DeepPoints::boxes_of(const State& state) const {
  Boxes boxes;
  for (const ContactBody& body : surfaces_.bodies) {
    Box& box = boxes.emplace_back(Box{{no_bound, no_bound, no_bound}, {-no_bound, -no_bound, -no_bound}});
    for (std::uint32_t p = body.first_point; p < body.first_point + body.surface_particles; ++p) {
      const Vec3& x = state.position[surfaces_.points[p].carrier[0]];
      for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], x[axis]);
        box.high[axis] = std::max(box.high[axis], x[axis]);
      }
    }
  }
  return boxes;
}

std::vector<BodyOverlap> DeepPoints::listed(const Found& found) {
  std::vector<BodyOverlap> all;
  for (const auto& [pair, each] : found) all.push_back(each);
  return all;
}

double DeepPoints::depth(std::uint32_t a, std::uint32_t b) const {
  return contact_pair(contact_, surfaces_.bodies[a], surfaces_.bodies[b], false).depth;
}

/// Whether a point of a may be deeper than D in b: what is deeper than that is as deep in the box of b.
bool DeepPoints::near(const Boxes& boxes, std::uint32_t a, std::uint32_t b) const {
  if (a == b || !surfaces_.bodies[b].closed) return false;
  const double D = depth(a, b);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(boxes[a].low[axis] <= boxes[b].high[axis] - D && boxes[a].high[axis] >= boxes[b].low[axis] + D))
      return false;
  }
  return true;
}

void DeepPoints::take(const State& state, const Boxes& boxes, std::uint32_t a, std::uint32_t b,
                      DeepPoints::Found& found) const {
  const ContactBody &points = surfaces_.bodies[a], &faces = surfaces_.bodies[b];
  const double D = depth(a, b);
  std::vector<Vector> candidates;
  for (std::uint32_t p = points.first_point; p < points.first_point + points.surface_particles; ++p) {
    const Vec3& x = state.position[surfaces_.points[p].carrier[0]];
    bool in = true;
    for (int axis = 0; axis < 3; ++axis)
      in = in && x[axis] >= boxes[b].low[axis] + D && x[axis] <= boxes[b].high[axis] - D;
    if (in) candidates.push_back(physics::rounded<double>(x));
  }
  if (candidates.empty()) return;
  const Skin skin(std::span(surfaces_.triangles).subspan(faces.first_triangle, faces.triangle_count), state);
  std::vector<Vector> deep;
  for (const Vector& P : candidates)
    if (skin.distance(P, D) >= D && skin.holds(P)) deep.push_back(P);
  if (deep.empty()) return;
  BodyOverlap& overlap = pair_of(found, points.body, faces.body);
  overlap.most = D;
  overlap.deepest = std::max(overlap.deepest, deepest_of(skin, deep));
}

namespace {

/// How deep the deepest of these places is within a closed surface [m]; 0 if none is.
double deepest_within(const Skin& skin, const std::vector<Vector>& places) {
  std::vector<Vector> within;
  for (std::size_t n = 0; n < places.size(); n += stride_of(places.size(), most_tried))
    if (skin.holds(places[n])) within.push_back(places[n]);
  return deepest_of(skin, within);
}

/// Particles of one body within another, those inside of it, too: where bodies are nearly in one place, all
/// points of their surfaces are next to faces that turn the same way, which exert no normal force.
void add_particles_within(const Model& model, const State& state, const ContactSurfaces& surfaces,
                          DeepPoints::Found& overlaps) {
  std::vector<Eigen::AlignedBox3d> boxes;
  const auto place = [&](std::size_t p) { return physics::rounded<double>(state.position[p]); };
  const auto for_particles = [&](const ContactBody& of, const auto& use) {
    const Body& body = model.bodies[of.body];
    for (std::size_t n = 0; n < body.particle_count; ++n) use(place(body.first_particle + n));
  };
  for (const ContactBody& each : surfaces.bodies) {
    Eigen::AlignedBox3d& box = boxes.emplace_back();
    for_particles(each, [&](const Vector& x) { box.extend(x); });
  }
  std::vector<std::optional<Skin>> skins(surfaces.bodies.size());
  const auto add = [&](std::size_t a, std::size_t b) {
    const ContactBody &points = surfaces.bodies[a], &faces = surfaces.bodies[b];
    if (points.body == faces.body || !faces.closed) return;
    std::vector<Vector> places;
    for_particles(points, [&](const Vector& x) {
      if (boxes[b].contains(x)) places.push_back(x);
    });
    if (places.empty()) return;
    if (!skins[b])
      skins[b].emplace(std::span(surfaces.triangles).subspan(faces.first_triangle, faces.triangle_count),
                       state);
    const double deepest = deepest_within(*skins[b], places);
    if (!(deepest > 0.0)) return;
    BodyOverlap& overlap = pair_of(overlaps, points.body, faces.body);
    overlap.most = std::max(overlap.most, contact_pair(model.contact, points, faces, false).eased_depth);
    overlap.deepest = std::max(overlap.deepest, deepest);
  };
  // Along x: of many bodies few are beside each other.
  std::vector<std::size_t> along(boxes.size());
  std::iota(along.begin(), along.end(), std::size_t{0});
  std::ranges::sort(along, {}, [&](std::size_t n) { return boxes[n].min().x(); });
  for (std::size_t n = 0; n < along.size(); ++n) {
    for (std::size_t m = n + 1; m < along.size(); ++m) {
      const std::size_t a = along[n], b = along[m];
      if (boxes[b].min().x() > boxes[a].max().x()) break;
      if (!boxes[a].intersects(boxes[b])) continue;
      add(a, b);
      add(b, a);
    }
  }
}

/// Bodies, ascending, without those whose box meets the boxes of most_crowded others that are at least as
/// large.
std::vector<std::uint32_t> outside_crowds(const Model& model, const State& state) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Body& body : model.bodies) {
    Eigen::AlignedBox3d& box = boxes.emplace_back();
    for (std::size_t n = 0; n < body.particle_count; ++n)
      box.extend(physics::rounded<double>(state.position[body.first_particle + n]));
  }
  std::vector<std::uint32_t> along(boxes.size()), before, chosen;
  std::iota(along.begin(), along.end(), std::uint32_t{0});
  std::ranges::sort(along, {}, [&](std::uint32_t n) { return boxes[n].min().x(); });
  for (const std::uint32_t b : along) {
    std::erase_if(before, [&](std::uint32_t a) { return boxes[a].max().x() < boxes[b].min().x(); });
    const auto met = std::ranges::count_if(before, [&](std::uint32_t a) {
      return boxes[a].volume() >= boxes[b].volume() && boxes[a].intersects(boxes[b]);
    });
    if (static_cast<std::size_t>(met) >= most_crowded) continue;
    before.push_back(b);
    chosen.push_back(b);
  }
  std::ranges::sort(chosen);
  return chosen;
}

}  // namespace

bool has_crowd(const Model& model, const State& state) {
  return model.contact.bodies && has_body_contact(model) &&
         outside_crowds(model, state).size() < model.bodies.size();
}

std::vector<BodyOverlap> overlaps_of(const Model& all, const State& state) {
  if (!all.contact.bodies || !has_body_contact(all)) return {};
  const std::vector<std::uint32_t> chosen = outside_crowds(all, state);
  std::optional<Model> few;
  if (chosen.size() < all.bodies.size()) {
    few = all;
    few->bodies.clear();
    for (const std::uint32_t b : chosen) few->bodies.push_back(all.bodies[b]);
  }
  const Model& model = few ? *few : all;
  const ContactSurfaces surfaces = contact_surfaces(model);
  DeepPoints::Found overlaps;
  for (const BodyOverlap& each :
       DeepPoints(model).find(state, [](std::uint32_t, std::uint32_t) { return false; }))
    pair_of(overlaps, each.a, each.b) = each;
  using Contact = collision::ContactSearch<double>;
  Contact search(model);
  const auto x = physics::field<double>(state.position), v = physics::field<double>(state.velocity);
  const Contact::Particles at = {physics::components(x.data()), physics::components(v.data()), 3};
  if (search.begin_step(state.step, at)) search.find(at);
  std::map<std::uint32_t, std::unique_ptr<Skin>> skins;  // by body
  for (const auto& contact : search.contacts()) {
    const ContactBody &points = surfaces.bodies[surfaces.body_of_point(contact.point)],
                      &faces = surfaces.bodies[surfaces.body_of_triangle(contact.triangle)];
    if (points.body == faces.body) continue;
    const ContactPair pair = contact_pair(model.contact, points, faces, false);
    BodyOverlap& overlap = pair_of(overlaps, points.body, faces.body);
    overlap.most = std::max(overlap.most, pair.eased_depth);
    if (contact.d < 0.0) {
      // The rule's face is the nearest of those that turn to the point; another may be nearer.
      auto& skin = skins[faces.body];
      if (!skin)
        skin = std::make_unique<Skin>(
            std::span(surfaces.triangles).subspan(faces.first_triangle, faces.triangle_count), state);
      const Vector P = physics::over_carriers<double>(
          contact, [&](std::uint32_t place) { return Vector(at.position(search.particles()[place])); });
      overlap.deepest = std::max(overlap.deepest, skin->distance(P, -contact.d));
    }
    const double near = std::max(pair.reach - contact.d, 0.0);
    overlap.energy += 0.5 * pair.stiffness * near * near;
  }
  add_particles_within(model, state, surfaces, overlaps);
  // Leaves out bodies in contact that overlap by no more than rounding.
  std::vector<BodyOverlap> within;
  for (const auto& [pair, each] : overlaps) {
    if (!(each.deepest > 1e-6 * each.most)) continue;
    within.push_back(each);
    within.back().a = chosen[each.a];
    within.back().b = chosen[each.b];
  }
  return within;
}

}  // namespace aspic
