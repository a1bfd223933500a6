#include "mesh/winding.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <tuple>

namespace aspic {
namespace {

constexpr std::size_t leaf_triangles = 8;
/// A node is far at so many times its radius: 2.3 keeps the error of three terms below 0.01.
constexpr double far_ratio = 2.3;
constexpr double four_pi = 4.0 * std::numbers::pi;

/// atan for |t| ≤ tan(π/8): 16 terms of its series, whose remainder is below 1e-14.
double small_arctangent(double t) {
  const double square = t * t;
  double sum = 0.0;
  for (int n = 31; n >= 1; n -= 2) sum = 1.0 / n - square * sum;
  return t * sum;
}

/// Adds `weight`·n ⊗ d ⊗ d to what is kept of it.
void add_second(Vec3& traces, std::array<double, 10>& cubic, const Vec3& n, const Vec3& d, double weight) {
  traces = traces + (2.0 * weight * dot(n, d)) * d + (weight * dot(d, d)) * n;
  const auto add = [&](std::size_t at, int i, int j, int k) { cubic[at] += weight * n[i] * (d[j] * d[k]); };
  const auto add_both = [&](std::size_t at, int twice, int once) {  // the coefficient of twice²·once
    add(at, once, twice, twice);
    add(at, twice, twice, once);
    add(at, twice, once, twice);
  };
  for (int axis = 0; axis < 3; ++axis) add(static_cast<std::size_t>(axis), axis, axis, axis);
  add_both(3, 0, 1);
  add_both(4, 0, 2);
  add_both(5, 1, 0);
  add_both(6, 1, 2);
  add_both(7, 2, 0);
  add_both(8, 2, 1);
  for (int axis = 0; axis < 3; ++axis) {
    add(9, axis, (axis + 1) % 3, (axis + 2) % 3);
    add(9, axis, (axis + 2) % 3, (axis + 1) % 3);
  }
}

}  // namespace

double angle_of(double y, double x) {
  constexpr double pi = std::numbers::pi, eighth = 0.41421356237309503;  // tan(π/8)
  const double ay = std::abs(y), ax = std::abs(x);
  if (ay == 0.0 && ax == 0.0) return 0.0;
  const bool steep = ay > ax;
  const double t = steep ? ax / ay : ay / ax;
  double angle = t > eighth ? pi / 4.0 + small_arctangent((t - 1.0) / (t + 1.0)) : small_arctangent(t);
  if (steep) angle = pi / 2.0 - angle;
  if (x < 0.0) angle = pi - angle;
  return y < 0.0 ? -angle : angle;
}

double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = length(a), lb = length(b), lc = length(c);
  const double volume = dot(a, cross(b, c));
  if (volume == 0.0) return 0.0;
  return 2.0 * angle_of(volume, ((la * lb * lc + dot(a, b) * lc) + dot(b, c) * la) + dot(c, a) * lb);
}

double winding_number(const TriangleMesh& mesh, const Vec3& point) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles)
    sum += solid_angle(mesh.vertices[t[0]] - point, mesh.vertices[t[1]] - point, mesh.vertices[t[2]] - point);
  return sum / four_pi;
}

/// A triangle's center, and its number for an order that does not depend on the library's sort.
struct WindingTree::Item {
  Vec3 center;
  std::uint32_t number;
  Corners corners;
};

WindingTree::WindingTree(const TriangleMesh& mesh) {
  std::vector<Item> items;
  items.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const Corners k = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    items.push_back({(k.a + k.b + k.c) / 3.0, static_cast<std::uint32_t>(items.size()), k});
  }
  corners_.reserve(items.size());
  if (!items.empty()) make_node(items, 0, items.size());
}

