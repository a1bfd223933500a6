#include "report/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/base64.h"
#include "report/chart_scale.h"
#include "report/pdf.h"

namespace aspic::report {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> labels(const AxisScale& scale) {
  std::vector<std::string> result;
  for (const Tick& tick : scale.ticks())
    if (!tick.label.empty()) result.push_back(tick.label);
  return result;
}

TEST(AxisScale, LinearTicksAreRound) {
  const AxisScale scale({"", Scale::linear, 0.0, 4.0}, {});
  EXPECT_THAT(labels(scale), ElementsAre("0", "1", "2", "3", "4"));
  EXPECT_EQ(scale.at(0.0), 0.0);
  EXPECT_EQ(scale.at(1.0), 0.25);
  const AxisScale small({"", Scale::linear, -0.2, 0.3}, {});
  EXPECT_THAT(labels(small), ElementsAre("-0.2", "-0.1", "0", "0.1", "0.2", "0.3"));
  EXPECT_THAT(labels(AxisScale({"", Scale::linear, 0.0, 2e5}, {})),
              ElementsAre("0", "50000", "10⁵", "1.5·10⁵", "2·10⁵"));
}

TEST(AxisScale, LogTicksAreDecades) {
  const AxisScale scale({"", Scale::log, 1e-8, 1e-2}, {});
  EXPECT_THAT(labels(scale), ElementsAre("10⁻⁸", "10⁻⁷", "10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²"));
  EXPECT_DOUBLE_EQ(scale.at(1e-5), 0.5);
  EXPECT_FALSE(std::isfinite(scale.at(0.0)));
  EXPECT_THAT(labels(AxisScale({"", Scale::log, 0.5, 20.0}, {})),
              ElementsAre("0.5", "1", "2", "5", "10", "20"));
}

TEST(AxisScale, CoversWhatIsFinite) {
  const AxisScale scale({"", Scale::linear},
                        {2.0, std::nan(""), 6.0, std::numeric_limits<double>::infinity()});
  EXPECT_GE(scale.at(2.0), 0.0);
  EXPECT_LE(scale.at(6.0), 1.0);
  EXPECT_GT(scale.at(6.0), 0.5);
}

Chart chart() {
  Chart c;
  Curve curve{
      "<rise & fall>", {{1.0, 2.5}, {2.0, std::nan("")}, {3.0, 0.1}}, Palette::category, 0, true, true};
  c.panels.push_back({"one", {"x [s]"}, {"y [m]"}, {curve}});
  return c;
}

TEST(Chart, DrawsWhatItsCsvHolds) {
  EXPECT_EQ(csv_of(chart()),
            "panel,curve,x,y,x_axis,y_axis\n"
            "one,<rise & fall>,1,2.5,x [s],y [m]\n"
            "one,<rise & fall>,2,,x [s],y [m]\n"
            "one,<rise & fall>,3,0.1,x [s],y [m]\n");
  const std::string svg = svg_of(chart(), "c", Medium::screen);
  EXPECT_THAT(svg, HasSubstr("<title>&lt;rise &amp; fall&gt;: 1, 2.5</title>"));
  EXPECT_THAT(svg, HasSubstr("<title>&lt;rise &amp; fall&gt;: 3, 0.1</title>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, HasSubstr("x [s]"));
  EXPECT_THAT(svg_of(chart(), "c", Medium::file), HasSubstr("xmlns"));
}

TEST(Chart, MapsTellStableFromUnstable) {
  Chart c;
  Panel panel{"map", {"h", Scale::log}, {"k", Scale::log}, {}};
  panel.map = CellMap{{1, 10}, {1}, {0.3, 3, 30}, {0.3, 3}, {true, false}};
  c.panels.push_back(panel);
  const std::string svg = svg_of(c, "m", Medium::screen);
  EXPECT_THAT(svg, HasSubstr("<title>1, 1: stable</title>"));
  EXPECT_THAT(svg, HasSubstr("<title>10, 1: unstable</title>"));
  EXPECT_THAT(csv_of(c), HasSubstr("map,unstable,10,1,h,k\n"));
}

TEST(Numbers, AreShort) {
  EXPECT_EQ(rounded(0.00204820418), "0.002048");
  EXPECT_EQ(rounded(9.1467e-5), "9.147·10⁻⁵");
  EXPECT_EQ(rounded(1e-7), "10⁻⁷");
  EXPECT_EQ(rounded(0.0), "0");
  EXPECT_EQ(rounded(123456.0, 3), "1.23·10⁵");
}

TEST(Page, IsOneFileWithItsImages) {
  Figure figure;
  figure.id = "f";
  figure.caption = "A `code` <caption>";
  figure.command = "aspic run a && b";
  figure.chart = chart();
  figure.table = Table{{{"name"}, {"value"}}, {{"a, b", 0.123456}, {"none", Cell()}}};
  figure.strip = Strip{{"t = 1 s"}, {{"row", "note", {"JPEG"}}}};
  Page page;
  page.title = "T";
  page.sections = {{"s", "S", {"A paragraph."}, {figure}}};
  page.colophon = {{"machine", "M"}};
  page.scene_toml = "schema = 1\n";
  const std::string html = html_of(page);
  EXPECT_THAT(html, HasSubstr("<data value=\"0.123456\">0.1235</data>"));
  EXPECT_THAT(html, HasSubstr("src=\"data:image/jpeg;base64,SlBFRw==\""));
  EXPECT_THAT(html, HasSubstr("A <code>code</code> &lt;caption&gt;"));
  EXPECT_THAT(html, HasSubstr("aspic run a &amp;&amp; b"));
  EXPECT_THAT(html, HasSubstr("prefers-color-scheme:dark"));
  EXPECT_THAT(html, Not(HasSubstr("http://")));
  EXPECT_THAT(html, Not(HasSubstr("https://")));
  const std::string markdown = markdown_of(page);
  EXPECT_THAT(markdown, HasSubstr("| a, b | 0.1235 |"));
  EXPECT_THAT(markdown, HasSubstr("![](figures/f-1-1.jpg)"));
  const auto files = files_of(page);
  EXPECT_EQ(files.at("data/f-table.csv"), "name,value\n\"a, b\",0.123456\nnone,\n");
  EXPECT_EQ(files.at("figures/f-1-1.jpg"), "JPEG");
  EXPECT_TRUE(files.contains("figures/f.svg"));
}

TEST(Page, NamesItsAuthorBelowTheTitle) {
  Page page;
  page.title = "T";
  page.lead = "Lead.";
  EXPECT_THAT(html_of(page), HasSubstr("<h1>T</h1><p>Lead.</p>"));
  EXPECT_THAT(markdown_of(page), testing::StartsWith("# T\n\nLead.\n"));
  page.author = "A & B";
  EXPECT_THAT(html_of(page), HasSubstr("<h1>T</h1><p class=\"by\">A &amp; B</p><p>Lead.</p>"));
  EXPECT_THAT(markdown_of(page), testing::StartsWith("# T\n\nA \\& B\n\nLead.\n"));
  for (const auto& [author, written] :
       std::initializer_list<std::pair<const char*, const char*>>{{"# one <b>", "\\# one \\<b\\>"},
                                                                  {"1. Ann", "1\\. Ann"},
                                                                  {"- Ann", "\\- Ann"},
                                                                  {"B. O'Neil-Lee", "B. O'Neil-Lee"}}) {
    page.author = author;
    EXPECT_THAT(markdown_of(page), testing::StartsWith(std::string("# T\n\n") + written + "\n\nLead.\n"));
  }
}

TEST(Chart, OnPaperHasReadableLettersAndSharedAxes) {
  Chart c;
  c.columns = 2;
  for (const char* const title : {"a", "b", "c", "d"})
    c.panels.push_back({title, {"h", Scale::linear, 0.0, 1.0}, {"k", Scale::linear, 0.0, 1.0}, {}});
  const auto count = [](const std::string& text, std::string_view part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
  };
  const std::string screen = svg_of(c, "c", Medium::screen), paper = svg_of(c, "c", Medium::paper, 680);
  EXPECT_THAT(paper, HasSubstr("viewBox=\"0 0 680 "));
  EXPECT_EQ(count(screen, ">h</text>"), 4u);
  EXPECT_EQ(count(paper, ">h</text>"), 2u) << "below the lower panels";
  EXPECT_EQ(count(paper, ">k</text>"), 2u) << "left of the left ones";
  EXPECT_THAT(svg_of(chart(), "c", Medium::paper), Not(HasSubstr("<title>")));
  // Both are in one page.
  EXPECT_THAT(screen, HasSubstr("\"c-0\""));
  EXPECT_THAT(paper, Not(HasSubstr("\"c-0\"")));
  c.panels[3].x.to = 2.0;
  EXPECT_EQ(count(svg_of(c, "c", Medium::paper, 680), ">h</text>"), 4u) << "another axis";
}

TEST(Chart, LabelsDoNotLieOnEachOther) {
  Chart c;
  c.columns = 4;
  c.panels.assign(4, {"p", {"n", Scale::linear, 0.0, 0.0005}, {"y"}, {}});
  const std::string paper = svg_of(c, "c", Medium::paper, 680);
  EXPECT_THAT(paper, HasSubstr(">0</text>"));
  EXPECT_THAT(paper, Not(HasSubstr(">0.0001</text>"))) << "0.0002 would touch it";
}

TEST(Pdf, CountsPages) {
  EXPECT_EQ(
      pages_of_pdf("<</Type /Pages /Count 2>> <</Type /Page>> <</Type/Page/Parent 1 0 R>> <</Type /Font>>"),
      2u);
  EXPECT_EQ(pages_of_pdf("<</Type\n/Page\n>>"), 1u);
  EXPECT_EQ(pages_of_pdf("<</Type /ObjStm>> <</Subtype /Type1>> /Type /Page"), 1u);
  EXPECT_EQ(pages_of_pdf("%PDF-1.7 <</Type /ObjStm>> /Type"), std::nullopt);
  EXPECT_EQ(pages_of_pdf(""), std::nullopt);
}

TEST(Page, MarksGapsForItsReadersWords) {
  Figure figure;
  figure.id = "f";
  figure.table = Table{{{"name"}}, {{"a"}}};
  figure.gap = "Why?";
  Page page;
  page.sections = {{"s", "S", {}, {figure}, {"What next?"}}, {"t", "T", {}, {}, {}, true}};
  page.scene_toml = "schema = 1\n";
  page.scene_in_file = true;
  const std::string html = html_of(page), markdown = markdown_of(page);
  EXPECT_THAT(html, HasSubstr("<h2>S</h2>"));
  EXPECT_THAT(html, HasSubstr("<h3>T</h3>"));
  EXPECT_LT(html.find("Why?"), html.find("What next?"));
  EXPECT_THAT(html, HasSubstr("contenteditable"));
  EXPECT_THAT(markdown, HasSubstr("\n> **Your words.** Why?\n"));
  EXPECT_THAT(markdown, HasSubstr("\n### T\n"));
  for (const std::string& text : {html, markdown}) EXPECT_THAT(text, Not(HasSubstr("schema = 1")));
  const auto files = files_of(page);
  EXPECT_EQ(files.at("data/scene.toml"), "schema = 1\n");
  EXPECT_EQ(files.size(), 1u) << "a table that nothing measured has no CSV";
}

TEST(Base64, FillsTheLastGroup) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
}

}  // namespace
}  // namespace aspic::report
