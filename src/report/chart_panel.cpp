#include "report/chart_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/printable.h"
#include "report/chart_scale.h"
#include "report/csv.h"

namespace aspic::report {
namespace {

char palette_letter(const Curve& curve) {
  return curve.palette == Palette::sequence ? 's' : 'c';
}

std::string color(const Curve& curve) {
  const std::size_t count = curve.palette == Palette::sequence ? 5 : 8;
  return fmt::format("var(--{}{})", palette_letter(curve), curve.index % count);
}

std::string_view dash(const Curve& curve) {
  constexpr std::string_view dashes[] = {"", "7 3", "2 3", "9 3 2 3", "12 4", "4 2", "1 2", "8 2 2 2 2 2"};
  return curve.palette == Palette::category ? dashes[curve.index % 8] : dashes[0];
}

}  // namespace

std::string px(double value) {
  return fmt::format("{:.6g}", std::round(100.0 * value) / 100.0);
}

std::string marker(const Curve& curve, double x, double y) {
  const auto shape = [&](std::initializer_list<Point> corners) {
    std::string path;
    for (const Point& p : corners)
      path += fmt::format("{}{} {}", path.empty() ? "M" : "L", px(x + p.x), px(y + p.y));
    return path + "Z";
  };
  switch (curve.index % 8) {
    case 1:
      return shape({{-3.5, -3.5}, {3.5, -3.5}, {3.5, 3.5}, {-3.5, 3.5}});
    case 2:
      return shape({{0, -4.6}, {4.4, 3.4}, {-4.4, 3.4}});
    case 3:
      return shape({{0, -4.8}, {4.8, 0}, {0, 4.8}, {-4.8, 0}});
    case 4:
      return shape({{0, 4.6}, {4.4, -3.4}, {-4.4, -3.4}});
    case 5:
      return shape({{-1.5, -4.5},
                    {1.5, -4.5},
                    {1.5, -1.5},
                    {4.5, -1.5},
                    {4.5, 1.5},
                    {1.5, 1.5},
                    {1.5, 4.5},
                    {-1.5, 4.5},
                    {-1.5, 1.5},
                    {-4.5, 1.5},
                    {-4.5, -1.5},
                    {-1.5, -1.5}});
    case 6:
      return shape({{-2, -4.5}, {2, -4.5}, {4.5, -2}, {4.5, 2}, {2, 4.5}, {-2, 4.5}, {-4.5, 2}, {-4.5, -2}});
    case 7:
      return shape({{-4.6, -2}, {4.6, -2}, {4.6, 2}, {-4.6, 2}});
    default:
      return fmt::format("M{0} {1}a3.8 3.8 0 1 0 7.6 0a3.8 3.8 0 1 0 -7.6 0Z", px(x - 3.8), px(y));
  }
}

std::string line_style(const Curve& curve) {
  if (curve.palette == Palette::theory) return "class=\"theory\"";
  const std::string_view pattern = dash(curve);
  return fmt::format("class=\"l\" style=\"stroke:{}{}{}\"", color(curve),
                     pattern.empty() ? "" : ";stroke-dasharray:", pattern);
}

std::string marker_style(const Curve& curve) {
  if (curve.palette == Palette::theory) return "class=\"m tm\"";
  return fmt::format("class=\"m\" style=\"fill:{}\"", color(curve));
}

std::string text(double x, double y, std::string_view words, std::string_view attributes) {
  return fmt::format("<text x=\"{}\" y=\"{}\" {}>{}</text>", px(x), px(y), attributes, xml(words));
}

namespace {

class PanelDrawing {
 public:
  PanelDrawing(const Panel& panel, const Frame& frame, const PanelPlace& place, std::string clip)
      : panel_(panel),
        frame_(frame),
        place_(place),
        width_(place.width),
        height_(place.height),
        clip_(std::move(clip)),
        x_(panel.x, numbers(&Point::x)),
        y_(panel.y, numbers(&Point::y)) {}

  std::string draw() {
    axes();
    if (panel_.map) map(*panel_.map);
    out_ += fmt::format(
        "<clipPath id=\"{0}\"><rect x=\"-6\" y=\"-6\" width=\"{1}\" height=\"{2}\"/></clipPath><g "
        "clip-path=\"url(#{0})\">",
        clip_, px(width_ + 12), px(height_ + 12));
    for (const Curve& curve : panel_.curves) line(curve);
    for (const Curve& curve : panel_.curves) markers(curve);
    return out_ + "</g>";
  }

