#include "report/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aspic::report {

std::string csv_number(double value) {
  if (!std::isfinite(value)) return "";
  return value == 0.0 ? "0" : fmt::format("{}", value);
}

std::string csv_field(std::string_view text) {
  std::string field(text);
  std::ranges::replace_if(
      field, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  if (field.find_first_of(",\"") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) {
    if (c == '"') quoted += c;
    quoted += c;
  }
  return quoted + "\"";
}

std::string csv_row(std::span<const std::string> fields) {
  std::string row;
  for (const std::string& field : fields) {
    if (&field != fields.data()) row += ',';
    row += csv_field(field);
  }
  return row + "\n";
}

std::vector<std::string> csv_fields(std::string_view row) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t at = 0; at < row.size() && (quoted || row[at] != '\n'); ++at) {
    const char c = row[at];
    if (c == '"' && quoted && at + 1 < row.size() && row[at + 1] == '"') {
      fields.back() += row[++at];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

}  // namespace aspic::report
