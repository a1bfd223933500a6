#include "report/page.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/base64.h"
#include "report/csv.h"

namespace aspic::report {
namespace {

std::string raw(const Cell& cell) {
  return cell.number ? csv_number(*cell.number) : cell.text;
}

std::string shown(const Cell& cell, const Column& column) {
  if (cell.number) return rounded(*cell.number, column.digits);
  return cell.text.empty() ? "–" : cell.text;
}

std::string chart_file(const Figure& figure) {
  return fmt::format("figures/{}.svg", figure.id);
}
std::string picture_file(const Figure& figure, std::size_t row, std::size_t column) {
  return fmt::format("figures/{}-{}-{}.jpg", figure.id, row + 1, column + 1);
}
std::string chart_csv(const Figure& figure) {
  return fmt::format("data/{}.csv", figure.id);
}
std::string table_csv(const Figure& figure) {
  return fmt::format("data/{}{}.csv", figure.id, figure.chart ? "-table" : "");
}

std::vector<std::string> data_files(const Figure& figure) {
  std::vector<std::string> files;
  if (figure.chart) files.push_back(chart_csv(figure));
  if (figure.table) files.push_back(table_csv(figure));
  return files;
}

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
                 : fmt::format("<td{}>{}</td>", text == "–" ? " class=\"n\"" : "", text);
    }
    out += "</tr>";
  }
  return out + "</tbody></table></div>";
}

std::string html_of(const Strip& strip) {
  std::string out =
      fmt::format("<div class=\"scroll\"><div class=\"strip\" style=\"--columns:{}\">", strip.columns.size());
  out += "<span></span>";
  for (const std::string& column : strip.columns)
    out += fmt::format("<span class=\"head\">{}</span>", xml(column));
  for (const Strip::Row& row : strip.rows) {
    out += fmt::format("<span class=\"name\"><b>{}</b>{}</span>", xml(row.title), inline_html(row.note));
    for (std::size_t c = 0; c < strip.columns.size(); ++c) {
      out += c >= row.jpegs.size() || row.jpegs[c].empty()
                 ? "<span class=\"none\">diverged</span>"
                 : fmt::format("<img alt=\"{}, {}\" src=\"data:image/jpeg;base64,{}\">", xml(row.title),
                               xml(strip.columns[c]), base64(row.jpegs[c]));
    }
  }
  return out + "</div></div>";
}

std::string html_of(const Figure& figure, std::size_t number) {
  std::string out = fmt::format("<figure id=\"{}\">", figure.id);
  out += figure.chart && figure.chart->columns == 1 ? "<div class=\"pair\">" : "<div>";
  if (figure.chart) out += svg_of(*figure.chart, figure.id, false);
  if (figure.table) out += html_of(*figure.table);
  out += "</div>";
  if (figure.strip) out += html_of(*figure.strip);
  out += fmt::format("<figcaption><p><b>Figure {}.</b> {}</p>", number, inline_html(figure.caption));
  out += fmt::format("<p class=\"how\"><code>{}</code>", xml(figure.command));
  for (const std::string& file : data_files(figure)) out += fmt::format(" · <a href=\"{0}\">{0}</a>", file);
  return out + "</p></figcaption></figure>\n";
}

