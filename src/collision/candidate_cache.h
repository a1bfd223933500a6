#pragma once
// The few triangles of a candidate group that can matter until particles have moved by a bound relative to
// each other. Where bodies rest on each other or move together, a query reads these alone. No state depends
// on the cache.
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

/// Candidate groups near each other form a cluster. Its displacement is an upper bound of the displacements
/// between its points and the triangles near them; a common motion does not count.
template <class T>
class CandidateCache {
 public:
  /// The triangles that can matter. A `separated` point has no contact while the entry is valid; then these
  /// are the triangles that it can touch first.
  struct Entry {
    double valid_until = -1.0;  ///< largest displacement of the cluster [m]
    /// Other triangles are no nearer than this less the displacement. Of a separated point: it cannot touch
    /// others within this displacement [m].
    double clearance = 0.0;
    std::uint32_t count = 0;  ///< number of triangles
    bool separated = false;
    std::array<std::uint32_t, most_cached> triangle;  ///< ascending unless separated
  };

  explicit CandidateCache(const ContactSurfaces& surfaces) : surfaces_(surfaces) {}

  /// Takes other candidate groups, whose points belong to the bodies `own`, at these places, by point.
  /// Entries of groups that remain stay valid.
  void reset(const CandidateLists& near, std::span<const std::uint32_t> own, std::span<const Row<T>> x) {
    for (Cluster& cluster : clusters_) cluster.displacement = displacement_of(cluster, x);
    std::vector<Entry> before = std::exchange(entries_, {});
    std::vector<CandidateGroup> known = std::exchange(candidate_groups_, {});
    const std::vector<std::uint32_t> cluster_before = std::exchange(cluster_, {});
    const std::vector<Cluster> clusters_before = std::exchange(clusters_, {});
    candidate_groups_.assign(near.candidate_groups().begin(), near.candidate_groups().end());
    entries_.assign(candidate_groups_.size(), {});
    const auto key = [](const CandidateGroup& e) { return std::tuple(e.point, e.body); };
    std::size_t old = 0;
    for (std::size_t n = 0; n < candidate_groups_.size(); ++n) {
      while (old < known.size() && key(known[old]) < key(candidate_groups_[n])) ++old;
      if (old == known.size() || key(known[old]) != key(candidate_groups_[n])) continue;
      entries_[n] = before[old];
      age(entries_[n], clusters_before[cluster_before[old]].displacement);
      // Only triangles of the new lists are tracked.
      const auto is_near = [all = near.triangles(candidate_groups_[n])](std::uint32_t t) {
        return std::ranges::binary_search(all, t);
      };
      if (!std::ranges::all_of(std::span(entries_[n].triangle).first(entries_[n].count), is_near))
        entries_[n].valid_until = -1.0;
    }
    make_clusters(near, own, x);
  }

  /// Measures displacements to these places; run(count, task) as in ContactSearch::find().
  template <class Run>
  void update(std::span<const Row<T>> x, const Run& run) {
    run_pieces(clusters_.size(), clusters_in_task, run, [&](std::size_t z) {
      Cluster& cluster = clusters_[z];
      cluster.displacement = displacement_of(cluster, x);
      // Entries made from now on stay valid longest if displacements start here.
      if (8 * cluster.renewed > cluster.groups_end - cluster.groups_first ||
          !(cluster.displacement < unbounded))
        renew(cluster, x);
    });
  }

  /// Displacement of the group's cluster [m].
  double displacement(std::size_t candidate_group) const {
    return clusters_[cluster_[candidate_group]].displacement;
  }
  bool holds(std::size_t candidate_group) const {
    return displacement(candidate_group) <= entries_[candidate_group].valid_until;
  }
  const Entry& operator[](std::size_t candidate_group) const { return entries_[candidate_group]; }
  Entry& entry(std::size_t candidate_group) { return entries_[candidate_group]; }
  const std::vector<Entry>& entries() const { return entries_; }
  /// Carriers of the points and corners of the triangles near them, with repetitions.
  std::span<const std::uint32_t> tracked() const { return tracked_; }
  /// Whether a group needs a query.
  bool may_contact(std::size_t candidate_group) const {
    return !holds(candidate_group) ||
           (entries_[candidate_group].count > 0 && !entries_[candidate_group].separated);
  }
  /// Entry::clearance less the displacement [m].
  double limit(std::size_t candidate_group) const {
    return entries_[candidate_group].clearance - displacement(candidate_group);
  }

  /// Starts an entry that is valid for a displacement of up to `valid_until` from now on [m].
  Entry& begin(std::size_t candidate_group, double valid_until) {
    Entry& entry = entries_[candidate_group];
    extend(candidate_group, valid_until);
    entry.count = 0;
    entry.separated = false;
    return entry;
  }
  /// Makes an entry valid for a displacement of up to `valid_until` from now on [m].
  void extend(std::size_t candidate_group, double valid_until) {
    std::atomic_ref(clusters_[cluster_[candidate_group]].renewed).fetch_add(1, std::memory_order_relaxed);
    entries_[candidate_group].valid_until = valid_until - displacement(candidate_group);
  }

  std::uint64_t bytes() const {
    return entries_.capacity() * sizeof(Entry) + candidate_groups_.capacity() * sizeof(CandidateGroup) +
           (cluster_.capacity() + order_.capacity() + tracked_.capacity()) * sizeof(std::uint32_t) +
           clusters_.capacity() * sizeof(Cluster) + from_.capacity() * sizeof(from_[0]) +
           triangle_set_.bytes() + corner_set_.bytes() + carrier_set_.bytes();
  }

