#pragma once
// Names for the ends of a lattice of particles, by which a scene pins them.
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "aspic/settings.h"
#include "base/result.h"

namespace aspic {

/// The particles at the low or the high end of an axis of a lattice (0 = x).
struct Side {
  std::string_view name;
  std::size_t axis;
  bool high;
};

/// What the key `pinned` of one kind of body may name: a side; a corner, which is one side of every axis that
/// has sides, joined by hyphens in any order; or a local index.
struct PinNames {
  std::string_view body;        ///< for messages: "cube"
  std::span<const Side> sides;  ///< in the order in which they are listed for users
  std::string_view side;        ///< what people call one: "face"
  std::string_view corner;      ///< how a corner is written: "three faces joined by hyphens, such as …"
  std::string_view last_index;  ///< as a formula: "n³ − 1"

  /// Whether a name is a side or a corner.
  bool knows(std::string_view name) const;
  /// Names of the sides.
  std::vector<std::string_view> words() const;
};

/// Which particles of a lattice are pinned, by local index (i·n₁ + j)·n₂ + k for `lattice` n, each ≥ 1.
/// Errors (scene_rejected), which begin with the key: an unknown name, an index outside the lattice.
Result<std::vector<bool>> pinned_particles(const PinNames& names, const PinnedSettings& pinned,
                                           const std::array<int, 3>& lattice);

}  // namespace aspic
