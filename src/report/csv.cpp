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

}  // namespace aspic::report
