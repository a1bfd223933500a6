#pragma once
// Bodies that overlap at a state: those that a start eases apart, and those too deep for contact to separate
// (docs/contact.md).
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "model/contact_surface.h"
#include "model/model.h"

namespace aspic {

/// Two bodies of which one has points within the other.
struct BodyOverlap {
  std::uint32_t a = 0, b = 0;  ///< indices in Model::bodies, a < b
  double deepest = 0.0;        ///< of these points, below the surface [m]
  double most = 0.0;           ///< D, up to which contact acts [m]
  double energy = 0.0;         ///< of all contacts between the two, were they not eased apart [J]
  bool locked() const { return deepest > most; }
};

/// Looks for points deeper than D within another body. Costs a look at a box for each body and, of bodies
/// whose boxes are so deep in each other, at the triangles near such points.
class DeepPoints {
 public:
  explicit DeepPoints(const Model& model);
  /// A pair for which this returns true is left out.
  template <class Known>
  std::vector<BodyOverlap> find(const State& state, const Known& known) const {
    Found found;
    const Boxes boxes = boxes_of(state);
    for (std::uint32_t a = 0; a < surfaces_.bodies.size(); ++a)
      for (std::uint32_t b = 0; b < surfaces_.bodies.size(); ++b)
        if (near(boxes, a, b) && !known(surfaces_.bodies[a].body, surfaces_.bodies[b].body))
          take(state, boxes, a, b, found);
    return listed(found);
  }

  /// By their two bodies.
  using Found = std::map<std::pair<std::uint32_t, std::uint32_t>, BodyOverlap>;
  static std::vector<BodyOverlap> listed(const Found& found);

 private:
  struct Box {
    Vec3 low, high;
  };
  using Boxes = std::vector<Box>;
  Boxes boxes_of(const State& state) const;
  bool near(const Boxes& boxes, std::uint32_t a, std::uint32_t b) const;
  void take(const State& state, const Boxes& boxes, std::uint32_t a, std::uint32_t b, Found& found) const;
  double depth(std::uint32_t a, std::uint32_t b) const;

  ContactSurfaces surfaces_;
  ContactSettings contact_;
};

/// Bodies in one place that are looked at: one whose box meets the boxes of so many that are at least as
/// large is left out.
inline constexpr std::size_t most_crowded = 32;

/// Whether more bodies are in one place: what contact of all of them takes grows with the square of their
/// number.
bool has_crowd(const Model& model, const State& state);

/// Every pair of which one has points or particles within the other at a state, with what is deeper than D.
/// Of a crowd in one place, some: there are as many pairs as the square of its bodies.
/// Empty for a model without contact between bodies.
std::vector<BodyOverlap> overlaps_of(const Model& model, const State& state);

}  // namespace aspic