 private:
  std::vector<double> numbers(double Point::*coordinate) const {
    std::vector<double> all;
    for (const Curve& curve : panel_.curves) {
      for (const Point& p : curve.points) {
        if (std::isfinite(p.x) && std::isfinite(p.y)) all.push_back(p.*coordinate);
      }
    }
    if (panel_.map) all = coordinate == &Point::x ? panel_.map->x_edges : panel_.map->y_edges;
    return all;
  }
  /// The end of an element's tag, after its title where there are any.
  std::string titled(std::string_view element, std::string_view words) const {
    return place_.tooltips ? fmt::format("><title>{}</title></{}>", xml(words), element) : "/>";
  }
  double x(double value) const { return width_ * x_.at(value); }
  double y(double value) const { return height_ * (1.0 - y_.at(value)); }

  void axes() {
    out_ += text(0, -frame_.title_up, panel_.title, "class=\"title\"");
    std::string lines;
    double free = -1e9;  // where the last label ends: none lies on another
    for (const Tick& tick : x_.ticks()) {
      const double at = x(tick.value),
                   half = 0.5 * frame_.tick_letter * static_cast<double>(character_count(tick.label));
      lines += fmt::format("M{0} 0V{1}", px(at), px(height_));
      if (tick.label.empty() || !place_.x_labels || at - half < free) continue;
      free = at + half + frame_.tick_letter;
      out_ += text(at, height_ + frame_.tick_down, tick.label, "class=\"tick\" text-anchor=\"middle\"");
    }
    for (const Tick& tick : y_.ticks()) {
      const double at = y(tick.value);
      lines += fmt::format("M0 {0}H{1}", px(at), px(width_));
      if (!tick.label.empty() && place_.y_labels)
        out_ += text(-7, at + 4, tick.label, "class=\"tick\" text-anchor=\"end\"");
    }
    out_ += fmt::format("<path class=\"grid\" d=\"{}\"/><rect class=\"frame\" width=\"{}\" height=\"{}\"/>",
                        lines, px(width_), px(height_));
    if (place_.x_labels)
      out_ += text(width_ / 2, height_ + frame_.axis_down, panel_.x.title, "text-anchor=\"middle\"");
    if (!place_.y_labels) return;
    out_ += fmt::format("<text transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
                        px(-frame_.axis_left), px(height_ / 2), xml(panel_.y.title));
  }

  void map(const CellMap& map) {
    const std::size_t columns = map.x.size();
    std::string hatch;
    for (std::size_t i = 0; i < map.stable.size(); ++i) {
      const std::size_t column = i % columns, row = i / columns;
      const double x0 = x(map.x_edges[column]), x1 = x(map.x_edges[column + 1]), y0 = y(map.y_edges[row + 1]),
                   y1 = y(map.y_edges[row]);
      out_ += fmt::format(
          "<rect class=\"cell {}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}",
          map.stable[i] ? "ok" : "bad", px(x0), px(y0), px(x1 - x0), px(y1 - y0),
          titled("rect", fmt::format("{}, {}: {}", csv_number(map.x[column]), csv_number(map.y[row]),
                                     map.stable[i] ? "stable" : "unstable")));
      if (!map.stable[i])
        hatch += fmt::format("M{} {}L{} {}", px(x0 + 1), px(y1 - 1), px(x1 - 1), px(y0 + 1));
    }
    if (!hatch.empty()) out_ += fmt::format("<path class=\"hatch\" d=\"{}\"/>", hatch);
  }

  void line(const Curve& curve) {
    if (!curve.line) return;
    std::string path;
    bool gap = true;
    for (const Point& p : curve.points) {
      const double at_x = x(p.x), at_y = y(p.y);
      if (!std::isfinite(at_x) || !std::isfinite(at_y)) {
        gap = true;
        continue;
      }
      // Far outside, where the clip hides it anyway.
      path += fmt::format("{}{} {}", gap ? 'M' : 'L', px(std::clamp(at_x, -1e4, 1e4)),
                          px(std::clamp(at_y, -1e4, 1e4)));
      gap = false;
    }
    if (!path.empty()) out_ += fmt::format("<path {} d=\"{}\"/>", line_style(curve), path);
  }

  void markers(const Curve& curve) {
    if (!curve.markers) return;
    for (const Point& p : curve.points) {
      const double at_x = x(p.x), at_y = y(p.y);
      if (!(at_x >= -1 && at_x <= width_ + 1 && at_y >= -1 && at_y <= height_ + 1)) continue;
      out_ += fmt::format(
          "<path {} d=\"{}\"{}", marker_style(curve), marker(curve, at_x, at_y),
          titled("path", fmt::format("{}: {}, {}", curve.name, csv_number(p.x), csv_number(p.y))));
    }
  }

  const Panel& panel_;
  const Frame& frame_;
  const PanelPlace place_;
  double width_, height_;
  std::string clip_;
  AxisScale x_, y_;
  std::string out_;
};

}  // namespace

std::string svg_of(const Panel& panel, const Frame& frame, const PanelPlace& place, const std::string& clip) {
  return PanelDrawing(panel, frame, place, clip).draw();
}

}  // namespace aspic::report
