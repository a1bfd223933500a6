#pragma once
// Constants of contact for every pair of bodies, in the solver's precision (docs/contact.md, "The surface").
#include <algorithm>
#include <cstdint>
#include <vector>

#include "model/contact_surface.h"

namespace aspic::physics {

/// Constants of a pair of bodies in the solver's precision (ContactPair).
template <class T>
struct PairConstants {
  T k;       ///< stiffness [N/m]
  T c;       ///< damping [N·s/m]
  T mu;      ///< μ
  T s;       ///< spacing [m]
  T reach;   ///< ρ [m]
  T range;   ///< distance up to which contacts are found [m]: ρ, or more where they are known ahead
  T depth;   ///< D [m]
  T eased;   ///< the same while bodies are eased apart [m]
  T margin;  ///< by which the boxes of candidates are widened [m]
  T tie;     ///< distances that differ by less are equal [m]
  std::uint32_t closed;    ///< 1 where faces have an inside, else 0
  std::uint32_t opposing;  ///< 1 where only faces count that turn to the point, else 0
};

/// Constants of every pair of bodies, held once for bodies that are alike.
template <class T>
class PairTable {
 public:
  PairTable(const ContactSettings& contact, const std::vector<ContactBody>& bodies, double ahead_step);
  /// Number of the pair.
  std::uint32_t of(std::uint32_t point_of, std::uint32_t face_of) const {
    return point_of == face_of ? kind_[point_of] : (1 + kind_[point_of]) * kinds_ + kind_[face_of];
  }
  const PairConstants<T>& operator[](std::uint32_t pair) const { return pairs_[pair]; }
  const std::vector<PairConstants<T>>& pairs() const { return pairs_; }
  const PairConstants<T>& at(std::uint32_t point_of, std::uint32_t face_of) const {
    return pairs_[of(point_of, face_of)];
  }
  /// Whether any pair has friction.
  bool has_friction() const {
    return std::ranges::any_of(pairs_, [](const PairConstants<T>& pair) { return pair.mu > T(0); });
  }

 private:
  std::vector<std::uint32_t> kind_;      // by body
  std::uint32_t kinds_ = 0;              // so many
  std::vector<PairConstants<T>> pairs_;  // by kind, of a body with itself; then by both kinds
};

// Compiled once, in pairs.cpp.
extern template class PairTable<float>;
extern template class PairTable<double>;

}  // namespace aspic::physics