constexpr const char* styles = R"(
:root{--ink:#1d2126;--soft:#5b6068;--paper:#fff;--wash:#f5f6f7;--rule:#dfe2e6;--link:#0b5f9e;color-scheme:light dark}
@media screen and (prefers-color-scheme:dark){:root{--ink:#e6e7e9;--soft:#a3aab4;--paper:#15181c;--wash:#1e2227;--rule:#343a42;--link:#7cc0f5}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:17px/1.55 Charter,"Bitstream Charter","Iowan Old Style","Palatino Linotype","DejaVu Serif",Georgia,serif}
main,header,footer{max-width:1180px;margin:0 auto;padding:0 28px}
h1,h2,h3,nav,table,.how,.strip,footer{font-family:system-ui,-apple-system,"Segoe UI","DejaVu Sans",sans-serif}
header{padding-top:52px}h1{font-size:34px;line-height:1.15;letter-spacing:-.015em;margin:0 0 10px}
header p,section>p{max-width:46em}.by{font-size:20px;margin:0 0 18px}
h2{font-size:25px;letter-spacing:-.01em;margin:64px 0 12px;padding-top:14px;border-top:2px solid var(--ink)}
nav{font-size:14px;margin:22px 0;display:flex;flex-wrap:wrap;gap:6px 20px}
a{color:var(--link);text-decoration:none}a:hover{text-decoration:underline}
figure{margin:34px 0 44px}svg.chart{display:block;width:100%;height:auto}
figcaption{max-width:52em;font-size:15px;color:var(--ink)}figcaption p{margin:8px 0}
.how{font-size:12.5px;color:var(--soft);overflow-wrap:anywhere}
code{font:.92em ui-monospace,"SF Mono","DejaVu Sans Mono",monospace;background:var(--wash);border-radius:3px;padding:1px 4px}
.scroll{overflow-x:auto}table{border-collapse:collapse;font-size:14px;font-variant-numeric:tabular-nums;margin:4px 0}
th,td{padding:5px 0 5px 14px;text-align:left;vertical-align:bottom;border-bottom:1px solid var(--rule)}
th{font-weight:600;color:var(--soft);font-size:12.5px;border-bottom:1.5px solid var(--ink)}th:first-child,td:first-child{padding-left:0}th{max-width:9em}.n{text-align:right!important}.pair{display:flex;flex-wrap:wrap;gap:14px 34px;align-items:flex-start}.pair>svg.chart{flex:1 1 500px;width:auto;min-width:0}.scroll{margin-top:20px}
.strip{margin-top:18px;display:grid;grid-template-columns:150px repeat(var(--columns),minmax(110px,1fr));gap:5px;font-size:13px;align-items:center;min-width:760px}
.strip img{width:100%;display:block;border-radius:3px}.strip .head{color:var(--soft);text-align:center}
.strip .name{line-height:1.3}.strip .name b{display:block}.strip .none{color:var(--soft);text-align:center}
pre{background:var(--wash);padding:14px 16px;overflow-x:auto;font-size:13px;line-height:1.45;border-radius:4px}
footer{padding-bottom:60px}footer dl{display:grid;grid-template-columns:max-content 1fr;gap:5px 22px;font-size:14px}
dt{color:var(--soft)}dd{margin:0;overflow-wrap:anywhere}
@media print{body{font-size:10.5pt}header{padding-top:0}nav{display:none}main,header,footer{max-width:none;padding:0}
h2{break-after:avoid;margin-top:30px}figure,table{break-inside:avoid}.scroll{overflow:visible}.strip{min-width:0;grid-template-columns:90px repeat(var(--columns),1fr)}
a{color:inherit}pre{white-space:pre-wrap}@page{margin:16mm}}
)";

}  // namespace

std::string csv_of(const Table& table) {
  std::vector<std::string> fields;
  for (const Column& column : table.columns) fields.push_back(column.title);
  std::string out = csv_row(fields);
  for (const std::vector<Cell>& row : table.rows) {
    fields.clear();
    for (const Cell& cell : row) fields.push_back(raw(cell));
    out += csv_row(fields);
  }
  return out;
}

std::string html_of(const Page& page) {
  std::string out =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">";
  out += fmt::format("<title>{}</title><style>{}{}</style></head><body>\n<header><h1>{}</h1>",
                     xml(page.title), styles, chart_styles, xml(page.title));
  if (!page.author.empty()) out += fmt::format("<p class=\"by\">{}</p>", xml(page.author));
  out += fmt::format("<p>{}</p><nav>", inline_html(page.lead));
  for (const Section& section : page.sections)
    out += fmt::format("<a href=\"#{}\">{}</a>", section.id, xml(section.title));
  out += "<a href=\"#machine\">Machine and scene</a></nav></header><main>\n";
  std::size_t number = 0;
  for (const Section& section : page.sections) {
    out += fmt::format("<section id=\"{}\"><h2>{}</h2>\n", section.id, xml(section.title));
    for (const std::string& paragraph : section.paragraphs)
      out += fmt::format("<p>{}</p>\n", inline_html(paragraph));
    for (const Figure& figure : section.figures) out += html_of(figure, ++number);
    out += "</section>\n";
  }
  out += "</main>\n<footer id=\"machine\"><h2>Machine and scene</h2><dl>";
  for (const auto& [name, what] : page.colophon)
    out += fmt::format("<dt>{}</dt><dd>{}</dd>", xml(name), xml(what));
  return out + fmt::format("</dl><pre>{}</pre></footer></body></html>\n", xml(page.scene_toml));
}

/// Text that Markdown takes for nothing but text.
std::string plain_markdown(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool numbers_a_list = i > 0 && (c == '.' || c == ')') && text.find_first_not_of("0123456789") == i;
    const bool begins_a_list = i == 0 && (c == '-' || c == '+' || c == '=');
    if (numbers_a_list || begins_a_list ||
        std::string_view("\\`*_[]<>#|&~").find(c) != std::string_view::npos)
      out += '\\';
    out += c;
  }
  return out;
}

