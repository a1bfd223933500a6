#pragma once
// Bodies that overlap in the initial state are pushed apart slowly (docs/contact.md, "Normal force").
#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "model/model.h"
#include "physics/contact/law.h"
#include "physics/contact/pairs.h"
#include "physics/particle_view.h"

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
  /// `search`: finds contacts in double precision, with the depth of initial overlaps.
  template <class Search>
  InitialOverlaps(const Model& model, const ContactSurfaces& surfaces, Search&& search) {
    const Field<double> x = field<double>(model.initial_position.list(0, model.particle_count()));
    const Field<double> v = Field<double>::Zero(3, x.cols());
    const ParticleView<const double> at = {components(x.data()), components(v.data()), 3};
    if (!search.begin_step(0, at) || !search.find(at)) return;
    std::vector<InitialOverlap<double>> exact;
    for (const ContactPoint<double>& contact : search.contacts()) {
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
