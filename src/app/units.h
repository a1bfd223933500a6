#pragma once
// Numbers with units, for people.
#include <string>
#include <string_view>

namespace aspic::app {

/// "88.26 kJ", "5.164 kN·s", "12 mJ", "0 J": so many significant digits ≥ 1, with a prefix from p to T. Of a
/// product of units the prefix goes to the first. An empty unit takes none: "8.826e+04".
std::string with_prefix(double value, std::string_view unit, int digits = 4);

/// The value, or 0 where it is less than what rounding in single precision makes of numbers of this size.
double without_noise(double value, double size);

}  // namespace aspic::app
