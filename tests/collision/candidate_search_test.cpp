// Candidates of contact between bodies: those of the search and of the reference against the definition of
// docs/contact.md, written once more.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include "collision/contact_search.h"
#include "cpu_reference/bodies_in_contact.h"

namespace aspic::collision {
namespace {

using V = Vector<double>;
using Contact = ContactSearch<double>;
using test::cube_of;
using test::random_vector;
using test::spacing;
using test::view_of_fields;

/// A candidate by its definition.
bool holds(const Field<double>& x, const SurfaceTriangle& triangle, const V& P, double margin) {
  for (Eigen::Index c = 0; c < 3; ++c) {
    double low = x(c, triangle.corner[0]), high = low;
    for (const std::uint32_t corner : triangle.corner) {
      low = std::min(low, x(c, corner));
      high = std::max(high, x(c, corner));
    }
    if (P[c] < low - margin || P[c] > high + margin) return false;
  }
  return true;
}

using Candidates = std::set<std::tuple<std::uint32_t, std::uint32_t>>;  // point, triangle

Candidates found_by(const Contact& contact) {
  Candidates found;
  std::tuple<std::uint32_t, std::uint32_t> last = {0, 0};
  contact.for_candidates([&](std::uint32_t point, std::uint32_t triangle) {
    EXPECT_TRUE(found.empty() || last < std::tuple(point, triangle));
    last = {point, triangle};
    found.emplace(point, triangle);
  });
  return found;
}

Candidates by_definition(const Model& model, const Field<double>& x) {
  const ContactSurfaces all = contact_surfaces(model);
  Candidates found;
  for (std::size_t a = 0; a < all.bodies.size(); ++a) {
    for (std::size_t b = 0; b < all.bodies.size(); ++b) {
      if (a == b ? !model.contact.self : !model.contact.bodies) continue;
      const ContactPair pair = contact_pair(model.contact, all.bodies[a], all.bodies[b], a == b);
      for (std::uint32_t p = all.bodies[a].first_point;
           p < all.bodies[a].first_point + all.bodies[a].point_count; ++p) {
        const auto place = [&](const auto& of) {
          const SurfacePoint& point = all.points[p];
          return point.single()
                     ? V(of(point.carrier[0]))
                     : V(point.weight[0] * of(point.carrier[0]) + point.weight[1] * of(point.carrier[1]));
        };
        const auto rest = [&](std::uint32_t i) { return rounded<double>(model.initial_position[i]); };
        const V P = place([&](std::uint32_t i) { return V(x.col(i)); }), P_rest = place(rest);
        for (std::uint32_t t = all.bodies[b].first_triangle;
             t < all.bodies[b].first_triangle + all.bodies[b].triangle_count; ++t) {
          double apart = std::numeric_limits<double>::infinity();
          for (const std::uint32_t corner : all.triangles[t].corner)
            apart = std::min(apart, (rest(corner) - P_rest).norm());
          if (a == b && !(apart > 2.1 * all.bodies[a].spacing)) continue;
          if (holds(x, all.triangles[t], P, pair.margin)) found.emplace(p, t);
        }
      }
    }
  }
  return found;
}

/// The same as the reference finds them.
Candidates by_brute_force(const Model& model, const Field<double>& x) {
  const ContactSurfaces surfaces = contact_surfaces(model);
  const physics::PairTable<double> table(model.contact, surfaces.bodies, 0.0);
  Candidates found;
  physics::for_each_candidate<double>(
      model, surfaces, table, view_of_fields(x, x),
      [&](std::uint32_t point, std::uint32_t, std::uint32_t triangle) { found.emplace(point, triangle); });
  return found;
}

// The search finds what the definition says, on paths on which its lists are made again now and then: bodies
// that shake, fall together, and pass each other.
TEST(CandidateSearch, FindsTheCandidatesOfTheDefinition) {
  ModelSettings settings = test::contact_scene({cube_of(3, {}), cube_of(4, {1.8, 0, 0}, 0.7 * spacing),
                                                test::box_of({2, 9, 2}, {0, 3, 0}), cube_of(2, {40, 0, 0})});
  settings.contact.self = true;
  const Model model = test::build(settings);
  const auto count = static_cast<Eigen::Index>(model.particle_count());
  for (const auto& [together, own] : {std::pair(0.0, 0.0), std::pair(0.1, 0.004), std::pair(0.0, 0.03)}) {
    Contact contact(model);
    std::mt19937 random(5);
    Field<double> x = field<double>(model.initial_position.list(0, model.particle_count()));
    const Field<double> v = Field<double>::Zero(3, count);
    std::size_t most = 0;
    for (int step = 0; step < 60; ++step) {
      for (Eigen::Index i = 0; i < count; ++i) {
        const auto body = static_cast<double>(
            std::ranges::upper_bound(model.bodies, static_cast<std::uint32_t>(i), {}, &Body::first_particle) -
            model.bodies.begin());
        const V towards = -0.02 * (V(x.col(i)) - together * step * V(1, 2, -1));
        x.col(i) += random_vector(random, together > 0.0 ? 1e-3 : 0.01) + towards + together * V(1, 2, -1) +
                    own * V(std::sin(body), std::cos(2.0 * body), std::sin(3.0 * body));
      }
      contact.begin_step(0, view_of_fields(x, v));
      const Candidates found = found_by(contact);
      ASSERT_EQ(found, by_definition(model, x)) << "step " << step << ", together " << together;
      ASSERT_EQ(found, by_brute_force(model, x)) << "step " << step << ", together " << together;
      most = std::max(most, found.size());
    }
    EXPECT_GT(most, 5000u);
  }
}

// Contact with faces of a cloth has a longer range than with those of the bodies in front of it.
TEST(CandidateSearch, FindsTrianglesInReachOfAClothAlone) {
  ModelSettings settings = test::contact_scene({});
  ClothSettings& cloth = settings.cloths.emplace_back();
  cloth.particles = {5, 5};
  cloth.size = {4 * spacing, 4 * spacing};
  cloth.position = {};
  cloth.rotation = {{1.0, 0.0, 0.0}, 90.0};
  VoxelsSettings& block = settings.voxels.emplace_back();
  block.size = spacing;
  block.layers.assign(2, CellLayers::value_type(2, "11"));
  settings.contact.body_gap = 1.0;
  for (const double height : {-3.3, 3.3}) {
    block.position = {0.0, height * spacing, 0.0};
    const Model model = test::build(settings);
    Contact contact(model);
    const Field<double> x = field<double>(model.initial_position.list(0, model.particle_count()));
    contact.begin_step(0, view_of_fields(x, x));
    const Candidates found = found_by(contact);
    EXPECT_EQ(found, by_definition(model, x));
    EXPECT_EQ(found, by_brute_force(model, x));
    EXPECT_FALSE(found.empty());
  }
}

}  // namespace
}  // namespace aspic::collision
