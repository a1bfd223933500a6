#pragma once
// Bodies that overlap in the initial state are pushed apart slowly (docs/contact.md, "The push").
#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "physics/contact/law.h"
#include "physics/contact/pairs.h"

namespace aspic::physics {

/// A point in contact with a body in the initial state. Normal forces begin at its distance there, which
/// grows with time until it is ρ.
template <class T>
struct InitialOverlap {
  std::uint32_t point, body;
  T d;  ///< [m]
};

template <class T>
class InitialOverlaps {
 public:
  using Overlap = InitialOverlap<T>;

  InitialOverlaps() = default;
  /// Of the contacts in the initial state, found in double precision.
  InitialOverlaps(const ContactSurfaces& surfaces, std::span<const ContactPoint<double>> contacts) {
    std::vector<InitialOverlap<double>> exact;
    for (const ContactPoint<double>& contact : contacts) {
      const std::uint32_t body = surfaces.body_of_triangle(contact.triangle);
      if (exact.empty() || exact.back().point != contact.point || exact.back().body != body)
        exact.push_back({contact.point, body, contact.d});
      exact.back().d = std::min(exact.back().d, contact.d);
    }
    for (const auto& [point, body, d] : exact) all_.push_back({point, body, static_cast<T>(d)});
  }

  /// Ascending by point and body.
  const std::vector<Overlap>& all() const { return all_; }

  /// A step begins this long after the initial state [s].
  void begin_step(const ContactSurfaces& surfaces, const PairTable<T>& table, T time) {
    time_ = time;
    active_ = std::ranges::any_of(all_, [&](const Overlap& overlap) {
      const PairConstants<T>& pair = table.at(surfaces.body_of_point(overlap.point), overlap.body);
      return grown(overlap, pair) < pair.reach;
    });
  }
  /// Whether any pair is pushed apart slowly in this step.
  bool active() const { return active_; }

  /// ρ, or the distance at which forces between the point and the body begin now [m].
  T reach(std::uint32_t point, std::uint32_t body, const PairConstants<T>& pair) const {
    const Overlap* const overlap = find(point, body, pair);
    return overlap ? grown(*overlap, pair) : pair.reach;
  }
  /// D, larger for a pair that is pushed apart slowly [m].
  T depth(std::uint32_t point, std::uint32_t body, const PairConstants<T>& pair) const {
    return find(point, body, pair) ? pair.eased : pair.depth;
  }

 private:
  T grown(const Overlap& overlap, const PairConstants<T>& pair) const { return overlap.d + pair.s * time_; }
  const Overlap* find(std::uint32_t point, std::uint32_t body, const PairConstants<T>& pair) const {
    if (!active_) return nullptr;
    const auto key = [](const Overlap& of) { return std::tuple(of.point, of.body); };
    const auto found = std::ranges::lower_bound(all_, std::tuple(point, body), {}, key);
    if (found == all_.end() || key(*found) != std::tuple(point, body)) return nullptr;
    return grown(*found, pair) < pair.reach ? &*found : nullptr;
  }

  std::vector<Overlap> all_;
  T time_ = T(0);
  bool active_ = false;
};

}  // namespace aspic::physics
