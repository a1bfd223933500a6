#include "report/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/printable.h"
#include "report/chart_scale.h"
#include "report/csv.h"

namespace aspic::report {

const char* const chart_styles = R"(
svg.chart{--s0:#3b1c6e;--s1:#3b528b;--s2:#1f8a83;--s3:#3fa34d;--s4:#b58a00;
--c0:#0072b2;--c1:#d55e00;--c2:#009e73;--c3:#a8458b;--c4:#b07800;--c5:#3a9bd9;--c6:#444;--c7:#8b5a2b;
--ink:#222;--soft:#5b6068;--grid:#e3e5e8;--frame:#9aa0a8;--stable:#bfe0f2;--unstable:#f6c9a8;--hatch:#c66a22;--paper:#fff;
font:12px system-ui,-apple-system,"Segoe UI","DejaVu Sans",sans-serif;font-variant-numeric:tabular-nums}
@media screen and (prefers-color-scheme:dark){svg.chart{--s0:#c9a6ff;--s1:#8fb2ff;--s2:#4fd1c5;--s3:#8fe388;--s4:#f7e463;
--c0:#5db7f0;--c1:#ff8c4a;--c2:#3fd0a0;--c3:#ee9fd4;--c4:#f5bd45;--c5:#a5dcff;--c6:#eee;--c7:#cfa77a;
--ink:#e8e8e8;--soft:#a9b0ba;--grid:#30353c;--frame:#6b727c;--stable:#1d4a63;--unstable:#5c3416;--hatch:#d98a4e;--paper:#15181c}}
svg.chart text{fill:var(--ink)}svg.chart .tick{fill:var(--soft);font-size:11px}svg.chart .title{font-weight:600}
svg.chart .grid{stroke:var(--grid);stroke-width:1;fill:none}svg.chart .frame{stroke:var(--frame);stroke-width:1;fill:none}
svg.chart .l{fill:none;stroke-width:1.8;stroke-linejoin:round}svg.chart .m{stroke-width:1.2;stroke:var(--paper)}
svg.chart .theory{stroke:var(--ink);stroke-dasharray:6 4;stroke-width:1.6;fill:none}svg.chart .tm{fill:var(--ink);stroke:var(--paper)}
svg.chart .ok{fill:var(--stable)}svg.chart .bad{fill:var(--unstable)}svg.chart .hatch{stroke:var(--hatch);stroke-width:1;opacity:.55}
svg.chart .cell{stroke:var(--paper);stroke-width:.6}
)";

namespace {

constexpr double left = 66.0, right = 14.0, top = 26.0, bottom = 46.0;  // around a panel's data [px]
constexpr double legend_row = 20.0, letter = 6.6;

std::string px(double value) {
  return fmt::format("{:.6g}", std::round(100.0 * value) / 100.0);
}

char palette_letter(const Curve& curve) {
  return curve.palette == Palette::sequence ? 's' : 'c';
}

std::string colour(const Curve& curve) {
  const std::size_t count = curve.palette == Palette::sequence ? 5 : 8;
  return fmt::format("var(--{}{})", palette_letter(curve), curve.index % count);
}

std::string_view dash(const Curve& curve) {
  constexpr std::string_view dashes[] = {"", "7 3", "2 3", "9 3 2 3", "12 4", "4 2", "1 2", "8 2 2 2 2 2"};
  return curve.palette == Palette::category ? dashes[curve.index % 8] : dashes[0];
}

/// A closed shape around (x, y).
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

/// Attributes of a curve's line.
std::string line_style(const Curve& curve) {
  if (curve.palette == Palette::theory) return "class=\"theory\"";
  const std::string_view pattern = dash(curve);
  return fmt::format("class=\"l\" style=\"stroke:{}{}{}\"", colour(curve),
                     pattern.empty() ? "" : ";stroke-dasharray:", pattern);
}

std::string marker_style(const Curve& curve) {
  if (curve.palette == Palette::theory) return "class=\"m tm\"";
  return fmt::format("class=\"m\" style=\"fill:{}\"", colour(curve));
}

std::string text(double x, double y, std::string_view words, std::string_view attributes = "") {
  return fmt::format("<text x=\"{}\" y=\"{}\" {}>{}</text>", px(x), px(y), attributes, xml(words));
}

/// One panel, its data's upper left corner at the origin.
class PanelDrawing {
 public:
  PanelDrawing(const Panel& panel, const Chart& chart, std::string clip)
      : panel_(panel),
        width_(chart.panel_width),
        height_(chart.panel_height),
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
  double x(double value) const { return width_ * x_.at(value); }
  double y(double value) const { return height_ * (1.0 - y_.at(value)); }

  void axes() {
    out_ += text(0, -10, panel_.title, "class=\"title\"");
    std::string lines;
    for (const Tick& tick : x_.ticks()) {
      const double at = x(tick.value);
      lines += fmt::format("M{0} 0V{1}", px(at), px(height_));
      if (!tick.label.empty())
        out_ += text(at, height_ + 16, tick.label, "class=\"tick\" text-anchor=\"middle\"");
    }
    for (const Tick& tick : y_.ticks()) {
      const double at = y(tick.value);
      lines += fmt::format("M0 {0}H{1}", px(at), px(width_));
      if (!tick.label.empty()) out_ += text(-7, at + 4, tick.label, "class=\"tick\" text-anchor=\"end\"");
    }
    out_ += fmt::format("<path class=\"grid\" d=\"{}\"/><rect class=\"frame\" width=\"{}\" height=\"{}\"/>",
                        lines, px(width_), px(height_));
    out_ += text(width_ / 2, height_ + 36, panel_.x.title, "text-anchor=\"middle\"");
    out_ += fmt::format("<text transform=\"translate(-50 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
                        px(height_ / 2), xml(panel_.y.title));
  }

  void map(const CellMap& map) {
    const std::size_t columns = map.x.size();
    std::string hatch;
    for (std::size_t i = 0; i < map.stable.size(); ++i) {
      const std::size_t column = i % columns, row = i / columns;
      const double x0 = x(map.x_edges[column]), x1 = x(map.x_edges[column + 1]), y0 = y(map.y_edges[row + 1]),
                   y1 = y(map.y_edges[row]);
      out_ += fmt::format(
          "<rect class=\"cell {}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"><title>{}, {}: "
          "{}</title></rect>",
          map.stable[i] ? "ok" : "bad", px(x0), px(y0), px(x1 - x0), px(y1 - y0), csv_number(map.x[column]),
          csv_number(map.y[row]), map.stable[i] ? "stable" : "unstable");
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
      out_ += fmt::format("<path {} d=\"{}\"><title>{}: {}, {}</title></path>", marker_style(curve),
                          marker(curve, at_x, at_y), xml(curve.name), csv_number(p.x), csv_number(p.y));
    }
  }

  const Panel& panel_;
  double width_, height_;
  std::string clip_;
  AxisScale x_, y_;
  std::string out_;
};

/// Each name once, in the order of panels.
std::vector<const Curve*> legend_of(const Chart& chart) {
  std::vector<const Curve*> entries;
  for (const Panel& panel : chart.panels) {
    for (const Curve& curve : panel.curves) {
      const bool known = std::ranges::any_of(entries, [&](const Curve* e) { return e->name == curve.name; });
      if (!known && !curve.name.empty()) entries.push_back(&curve);
    }
  }
  return entries;
}

/// The legend in rows of at most `width`; `height` grows by what it takes.
std::string draw_legend(const Chart& chart, double width, double& height) {
  std::string out;
  double x = left, y = height + 8;
  const auto place = [&](std::string_view name, const auto& sample) {
    const double needed = 34 + letter * static_cast<double>(character_count(name)) + 18;
    if (x + needed > width && x > left) {
      x = left;
      y += legend_row;
    }
    out += sample(x, y) + text(x + 32, y + 4, name);
    x += needed;
  };
  for (const Curve* entry : legend_of(chart)) {
    place(entry->name, [&](double sx, double sy) {
      std::string sample;
      if (entry->line)
        sample += fmt::format("<path {} d=\"M{} {}h26\"/>", line_style(*entry), px(sx), px(sy));
      if (entry->markers)
        sample += fmt::format("<path {} d=\"{}\"/>", marker_style(*entry), marker(*entry, sx + 13, sy));
      return sample;
    });
  }
  const bool maps = std::ranges::any_of(chart.panels, [](const Panel& p) { return p.map.has_value(); });
  for (const bool stable : {true, false}) {
    if (!maps) break;
    place(stable ? "stable" : "unstable: small motions grow", [&](double sx, double sy) {
      std::string sample =
          fmt::format("<rect class=\"cell {}\" x=\"{}\" y=\"{}\" width=\"22\" height=\"12\"/>",
                      stable ? "ok" : "bad", px(sx + 2), px(sy - 6));
      if (!stable)
        sample += fmt::format("<path class=\"hatch\" d=\"M{} {}l20 -10\"/>", px(sx + 3), px(sy + 5));
      return sample;
    });
  }
  height = y + legend_row - 4;
  return out;
}

}  // namespace

std::string xml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string rounded(double value, int digits) {
  if (value == 0.0) return "0";
  std::string text = fmt::format("{:.{}g}", value, digits);
  if (const std::size_t e = text.find('e'); e != std::string::npos) {
    const std::string power = power_of_ten(std::stoi(text.substr(e + 1)));
    text.resize(e);
    text = text == "1" ? power : fmt::format("{}·{}", text, power);
  }
  return text;
}

std::string svg_of(const Chart& chart, const std::string& id, bool alone) {
  const std::size_t columns = std::max<std::size_t>(1, std::min(chart.columns, chart.panels.size()));
  const std::size_t rows = (chart.panels.size() + columns - 1) / columns;
  const double cell_width = left + chart.panel_width + right, cell_height = top + chart.panel_height + bottom;
  const double width = static_cast<double>(columns) * cell_width;
  double height = static_cast<double>(rows) * cell_height;
  std::string body;
  for (std::size_t i = 0; i < chart.panels.size(); ++i) {
    const std::size_t column = i % columns, row = i / columns;
    const double x = static_cast<double>(column) * cell_width + left,
                 y = static_cast<double>(row) * cell_height + top;
    body += fmt::format("<g transform=\"translate({} {})\">{}</g>", px(x), px(y),
                        PanelDrawing(chart.panels[i], chart, fmt::format("{}-{}", id, i)).draw());
  }
  if (chart.legend) body += draw_legend(chart, width, height);
  return fmt::format(
      "<svg class=\"chart\" {}viewBox=\"0 0 {} {}\" role=\"img\" style=\"max-width:{}px\">{}{}</svg>",
      alone ? "xmlns=\"http://www.w3.org/2000/svg\" " : "", px(width), px(height), px(width),
      alone ? fmt::format("<style>{}</style><rect width=\"100%\" height=\"100%\" fill=\"var(--paper)\"/>",
                          chart_styles)
            : "",
      body);
}

std::string csv_of(const Chart& chart) {
  std::string out = "panel,curve,x,y,x_axis,y_axis\n";
  const auto row = [&](const Panel& panel, std::string_view curve, double x, double y) {
    out += csv_row(std::vector<std::string>{panel.title, std::string(curve), csv_number(x), csv_number(y),
                                            panel.x.title, panel.y.title});
  };
  for (const Panel& panel : chart.panels) {
    if (panel.map) {
      for (std::size_t i = 0; i < panel.map->stable.size(); ++i) {
        row(panel, panel.map->stable[i] ? "stable" : "unstable", panel.map->x[i % panel.map->x.size()],
            panel.map->y[i / panel.map->x.size()]);
      }
    }
    for (const Curve& curve : panel.curves) {
      for (const Point& p : curve.points) row(panel, curve.name, p.x, p.y);
    }
  }
  return out;
}

}  // namespace aspic::report
