#include "report/chart_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace aspic::report {
std::string power_of_ten(int exponent) {
  constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char c : fmt::format("{}", std::abs(exponent))) text += digits[c - '0'];
  return text;
}

AxisScale::AxisScale(const ChartAxis& axis, const std::vector<double>& values)
    : log_(axis.scale == Scale::log) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!std::isfinite(value) || (log_ && value <= 0.0)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(low <= high)) {
    low = log_ ? 0.1 : 0.0;
    high = 1.0;
  }
  if (log_) {
    const double pad = std::pow(high / low, 0.04) * 1.02;
    from_ = axis.from.value_or(low / pad);
    to_ = axis.to.value_or(high * pad);
    if (!(to_ > from_)) to_ = 10.0 * from_;
    make_log_ticks();
  } else {
    const double span = high > low ? high - low : std::max(1.0, std::abs(high));
    // An axis that begins at 0 anyway begins there exactly.
    from_ = axis.from.value_or(low >= 0.0 && low < 0.2 * span ? 0.0 : low - 0.05 * span);
    to_ = axis.to.value_or(high + 0.06 * std::max(high - from_, 0.5 * span));
    if (!(to_ > from_)) to_ = from_ + 1.0;
    make_linear_ticks(6.0);
  }
}

double AxisScale::at(double value) const {
  if (log_) return value > 0.0 ? std::log(value / from_) / std::log(to_ / from_) : std::nan("");
  return (value - from_) / (to_ - from_);
}

void AxisScale::make_linear_ticks(double most) {
  const double raw = (to_ - from_) / most, power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= raw) step = factor * power;
  }
  for (double n = std::ceil(from_ / step - 1e-9); n * step <= to_ + 1e-9 * step; n += 1.0) {
    const double value = n * step;
    // 5·10⁵ rather than 500000: there is room for five digits.
    ticks_.push_back({value, n == 0.0                     ? "0"
                             : std::abs(value) >= 99999.5 ? rounded(value, 5)
                                                          : fmt::format("{:.6g}", value)});
  }
}

void AxisScale::make_log_ticks() {
  const double decades = std::log10(to_ / from_);
  const int first = static_cast<int>(std::floor(std::log10(from_))),
            last = static_cast<int>(std::ceil(std::log10(to_)));
  const bool plain = from_ > 0.9e-4 && to_ < 2e5;
  const int every = std::max(1, static_cast<int>(std::ceil(decades / 6.0)));
  for (int exponent = first; exponent <= last; ++exponent) {
    for (int digit = 1; digit < 10; ++digit) {
      const double value = digit * std::pow(10.0, exponent);
      if (value < from_ * (1 - 1e-9) || value > to_ * (1 + 1e-9)) continue;
      const bool labeled = digit == 1 ? exponent % every == 0 : (decades < 2.0 && (digit == 2 || digit == 5));
      if (digit > 1 && decades > 4.0) continue;
      Tick tick = {value, ""};
      if (labeled)
        tick.label = plain        ? fmt::format("{:.6g}", value)
                     : digit == 1 ? power_of_ten(exponent)
                                  : fmt::format("{}·{}", digit, power_of_ten(exponent));
      ticks_.push_back(tick);
    }
  }
}

}  // namespace aspic::report
