#pragma once
// Candidate lists for several steps: every point and triangle that may become candidates (docs/contact.md)
// before a particle has moved by half of a slack, or before particles of neighboring bodies have moved by a
// slack relative to each other. Double precision and wide margins: no state depends on the lists.
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "aspic/vec.h"
#include "model/contact_surface.h"

namespace aspic::collision {

/// The triangles of one body near a point.
struct CandidateGroup {
  std::uint32_t point, body;   ///< numbers in ContactSurfaces; the body is the triangles'
  std::uint32_t first, count;  ///< in a list of triangles
};

/// Points of two neighboring bodies: of one from `first` on, of the other from `second` on. The same points
/// for a body and itself.
struct BodyPair {
  std::uint32_t first, second, end;  ///< in a list of points
};

/// An axis-aligned box around places [m]; empty at first.
struct Bounds {
  static constexpr double far = std::numeric_limits<double>::infinity();
  std::array<double, 3> min = {far, far, far}, max = {-far, -far, -far};

  void add(const Vec3& place);
  /// Whether the box, widened by `margin`, holds the place, or overlaps another.
  bool holds(const Vec3& place, double margin) const;
  bool meets(const Bounds& other, double margin) const;
};

/// A uniform grid over the centers of the boxes of a body's triangles.
class TriangleGrid {
 public:
  /// From the boxes of the body's triangles.
  void build(std::span<const Bounds> boxes);
  /// Appends the triangles whose boxes, widened by `margin`, hold the place: numbers relative to the body's
  /// first, ascending.
  void near(const Vec3& place, double margin, std::vector<std::uint32_t>& found) const;
  std::uint64_t bytes() const {
    return (begin_.capacity() + triangles_.capacity()) * sizeof(std::uint32_t) +
           boxes_.capacity() * sizeof(Bounds);
  }

 private:
  std::size_t cell(std::size_t axis, double x) const;

  Bounds centers_;
  double half_ = 0.0;  // extent of the largest box [m]
  double size_ = 1.0;  // of a cell [m]
  std::array<std::size_t, 3> cells_ = {};
  std::vector<std::uint32_t> begin_, triangles_;  // by cell
  std::vector<Bounds> boxes_;                     // of these
};

class CandidateLists {
 public:
  /// `surfaces` must outlive it. The lists hold until a particle has moved by half of `slack` [spacings].
  /// With `body_pairs` they hold until one has moved farther, or particles of a pair have moved by `slack`
  /// relative to each other.
  CandidateLists(const Model& model, const ContactSurfaces& surfaces, double slack = 0.25,
                 bool body_pairs = false);

  /// Makes the lists for these places, by point; those of points on edges are not read.
  void make(std::span<const Vec3> places);
  /// The largest margin of any pair of bodies [m].
  double most_margin() const;
  /// Largest displacement of a particle since the lists were made with which they hold [m].
  double displacement_limit() const { return 0.5 * far_slack_; }
  /// With body pairs: largest displacement of particles of a pair relative to each other [m].
  double slack() const { return slack_; }
  std::span<const BodyPair> body_pairs() const { return body_pairs_; }
  /// Neighboring bodies, those of triangles and of points, ascending. Other pairs have no candidates.
  std::span<const std::array<std::uint32_t, 2>> neighbors() const { return neighbors_; }
  /// The points that body pairs refer to.
  std::span<const std::uint32_t> pair_points() const { return pair_points_; }
  /// Upper bound of the rounding error of a place in single precision [m].
  double rounding() const { return rounding_; }
  /// Ascending by point, then by body.
  std::span<const CandidateGroup> candidate_groups() const { return candidate_groups_; }
  /// The triangles of a group, ascending.
  std::span<const std::uint32_t> triangles(const CandidateGroup& of) const {
    return std::span(triangles_).subspan(of.first, of.count);
  }
  std::uint64_t bytes() const;

 private:
  void build();
  /// The points of a triangle's corners.
  std::span<const std::uint32_t, 3> corners(std::uint32_t triangle) const {
    return std::span(surfaces_.faces[triangle]).first<3>();
  }
  void find_neighbors(const std::vector<Bounds>& around);
  void find_body_pairs(const std::vector<Bounds>& around);
  void add_groups(std::uint32_t a, std::uint32_t b);
  Vec3 place_of(std::uint32_t point, std::span<const Vec3> places) const;
  void drop_neighbors(std::uint32_t point, std::vector<std::uint32_t>& triangles) const;

  const ContactSurfaces& surfaces_;
  ContactSettings contact_;
  std::vector<Vec3> rest_;  // places at rest, by point; empty without self-contact
  double slack_ = 0.0, far_slack_ = 0.0, rounding_ = 0.0;  // [m]
  bool with_body_pairs_ = false;
  std::vector<Vec3> built_;                              // places at which the lists were made
  std::vector<Bounds> boxes_;                            // of triangles, when the lists were made
  std::vector<std::array<std::uint32_t, 2>> neighbors_;  // body of triangles, body of points
  TriangleGrid grid_;
  std::vector<CandidateGroup> candidate_groups_;
  std::vector<std::uint32_t> triangles_, found_;
  std::vector<BodyPair> body_pairs_;
  std::vector<std::uint32_t> pair_points_;
};

}  // namespace aspic::collision
