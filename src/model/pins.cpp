#include "model/pins.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

namespace aspic {
namespace {

/// Where along each axis a name's particles are: at the first or the last lattice point, or anywhere.
enum class Place { anywhere, first, last };
using PlacesByAxis = std::array<Place, 3>;

/// The places that the name of a side or a corner speaks of; nothing for a name that is unknown.
std::optional<PlacesByAxis> places_of(std::span<const Side> sides, std::string_view name) {
  PlacesByAxis places = {Place::anywhere, Place::anywhere, Place::anywhere};
  std::size_t parts = 0;
  for (std::size_t start = 0; start <= name.size();) {
    const std::size_t end = std::min(name.find('-', start), name.size());
    const auto side = std::ranges::find(sides, name.substr(start, end - start), &Side::name);
    if (side == sides.end()) return std::nullopt;
    Place& place = places[side->axis];
    if (place != Place::anywhere) return std::nullopt;
    place = side->high ? Place::last : Place::first;
    ++parts;
    start = end + 1;
  }
  // Each axis has two sides: half of them make a corner.
  if (parts != 1 && parts != sides.size() / 2) return std::nullopt;
  return places;
}

}  // namespace

bool PinNames::knows(std::string_view name) const {
  return places_of(sides, name).has_value();
}

std::vector<std::string_view> PinNames::words() const {
  std::vector<std::string_view> all;
  for (const Side& s : sides) all.push_back(s.name);
  return all;
}

Result<std::vector<bool>> pinned_particles(const PinNames& names, const PinnedSettings& pinned,
                                           const std::array<int, 3>& lattice) {
  const auto [n0, n1, n2] = lattice;
  std::vector<bool> result(
      static_cast<std::size_t>(n0) * static_cast<std::size_t>(n1) * static_cast<std::size_t>(n2), false);
  for (const std::string& name : pinned.names) {
    const auto places = places_of(names.sides, name);
    if (!places) {
      return fail(ErrorCode::scene_rejected, "pinned: \"{}\" is neither {} {} ({}) nor a corner ({})", name,
                  std::string_view("aeiou").find(names.side.front()) != std::string_view::npos ? "an" : "a",
                  names.side, fmt::join(names.words(), ", "), names.corner);
    }
    const auto along = [&](std::size_t axis, int at) {
      return (*places)[axis] == Place::anywhere ||
             at == ((*places)[axis] == Place::last ? lattice[axis] - 1 : 0);
    };
    std::size_t local = 0;
    for (int i = 0; i < n0; ++i) {
      for (int j = 0; j < n1; ++j) {
        for (int k = 0; k < n2; ++k, ++local) {
          if (along(0, i) && along(1, j) && along(2, k)) result[local] = true;
        }
      }
    }
  }
  for (const std::int64_t index : pinned.indices) {
    if (index < 0 || index >= std::ssize(result)) {
      return fail(ErrorCode::scene_rejected, "pinned: index {} is not in the {}; allowed: 0 … {}", index,
                  names.body, result.size() - 1);
    }
    result[static_cast<std::size_t>(index)] = true;
  }
  return result;
}

}  // namespace aspic