void WindingTree::make_node(std::vector<Item>& items, std::size_t first, std::size_t count) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  const std::span<Item> mine = std::span(items).subspan(first, count);
  if (count <= leaf_triangles) {
    nodes_[self].begin = static_cast<std::uint32_t>(corners_.size());
    nodes_[self].triangles = static_cast<std::uint32_t>(count);
    std::ranges::sort(mine, {}, &Item::number);
    for (const Item& item : mine) corners_.push_back(item.corners);
  } else {
    Bounds centers;
    for (const Item& item : mine) centers.add(item.center);
    const Vec3 extent = centers.extent();
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::size_t half = count / 2;
    std::ranges::nth_element(
        mine, mine.begin() + static_cast<std::ptrdiff_t>(half), [axis](const Item& a, const Item& b) {
          return std::make_tuple(a.center[axis], a.number) < std::make_tuple(b.center[axis], b.number);
        });
    make_node(items, first, half);
    make_node(items, first + half, count - half);
  }
  nodes_[self].next = static_cast<std::uint32_t>(nodes_.size());
  sum_moments(nodes_[self], count);
}

/// Of the last `count` triangles of corners_, which are a subtree's, in an order that is the same everywhere.
void WindingTree::sum_moments(Node& node, std::size_t count) const {
  const auto all = std::span(corners_).last(count);
  double area = 0.0;
  for (const Corners& k : all) {
    const double weight = length(area_vector(k.a, k.b, k.c));
    area += weight;
    node.center = node.center + (weight / 3.0) * (k.a + k.b + k.c);
  }
  node.center = area > 0.0 ? node.center / area : all.front().a;
  double radius = 0.0;  // squared
  for (const Corners& k : all) {
    const Vec3 n = 0.5 * area_vector(k.a, k.b, k.c), middle = (k.a + k.b + k.c) / 3.0,
               d = middle - node.center;
    node.dipole = node.dipole + n;
    for (int i = 0; i < 9; ++i) node.first[static_cast<std::size_t>(i)] += n[i / 3] * d[i % 3];
    // The mean of d ⊗ d over a triangle is that of its middle and a twelfth of its corners' from there.
    add_second(node.second.traces, node.second.cubic, n, d, 1.0);
    for (const Vec3& corner : {k.a, k.b, k.c}) {
      add_second(node.second.traces, node.second.cubic, n, corner - middle, 1.0 / 12.0);
      radius = std::max(radius, dot(corner - node.center, corner - node.center));
    }
  }
  node.near = far_ratio * far_ratio * radius;
}

/// The Taylor series of Σ n·r/|r|³ about the node's center, r from the point to it.
double WindingTree::far(const Node& node, const Vec3& r, double squared) const {
  const auto& f = node.first;
  const auto& c = node.second.cubic;
  const double inverse = 1.0 / squared, cubed = inverse / std::sqrt(squared);
  const Vec3 fr = {(f[0] * r.x + f[1] * r.y) + f[2] * r.z, (f[3] * r.x + f[4] * r.y) + f[5] * r.z,
                   (f[6] * r.x + f[7] * r.y) + f[8] * r.z};
  const double x = r.x * ((c[0] * r.x + c[3] * r.y) + c[4] * r.z) * r.x,
               y = r.y * ((c[1] * r.y + c[5] * r.x) + c[6] * r.z) * r.y,
               z = r.z * ((c[2] * r.z + c[7] * r.x) + c[8] * r.y) * r.z;
  const double cubic = ((x + y) + z) + c[9] * (r.x * r.y * r.z);
  const double zeroth = dot(node.dipole, r), first = ((f[0] + f[4]) + f[8]) - 3.0 * (dot(r, fr) * inverse),
               second = (7.5 * (cubic * inverse) - 1.5 * dot(node.second.traces, r)) * inverse;
  return ((zeroth + first) + second) * cubed;
}

double WindingTree::at(const Vec3& point) const {
  double angles = 0.0;
  for (std::uint32_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    const Vec3 r = node.center - point;
    const double squared = dot(r, r);
    if (squared > node.near) {
      angles += far(node, r, squared);
      i = node.next;
    } else if (node.triangles > 0) {
      for (const Corners& k : std::span(corners_).subspan(node.begin, node.triangles))
        angles += solid_angle(k.a - point, k.b - point, k.c - point);
      i = node.next;
    } else {
      ++i;
    }
  }
  return angles / four_pi;
}

}  // namespace aspic
