#include "collision/candidate_lists.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace aspic::collision {
namespace {

double component(const Vec3& v, std::size_t axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// A bounding volume hierarchy: finds all overlapping pairs in time proportional to their number times a
/// logarithm.
class BoxTree {
 public:
  explicit BoxTree(const std::vector<Bounds>& boxes) : boxes_(boxes), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.reserve(2 * boxes.size());
    if (!boxes.empty()) split(0, boxes.size());
  }
  /// Calls use(n) for the boxes that overlap a box widened by `margin`.
  template <class Use>
  void meeting(const Bounds& box, double margin, const Use& use) const {
    if (!nodes_.empty()) meeting(0, 0, boxes_.size(), box, margin, use);
  }

 private:
  static constexpr std::size_t leaf = 4;  // most boxes of a leaf
  struct Node {
    Bounds box;
    std::size_t second = 0;  // the second child; the first one follows the node
  };
  static std::size_t half(std::size_t first, std::size_t end) { return first + (end - first) / 2; }

  std::size_t split(std::size_t first, std::size_t end) {
    const std::size_t node = nodes_.size();
    nodes_.emplace_back();
    for (std::size_t n = first; n < end; ++n) {
      for (std::size_t c = 0; c < 3; ++c) {
        Bounds& box = nodes_[node].box;
        box.min[c] = std::min(box.min[c], boxes_[order_[n]].min[c]);
        box.max[c] = std::max(box.max[c], boxes_[order_[n]].max[c]);
      }
    }
    if (end - first <= leaf) return node;
    std::size_t longest = 0;
    const auto extent = [&](std::size_t c) { return nodes_[node].box.max[c] - nodes_[node].box.min[c]; };
    for (const std::size_t c : {1u, 2u})
      if (extent(c) > extent(longest)) longest = c;
    const auto at = [&](std::size_t n) { return order_.begin() + static_cast<std::ptrdiff_t>(n); };
    std::ranges::nth_element(at(first), at(half(first, end)), at(end), {}, [&](std::uint32_t n) {
      const double middle = boxes_[n].min[longest] + boxes_[n].max[longest];
      return std::pair(std::isfinite(middle) ? middle : 0.0, n);
    });
    split(first, half(first, end));
    const std::size_t second = split(half(first, end), end);
    nodes_[node].second = second;
    return node;
  }
  template <class Use>
  void meeting(std::size_t node, std::size_t first, std::size_t end, const Bounds& box, double margin,
               const Use& use) const {
    if (!nodes_[node].box.meets(box, margin)) return;
    if (end - first > leaf) {
      meeting(node + 1, first, half(first, end), box, margin, use);
      meeting(nodes_[node].second, half(first, end), end, box, margin, use);
      return;
    }
    for (std::size_t n = first; n < end; ++n)
      if (boxes_[order_[n]].meets(box, margin)) use(order_[n]);
  }

  const std::vector<Bounds>& boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;  // a parent before its children
};

double extent(const Bounds& box) {
  double most = 0.0;
  for (std::size_t c = 0; c < 3; ++c) most = std::max(most, box.max[c] - box.min[c]);
  return most;
}

/// Largest margin of any pair with the body [m].
double margin_of(const ContactSettings& contact, const ContactBody& body) {
  ContactBody open = body;
  open.closed = false;
  return contact_pair(contact, body, open, false).margin;
}

/// The larger margin of points of either and faces of the other [m].
double margin_between(const ContactSettings& contact, const ContactBody& a, const ContactBody& b, bool same) {
  return std::max(contact_pair(contact, a, b, same).margin, contact_pair(contact, b, a, same).margin);
}

}  // namespace

void Bounds::add(const Vec3& place) {
  for (std::size_t c = 0; c < 3; ++c) {
    min[c] = std::min(min[c], component(place, c));
    max[c] = std::max(max[c], component(place, c));
  }
}

bool Bounds::holds(const Vec3& place, double margin) const {
  // All comparisons, without branches: which of them fails first cannot be predicted.
  bool all = true;
  for (std::size_t c = 0; c < 3; ++c) {
    const double x = component(place, c);
    const bool above = x >= min[c] - margin, below = x <= max[c] + margin;
    all &= above;
    all &= below;
  }
  return all;
}

