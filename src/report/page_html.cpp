// The report as one HTML file, for screens and for paper.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "base/base64.h"
#include "base/embedded_file.h"
#include "report/page.h"

namespace aspic {
std::span<const EmbeddedFile> report_files();  // cmake/EmbedFiles.cmake
}

namespace aspic::report {
namespace {

/// On paper: widths of a chart with text at its side, and of all that a line holds [px], as in report.css.
constexpr double half_width = 312.0, full_width = 680.0;
/// What has more columns does not fit next to a chart.
constexpr std::size_t most_columns = 5;
/// What has more rows may be divided between two pages.
constexpr std::size_t most_rows = 10, most_image_rows = 3;

/// Text with `code` in backquotes.
std::string inline_html(const std::string& text) {
  std::string out;
  bool code = false;
  for (const char c : xml(text)) {
    if (c == '`') {
      out += code ? "</code>" : "<code>";
      code = !code;
    } else {
      out += c;
    }
  }
  return out;
}

std::string html_of(const Table& table) {
  std::string out = "<div class=\"scroll\"><table><thead><tr>";
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const bool numbers =
        std::ranges::any_of(table.rows, [c](const auto& row) { return row[c].number.has_value(); });
    out += fmt::format("<th{}>{}</th>", numbers ? " class=\"n\"" : "", xml(table.columns[c].title));
  }
  out += "</tr></thead><tbody>";
  for (const std::vector<Cell>& row : table.rows) {
    out += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string text = xml(shown(row[c], table.columns[c]));
      out += row[c].number
                 ? fmt::format("<td class=\"n\"><data value=\"{}\">{}</data></td>", raw(row[c]), text)
                 : fmt::format("<td{}>{}</td>", text == "–" ? " class=\"n\"" : "",
                               inline_html(shown(row[c], table.columns[c])));
    }
    out += "</tr>";
  }
  return out + "</tbody></table></div>";
}

/// A table, so that a browser repeats its head where it goes on to another page of paper.
std::string html_of(const Strip& strip) {
  std::string out = "<div class=\"scroll\"><table class=\"strip\"><thead><tr><th></th>";
  for (const std::string& column : strip.columns) out += fmt::format("<th>{}</th>", xml(column));
  out += "</tr></thead><tbody>";
  for (const Strip::Row& row : strip.rows) {
    out += fmt::format("<tr><th><b>{}</b> {}</th>", xml(row.title), inline_html(row.note));
    for (std::size_t c = 0; c < strip.columns.size(); ++c) {
      out += c >= row.jpegs.size() || row.jpegs[c].empty()
                 ? "<td>diverged</td>"
                 : fmt::format("<td><img alt=\"{}, {}\" src=\"data:image/jpeg;base64,{}\"></td>",
                               xml(row.title), xml(strip.columns[c]), base64(row.jpegs[c]));
    }
    out += "</tr>";
  }
  return out + "</tbody></table></div>";
}

std::string gap_html(const std::string& asks) {
  // The question follows what it asks for, so that the style can hide it once that is written.
  return fmt::format(
      "<div class=\"gap\"><div contenteditable=\"true\" role=\"textbox\" aria-label=\"Your words\"></div>"
      "<p><b>Your words.</b> {}</p></div>\n",
      inline_html(asks));
}

std::string html_of(const Figure& figure, std::size_t number) {
  const bool narrow_table = !figure.table || figure.table->columns.size() <= most_columns;
  const bool half = figure.chart && figure.chart->columns == 1 && narrow_table;
  const bool divisible = (figure.table && figure.table->rows.size() > most_rows) ||
                         (figure.strip && figure.strip->rows.size() > most_image_rows);
  const bool beside = half || (!figure.chart && !figure.command.empty());
  std::string out = fmt::format("<figure id=\"{}\" class=\"{}{}\">", figure.id,
                                beside         ? "half"
                                : figure.chart ? "full"
                                               : "plain",
                                divisible ? " divisible" : "");
  out += figure.chart && figure.chart->columns == 1 ? "<div class=\"pair\">" : "<div>";
  if (figure.chart) {
    out += svg_of(*figure.chart, figure.id, Medium::screen);
    out += svg_of(*figure.chart, figure.id, Medium::paper, half ? half_width : full_width);
  }
  if (figure.table) out += html_of(*figure.table);
  out += "</div>";
  if (figure.strip) out += html_of(*figure.strip);
  out += fmt::format("<figcaption><p><b>Figure {}.</b> {}</p>", number, inline_html(figure.caption));
  if (!figure.command.empty()) {
    out += fmt::format("<p class=\"how\"><code>{}</code>", xml(figure.command));
    for (const std::string& file : data_files(figure)) out += fmt::format(" · <a href=\"{0}\">{0}</a>", file);
    out += "</p>";
  }
  out += "</figcaption></figure>\n";
  if (!figure.gap.empty()) out += gap_html(figure.gap);
  return out;
}

}  // namespace

std::string html_of(const Page& page) {
  std::string out =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">";
  out +=
      fmt::format("<title>{}</title><style>{}{}</style></head><body>\n<header><h1>{}</h1>", xml(page.title),
                  chart_styles(), find_embedded(report_files(), "report.css").value(), xml(page.title));
  if (!page.author.empty()) out += fmt::format("<p class=\"by\">{}</p>", xml(page.author));
  out += fmt::format("<p>{}</p><nav>", inline_html(page.lead));
  for (const Section& section : page.sections)
    out += fmt::format("<a href=\"#{}\">{}</a>", section.id, xml(section.title));
  out += "<a href=\"#machine\">Machine and scene</a></nav></header><main>\n";
  std::size_t number = 0;
  for (const Section& section : page.sections) {
    out += fmt::format("<section id=\"{0}\"><{1}>{2}</{1}>\n", section.id, section.part ? "h3" : "h2",
                       xml(section.title));
    for (const std::string& paragraph : section.paragraphs)
      out += fmt::format("<p>{}</p>\n", inline_html(paragraph));
    for (const Figure& figure : section.figures) out += html_of(figure, ++number);
    for (const std::string& gap : section.gaps) out += gap_html(gap);
    out += "</section>\n";
  }
  out += "</main>\n<footer id=\"machine\"><h2>Machine and scene</h2><dl>";
  for (const auto& [name, what] : page.colophon)
    out += fmt::format("<dt>{}</dt><dd>{}</dd>", xml(name), xml(what));
  out += "</dl>";
  if (!page.scene_in_file) out += fmt::format("<pre>{}</pre>", xml(page.scene_toml));
  return out + "</footer></body></html>\n";
}

}  // namespace aspic::report
