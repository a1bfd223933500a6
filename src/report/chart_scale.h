#pragma once
// The scale of an axis: its range, its ticks, and where numbers lie on it.
#include <string>
#include <vector>

#include "report/chart.h"

namespace aspic::report {

struct Tick {
  double value = 0.0;
  std::string label;  ///< empty: between those that have one
};

class AxisScale {
 public:
  /// Covers the values that are finite and, with log, above 0; the axis' own ends go before.
  AxisScale(const ChartAxis& axis, const std::vector<double>& values);

  /// Share of the axis' length, from 0 to 1 within its range; not finite where the number has no place.
  double at(double value) const;
  const std::vector<Tick>& ticks() const { return ticks_; }

 private:
  void make_linear_ticks(double most);
  void make_log_ticks();

  bool log_ = false;
  double from_ = 0.0, to_ = 1.0;
  std::vector<Tick> ticks_;
};

}  // namespace aspic::report
