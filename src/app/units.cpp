#include "app/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace aspic::app {

std::string with_prefix(double value, std::string_view unit, int digits) {
  if (unit.empty() || !std::isfinite(value)) return fmt::format("{:.{}g} {}", value, digits, unit);
  if (value == 0.0) return fmt::format("0 {}", unit);
  constexpr std::array<std::string_view, 9> prefixes = {"p", "n", "µ", "m", "", "k", "M", "G", "T"};
  constexpr int plain = 4, last = static_cast<int>(prefixes.size()) - 1;
  // Rounded first: 999.96 is 1 k in four digits.
  const double unit_of_last = std::pow(10.0, std::floor(std::log10(std::abs(value))) - digits + 1);
  const double rounded = std::round(value / unit_of_last) * unit_of_last;
  const int thousands = static_cast<int>(std::floor(std::log10(std::abs(rounded) * (1.0 + 1e-12)) / 3.0));
  const int place = std::clamp(plain + thousands, 0, last);
  const double shown = rounded / std::pow(1000.0, place - plain);
  return fmt::format("{:.{}g} {}{}", shown, digits, prefixes[static_cast<std::size_t>(place)], unit);
}

double without_noise(double value, double size) {
  constexpr double rounding = 1e-6;  // some units in the last place of single precision
  return std::abs(value) < rounding * std::abs(size) ? 0.0 : value;
}

}  // namespace aspic::app
