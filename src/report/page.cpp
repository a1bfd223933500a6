#include "report/page.h"

#include <fmt/format.h>

#include "report/csv.h"

namespace aspic::report {
namespace {

std::string chart_file(const Figure& figure) {
  return fmt::format("figures/{}.svg", figure.id);
}
std::string image_file(const Figure& figure, std::size_t row, std::size_t column) {
  return fmt::format("figures/{}-{}-{}.jpg", figure.id, row + 1, column + 1);
}
std::string chart_csv(const Figure& figure) {
  return fmt::format("data/{}.csv", figure.id);
}
std::string table_csv(const Figure& figure) {
  return fmt::format("data/{}{}.csv", figure.id, figure.chart ? "-table" : "");
}

}  // namespace

std::string raw(const Cell& cell) {
  return cell.number ? csv_number(*cell.number) : cell.text;
}

std::string shown(const Cell& cell, const Column& column) {
  if (cell.number) return rounded(*cell.number, column.digits);
  return cell.text.empty() ? "–" : cell.text;
}

std::vector<std::string> data_files(const Figure& figure) {
  std::vector<std::string> files;
  if (figure.command.empty()) return files;
  if (figure.chart) files.push_back(chart_csv(figure));
  if (figure.table) files.push_back(table_csv(figure));
  return files;
}

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

namespace {

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

}  // namespace

std::string markdown_of(const Page& page) {
  std::string out = fmt::format("# {}\n\n", page.title);
  if (!page.author.empty()) out += fmt::format("{}\n\n", plain_markdown(page.author));
  out += page.lead + "\n";
  std::size_t number = 0;
  for (const Section& section : page.sections) {
    out += fmt::format("\n{} {}\n", section.part ? "###" : "##", section.title);
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
                             ? fmt::format("| ![]({}) ", image_file(figure, r, c))
                             : "| diverged ";
                out += "|\n";
              }
            });
      }
      out += fmt::format("**Figure {}.** {}\n", ++number, figure.caption);
      if (!figure.command.empty()) out += fmt::format("\n    {}\n", figure.command);
      for (const std::string& file : data_files(figure)) out += fmt::format("\n[{0}]({0})\n", file);
      if (!figure.gap.empty()) out += fmt::format("\n> **Your words.** {}\n", figure.gap);
    }
    for (const std::string& gap : section.gaps) out += fmt::format("\n> **Your words.** {}\n", gap);
  }
  out += "\n## Machine and scene\n\n| | |\n|---|---|\n";
  for (const auto& [name, what] : page.colophon) out += fmt::format("| {} | {} |\n", name, what);
  return page.scene_in_file ? out : out + fmt::format("\n```toml\n{}```\n", page.scene_toml);
}

std::map<std::string, std::string> files_of(const Page& page) {
  std::map<std::string, std::string> files;
  if (page.scene_in_file) files["data/scene.toml"] = page.scene_toml;
  for (const Section& section : page.sections) {
    for (const Figure& figure : section.figures) {
      if (figure.chart) {
        files[chart_file(figure)] = svg_of(*figure.chart, figure.id, Medium::file);
        files[chart_csv(figure)] = csv_of(*figure.chart);
      }
      if (figure.table && !figure.command.empty()) files[table_csv(figure)] = csv_of(*figure.table);
      if (!figure.strip) continue;
      for (std::size_t r = 0; r < figure.strip->rows.size(); ++r) {
        const auto& jpegs = figure.strip->rows[r].jpegs;
        for (std::size_t c = 0; c < jpegs.size(); ++c)
          if (!jpegs[c].empty()) files[image_file(figure, r, c)] = jpegs[c];
      }
    }
  }
  return files;
}

}  // namespace aspic::report
