#include "gpu/lattice_links.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "model/lattice.h"

namespace aspic::gl {
namespace {

/// Links of the particles 0 … run − 1, which lie one after the other, to the particle at t steps from the
/// first of them in the row at (di, dj), and before them the reading of that particle; nothing without links.
std::string links_to(int di, int dj, int t, int run) {
  std::string links;
  for (int p = 0; p < run; ++p) {
    const auto directions = lattice_directions();
    const auto towards = std::ranges::find_if(
        directions, [&](const LatticeDirection& o) { return o.di == di && o.dj == dj && o.dk == t - p; });
    if (towards != directions.end())
      links += fmt::format(" LINK({}, {}, {}, {}, {})", p, di, dj, t - p, towards->spring_class);
  }
  if (links.empty()) return links;
  const bool own = di == 0 && dj == 0 && t >= 0 && t < run;
  return (own ? fmt::format("NEAR({})", t) : fmt::format("FAR({}, {}, {})", di, dj, t)) + links;
}

std::string each_link(int run) {
  int reach = 0;
  for (const LatticeDirection& o : lattice_directions()) reach = std::max(reach, std::abs(o.dk));
  std::string text = "#define EACH_LINK";
  for (int di = -reach; di <= reach; ++di) {
    for (int dj = -reach; dj <= reach; ++dj) {
      for (int t = -reach; t < run + reach; ++t) {
        const std::string links = links_to(di, dj, t, run);
        if (!links.empty()) text += " \\\n  " + links;
      }
    }
  }
  return text + "\n";
}

}  // namespace

std::string lattice_links() {
  return each_link(4);
}

}  // namespace aspic::gl
