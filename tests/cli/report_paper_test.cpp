// The report and its outline on paper: pages counted, how full they are, letters that can be read.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>

#include "cli/process.h"
#include "cli/report_fixture.h"

namespace aspic {
namespace {

using test::aspic;
using test::content;
using test::Report;
using testing::HasSubstr;
using testing::Not;

/// A program of the package poppler-utils, or the browser.
test::Finished tool(const char* program, const std::vector<std::string>& words) {
  test::ProcessOptions options;
  options.program = program;
  return aspic(words, options);
}

struct Word {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;  ///< [pt], y downwards
  std::string text;
};

struct Paper {
  double filled = 0.0;  ///< share of the page's height down to its last ink
  std::vector<Word> words;
};

/// Share of an image's height above its last row with ink (PGM, binary).
double filled(const std::string& image) {
  const std::string bytes = content(image);
  std::istringstream header(bytes);
  std::string kind;
  std::size_t width = 0, height = 0, most = 0;
  header >> kind >> width >> height >> most;
  EXPECT_EQ(kind, "P5") << image;
  const std::size_t first = bytes.size() - width * height;
  std::size_t last = 0;
  for (std::size_t i = 0; i < width * height; ++i)
    if (static_cast<unsigned char>(bytes[first + i]) < 200) last = i / width;
  return static_cast<double>(last + 1) / static_cast<double>(height);
}

/// The pages of a PDF as poppler draws and reads them.
std::vector<Paper> pages_of(const std::string& pdf) {
  const test::TemporaryDirectory directory;
  const auto drawn = tool(ASPIC_PDFTOPPM, {"-r", "50", "-gray", pdf, directory.file("p")});
  EXPECT_EQ(drawn.exit_code, 0) << "poppler-utils is needed: " << drawn.err;
  std::vector<std::string> images;
  for (const auto& file : std::filesystem::directory_iterator(directory.file("")))
    if (file.path().extension() == ".pgm") images.push_back(file.path().string());
  std::ranges::sort(images);  // pdftoppm fills page numbers with zeros
  std::vector<Paper> pages;
  for (const std::string& image : images) pages.push_back({filled(image), {}});
  const auto read = tool(ASPIC_PDFTOTEXT, {"-bbox", pdf, "-"});
  EXPECT_EQ(read.exit_code, 0) << read.err;
  const std::regex word(
      R"re(<word xMin="([^"]*)" yMin="([^"]*)" xMax="([^"]*)" yMax="([^"]*)">([^<]*)</word>)re");
  std::size_t page = 0;
  for (const std::string& line : test::lines(read.out)) {
    if (line.find("<page ") != std::string::npos) ++page;
    if (std::smatch m; std::regex_search(line, m, word) && page >= 1 && page <= pages.size())
      pages[page - 1].words.push_back(
          {std::stod(m[1]), std::stod(m[2]), std::stod(m[3]), std::stod(m[4]), m[5]});
  }
  EXPECT_EQ(page, pages.size());
  return pages;
}

/// What a reader of paper expects of every page.
void expect_readable(const std::vector<Paper>& pages, const std::string& html) {
  std::vector<std::string> headings;  // their first words
  const std::regex heading(R"(<h[23]>(\S+) ?[^<]*</h[23]>)");
  for (auto at = std::sregex_iterator(html.begin(), html.end(), heading); at != std::sregex_iterator(); ++at)
    headings.push_back((*at)[1]);
  ASSERT_GE(headings.size(), 5u);
  for (std::size_t p = 0; p < pages.size(); ++p) {
    SCOPED_TRACE(fmt::format("page {}", p + 1));
    const Paper& page = pages[p];
    ASSERT_FALSE(page.words.empty());
    const bool last = p + 1 == pages.size();
    EXPECT_TRUE(last || page.filled >= 2.0 / 3) << page.filled;
    double bottom = 0.0, top = 1e9, left = 1e9;
    for (const Word& w : page.words) {
      bottom = std::max(bottom, w.y1);
      top = std::min(top, w.y0);
      left = std::min(left, w.x0);
    }
    for (const Word& w : page.words) {
      // Letters of 6.5 pt, those of commands, are 7.5 pt from top to bottom; words up a page are narrow.
      const double letters = std::min(w.x1 - w.x0, w.y1 - w.y0);
      const bool word = w.text.size() >= 4 &&
                        std::ranges::all_of(w.text, [](unsigned char c) { return std::isalpha(c) != 0; });
      EXPECT_TRUE(!word || letters >= 7.0) << w.text << ": " << letters;
      const bool heading = w.y1 - w.y0 > 12.0 && std::ranges::find(headings, w.text) != headings.end();
      EXPECT_FALSE(heading && w.y1 > bottom - 4.0) << w.text << " is alone at the foot";
      const bool caption = w.text == "Figure" && w.x0 < left + 36.0;
      EXPECT_FALSE(caption && w.y0 < top + 4.0) << "a caption without its figure";
    }
  }
}

TEST_F(Report, OnPaperIsShortAndItsPagesAreFull) {
  const auto pages = pages_of(path("report.pdf"));
  EXPECT_THAT(finished->out, HasSubstr(fmt::format("report.pdf, {} pages\n", pages.size())));
  EXPECT_LE(pages.size(), 16u);
  EXPECT_GE(pages.size(), 5u);
  expect_readable(pages, read("report.html"));
}

TEST_F(Report, TheCoursesOutlineTakesAtMostTenPages) {
  const auto made = aspic({"report", "cube-plane", "--set", "cube[0].particles-per-edge=4", "--set",
                           "author=309553010", "--outline", "course", "--out", directory->file("o")});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto pages = pages_of(directory->file("o/report.pdf"));
  EXPECT_THAT(made.out, HasSubstr(fmt::format("report.pdf, {} pages of at most 10\n", pages.size())));
  EXPECT_LE(pages.size(), 10u);
  EXPECT_THAT(made.err, Not(HasSubstr("warning")));
  const std::string html = content(directory->file("o/report.html")),
                    markdown = content(directory->file("o/report.md"));
  expect_readable(pages, html);
  // Its chapters in order, figures in each that has any, gaps in all.
  std::size_t at = 0;
  for (const char* words : {"309553010",
                            "1 Introduction",
                            "id=\"scene\"",
                            "Your words",
                            "2 Fundamentals",
                            "id=\"springs\"",
                            "id=\"formulas\"",
                            "Your words",
                            "3 Implementation",
                            "id=\"functions\"",
                            "Your words",
                            "4 Results and discussion",
                            "4.1 The difference between integrators",
                            "id=\"order\"",
                            "id=\"largest-step\"",
                            "id=\"energy-free\"",
                            "id=\"drop\"",
                            "Your words",
                            "4.2 Effect of parameters",
                            "id=\"parameter-k\"",
                            "Your words",
                            "id=\"parameter-mu-images\"",
                            "Your words",
                            "5 Conclusion",
                            "Your words"}) {
    at = html.find(words, at);
    ASSERT_NE(at, std::string::npos) << words;
  }
  EXPECT_THAT(markdown, HasSubstr("### 4.1 The difference between integrators"));
  EXPECT_THAT(markdown, HasSubstr("> **Your words.** Summarize your results"));
  EXPECT_THAT(content(directory->file("o/data/scene.toml")), HasSubstr("author = \"309553010\""));
  // Words in a gap take the place of its question.
  const std::string gap = "aria-label=\"Your words\"></div>", question = "Name the subject";
  std::string written = html;
  written.replace(written.find(gap), gap.size(), "aria-label=\"Your words\">A jelly falls.</div>");
  std::ofstream(directory->file("o/written.html")) << written;
  const auto printed =
      tool(ASPIC_CHROMIUM, {"--headless", "--no-sandbox", "--disable-gpu", "--no-pdf-header-footer",
                            fmt::format("--user-data-dir={}", directory->file("profile")),
                            "--print-to-pdf=" + directory->file("o/written.pdf"),
                            "file://" + directory->file("o/written.html")});
  ASSERT_EQ(printed.exit_code, 0) << printed.err;
  EXPECT_THAT(tool(ASPIC_PDFTOTEXT, {directory->file("o/report.pdf"), "-"}).out, HasSubstr(question));
  const std::string text = tool(ASPIC_PDFTOTEXT, {directory->file("o/written.pdf"), "-"}).out;
  EXPECT_THAT(text, HasSubstr("A jelly falls."));
  EXPECT_THAT(text, Not(HasSubstr(question)));
}

}  // namespace
}  // namespace aspic
