#pragma once
// Which of the triangles near a point may matter to it for a while: those that cannot come near enough before
// bodies have moved by a certain way against each other are left out. Where bodies rest on each other, or
// move together, a look at a point is a look at a few triangles. Generous: nothing in a state depends on it.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "aspic/vec.h"
#include "collision/candidate_lists.h"
#include "collision/contact_batch.h"
#include "collision/number_set.h"
#include "collision/pieces.h"
#include "model/contact_surface.h"

namespace aspic::collision {

/// Encounters near each other are a zone, for which the way is measured that any of its points has gone
/// against any triangle near one of them: what they go together does not count. So lists live by what happens
/// about them.
template <class T>
class CandidateCache {
 public:
  /// Of triangles that may matter, or, of an `idle` point, which touches nothing while it holds, of those
  /// that it may touch first.
  struct List {
    double spare = -1.0;  ///< holds while the zone's way is no more than this [m]
    /// Triangles that are left out are no nearer than this less the way, or of an idle point may not be
    /// touched before it has gone by so much [m].
    double bound = 0.0;
    std::uint32_t count = 0;  ///< of triangles
    bool idle = false;
    std::array<std::uint32_t, most_listed> triangle;  ///< ascending, but of an idle point
  };

  explicit CandidateCache(const ContactSurfaces& surfaces) : surfaces_(surfaces) {}

  /// For other encounters, of points of the bodies `own`, with particles at these places, by point. Lists of
  /// encounters that there were before live on.
  void reset(const CandidateLists& near, std::span<const std::uint32_t> own, std::span<const Row<T>> x) {
    for (Zone& zone : zones_) zone.way = way_of(zone, x);
    std::vector<List> before = std::exchange(lists_, {});
    std::vector<PointCandidates> known = std::exchange(encounters_, {});
    const std::vector<std::uint32_t> zone_before = std::exchange(zone_, {});
    const std::vector<Zone> zones_before = std::exchange(zones_, {});
    encounters_.assign(near.encounters().begin(), near.encounters().end());
    lists_.assign(encounters_.size(), {});
    const auto key = [](const PointCandidates& e) { return std::tuple(e.point, e.body); };
    std::size_t old = 0;
    for (std::size_t n = 0; n < encounters_.size(); ++n) {
      while (old < known.size() && key(known[old]) < key(encounters_[n])) ++old;
      if (old == known.size() || key(known[old]) != key(encounters_[n])) continue;
      lists_[n] = before[old];
      wear(lists_[n], zones_before[zone_before[old]].way);
      // What is followed, and named, is near.
      const auto is_near = [all = near.triangles(encounters_[n])](std::uint32_t t) {
        return std::ranges::binary_search(all, t);
      };
      if (!std::ranges::all_of(std::span(lists_[n].triangle).first(lists_[n].count), is_near))
        lists_[n].spare = -1.0;
    }
    make_zones(near, own, x);
  }

  /// Particles are at these places now; run(count, task) as in BodyContact::find().
  template <class Run>
  void follow(std::span<const Row<T>> x, const Run& run) {
    run_pieces(zones_.size(), zones_in_piece, run, [&](std::size_t z) {
      Zone& zone = zones_[z];
      zone.way = way_of(zone, x);
      // Lists that are made from here on last longest if the way begins here.
      if (8 * zone.lost > zone.encounters_end - zone.encounters_first || !(zone.way < nowhere))
        renew(zone, x);
    });
  }

  /// How far points about this encounter have gone against triangles [m].
  double way(std::size_t encounter) const { return zones_[zone_[encounter]].way; }
  bool holds(std::size_t encounter) const { return way(encounter) <= lists_[encounter].spare; }
  const List& operator[](std::size_t encounter) const { return lists_[encounter]; }
  List& list(std::size_t encounter) { return lists_[encounter]; }
  const std::vector<List>& lists() const { return lists_; }
  /// Carriers of the points, and corners of the triangles near them, some more than once.
  std::span<const std::uint32_t> followed() const { return followed_; }
  /// Whether an encounter has to be looked at.
  bool may_contact(std::size_t encounter) const {
    return !holds(encounter) || (lists_[encounter].count > 0 && !lists_[encounter].idle);
  }
  /// List::bound now [m].
  double limit(std::size_t encounter) const { return lists_[encounter].bound - way(encounter); }

  /// Begins a list that holds, if nothing else is against it, while the zone goes no further than `spare`
  /// [m].
  List& begin(std::size_t encounter, double spare) {
    List& list = lists_[encounter];
    prolong(encounter, spare);
    list.count = 0;
    list.idle = false;
    return list;
  }
  /// From here on a list holds while the zone goes no further than `spare` [m].
  void prolong(std::size_t encounter, double spare) {
    std::atomic_ref(zones_[zone_[encounter]].lost).fetch_add(1, std::memory_order_relaxed);
    lists_[encounter].spare = spare - way(encounter);
  }

  std::uint64_t bytes() const {
    return lists_.capacity() * sizeof(List) + encounters_.capacity() * sizeof(PointCandidates) +
           (zone_.capacity() + order_.capacity() + followed_.capacity()) * sizeof(std::uint32_t) +
           zones_.capacity() * sizeof(Zone) + from_.capacity() * sizeof(from_[0]) + triangle_set_.bytes() +
           corner_set_.bytes() + carrier_set_.bytes();
  }

