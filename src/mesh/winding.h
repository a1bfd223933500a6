#pragma once
// How often a mesh winds around a point: the generalized winding number (Jacobson, Kavan, Sorkine-Hornung,
// 2013), by solid angles and a tree (Barill, Dickson, Schmidt, Levin, Jacobson: Fast winding numbers for
// soups and clouds, 2018). It is 1 inside a closed mesh that is oriented outwards and 0 outside; holes make
// it change gradually.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/triangle_mesh.h"

namespace aspic {

/// The angle of (x, y) ≠ 0 from the x axis, in (−π, π], to 1e-12; 0 of (0, 0). Of + − × ÷ alone, so that it
/// has the same bits on every machine, which the C library's has not.
double angle_of(double y, double x);

/// The solid angle of a triangle seen from the origin, positive where it turns clockwise seen from there,
/// in [−2π, 2π]; 0 in its plane. Source: Van Oosterom and Strackee, 1983.
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c);

/// Winding number of a point, of every triangle one by one.
double winding_number(const TriangleMesh& mesh, const Vec3& point);

/// A tree of boxes over the triangles of a mesh. Groups of triangles that are far from a point act as a
/// dipole and its first derivative; the error of the sum is below 0.01. Building it takes O(n log n), a
/// question O(log n).
class WindingTree {
 public:
  explicit WindingTree(const TriangleMesh& mesh);
  /// Winding number of a point.
  double at(const Vec3& point) const;

 private:
  struct Corners {
    Vec3 a, b, c;
  };
  /// Σ over triangles of n ⊗ d ⊗ d, n their area vectors and d from the node's center, as far as it acts.
  struct Second {
    Vec3 traces;  ///< 2·Σ (n·d) d + Σ |d|² n
    std::array<double, 10> cubic =
        {};  ///< of Σ (n·r)(d·r)²: xxx, yyy, zzz, xxy, xxz, yyx, yyz, zzx, zzy, xyz
  };
  struct Node {
    Vec3 center;                       ///< of its triangles, weighted by area
    double near = 0.0;                 ///< square of the distance from which on it is taken as one
    Vec3 dipole;                       ///< Σ n
    std::array<double, 9> first = {};  ///< Σ n ⊗ d, by rows
    Second second;
    std::uint32_t next = 0;                  ///< the node after its subtree; its own subtree follows it
    std::uint32_t begin = 0, triangles = 0;  ///< of a leaf; no triangles: an inner node
  };
  struct Item;  // a triangle while the tree is made

  double far(const Node& node, const Vec3& r, double squared) const;
  void sum_moments(Node& node, std::size_t count) const;
  void make_node(std::vector<Item>& items, std::size_t first, std::size_t count);

  std::vector<Node> nodes_;
  std::vector<Corners> corners_;
};

}  // namespace aspic
