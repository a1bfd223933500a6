#pragma once
// One panel of a chart, and what its legend shares with it.
#include <string>
#include <string_view>

#include "report/chart.h"

namespace aspic::report {

/// What a chart is drawn on: its letters have one size on paper however wide the chart is.
struct Frame {
  double left, right, top, bottom;                   ///< around a panel's data [px]
  double inner_left, inner_bottom;                   ///< the same where a neighbor's axis serves [px]
  double title_up, tick_down, axis_down, axis_left;  ///< base lines from the data's edges [px]
  double legend_row;                                 ///< height [px]
  double letter, tick_letter;                        ///< mean width [px]
};
inline constexpr Frame screen_frame = {66, 14, 26, 46, 66, 46, 10, 16, 36, 50, 20, 6.6, 6.2};
inline constexpr Frame paper_frame = {51, 8, 19, 33, 12, 18, 6, 12, 27, 41, 14, 5.5, 5.2};

/// Where a panel is among others, its data's upper left corner at the origin.
struct PanelPlace {
  double width = 0.0, height = 0.0;  ///< of its data [px]
  bool x_labels = true, y_labels = true;
  bool tooltips = true;  ///< marks and cells have titles with their numbers
};

/// The panel as SVG. `clip` is an id that is unique in the page.
std::string svg_of(const Panel& panel, const Frame& frame, const PanelPlace& place, const std::string& clip);

/// A number of pixels, in hundredths.
std::string px(double value);
/// Attributes of a curve's line and of its markers.
std::string line_style(const Curve& curve);
std::string marker_style(const Curve& curve);
/// The path of a curve's marker around (x, y).
std::string marker(const Curve& curve, double x, double y);
std::string text(double x, double y, std::string_view words, std::string_view attributes = "");

}  // namespace aspic::report
