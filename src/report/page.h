#pragma once
// The report as plain data, and its forms: one HTML file, Markdown with separate images, CSV.
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/chart.h"

namespace aspic::report {

/// A cell of a table: text, a number, or nothing, which is shown as a dash.
struct Cell {
  Cell() = default;
  Cell(std::string words) : text(std::move(words)) {}
  Cell(const char* words) : text(words) {}
  Cell(double value) : number(value) {}
  Cell(std::optional<double> value) : number(value) {}

  std::string text;
  std::optional<double> number;  ///< finite
};

struct Column {
  std::string title;  ///< with its unit
  int digits = 4;     ///< shown; the CSV has all
};

struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
};

/// Images in rows.
struct Strip {
  std::vector<std::string> columns;  ///< "t = 1.5 s"
  struct Row {
    std::string title, note;
    std::vector<std::string> jpegs;  ///< as many as columns; empty: there is none
  };
  std::vector<Row> rows;
};

/// A numbered figure. Its id names its files.
struct Figure {
  std::string id, caption;
  std::string command;  ///< that measures it again; empty: nothing in it is measured,
                        ///< and its table has no CSV
  std::optional<Chart> chart = {};
  std::optional<Table> table = {};
  std::optional<Strip> strip = {};
  std::string gap = {};  ///< what the reader is asked to write below it; empty: nothing
};

struct Section {
  std::string id, title;
  std::vector<std::string> paragraphs;
  std::vector<Figure> figures;
  std::vector<std::string> gaps = {};  ///< what the reader is asked to write after the figures
  bool part = false;                   ///< of the section before it
};

struct Page {
  std::string title, lead;
  std::string author;  ///< below the title; empty: nobody is named
  std::vector<Section> sections;
  /// Machine, driver, version, scene: names and what they are.
  std::vector<std::pair<std::string, std::string>> colophon;
  std::string scene_toml;
  bool scene_in_file = false;  ///< its text is `data/scene.toml`, not at the page's end
};

/// The page as one file without any link to another place but its own CSV files.
std::string html_of(const Page& page);
/// The same in Markdown; charts and images are the files of files_of().
std::string markdown_of(const Page& page);
/// The CSV of a table.
std::string csv_of(const Table& table);

/// A cell's text: with all its digits, and as shown in a column.
std::string raw(const Cell& cell);
std::string shown(const Cell& cell, const Column& column);
/// The CSV files of a figure, by their paths in the report's directory.
std::vector<std::string> data_files(const Figure& figure);

/// Every file besides the two pages: path in the report's directory, content.
std::map<std::string, std::string> files_of(const Page& page);

}  // namespace aspic::report
