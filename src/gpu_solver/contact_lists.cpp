#include "gpu_solver/contact_lists.h"

#include <algorithm>
#include <bit>
#include <tuple>

#include "collision/contact_search.h"
#include "model/integrator.h"

namespace aspic {
namespace {

/// A kernel walks over the triangles near a point thirteen times, and over the candidate groups of a particle
/// and the contacts of each: within the rounds that drivers allow (MAX_ROUNDS).
constexpr std::size_t most_near = 4000, most_groups = 5000;

/// Far above any ρ: where bodies did not overlap.
constexpr float nowhere_near = 3e38f;

Status too_many(std::size_t count, std::string_view of, std::size_t most) {
  return advised(
      fail(ErrorCode::scene_rejected,
           "bodies have too many contacts at once: {} {}, and the gpu backend takes {}.", count, of, most),
      {use_backend("cpu")});
}

}  // namespace

ContactLists::ContactLists(const Model& model)
    : surfaces_(contact_surfaces(model)),
      contact_(model.contact),
      near_(model, surfaces_),
      ahead_step_(row_of(model.simulation.integrator).staged() ? 0.0 : model.simulation.timestep) {
  const collision::ContactSearch<double> contact(model);
  for (const auto& [point, body, d] : contact.initial_overlaps())
    starts_.push_back({point, body, static_cast<float>(d)});
  // Normal forces begin at d₀ + s·t, and at ρ at most.
  for (const auto& [point, body, d] : contact.initial_overlaps()) {
    const ContactPair pair = contact_pair(contact_, surfaces_.bodies[surfaces_.body_of_point(point)],
                                          surfaces_.bodies[body], surfaces_.body_of_point(point) == body);
    // A little longer: rounding decides nothing afterwards.
    eased_until_ = std::max(eased_until_, 1.001 * (pair.reach - d) / pair.spacing + 1e-3);
  }
}

bool ContactLists::has_friction() const {
  return std::ranges::any_of(
      surfaces_.bodies, [](const ContactBody& body) { return static_cast<float>(body.friction) > 0.0f; });
}

std::vector<layout::uvec4> ContactLists::triangles() const {
  std::vector<layout::uvec4> all;
  for (const SurfaceTriangle& t : surfaces_.triangles)
    all.push_back({t.corner[0], t.corner[1], t.corner[2], t.side});
  return all;
}

/// Without its triangles.
layout::CandidateGroup ContactLists::group_of(const collision::CandidateGroup& near) const {
  const SurfacePoint& point = surfaces_.points[near.point];
  const std::uint32_t own = surfaces_.body_of_point(near.point);
  const ContactBody &points = surfaces_.bodies[own], &faces = surfaces_.bodies[near.body];
  ContactPair pair = contact_pair(contact_, points, faces, own == near.body);
  if (ahead_step_ > 0.0) pair = with_implicit_range(pair, ahead_step_);
  layout::CandidateGroup made{};
  made.carrier0 = point.carrier[0];
  made.carrier1 = point.carrier[1];
  made.carrier_weight0 = static_cast<float>(point.weight[0]);
  made.carrier_weight1 = static_cast<float>(point.weight[1]);
  if (faces.closed) made.flags |= CONTACT_CLOSED;
  if (faces.closed && points.closed) made.flags |= CONTACT_OPPOSING;
  const auto& from = surfaces_.from;
  made.normals_first0 = from[point.own[0]];
  made.normals_count0 = from[point.own[0] + 1] - from[point.own[0]];
  made.normals_first1 = from[point.own[1]];
  made.normals_count1 = from[point.own[1] + 1] - from[point.own[1]];
  made.contact_stiffness = static_cast<float>(pair.stiffness);
  made.contact_damping = static_cast<float>(pair.damping);
  made.spacing = static_cast<float>(pair.spacing);
  made.reach = static_cast<float>(pair.reach);
  made.depth = static_cast<float>(pair.depth);
  made.eased_depth = static_cast<float>(pair.eased_depth);
  made.margin = static_cast<float>(pair.margin);
  made.tie = static_cast<float>(2e-6 * pair.spacing);
  made.range = static_cast<float>(pair.range);
  made.contact_friction = static_cast<float>(pair.friction);
  made.start_distance = nowhere_near;
  const auto key = [](const auto& of) { return std::tuple(of.point, of.body); };
  const auto start = std::ranges::lower_bound(starts_, key(near), {}, key);
  if (start != starts_.end() && key(*start) == key(near)) made.start_distance = start->distance;
  return made;
}

Status ContactLists::make(std::span<const layout::Particle> particles) {
  std::vector<Vec3> places(surfaces_.points.size());
  built_.clear();
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (!surfaces_.points[p].single()) continue;
    const std::uint32_t i = surfaces_.points[p].carrier[0];
    const layout::vec4& x = particles[i].position;
    places[p] = {x.x, x.y, x.z};
    built_.push_back({std::bit_cast<std::uint32_t>(x.x), std::bit_cast<std::uint32_t>(x.y),
                      std::bit_cast<std::uint32_t>(x.z), i});
  }
  near_.make(places);
  words_ = surfaces_.at_particle;
  candidate_groups_.clear();
  for (const collision::CandidateGroup& near : near_.candidate_groups()) {
    if (near.count > most_near) return too_many(near.count, "triangles near one point", most_near);
    layout::CandidateGroup made = group_of(near);
    made.near_first = static_cast<std::uint32_t>(words_.size());
    made.near_count = near.count;
    const auto triangles = near_.triangles(near);
    words_.insert(words_.end(), triangles.begin(), triangles.end());
    candidate_groups_.push_back(made);
  }
  return list_particles();
}

/// For each particle that a candidate group may name, the candidate groups that do, as a carrier and as a
/// corner.
Status ContactLists::list_particles() {
  std::vector<Named> named;
  for (std::uint32_t e = 0; e < candidate_groups_.size(); ++e) {
    const layout::CandidateGroup& of = candidate_groups_[e];
    named.push_back({of.carrier0, e, false});
    if (of.carrier1 != of.carrier0) named.push_back({of.carrier1, e, false});
    std::vector<std::uint32_t> corners;
    for (std::uint32_t n = of.near_first; n < of.near_first + of.near_count; ++n)
      for (const std::uint32_t corner : surfaces_.triangles[words_[n]].corner) corners.push_back(corner);
    std::ranges::sort(corners);
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    for (const std::uint32_t corner : corners) named.push_back({corner, e, true});
  }
  std::ranges::sort(named, {},
                    [](const Named& n) { return std::tuple(n.particle, n.visits, n.candidate_group); });
  listed_.clear();
  for (const Named& n : named) {
    const auto at = static_cast<std::uint32_t>(words_.size());
    if (listed_.empty() || listed_.back().listed != n.particle)
      listed_.push_back({n.particle, at, 0, at, 0, 0, 0, 0});
    layout::ContactParticle& of = listed_.back();
    if (n.visits && of.visit_count == 0) of.visit_first = at;
    ++(n.visits ? of.visit_count : of.own_count);
    words_.push_back(n.candidate_group);
    if (std::max(of.own_count, of.visit_count) > most_groups)
      return too_many(std::max(of.own_count, of.visit_count), "points near one particle", most_groups);
  }
  return {};
}

}  // namespace aspic
