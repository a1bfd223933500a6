#pragma once
// Charts: panels with axes, curves and maps, as inline SVG and as CSV. Colors are CSS variables, so that one
// image serves light and dark pages.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aspic::report {

/// Numbers of an axis.
enum class Scale { linear, log };

struct ChartAxis {
  std::string title;  ///< "time step h [s]"
  Scale scale = Scale::linear;
  std::optional<double> from = {}, to = {};  ///< absent: what the data need
};

struct Point {
  double x = 0.0, y = 0.0;  ///< not finite: a gap
};

/// How a curve looks. Color, dash and marker go together, so that no curve is told by color alone.
enum class Palette {
  category,  ///< eight, told apart with any color vision (Okabe and Ito, 2008)
  sequence,  ///< five, from dark to light: values of one parameter
  theory     ///< neutral and dashed
};

struct Curve {
  std::string name;
  std::vector<Point> points;
  Palette palette = Palette::category;
  std::size_t index = 0;  ///< in the palette
  bool line = true, markers = true;
};

/// Cells of a map, row by row from the lowest y: x_edges.size() − 1 by y_edges.size() − 1.
struct CellMap {
  std::vector<double> x, y;              ///< centers
  std::vector<double> x_edges, y_edges;  ///< ascending
  std::vector<bool> stable;
};

struct Panel {
  std::string title;
  ChartAxis x, y;
  std::vector<Curve> curves;
  std::optional<CellMap> map = {};
};

struct Chart {
  std::vector<Panel> panels;
  std::size_t columns = 1;
  double panel_width = 560.0, panel_height = 300.0;  ///< of the area with the data [px]
  bool legend = true;
};

/// What a chart is drawn for.
enum class Medium {
  screen,  ///< in a page on a screen, as wide as there is room
  paper,   ///< in a page that is printed: letters of 7 pt and more; without the numbers that a mouse shows
  file     ///< a file of its own, with its styles
};

/// The chart. `id` begins the ids of its parts and is unique in its page. `paper_width` is that of the chart
/// on paper [px, 96 to the inch].
std::string svg_of(const Chart& chart, const std::string& id, Medium medium, double paper_width = 312.0);

/// Every number that the chart shows: panel, curve, x, y, and what x and y are.
std::string csv_of(const Chart& chart);

/// The styles of charts, for the page that holds them.
std::string_view chart_styles();

/// Text with &, <, > and " escaped for XML.
std::string xml(std::string_view text);

/// A number for people, with so many digits: 0.002048, 9.15·10⁻⁵.
std::string rounded(double value, int digits = 4);
/// 10⁻³
std::string power_of_ten(int exponent);

}  // namespace aspic::report