std::string markdown_of(const Page& page) {
  std::string out = fmt::format("# {}\n\n", page.title);
  if (!page.author.empty()) out += fmt::format("{}\n\n", plain_markdown(page.author));
  out += page.lead + "\n";
  std::size_t number = 0;
  for (const Section& section : page.sections) {
    out += fmt::format("\n## {}\n", section.title);
    for (const std::string& paragraph : section.paragraphs) out += fmt::format("\n{}\n", paragraph);
    for (const Figure& figure : section.figures) {
      out += "\n";
      if (figure.chart) out += fmt::format("![Figure {}]({})\n\n", number + 1, chart_file(figure));
      const auto rows = [&](const auto& columns, const auto& title, const auto& each) {
        std::string line;
        for (const auto& column : columns) {
          out += fmt::format("| {} ", title(column));
          line += "|---";
        }
        out += fmt::format("|\n{}|\n", line);
        each();
        out += "\n";
      };
      if (const auto& table = figure.table) {
        rows(
            table->columns, [](const Column& c) { return c.title; },
            [&] {
              for (const auto& row : table->rows) {
                for (std::size_t c = 0; c < row.size(); ++c)
                  out += fmt::format("| {} ", shown(row[c], table->columns[c]));
                out += "|\n";
              }
            });
      }
      if (const auto& strip = figure.strip) {
        std::vector<std::string> columns = {" "};
        columns.insert(columns.end(), strip->columns.begin(), strip->columns.end());
        rows(
            columns, [](const std::string& c) { return c; },
            [&] {
              for (std::size_t r = 0; r < strip->rows.size(); ++r) {
                const Strip::Row& row = strip->rows[r];
                out += fmt::format("| {} {} ", row.title, row.note);
                for (std::size_t c = 0; c < strip->columns.size(); ++c)
                  out += c < row.jpegs.size() && !row.jpegs[c].empty()
                             ? fmt::format("| ![]({}) ", picture_file(figure, r, c))
                             : "| diverged ";
                out += "|\n";
              }
            });
      }
      out += fmt::format("**Figure {}.** {}\n\n    {}\n", ++number, figure.caption, figure.command);
      for (const std::string& file : data_files(figure)) out += fmt::format("\n[{0}]({0})\n", file);
    }
  }
  out += "\n## Machine and scene\n\n| | |\n|---|---|\n";
  for (const auto& [name, what] : page.colophon) out += fmt::format("| {} | {} |\n", name, what);
  return out + fmt::format("\n```toml\n{}```\n", page.scene_toml);
}

std::map<std::string, std::string> files_of(const Page& page) {
  std::map<std::string, std::string> files;
  for (const Section& section : page.sections) {
    for (const Figure& figure : section.figures) {
      if (figure.chart) {
        files[chart_file(figure)] = svg_of(*figure.chart, figure.id, true);
        files[chart_csv(figure)] = csv_of(*figure.chart);
      }
      if (figure.table) files[table_csv(figure)] = csv_of(*figure.table);
      if (!figure.strip) continue;
      for (std::size_t r = 0; r < figure.strip->rows.size(); ++r) {
        const auto& jpegs = figure.strip->rows[r].jpegs;
        for (std::size_t c = 0; c < jpegs.size(); ++c)
          if (!jpegs[c].empty()) files[picture_file(figure, r, c)] = jpegs[c];
      }
    }
  }
  return files;
}

}  // namespace aspic::report