 private:
  static constexpr double unbounded = std::numeric_limits<double>::infinity();
  static constexpr std::size_t clusters_in_task = 16;
  /// Edge of a cluster's cube [spacings].
  static constexpr double cluster_size = 3.0;
  struct Cluster {
    std::uint32_t groups_first = 0, groups_end = 0;    // in order_
    std::uint32_t corners = 0, carriers = 0, end = 0;  // first of each in tracked_
    std::uint32_t renewed = 0;                         // entries made since displacements started
    double displacement = 0.0;
  };

  static void age(Entry& entry, double displacement) {
    // NaN displacements count as infinite.
    entry.valid_until = displacement < unbounded ? entry.valid_until - displacement : -1.0;
    entry.clearance -= displacement;
  }

  /// Two boxes bound the displacements of corners and of carriers; the largest distance between the boxes
  /// bounds the relative displacement.
  double displacement_of(const Cluster& cluster, std::span<const Row<T>> x) const {
    using Array = Eigen::Array<T, 4, 1>;
    using Map = Eigen::Map<const Array>;
    Array sum = Array::Zero();
    const auto around = [&](std::uint32_t first, std::uint32_t end) {
      std::pair<Array, Array> box = {Array::Constant(std::numeric_limits<T>::max()),
                                     Array::Constant(-std::numeric_limits<T>::max())};
      for (std::uint32_t n = first; n < end; ++n) {
        const Array moved = Map(x[tracked_[n]].data()) - Map(from_[n].data());
        box.first = box.first.min(moved);
        box.second = box.second.max(moved);
        sum += moved;
      }
      return box;
    };
    const auto corners = around(cluster.corners, cluster.carriers),
               carriers = around(cluster.carriers, cluster.end);
    if (!std::isfinite(sum.sum())) return unbounded;  // NaN counts as infinite
    const Array furthest = (corners.second - carriers.first).max(carriers.second - corners.first);
    const double displacement = std::sqrt(static_cast<double>(furthest.square().sum()));
    const double all = static_cast<double>(corners.first.abs().max(corners.second.abs()).maxCoeff());
    // Allows for the rounding of the differences above.
    return 1.001 * displacement + 1e-6 * all;
  }

  /// Starts the displacements of a cluster here.
  void renew(Cluster& cluster, std::span<const Row<T>> x) {
    for (std::uint32_t n = cluster.groups_first; n < cluster.groups_end; ++n)
      age(entries_[order_[n]], cluster.displacement);
    for (std::uint32_t n = cluster.corners; n < cluster.end; ++n) from_[n] = x[tracked_[n]];
    cluster.displacement = cluster.renewed = 0;
  }

  void make_clusters(const CandidateLists& near, std::span<const std::uint32_t> own,
                     std::span<const Row<T>> at) {
    using Key = std::tuple<std::uint32_t, std::uint32_t, std::array<std::int64_t, 3>>;
    std::vector<std::pair<Key, std::uint32_t>> keyed;
    keyed.reserve(candidate_groups_.size());
    for (std::uint32_t n = 0; n < candidate_groups_.size(); ++n) {
      const CandidateGroup& e = candidate_groups_[n];
      const Row<T>& x = at[surfaces_.points[e.point].own[0]];
      const double size =
          cluster_size * std::max(surfaces_.bodies[own[n]].spacing, surfaces_.bodies[e.body].spacing);
      std::array<std::int64_t, 3> cell = {};
      for (std::size_t c = 0; c < 3; ++c) {
        const double place = static_cast<double>(x[c]) / size;
        cell[c] = std::abs(place) < 1e15 ? static_cast<std::int64_t>(std::floor(place)) : 0;
      }
      keyed.push_back({{own[n], e.body, cell}, n});
    }
    std::ranges::sort(keyed);
    cluster_.resize(candidate_groups_.size());
    order_.clear();
    tracked_.clear();
    for (std::size_t k = 0; k < keyed.size();) {
      Cluster cluster;
      cluster.groups_first = static_cast<std::uint32_t>(k);
      cluster.corners = static_cast<std::uint32_t>(tracked_.size());
      const Key& key = keyed[k].first;
      for (; k < keyed.size() && keyed[k].first == key; ++k) {
        const std::uint32_t n = keyed[k].second;
        cluster_[n] = static_cast<std::uint32_t>(clusters_.size());
        order_.push_back(n);
        for (const std::uint32_t t : near.triangles(candidate_groups_[n])) triangle_set_.add(t);
        for (const std::uint32_t p : surfaces_.points[candidate_groups_[n].point].own) carrier_set_.add(p);
      }
      cluster.groups_end = static_cast<std::uint32_t>(k);
      for (const std::uint32_t t : triangle_set_.added())
        for (std::size_t c = 0; c < 3; ++c) corner_set_.add(surfaces_.faces[t][c]);
      const auto update = [&](NumberSet& set) {
        tracked_.insert(tracked_.end(), set.added().begin(), set.added().end());
        set.clear();
      };
      triangle_set_.clear();
      update(corner_set_);
      cluster.carriers = static_cast<std::uint32_t>(tracked_.size());
      update(carrier_set_);
      cluster.end = static_cast<std::uint32_t>(tracked_.size());
      clusters_.push_back(cluster);
    }
    from_.clear();
    for (const std::uint32_t p : tracked_) from_.push_back(at[p]);
  }

  const ContactSurfaces& surfaces_;
  std::vector<CandidateGroup> candidate_groups_;
  std::vector<Entry> entries_;          // by group
  std::vector<std::uint32_t> cluster_;  // by group
  std::vector<Cluster> clusters_;
  std::vector<std::uint32_t> order_;    // groups by cluster
  std::vector<std::uint32_t> tracked_;  // points by cluster: corners of triangles, then carriers
  std::vector<Row<T>> from_;            // their places where displacements start
  NumberSet triangle_set_, corner_set_, carrier_set_;
};

}  // namespace aspic::collision
