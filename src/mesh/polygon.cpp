#include "mesh/polygon.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace aspic {
namespace {

struct Point {
  double u = 0.0, v = 0.0;
  friend bool operator==(const Point&, const Point&) = default;
};

/// Twice the area of a triangle in the plane, positive counterclockwise.
double area(const Point& a, const Point& b, const Point& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

/// What is left of a polygon while ears are cut off.
class Ears {
 public:
  explicit Ears(std::vector<Point> points) : at_(std::move(points)), next_(at_.size()), before_(at_.size()) {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      next_[i] = (i + 1) % at_.size();
      before_[next_[i]] = i;
    }
  }

  /// The corner of the next ear, from `from` on: an ear, else one on a line with its neighbors, else any.
  std::size_t find(std::size_t from) const {
    std::size_t flat = at_.size();
    for (std::size_t i = from;;) {
      const double turn = turn_at(i);
      if (turn > 0.0 && is_free(i)) return i;
      if (turn == 0.0 && flat == at_.size()) flat = i;
      i = next_[i];
      if (i == from) return flat < at_.size() ? flat : from;
    }
  }
  std::size_t next(std::size_t i) const { return next_[i]; }
  std::size_t before(std::size_t i) const { return before_[i]; }
  void cut(std::size_t i) {
    next_[before_[i]] = next_[i];
    before_[next_[i]] = before_[i];
  }

 private:
  double turn_at(std::size_t i) const { return area(at_[before_[i]], at_[i], at_[next_[i]]); }

  /// Whether no other corner is within the triangle at a corner: of those that turn outwards one would be.
  bool is_free(std::size_t i) const {
    const Point &a = at_[before_[i]], &b = at_[i], &c = at_[next_[i]];
    for (std::size_t j = next_[next_[i]]; j != before_[i]; j = next_[j]) {
      const Point& p = at_[j];
      if (area(a, b, p) < 0.0 || area(b, c, p) < 0.0 || area(c, a, p) < 0.0) continue;
      if (p == a || p == b || p == c || turn_at(j) > 0.0) continue;
      return false;
    }
    return true;
  }

  std::vector<Point> at_;
  std::vector<std::size_t> next_, before_;
};

/// Corners up to which a fan serves. The triangles of a larger one are needles, of which a tree of boxes
/// tells none from the others.
constexpr std::size_t most_fan_corners = 64;

/// Triangles over the first, the middle and the last corner, and so on between these.
void halve(std::span<const std::uint32_t> corners, std::vector<Triangle>& triangles) {
  if (corners.size() < 3) return;
  const std::size_t middle = corners.size() / 2;
  triangles.push_back({corners.front(), corners[middle], corners.back()});
  halve(corners.first(middle + 1), triangles);
  halve(corners.subspan(middle), triangles);
}

}  // namespace

bool cut_polygon(std::span<const Vec3> vertices, std::span<Triangle> fan) {
  const auto area_of = [&](const Triangle& t) {
    return area_vector(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  };
  Vec3 normal;
  for (const Triangle& t : fan) normal = normal + area_of(t);
  const double square = dot(normal, normal);
  const auto outside = [&](const Triangle& t) { return dot(area_of(t), normal) < -1e-9 * square; };
  if (!(square > 0.0) || !std::isfinite(square)) return true;
  std::vector<std::uint32_t> corners = {fan.front()[0], fan.front()[1]};
  for (const Triangle& t : fan) corners.push_back(t[2]);
  if (corners.size() > most_fan_corners) {
    std::vector<Triangle> halves;
    halve(corners, halves);
    if (std::ranges::none_of(halves, outside)) return std::ranges::copy(halves, fan.begin()), true;
  }
  if (std::ranges::none_of(fan, outside)) return true;
  if (corners.size() > most_cut_corners) return false;

  // Seen along the axis that is nearest to the normal, from its tip.
  int axis = 0;
  for (const int other : {1, 2})
    if (std::abs(normal[other]) > std::abs(normal[axis])) axis = other;
  const double side = normal[axis] > 0.0 ? 1.0 : -1.0;
  std::vector<Point> points;
  for (const std::uint32_t corner : corners)
    points.push_back({vertices[corner][(axis + 1) % 3], side * vertices[corner][(axis + 2) % 3]});
  Ears ears(std::move(points));
  std::size_t at = 0;
  for (Triangle& t : fan) {
    const std::size_t ear = ears.find(at), before = ears.before(ear), next = ears.next(ear);
    t = {corners[before], corners[ear], corners[next]};
    ears.cut(ear);
    at = next;
  }
  return true;
}

}  // namespace aspic