bool Bounds::meets(const Bounds& other, double margin) const {
  for (std::size_t c = 0; c < 3; ++c)
    if (!(other.max[c] >= min[c] - margin && other.min[c] <= max[c] + margin)) return false;
  return true;
}

std::size_t TriangleGrid::cell(std::size_t axis, double x) const {
  const double n = (x - centers_.min[axis]) / size_;
  if (!(n > 0.0)) return 0;
  return std::min(cells_[axis] - 1, static_cast<std::size_t>(std::min(n, 1e9)));
}

void TriangleGrid::build(std::span<const Bounds> boxes) {
  centers_ = {};
  half_ = 0.0;
  const auto center = [](const Bounds& box) {
    return 0.5 * Vec3{box.min[0] + box.max[0], box.min[1] + box.max[1], box.min[2] + box.max[2]};
  };
  double sum = 0.0;
  for (const Bounds& box : boxes) {
    centers_.add(center(box));
    double half = 0.0;
    for (std::size_t c = 0; c < 3; ++c) half = std::max(half, 0.5 * (box.max[c] - box.min[c]));
    half_ = std::max(half_, half);
    sum += half;
  }
  // Cells of the size of a quad, larger where that would make more of them than there are triangles.
  size_ = std::max(2.0 * sum / static_cast<double>(boxes.size()), std::numeric_limits<double>::min());
  const auto count = [&](std::size_t c) {
    return 1.0 + std::floor((centers_.max[c] - centers_.min[c]) / size_);
  };
  while (count(0) * count(1) * count(2) > 8.0 * static_cast<double>(boxes.size())) size_ *= 2.0;
  for (std::size_t c = 0; c < 3; ++c) cells_[c] = static_cast<std::size_t>(count(c));

  const auto index = [&](const Bounds& box) {
    const Vec3 at = center(box);
    return (cell(0, at.x) * cells_[1] + cell(1, at.y)) * cells_[2] + cell(2, at.z);
  };
  begin_.assign(cells_[0] * cells_[1] * cells_[2] + 1, 0);
  for (const Bounds& box : boxes) ++begin_[index(box) + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  triangles_.resize(boxes.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  boxes_.resize(boxes.size());
  for (std::uint32_t t = 0; t < boxes.size(); ++t) {
    const std::uint32_t place = next[index(boxes[t])]++;
    triangles_[place] = t;
    boxes_[place] = boxes[t];
  }
}

void TriangleGrid::near(const Vec3& place, double margin, std::vector<std::uint32_t>& found) const {
  const auto before = static_cast<std::ptrdiff_t>(found.size());
  const double reach = margin + half_;
  std::array<std::size_t, 3> from, to;
  for (std::size_t c = 0; c < 3; ++c) {
    from[c] = cell(c, component(place, c) - reach);
    to[c] = cell(c, component(place, c) + reach);
  }
  for (std::size_t i = from[0]; i <= to[0]; ++i) {
    for (std::size_t j = from[1]; j <= to[1]; ++j) {
      const std::size_t row = (i * cells_[1] + j) * cells_[2];
      for (std::uint32_t n = begin_[row + from[2]]; n < begin_[row + to[2] + 1]; ++n)
        if (boxes_[n].holds(place, margin)) found.push_back(triangles_[n]);
    }
  }
  std::sort(found.begin() + before, found.end());
}

CandidateLists::CandidateLists(const Model& model, const ContactSurfaces& surfaces, double slack,
                               bool body_pairs)
    : surfaces_(surfaces),
      contact_(model.contact),
      slack_(std::numeric_limits<double>::infinity()),
      with_body_pairs_(body_pairs) {
  for (const ContactBody& body : surfaces.bodies) slack_ = std::min(slack_, slack * body.spacing);
  boxes_.resize(surfaces.triangles.size());
  // A larger value would list neighbors that never come into contact.
  double smallest = std::numeric_limits<double>::infinity();
  for (const ContactBody& body : surfaces.bodies) {
    Bounds box;
    for (std::uint32_t p = body.first_point; p < body.first_point + body.surface_particles; ++p)
      box.add(model.initial_position[surfaces.points[p].carrier[0]]);
    smallest = std::min(smallest, extent(box));
  }
  far_slack_ = body_pairs ? std::clamp(0.5 * smallest, slack_, 4.0 * slack_) : slack_;
  if (!contact_.self) return;
  for (const SurfacePoint& point : surfaces.points) {
    const auto at = [&](std::size_t n) { return model.initial_position[point.carrier[n]]; };
    rest_.push_back(point.single() ? at(0) : point.weight[0] * at(0) + point.weight[1] * at(1));
  }
}

void CandidateLists::make(std::span<const Vec3> places) {
  built_.assign(places.begin(), places.end());
  build();
}

Vec3 CandidateLists::place_of(std::uint32_t point, std::span<const Vec3> places) const {
  const SurfacePoint& p = surfaces_.points[point];
  if (p.single()) return places[point];
  return p.weight[0] * places[p.own[0]] + p.weight[1] * places[p.own[1]];
}

void CandidateLists::build() {
  std::vector<Bounds> around(surfaces_.bodies.size());
  Bounds all;
  for (std::size_t b = 0; b < around.size(); ++b) {
    const ContactBody& body = surfaces_.bodies[b];
    for (std::uint32_t p = 0; p < body.surface_particles; ++p) around[b].add(built_[body.first_point + p]);
    for (std::size_t c = 0; c < 3; ++c) {
      all.min[c] = std::min(all.min[c], around[b].min[c]);
      all.max[c] = std::max(all.max[c], around[b].max[c]);
    }
  }
  // Rounding of places in single precision, many times over.
  rounding_ = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    rounding_ = std::max({rounding_, 1e-6 * std::abs(all.min[c]), 1e-6 * std::abs(all.max[c])});

  find_neighbors(around);
  if (with_body_pairs_) find_body_pairs(around);
  candidate_groups_.clear();
  triangles_.clear();
  std::uint32_t gridded = std::numeric_limits<std::uint32_t>::max();
  for (const auto& [faces, points] : neighbors_) {
    if (faces != gridded) {
      const ContactBody& body = surfaces_.bodies[faces];
      for (std::uint32_t t = body.first_triangle; t < body.first_triangle + body.triangle_count; ++t) {
        boxes_[t] = {};
        for (const std::uint32_t corner : corners(t)) boxes_[t].add(built_[corner]);
      }
      grid_.build(std::span(boxes_).subspan(body.first_triangle, body.triangle_count));
      gridded = faces;
    }
    add_groups(points, faces);
  }
  std::ranges::sort(candidate_groups_, {},
                    [](const CandidateGroup& e) { return std::pair(e.point, e.body); });
}

double CandidateLists::most_margin() const {
  double widest = 0.0;
  for (const ContactBody& body : surfaces_.bodies) widest = std::max(widest, margin_of(contact_, body));
  return widest;
}

/// Pairs of bodies whose boxes are near, by body of triangles.
void CandidateLists::find_neighbors(const std::vector<Bounds>& around) {
  neighbors_.clear();
  for (std::uint32_t a = 0; contact_.self && a < around.size(); ++a) neighbors_.push_back({a, a});
  if (contact_.bodies) {
    const BoxTree tree(around);
    const double widest = most_margin() + far_slack_ + rounding_;
    for (std::uint32_t a = 0; a < around.size(); ++a) {
      tree.meeting(around[a], widest, [&](std::uint32_t b) {
        if (b <= a) return;
        const double margin = margin_between(contact_, surfaces_.bodies[a], surfaces_.bodies[b], false) +
                              far_slack_ + rounding_;
        if (!around[a].meets(around[b], margin)) return;
        neighbors_.push_back({a, b});
        neighbors_.push_back({b, a});
      });
    }
  }
  std::ranges::sort(neighbors_);
}

/// Of neighboring bodies, the particles that may carry a point or be a corner of a candidate while the lists
/// hold. All other particles are farther apart.
void CandidateLists::find_body_pairs(const std::vector<Bounds>& around) {
  body_pairs_.clear();
  pair_points_.clear();
  const auto longest = [&](const ContactBody& body) {
    double most = 0.0;
    for (std::uint32_t t = body.first_triangle; t < body.first_triangle + body.triangle_count; ++t) {
      Bounds box;
      for (const std::uint32_t corner : corners(t)) box.add(built_[corner]);
      most = std::max(most, extent(box));
    }
    return most;
  };
  std::vector<double> edges(surfaces_.bodies.size(), -1.0);  // [m], computed on demand
  const auto add = [&](std::uint32_t of, std::uint32_t other) {
    const ContactBody& body = surfaces_.bodies[of];
    if (edges[of] < 0.0) edges[of] = longest(body);
    // Points on edges and triangles are at most one edge from their particles, and these at most one edge
    // from the neighbors that their normals depend on.
    const double margin = margin_between(contact_, body, surfaces_.bodies[other], of == other) + rounding_ +
                          std::max(far_slack_ + edges[of], slack_ + 2.0 * edges[of]);
    for (std::uint32_t p = body.first_point; p < body.first_point + body.surface_particles; ++p)
      if (around[other].holds(built_[p], margin)) pair_points_.push_back(p);
  };
  const auto end = [&] { return static_cast<std::uint32_t>(pair_points_.size()); };
  for (const auto& [a, b] : neighbors_) {
    if (b < a) continue;
    const std::uint32_t first = end();
    add(a, b);
    const std::uint32_t second = a == b ? first : end();
    if (a != b) add(b, a);
    body_pairs_.push_back({first, second, end()});
  }
}

/// Points of body a near the triangles of body b, which are in the grid.
void CandidateLists::add_groups(std::uint32_t a, std::uint32_t b) {
  const ContactBody &points = surfaces_.bodies[a], &faces = surfaces_.bodies[b];
  const double margin = contact_pair(contact_, points, faces, a == b).margin + slack_ + rounding_;
  Bounds box;
  for (std::uint32_t p = 0; p < faces.surface_particles; ++p) box.add(built_[faces.first_point + p]);
  for (std::uint32_t p = points.first_point; p < points.first_point + points.point_count; ++p) {
    const Vec3 place = place_of(p, built_);
    if (!box.holds(place, margin)) continue;
    found_.clear();
    grid_.near(place, margin, found_);
    for (std::uint32_t& t : found_) t += faces.first_triangle;
    if (a == b) drop_neighbors(p, found_);
    if (found_.empty()) continue;
    candidate_groups_.push_back(
        {p, b, static_cast<std::uint32_t>(triangles_.size()), static_cast<std::uint32_t>(found_.size())});
    triangles_.insert(triangles_.end(), found_.begin(), found_.end());
  }
}

/// Self-contact: leaves only triangles that are far apart at rest.
void CandidateLists::drop_neighbors(std::uint32_t point, std::vector<std::uint32_t>& triangles) const {
  const auto spacing_at = [&](std::uint32_t p) {
    const auto after = std::ranges::upper_bound(surfaces_.bodies, p, {}, &ContactBody::first_point);
    return std::prev(after)->spacing;
  };
  const double least = least_rest_distance * spacing_at(point);
  std::erase_if(triangles, [&](std::uint32_t t) {
    return std::ranges::any_of(
        corners(t), [&](std::uint32_t corner) { return !(length(rest_[point] - rest_[corner]) > least); });
  });
}

std::uint64_t CandidateLists::bytes() const {
  return (rest_.capacity() + built_.capacity()) * sizeof(Vec3) + boxes_.capacity() * sizeof(Bounds) +
         candidate_groups_.capacity() * sizeof(CandidateGroup) +
         (triangles_.capacity() + found_.capacity() + pair_points_.capacity()) * sizeof(std::uint32_t) +
         body_pairs_.capacity() * sizeof(BodyPair) + grid_.bytes();
}

}  // namespace aspic::collision