 private:
  static constexpr double nowhere = std::numeric_limits<double>::infinity();
  static constexpr std::size_t zones_in_piece = 16;
  /// Edge of the cube that a zone's points lie in, in spacings.
  static constexpr double zone_size = 3.0;
  struct Zone {
    std::uint32_t encounters_first = 0, encounters_end = 0;  // in order_
    std::uint32_t corners = 0, carriers = 0, end = 0;        // where these begin in followed_
    std::uint32_t lost = 0;                                  // lists made since the way began
    double way = 0.0;
  };

  static void wear(List& list, double way) {
    // What is no number has gone anywhere.
    list.spare = way < nowhere ? list.spare - way : -1.0;
    list.bound -= way;
  }

  /// What corners and carriers have gone lies in two boxes; no further than from one end to the other have
  /// any two gone against each other.
  double way_of(const Zone& zone, std::span<const Row<T>> x) const {
    using Array = Eigen::Array<T, 4, 1>;
    using Map = Eigen::Map<const Array>;
    Array sum = Array::Zero();
    const auto around = [&](std::uint32_t first, std::uint32_t end) {
      std::pair<Array, Array> box = {Array::Constant(std::numeric_limits<T>::max()),
                                     Array::Constant(-std::numeric_limits<T>::max())};
      for (std::uint32_t n = first; n < end; ++n) {
        const Array gone = Map(x[followed_[n]].data()) - Map(from_[n].data());
        box.first = box.first.min(gone);
        box.second = box.second.max(gone);
        sum += gone;
      }
      return box;
    };
    const auto corners = around(zone.corners, zone.carriers), carriers = around(zone.carriers, zone.end);
    if (!std::isfinite(sum.sum())) return nowhere;  // what is no number has gone anywhere
    const Array furthest = (corners.second - carriers.first).max(carriers.second - corners.first);
    const double way = std::sqrt(static_cast<double>(furthest.square().sum()));
    const double all = static_cast<double>(corners.first.abs().max(corners.second.abs()).maxCoeff());
    // Rounding of the differences above.
    return 1.001 * way + 1e-6 * all;
  }

  /// The way of a zone begins here.
  void renew(Zone& zone, std::span<const Row<T>> x) {
    for (std::uint32_t n = zone.encounters_first; n < zone.encounters_end; ++n)
      wear(lists_[order_[n]], zone.way);
    for (std::uint32_t n = zone.corners; n < zone.end; ++n) from_[n] = x[followed_[n]];
    zone.way = zone.lost = 0;
  }

  void make_zones(const CandidateLists& near, std::span<const std::uint32_t> own,
                  std::span<const Row<T>> at) {
    using Key = std::tuple<std::uint32_t, std::uint32_t, std::array<std::int64_t, 3>>;
    std::vector<std::pair<Key, std::uint32_t>> keyed;
    keyed.reserve(encounters_.size());
    for (std::uint32_t n = 0; n < encounters_.size(); ++n) {
      const PointCandidates& e = encounters_[n];
      const Row<T>& x = at[surfaces_.points[e.point].own[0]];
      const double size =
          zone_size * std::max(surfaces_.bodies[own[n]].spacing, surfaces_.bodies[e.body].spacing);
      std::array<std::int64_t, 3> cell = {};
      for (std::size_t c = 0; c < 3; ++c) {
        const double place = static_cast<double>(x[c]) / size;
        cell[c] = std::abs(place) < 1e15 ? static_cast<std::int64_t>(std::floor(place)) : 0;
      }
      keyed.push_back({{own[n], e.body, cell}, n});
    }
    std::ranges::sort(keyed);
    zone_.resize(encounters_.size());
    order_.clear();
    followed_.clear();
    for (std::size_t k = 0; k < keyed.size();) {
      Zone zone;
      zone.encounters_first = static_cast<std::uint32_t>(k);
      zone.corners = static_cast<std::uint32_t>(followed_.size());
      const Key& key = keyed[k].first;
      for (; k < keyed.size() && keyed[k].first == key; ++k) {
        const std::uint32_t n = keyed[k].second;
        zone_[n] = static_cast<std::uint32_t>(zones_.size());
        order_.push_back(n);
        for (const std::uint32_t t : near.triangles(encounters_[n])) triangle_set_.add(t);
        for (const std::uint32_t p : surfaces_.points[encounters_[n].point].own) carrier_set_.add(p);
      }
      zone.encounters_end = static_cast<std::uint32_t>(k);
      for (const std::uint32_t t : triangle_set_.added())
        for (std::size_t c = 0; c < 3; ++c) corner_set_.add(surfaces_.faces[t][c]);
      const auto follow = [&](NumberSet& set) {
        followed_.insert(followed_.end(), set.added().begin(), set.added().end());
        set.clear();
      };
      triangle_set_.clear();
      follow(corner_set_);
      zone.carriers = static_cast<std::uint32_t>(followed_.size());
      follow(carrier_set_);
      zone.end = static_cast<std::uint32_t>(followed_.size());
      zones_.push_back(zone);
    }
    from_.clear();
    for (const std::uint32_t p : followed_) from_.push_back(at[p]);
  }

  const ContactSurfaces& surfaces_;
  std::vector<PointCandidates> encounters_;
  std::vector<List> lists_;          // by encounter
  std::vector<std::uint32_t> zone_;  // by encounter
  std::vector<Zone> zones_;
  std::vector<std::uint32_t> order_;     // encounters by zone
  std::vector<std::uint32_t> followed_;  // points by zone: corners of triangles, then carriers of points
  std::vector<Row<T>> from_;             // where the ways of these begin
  NumberSet triangle_set_, corner_set_, carrier_set_;
};

}  // namespace aspic::collision
