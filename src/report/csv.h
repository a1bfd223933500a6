#pragma once
// Rows of CSV files (RFC 4180).
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aspic::report {

/// A number as it is written everywhere: the shortest text that reads back as the same bits; empty if it is
/// not finite.
std::string csv_number(double value);
/// A field, in quotation marks where it needs them; line ends become spaces.
std::string csv_field(std::string_view text);
/// The fields of a row that csv_row() made.
std::vector<std::string> csv_fields(std::string_view row);
/// The fields with commas between and a line end.
std::string csv_row(std::span<const std::string> fields);

}  // namespace aspic::report
