#pragma once
// Which of the triangles near a point it touches (docs/contact.md, "Which faces a point touches").
#include <cstdint>
#include <limits>
#include <vector>

#include "physics/contact/geometry.h"
#include "physics/contact/pairs.h"

namespace aspic::physics {

/// Whether a triangle counts for a point with normal N: it has an area and, between closed surfaces, faces
/// the point.
template <class T>
bool counts(const Face<T>& face, const PairConstants<T>& pair, const Vector<T>& N) {
  return face.real && (!pair.opposing || dot3<T>(N, face.g) < T(0));
}

/// The contacts of a point with one body: calls add(sight, gap) for the first contact, then for those with
/// other sides, ascending. `sights`: of the triangles that count, ascending; `depth`: D [m].
template <class T, class Add>
void select_contacts(const std::vector<ClosestPoint<T>>& closest, const PairConstants<T>& pair, T depth,
                     const Add& add) {
  const ClosestPoint<T>* const first =
      nearest_of<T>(closest, pair.tie, [](const ClosestPoint<T>&) { return true; });
  if (!first) return;
  const auto gap = pair.closed ? closed_gap<T>(*first, pair.range, depth) : open_gap<T>(*first, pair.range);
  if (gap) add(*first, *gap);
  if (!pair.closed) return;
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  const auto next_side = [&](std::uint32_t least) {
    std::uint32_t side = none;
    for (const ClosestPoint<T>& seen : closest)
      if (seen.side >= least && seen.side != first->side) side = std::min(side, seen.side);
    return side;
  };
  for (std::uint32_t side = next_side(0); side != none; side = next_side(side + 1)) {
    const ClosestPoint<T>& seen =
        *nearest_of<T>(closest, pair.tie, [&](const ClosestPoint<T>& each) { return each.side == side; });
    if (straight_in_front<T>(seen, pair.range)) add(seen, *closed_gap<T>(seen, pair.range, depth));
  }
}

}  // namespace aspic::physics
