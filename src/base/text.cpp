#include "base/text.h"

#include <fmt/format.h>

#include <iterator>

namespace aspic {

std::string human_bytes(std::uint64_t bytes) {
  constexpr const char* units[] = {"KiB", "MiB", "GiB", "TiB", "PiB"};
  if (bytes < 1024) return fmt::format("{} bytes", bytes);
  double size = static_cast<double>(bytes) / 1024.0;
  std::size_t unit = 0;
  while (size >= 1024.0 && unit + 1 < std::size(units)) size /= 1024.0, ++unit;
  return fmt::format("{:.4g} {}", size, units[unit]);
}

}  // namespace aspic
