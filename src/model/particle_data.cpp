#include "aspic/particle_data.h"

namespace aspic {

Vec3 LatticePlaces::operator[](std::size_t local) const {
  const auto at = static_cast<int>(local);
  const int i = at / (edge * edge), j = at / edge % edge, k = at % edge;
  return centre + turned({i * spacing - half, j * spacing - half, k * spacing - half});
}

Vec3 Places::operator[](std::size_t i) const {
  const auto next = std::ranges::upper_bound(lattices_, i, {}, &Piece::end);
  if (next != lattices_.end() && i >= next->first()) return next->places[i - next->first()];
  return listed_[next == lattices_.begin() ? i : i - std::prev(next)->end + std::prev(next)->listed_before];
}

std::vector<Vec3> Places::list(std::size_t first, std::size_t count) const {
  std::vector<Vec3> all;
  all.reserve(count);
  for (std::size_t i = first; i < first + count; ++i) all.push_back((*this)[i]);
  return all;
}

void Places::append(const LatticePlaces& lattice) {
  lattices_.push_back({size() + lattice.count(), listed_.size(), lattice});
}

void Places::set(std::size_t i, const Vec3& place) {
  if (!lattices_.empty()) *this = Places(list(0, size()));
  listed_[i] = place;
}

std::uint64_t Places::bytes() const {
  return listed_.capacity() * sizeof(Vec3) + lattices_.capacity() * sizeof(Piece);
}

}  // namespace aspic
