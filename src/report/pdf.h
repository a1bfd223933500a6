#pragma once
// The report on paper.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace aspic::report {

/// Prints a page of this machine as PDF, by the first of chromium, weasyprint and wkhtmltopdf that can.
/// Empty: the PDF is there; otherwise why it is not.
std::string print_pdf(const std::string& html_file, const std::string& pdf_file);

/// How many pages a PDF has. Absent: its page objects are in compressed streams, which are not read here, or
/// it has none.
std::optional<std::size_t> pages_of_pdf(std::string_view bytes);

}  // namespace aspic::report
