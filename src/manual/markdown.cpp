#include <algorithm>
#include <optional>
#include <regex>

#include "manual/manual.h"

namespace aspic::manual {
namespace {

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.emplace_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

/// `code` is bold, *emphasis* italic, [text](address) its text.
std::string inline_roff(const std::string& markdown) {
  static const std::regex link(R"(\[([^\]]+)\]\([^)]*\))"), marks(R"(`([^`]+)`|\*([^*]+)\*)");
  const std::string text = std::regex_replace(markdown, link, "$1");
  std::string roff;
  std::size_t at = 0;
  for (std::sregex_iterator mark(text.begin(), text.end(), marks), end; mark != end; ++mark) {
    const bool code = (*mark)[1].matched;
    roff += roff_text(text.substr(at, static_cast<std::size_t>(mark->position()) - at));
    roff += (code ? "\\fB" : "\\fI") + roff_text(code ? mark->str(1) : mark->str(2)) + "\\fR";
    at = static_cast<std::size_t>(mark->position() + mark->length());
  }
  return roff + roff_text(text.substr(at));
}

/// A row of a table with two columns: "| a | b |". A bar within a cell is written \|.
std::optional<std::pair<std::string, std::string>> row_of(const std::string& line) {
  static const std::regex row(R"(^\| ((?:[^|\\]|\\.)*) \| ((?:[^|\\]|\\.)*) \|$)"), bar(R"(\\\|)");
  std::smatch cells;
  if (!std::regex_match(line, cells, row)) return std::nullopt;
  return std::pair(std::regex_replace(cells.str(1), bar, "|"), std::regex_replace(cells.str(2), bar, "|"));
}

}  // namespace

Sections sections_of(std::string_view markdown) {
  Sections sections;
  std::string name;
  for (const std::string& line : lines_of(markdown)) {
    if (line.starts_with("## ")) {
      name = line.substr(3);
      std::erase(name, '`');
    } else if (!line.starts_with("# "))
      sections[name].push_back(line);
  }
  return sections;
}

std::string roff_text(std::string_view text) {
  std::string roff;
  for (const char c : text) {
    // A line that begins with a dot or an apostrophe is a request. A bare hyphen may be shown as a dash.
    if ((c == '.' || c == '\'') && (roff.empty() || roff.back() == '\n')) roff += "\\&";
    if (c == '\\')
      roff += "\\e";
    else if (c == '-')
      roff += "\\-";
    else if (c == '\'')
      roff += "\\(aq";
    else if (c == '^')
      roff += "\\(ha";
    else if (c == '~')
      roff += "\\(ti";
    else if (c == '`')
      roff += "\\(ga";
    else
      roff += c;
  }
  return roff;
}

std::string roff_of(const std::vector<std::string>& markdown) {
  std::string roff;
  bool code = false, in_paragraph = false, options = false;
  for (const std::string& line : markdown) {
    if (line.starts_with("```")) {
      code = !code;
      roff += code ? ".PP\n.EX\n" : ".EE\n";
    } else if (code) {
      roff += roff_text(line) + "\n";
    } else if (line.starts_with("### ")) {
      roff += ".SS " + inline_roff(line.substr(4)) + "\n";
      in_paragraph = true;  // a heading begins one
    } else if (line.starts_with("|---")) {
      continue;
    } else if (const auto row = row_of(line)) {
      const bool heading =
          row->first == "option" || row->first == "code" || row->first == "variable" || row->first == "file";
      options = heading ? row->first == "option" : options;
      if (!heading && !options)
        roff += ".TP\n" + inline_roff(row->first) + "\n" + inline_roff(row->second) + "\n";
      in_paragraph = false;
    } else if (line.empty()) {
      in_paragraph = false;
    } else {
      if (!in_paragraph) roff += ".PP\n";
      in_paragraph = true;
      roff += inline_roff(line) + "\n";
    }
  }
  return roff;
}

}  // namespace aspic::manual
