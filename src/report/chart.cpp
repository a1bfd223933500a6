#include "report/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string_view>

#include "base/embedded_file.h"
#include "base/printable.h"
#include "report/chart_panel.h"
#include "report/csv.h"

namespace aspic {
std::span<const EmbeddedFile> report_files();  // cmake/EmbedFiles.cmake
}

namespace aspic::report {

namespace {

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
std::string draw_legend(const Chart& chart, const Frame& frame, double width, double& height) {
  std::string out;
  double x = frame.left, y = height + 0.4 * frame.legend_row;
  const auto place = [&](std::string_view name, const auto& sample) {
    const double needed = 52 + frame.letter * static_cast<double>(character_count(name));
    if (x + needed > width && x > frame.left) {
      x = frame.left;
      y += frame.legend_row;
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
  height = y + frame.legend_row - 4;
  return out;
}

/// Whether all panels have one axis.
bool one_axis(const Chart& chart, ChartAxis Panel::*axis) {
  return std::ranges::all_of(chart.panels, [&](const Panel& panel) {
    const ChartAxis &one = chart.panels[0].*axis, &other = panel.*axis;
    return other.from && other.to && other.title == one.title && other.scale == one.scale &&
           other.from == one.from && other.to == one.to;
  });
}

/// Of a panel's data on paper [px], so that a figure takes less than a third of a page.
double paper_height(std::size_t columns, std::size_t rows) {
  return columns == 1 ? 122.0 : rows > 1 ? 70.0 : columns > 2 ? 88.0 : 130.0;
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

std::string_view chart_styles() {
  return find_embedded(report_files(), "chart.css").value();
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

std::string svg_of(const Chart& chart, const std::string& id, Medium medium, double paper_width) {
  const std::size_t columns = std::max<std::size_t>(1, std::min(chart.columns, chart.panels.size()));
  const std::size_t rows = (chart.panels.size() + columns - 1) / columns;
  const bool paper = medium == Medium::paper;
  const Frame& frame = paper ? paper_frame : screen_frame;
  const bool share_x = paper && rows > 1 && one_axis(chart, &Panel::x),
             share_y = paper && columns > 1 && one_axis(chart, &Panel::y);
  const auto inner = static_cast<double>(columns - 1);
  const double inner_left = share_y ? frame.inner_left : frame.left,
               inner_bottom = share_x ? frame.inner_bottom : frame.bottom,
               around = frame.left + frame.right + inner * (inner_left + frame.right);
  PanelPlace place;
  place.tooltips = !paper;
  place.width = paper ? (paper_width - around) / static_cast<double>(columns) : chart.panel_width;
  place.height = paper ? paper_height(columns, rows) : chart.panel_height;
  const double width = around + static_cast<double>(columns) * place.width;
  const std::string kind = paper ? " paper" : medium == Medium::screen ? " screen" : "";
  std::string body;
  double x = 0.0, y = 0.0;
  for (std::size_t i = 0; i < chart.panels.size(); ++i) {
    const bool first = i % columns == 0, last_row = i / columns + 1 == rows;
    place.x_labels = !share_x || last_row || i + columns >= chart.panels.size();
    place.y_labels = !share_y || first;
    x += first ? frame.left : inner_left;
    body += fmt::format(
        "<g transform=\"translate({} {})\">{}</g>", px(x), px(y + frame.top),
        svg_of(chart.panels[i], frame, place, fmt::format("{}{}-{}", id, paper ? "-paper" : "", i)));
    x += place.width + frame.right;
    if (i % columns + 1 < columns && i + 1 < chart.panels.size()) continue;
    x = 0.0;
    y += frame.top + place.height + (last_row ? frame.bottom : inner_bottom);
  }
  if (chart.legend) body += draw_legend(chart, frame, width, y);
  return fmt::format(
      "<svg class=\"chart{}\" {}viewBox=\"0 0 {} {}\" role=\"img\" style=\"max-width:{}px\">{}{}</svg>", kind,
      medium == Medium::file ? "xmlns=\"http://www.w3.org/2000/svg\" " : "", px(width), px(y), px(width),
      medium == Medium::file
          ? fmt::format("<style>{}</style><rect width=\"100%\" height=\"100%\" fill=\"var(--paper)\"/>",
                        chart_styles())
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
