#include "report/pdf.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <string_view>
#include <vector>

#include "io/child_process.h"

namespace aspic::report {
namespace {

namespace fs = std::filesystem;

/// A program that prints a page as PDF, and its words for `html` and `pdf`.
struct Converter {
  const char* program;
  std::vector<std::string> (*words)(const std::string& html, const std::string& pdf);
};
std::vector<std::string> chromium_words(const std::string& html, const std::string& pdf) {
  std::vector<std::string> words = {"--headless", "--disable-gpu", "--no-pdf-header-footer",
                                    "--print-to-pdf=" + pdf};
  if (::geteuid() == 0) words.emplace_back("--no-sandbox");  // it refuses to start for root otherwise
  words.push_back("file://" + html);
  return words;
}
constexpr Converter converters[] = {
    {"chromium", chromium_words},
    {"chromium-browser", chromium_words},
    {"google-chrome", chromium_words},
    {"weasyprint",
     [](const std::string& html, const std::string& pdf) {
       return std::vector<std::string>{html, pdf};
     }},
    {"wkhtmltopdf",
     [](const std::string& html, const std::string& pdf) {
       return std::vector<std::string>{"--print-media-type", "--enable-local-file-access", html, pdf};
     }},
};

}  // namespace

std::string print_pdf(const std::string& html_file, const std::string& pdf_file) {
  std::error_code failed;
  const std::string html = fs::absolute(html_file, failed).string(),
                    pdf = fs::absolute(pdf_file, failed).string();
  std::string reason;
  for (const Converter& converter : converters) {
    std::vector<std::string> words = {converter.program};
    for (std::string& word : converter.words(html, pdf)) words.push_back(std::move(word));
    auto child = ChildProcess::start(words);
    if (!child) continue;
    if (child->finish().ok() && fs::exists(pdf, failed)) return "";
    reason = fmt::format("{} did not make one.", converter.program);
  }
  return reason.empty() ? "install chromium, weasyprint or wkhtmltopdf." : reason;
}

std::optional<std::size_t> pages_of_pdf(std::string_view bytes) {
  // A page is an object with `/Type /Page`; white space between them is free.
  std::size_t pages = 0;
  for (std::size_t at = bytes.find("/Type"); at != std::string_view::npos; at = bytes.find("/Type", at)) {
    at = bytes.find_first_not_of(" \t\r\n", at + 5);
    if (at == std::string_view::npos) break;
    const std::string_view rest = bytes.substr(at);
    constexpr std::string_view page = "/Page", delimiters = " \t\r\n/<>[]()%";
    if (!rest.starts_with(page)) continue;
    if (rest.size() == page.size() || delimiters.find(rest[page.size()]) != std::string_view::npos) ++pages;
  }
  return pages > 0 ? std::optional(pages) : std::nullopt;
}

}  // namespace aspic::report
