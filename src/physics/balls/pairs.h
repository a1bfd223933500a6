#pragma once
// Pairs of bodies that touch, and which of them act.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace aspic::physics {

/// Bodies' partners, body after body, each in ascending index.
struct Contacts {
  std::vector<std::size_t> start;     ///< of each body's partners; one more entry than bodies
  std::vector<std::uint32_t> other;   ///< the partners
  std::vector<std::uint8_t> acting;   ///< of each pair: it takes part in the phase of velocities
  std::vector<std::uint8_t> overlap;  ///< of each pair: its gap is negative

  void clear() {
    start.assign(1, 0);
    other.clear();
    overlap.clear();
  }
  void add(std::uint32_t partner, bool overlaps) {
    other.push_back(partner);
    overlap.push_back(overlaps);
  }
  /// The partners of the next body have been added.
  void end_body() { start.push_back(other.size()); }
};

/// Marks the pairs that act, and counts each body's.
template <class Acts>
std::vector<std::uint32_t> tally(Contacts& contacts, const Acts& acts) {
  std::vector<std::uint32_t> c(contacts.start.size() - 1, 0);
  contacts.acting.resize(contacts.other.size());
  for (std::uint32_t own = 0; own < c.size(); ++own) {
    for (std::size_t k = contacts.start[own]; k < contacts.start[own + 1]; ++k) {
      contacts.acting[k] = acts(own, contacts.other[k]);
      c[own] += contacts.acting[k];
    }
  }
  return c;
}

/// Adds each body's pairs that overlap to its count.
inline void tally_overlaps(const Contacts& contacts, std::vector<std::uint32_t>& c) {
  for (std::size_t own = 0; own < c.size(); ++own) {
    for (std::size_t k = contacts.start[own]; k < contacts.start[own + 1]; ++k) c[own] += contacts.overlap[k];
  }
}

/// Calls take(other) for the partners of a body that `flags` marks.
template <class Take>
void for_each(const Contacts& contacts, const std::vector<std::uint8_t>& flags, std::uint32_t own,
              const Take& take) {
  for (std::size_t k = contacts.start[own]; k < contacts.start[own + 1]; ++k) {
    if (flags[k] != 0) take(contacts.other[k]);
  }
}

}  // namespace aspic::physics
