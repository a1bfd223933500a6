#pragma once
// Which triangles are near which points of which bodies, for several steps at once: every pair that may
// become a candidate (docs/contact.md) before something has moved by half of a slack, or before bodies have
// moved by a slack against each other where they meet. In double precision and generous: nothing in a state
// depends on it.
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

/// Triangles of one body near a point.
struct PointCandidates {
  std::uint32_t point, body;   ///< numbers in ContactSurfaces; the body is the triangles'
  std::uint32_t first, count;  ///< in a list of triangles
};

/// Where two bodies may come near each other: particles of one from `first` on, of the other from `second`
/// on, which are the same where a body meets itself.
struct Meeting {
  std::uint32_t first, second, end;  ///< in a list of points
};

/// Around places [m]; around none at first.
struct Bounds {
  static constexpr double far = std::numeric_limits<double>::infinity();
  std::array<double, 3> min = {far, far, far}, max = {-far, -far, -far};

  void add(const Vec3& place);
  /// Whether the box, widened by `margin`, holds the place, or meets another.
  bool holds(const Vec3& place, double margin) const;
  bool meets(const Bounds& other, double margin) const;
};

/// The triangles of a body in cubic cells, by the centres of their boxes.
class TriangleGrid {
 public:
  /// `boxes`: of the body's triangles.
  void build(std::span<const Bounds> boxes);
  /// Appends those whose boxes, widened by `margin`, hold the place; relative to the body's first, ascending.
  void near(const Vec3& place, double margin, std::vector<std::uint32_t>& found) const;
  std::uint64_t bytes() const {
    return (begin_.capacity() + triangles_.capacity()) * sizeof(std::uint32_t) +
           boxes_.capacity() * sizeof(Bounds);
  }

 private:
  std::size_t cell(std::size_t axis, double x) const;

  Bounds centres_;
  double half_ = 0.0;  // extent of the largest box [m]
  double size_ = 1.0;  // of a cell [m]
  std::array<std::size_t, 3> cells_ = {};
  std::vector<std::uint32_t> begin_, triangles_;  // by cell
  std::vector<Bounds> boxes_;                     // of these
};

class CandidateLists {
 public:
  /// `surfaces` must outlive it. `slack`: in spacings; half of it is how far particles may move until the
  /// lists have to be made again. With `meetings` lists last until particles have moved by more, or those of
  /// a meeting have moved against each other by the slack.
  CandidateLists(const Model& model, const ContactSurfaces& surfaces, double slack = 0.25,
                 bool meetings = false);

  /// Makes the lists for particles of points at these places, by point; of those on edges nothing is asked.
  void make(std::span<const Vec3> places);
  /// The largest margin of any pair of bodies [m].
  double most_margin() const;
  /// How far a particle may be from where it was when the lists were made [m].
  double leeway() const { return 0.5 * far_slack_; }
  /// With meetings: how far, in each direction, particles of two sides of one may have gone against each
  /// other since then [m].
  double slack() const { return slack_; }
  std::span<const Meeting> meetings() const { return meetings_; }
  /// Of triangles and of points; ascending. Those of bodies whose boxes were further apart are in no list.
  std::span<const std::array<std::uint32_t, 2>> partners() const { return partners_; }
  /// Points of particles, which meetings name.
  std::span<const std::uint32_t> met() const { return met_; }
  /// More than rounding of places in single precision can amount to [m].
  double pad() const { return pad_; }
  /// Ascending by point, then by body.
  std::span<const PointCandidates> encounters() const { return encounters_; }
  /// Of one of them, ascending.
  std::span<const std::uint32_t> triangles(const PointCandidates& of) const {
    return std::span(triangles_).subspan(of.first, of.count);
  }
  std::uint64_t bytes() const;

 private:
  void build();
  /// Points of a triangle's corners.
  std::span<const std::uint32_t, 3> corners(std::uint32_t triangle) const {
    return std::span(surfaces_.faces[triangle]).first<3>();
  }
  void find_partners(const std::vector<Bounds>& around);
  void find_meetings(const std::vector<Bounds>& around);
  void meet(std::uint32_t a, std::uint32_t b);
  Vec3 place_of(std::uint32_t point, std::span<const Vec3> places) const;
  void drop_neighbours(std::uint32_t point, std::vector<std::uint32_t>& triangles) const;

  const ContactSurfaces& surfaces_;
  ContactSettings contact_;
  std::vector<Vec3> rest_;                            // places at rest, by point; none without self contact
  double slack_ = 0.0, far_slack_ = 0.0, pad_ = 0.0;  // [m]
  bool with_meetings_ = false;
  std::vector<Vec3> built_;                             // places at which the lists were made
  std::vector<Bounds> boxes_;                           // of triangles, then
  std::vector<std::array<std::uint32_t, 2>> partners_;  // body of triangles, body of points
  TriangleGrid grid_;
  std::vector<PointCandidates> encounters_;
  std::vector<std::uint32_t> triangles_, found_;
  std::vector<Meeting> meetings_;
  std::vector<std::uint32_t> met_;
};

}  // namespace aspic::collision
